/// Compiled once per instruction set.
#include "analysis/sieve_kernels.h"

#include <bit>

#include "math/lanes.h"

namespace gumshoe::analysis {
namespace {

Lanes powers_of_two() {
  alignas(64) double x[Lanes::size];
  for (std::size_t i = 0; i < Lanes::size; ++i) x[i] = static_cast<double>(1u << i);
  return Lanes::load_aligned(x);
}

std::size_t within(const double* x, std::size_t n, const SieveBounds& b, double* out) {
  const Lanes low0(b.low[0]), high0(b.high[0]), low1(b.low[1]), high1(b.high[1]), powers = powers_of_two(), zero(0.0);
  std::size_t count = 0, i = 0;
  for (; i + Lanes::size <= n; i += Lanes::size) {
    const Lanes v = Lanes::load_unaligned(x + i);
    const auto in = ((v >= low0) & (v <= high0)) | ((v >= low1) & (v <= high1));
    if (!xsimd::any(in)) continue;
    for (auto bits = static_cast<unsigned>(xsimd::hadd(xsimd::select(in, powers, zero))); bits != 0; bits &= bits - 1)
      out[count++] = x[i + static_cast<std::size_t>(std::countr_zero(bits))];
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
