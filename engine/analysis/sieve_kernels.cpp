/// Compiled once per instruction set.
#include "analysis/sieve_kernels.h"

#include "math/store_where.h"

namespace gumshoe::analysis {
namespace {

std::size_t within(const double* x, std::size_t n, const SieveBounds& b, double* out) {
  const Lanes low0(b.low[0]), high0(b.high[0]), low1(b.low[1]), high1(b.high[1]);
  std::size_t count = 0, i = 0;
  for (; i + Lanes::size <= n; i += Lanes::size) {
    const Lanes v = Lanes::load_unaligned(x + i);
    const auto in = ((v >= low0) & (v <= high0)) | ((v >= low1) & (v <= high1));
    count += store_where(in, v, out + count);
  }
  for (; i < n; ++i)
    if ((x[i] >= b.low[0] && x[i] <= b.high[0]) || (x[i] >= b.low[1] && x[i] <= b.high[1])) out[count++] = x[i];
  return count;
}

void outside(const double* x, std::size_t n, double low, double high, std::size_t& below, std::size_t& above) {
  const Lanes least(low), most(high), one(1.0), zero(0.0);
  Lanes under(0.0), over(0.0);
  std::size_t i = 0;
  for (; i + Lanes::size <= n; i += Lanes::size) {
    const Lanes v = Lanes::load_unaligned(x + i);
    under += xsimd::select(v < least, one, zero);
    over += xsimd::select(v > most, one, zero);
  }
  below = static_cast<std::size_t>(xsimd::hadd(under));
  above = static_cast<std::size_t>(xsimd::hadd(over));
  for (; i < n; ++i) below += x[i] < low ? 1 : 0, above += x[i] > high ? 1 : 0;
}

} // namespace
} // namespace gumshoe::analysis

extern "C" const gumshoe::analysis::SieveKernels GUMSHOE_KERNEL(gumshoe_sieve_);
const gumshoe::analysis::SieveKernels GUMSHOE_KERNEL(gumshoe_sieve_) = {gumshoe::analysis::within,
                                                                        gumshoe::analysis::outside};
