/// Sums of the pick-freeze design. Compiled once per instruction set.
#include <algorithm>

#include "analysis/pick_freeze_sums.h"
#include "math/lanes.h"

namespace gumshoe::analysis {
namespace {

constexpr std::size_t lanes = 8, parts = lanes / Lanes::size;

/// Eight running sums, whatever the width of the lanes.
struct Sum {
  Lanes part[parts];
  Sum() {
    for (auto& p : part) p = Lanes(0.0);
  }
  double total() const {
    alignas(64) double x[lanes];
    for (std::size_t p = 0; p < parts; ++p) part[p].store_aligned(x + p * Lanes::size);
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
  }
};

/// Calls body(sums, p, i) for each part p of each eight rows from i, group by group.
template <std::size_t n, class Body>
inline void each_group(std::size_t rows, std::size_t per_group, double* out, std::size_t stride, const Body& body) {
  for (std::size_t g = 0, first = 0; first < rows; ++g, first += per_group) {
    Sum sum[n];
    const std::size_t end = std::min(rows, first + per_group);
    for (std::size_t i = first; i < end; i += lanes)
      for (std::size_t p = 0; p < parts; ++p) body(sum, p, i + p * Lanes::size);
    for (std::size_t s = 0; s < n; ++s) out[s * stride + g] = sum[s].total();
  }
}

inline Lanes at(const double* x, std::size_t i) { return Lanes::load_unaligned(x + i); }

void base(const double* a, const double* b, double origin, std::size_t rows, std::size_t per_group, double* out,
          std::size_t stride) {
  const Lanes from(origin);
  each_group<5>(rows, per_group, out + base_a * stride, stride, [=](Sum* sum, std::size_t p, std::size_t i) {
    const Lanes ya = at(a, i) - from, yb = at(b, i) - from;
    sum[0].part[p] += ya;
    sum[1].part[p] += ya * ya;
    sum[2].part[p] += yb;
    sum[3].part[p] += yb * yb;
    sum[4].part[p] += ya * yb;
  });
}

void frozen(const double* a, const double* b, const double* c, double origin, std::size_t rows, std::size_t per_group,
            double* out, std::size_t stride) {
  const Lanes from(origin);
  each_group<4>(rows, per_group, out, stride, [=](Sum* sum, std::size_t p, std::size_t i) {
    const Lanes yc = at(c, i) - from, change = at(a, i) - from - yc;
    sum[0].part[p] += yc;
    sum[1].part[p] += yc * yc;
    sum[2].part[p] += (at(b, i) - from) * yc;
    sum[3].part[p] += change * change;
  });
}

void mirrored(const double* a, const double* b, const double* c, const double* d, double origin, std::size_t rows,
              std::size_t per_group, double* out, std::size_t stride) {
  const Lanes from(origin);
  each_group<5>(rows, per_group, out + frozen_d * stride, stride, [=](Sum* sum, std::size_t p, std::size_t i) {
    const Lanes yd = at(d, i) - from, change = at(b, i) - from - yd;
    sum[0].part[p] += yd;
    sum[1].part[p] += yd * yd;
    sum[2].part[p] += (at(a, i) - from) * yd;
    sum[3].part[p] += (at(c, i) - from) * yd;
    sum[4].part[p] += change * change;
  });
}

void pair(const double* a, const double* b, const double* ci, const double* di, const double* cj, const double* dj,
          std::size_t rows, std::size_t per_group, double* out) {
  each_group<1>(rows, per_group, out, 0, [=](Sum* sum, std::size_t p, std::size_t i) {
    const Lanes ya = at(a, i), yb = at(b, i);
    sum[0].part[p] += (at(ci, i) - ya) * (at(dj, i) - yb) + (at(cj, i) - ya) * (at(di, i) - yb);
  });
}

} // namespace
} // namespace gumshoe::analysis

extern "C" const gumshoe::analysis::PickFreezeKernels GUMSHOE_KERNEL(gumshoe_pick_freeze_);
const gumshoe::analysis::PickFreezeKernels GUMSHOE_KERNEL(gumshoe_pick_freeze_) = {
    gumshoe::analysis::base, gumshoe::analysis::frozen, gumshoe::analysis::mirrored, gumshoe::analysis::pair};
