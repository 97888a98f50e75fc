#include "analysis/pick_freeze.h"

#include <algorithm>
#include <bit>

#include "base/instruction_set.h"
#include "propagation/propagate.h"

extern "C" {
extern const gumshoe::analysis::PickFreezeKernels gumshoe_pick_freeze_sse2, gumshoe_pick_freeze_avx2,
    gumshoe_pick_freeze_avx512;
}

namespace gumshoe::analysis {

using quantities::Purpose;

const PickFreezeKernels& pick_freeze_kernels() {
#ifdef GUMSHOE_HAS_AVX2
  switch (best_instruction_set()) {
  case InstructionSet::avx512:
    return gumshoe_pick_freeze_avx512;
  case InstructionSet::avx2:
    return gumshoe_pick_freeze_avx2;
  default:
    break;
  }
#endif
  return gumshoe_pick_freeze_sse2;
}

std::size_t rows_per_group(std::uint64_t rows) {
  return std::clamp<std::size_t>(std::bit_ceil((rows + 1023) / 1024), 8, 1024);
}

std::vector<std::vector<bool>> reaching_variates(const propagation::Experiment& e) {
  const auto& plan = e.plan();
  std::vector<std::vector<bool>> reaches(e.outputs().size(), std::vector<bool>(plan.variates.size(), false));
  for (std::size_t o = 0; o < reaches.size(); ++o)
    for (const std::size_t c : plan.gather[e.outputs()[o].reading])
      for (const std::size_t v : plan.columns[c].variates) reaches[o][v] = true;
  return reaches;
}

namespace {

constexpr std::size_t rows_per_block = 1024; // a multiple of every group's rows

/// One block of rows: its draws, its outputs, and the columns that a variate moves.
class Block {
public:
  Block(const propagation::Experiment& e, const quantities::Sampler& sampler, std::uint64_t first, std::size_t rows)
      : e_(e), rows_(rows), d_(e.plan().variates.size()), outputs_(e.outputs().size()), a_(d_ * rows), b_(d_ * rows),
        pointers_(d_), status_(rows), failed_(rows, 0) {
    sampler.draw(first, rows, Purpose::sampling, a_.data(), rows);
    sampler.draw(first, rows, Purpose::pick_freeze, b_.data(), rows);
  }

  /// The unchanged row, and then for each variate the row in which it is frozen to the other draw.
  void run(bool from_a, const std::vector<std::vector<std::size_t>>& columns_of, double* base, double* frozen,
           bool all) {
    const std::vector<double>&x = from_a ? a_ : b_, &other = from_a ? b_ : a_;
    for (std::size_t v = 0; v < d_; ++v) pointers_[v] = &x[v * rows_];
    model(base, nullptr);
    if (!all) return;
    std::vector<std::size_t> changed;
    for (std::size_t v = 0; v < d_; ++v) {
      pointers_[v] = &other[v * rows_];
      changed = columns_of[v];
      if (v > 0) changed.insert(changed.end(), columns_of[v - 1].begin(), columns_of[v - 1].end());
      model(frozen + v * outputs_ * rows_, &changed);
      pointers_[v] = &x[v * rows_];
    }
  }

  /// Outputs from the origin; a failed row's are zero, so that it adds nothing to any sum.
  void settle(std::vector<double>& y, const std::vector<double>& origin) const {
    const bool any = std::ranges::any_of(failed_, [](std::uint8_t f) { return f != 0; });
    for (std::size_t row = 0; row < y.size() / rows_; ++row) {
      const double from = origin[row % outputs_];
      double* values = &y[row * rows_];
      for (std::size_t i = 0; i < rows_; ++i) values[i] -= from;
      for (std::size_t i = 0; any && i < rows_; ++i)
        if (failed_[i] != 0) values[i] = 0;
    }
  }

  const std::vector<std::uint8_t>& failed() const { return failed_; }

private:
  void model(double* y, const std::vector<std::size_t>* changed) {
    e_.run(pointers_, rows_, workspace_, y, status_.data(), changed);
    for (std::size_t i = 0; i < rows_; ++i) failed_[i] |= status_[i];
  }

  const propagation::Experiment& e_;
  std::size_t rows_, d_, outputs_;
  std::vector<double> a_, b_;
  std::vector<const double*> pointers_;
  std::vector<std::uint8_t> status_, failed_;
  propagation::Workspace workspace_;
};

/// Means of the outputs over the first 64 rows: from there, squares do not drown the variance.
std::vector<double> origins(const propagation::Experiment& e, const quantities::Sampler& sampler) {
  constexpr std::size_t n = 64;
  const std::size_t outputs = e.outputs().size();
  std::vector<double> y(outputs * n), origin(outputs);
  Block block(e, sampler, 0, n);
  block.run(true, {}, y.data(), nullptr, false);
  for (std::size_t o = 0; o < outputs; ++o) {
    double sum = 0, valid = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (block.failed()[i] == 0) sum += y[o * n + i], ++valid;
    if (valid > 0) origin[o] = sum / valid;
  }
  return origin;
}

} // namespace

PickFreezeSums run_pick_freeze(const propagation::Experiment& e, std::uint64_t n, bool mirrored, int threads) {
  const auto& plan = e.plan();
  n = (n + 63) / 64 * 64;
  const std::size_t d = plan.variates.size(), outputs = e.outputs().size(), per_group = rows_per_group(n);
  PickFreezeSums s{n, outputs, d, (n + per_group - 1) / per_group, mirrored, {}, {}, {}};
  s.base_values.resize(outputs * base_sums * s.groups);
  s.frozen_values.resize(outputs * d * s.kept() * s.groups);
  if (mirrored) s.pair_values.resize(outputs * s.pairs() * s.groups);

  const auto reaches = reaching_variates(e);
  std::vector<std::vector<std::size_t>> columns_of(d);
  for (std::size_t c = 0; c < plan.columns.size(); ++c)
    for (const std::size_t v : plan.columns[c].variates) columns_of[v].push_back(c);
  const quantities::Sampler sampler(plan, quantities::PointSet::monte_carlo, n);
  const std::vector<double> origin = origins(e, sampler);
  const PickFreezeKernels& kernels = pick_freeze_kernels();

  const std::size_t blocks = (n + rows_per_block - 1) / rows_per_block;
  propagation::parallel_for(blocks, threads, [&](std::size_t at) {
    const std::uint64_t first = at * rows_per_block;
    const std::size_t rows = std::min<std::uint64_t>(rows_per_block, n - first);
    const std::size_t group = first / per_group, groups = (rows + per_group - 1) / per_group;
    std::vector<double> ya(outputs * rows), yb(outputs * rows), yc(d * outputs * rows), yd;
    if (mirrored) yd.resize(d * outputs * rows);
    Block block(e, sampler, first, rows);
    block.run(false, columns_of, yb.data(), yd.data(), mirrored);
    block.run(true, columns_of, ya.data(), yc.data(), true);
    for (auto* y : {&ya, &yb, &yc, &yd}) block.settle(*y, origin);

    for (std::size_t o = 0; o < outputs; ++o) {
      const double *a = &ya[o * rows], *b = &yb[o * rows];
      const auto c = [&](std::size_t v) { return &yc[(v * outputs + o) * rows]; };
      const auto mirror = [&](std::size_t v) { return &yd[(v * outputs + o) * rows]; };
      kernels.base(a, b, rows, per_group, s.base(o, 0) + group, s.groups);
      for (std::size_t g = 0; g < groups; ++g) {
        const auto begin = block.failed().begin() + static_cast<std::ptrdiff_t>(g * per_group);
        const auto end = block.failed().begin() + static_cast<std::ptrdiff_t>(std::min(rows, (g + 1) * per_group));
        s.base(o, base_n)[group + g] = static_cast<double>(std::count(begin, end, std::uint8_t{0}));
      }
      for (std::size_t v = 0; v < d; ++v) {
        if (!reaches[o][v]) continue;
        kernels.frozen(a, b, c(v), rows, per_group, s.frozen(o, v, 0) + group, s.groups);
        if (!mirrored) continue;
        kernels.mirrored(a, b, c(v), mirror(v), rows, per_group, s.frozen(o, v, 0) + group, s.groups);
        for (std::size_t i = 0; i < v; ++i)
          if (reaches[o][i])
            kernels.pair(a, b, c(i), mirror(i), c(v), mirror(v), rows, per_group, s.pair(o, i, v) + group);
      }
    }
  });
  return s;
}

} // namespace gumshoe::analysis
