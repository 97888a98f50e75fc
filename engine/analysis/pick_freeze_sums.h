#pragma once
/// Sums over groups of rows of a pick-freeze design: the loops, compiled once per instruction set, with the same bits
/// in all (eight running sums per group, added up in one order).
#include <cstddef>

namespace gumshoe::analysis {

enum BaseSum { base_n, base_a, base_aa, base_b, base_bb, base_ab, base_sums };
/// c = y_AB_i; d = y_BA_i, in designs that have these rows too (the sums from `frozen_d` on).
enum FrozenSum {
  frozen_c,
  frozen_cc,
  frozen_bc,
  frozen_change, ///< (a - c)^2
  frozen_d,
  frozen_dd,
  frozen_ad,
  frozen_cd,
  frozen_mirrored_change, ///< (b - d)^2
  frozen_sums
};

/// Outputs are taken from `origin`. `rows` in groups of `per_group` (both multiples of 8, the last group may be short);
/// sum s of group g goes to out[s * stride + g].
struct PickFreezeKernels {
  void (*base)(const double* a, const double* b, double origin, std::size_t rows, std::size_t per_group, double* out,
               std::size_t stride); ///< all but base_n
  void (*frozen)(const double* a, const double* b, const double* c, double origin, std::size_t rows,
                 std::size_t per_group, double* out, std::size_t stride);
  void (*mirrored)(const double* a, const double* b, const double* c, const double* d, double origin, std::size_t rows,
                   std::size_t per_group, double* out, std::size_t stride); ///< frozen_d and on
  /// (c_i - a) (d_j - b) + (c_j - a) (d_i - b)
  void (*pair)(const double* a, const double* b, const double* ci, const double* di, const double* cj, const double* dj,
               std::size_t rows, std::size_t per_group, double* out);
};

/// Kernels for the best instruction set of this processor.
const PickFreezeKernels& pick_freeze_kernels();

} // namespace gumshoe::analysis
