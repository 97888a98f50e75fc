#include "analysis/pick_freeze.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>

#include "analysis/units.h"
#include "base/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::analysis::PickFreezeKernels, pick_freeze)

namespace gumshoe::analysis {

using quantities::Purpose;

const PickFreezeKernels& pick_freeze_kernels() { return *GUMSHOE_BEST_KERNELS(pick_freeze); }

std::vector<std::vector<bool>> reaching_variates(const propagation::Experiment& e) {
  const auto& plan = e.plan();
  std::vector<std::vector<bool>> reaches(e.outputs().size(), std::vector<bool>(plan.variates.size(), false));
  for (std::size_t o = 0; o < reaches.size(); ++o)
    for (const std::size_t c : e.columns_at(e.outputs()[o].reading))
      for (const std::size_t v : plan.columns[c].variates) reaches[o][v] = true;
  return reaches;
}

std::vector<Factor> factors(const propagation::Experiment& e) {
  const auto& plan = e.plan();
  std::vector<Factor> found;
  std::vector<std::size_t> of_quantity(e.scenario().quantities.size(), plan.variates.size());
  for (std::size_t v = 0; v < plan.variates.size(); ++v) {
    std::size_t& place = of_quantity[plan.variates[v].quantity];
    if (!e.scenario().analysis.sensitivity.by_quantity) {
      found.push_back({plan.variates[v].name, {v}});
    } else if (place == plan.variates.size()) {
      place = found.size();
      found.push_back({e.scenario().quantities[plan.variates[v].quantity].name, {v}});
    } else {
      found[place].variates.push_back(v);
    }
  }
  return found;
}

bool reaches(const std::vector<bool>& variates, const Factor& factor) {
  return std::ranges::any_of(factor.variates, [&](std::size_t v) { return variates[v]; });
}

namespace {

/// One block of rows: its draws, its outputs, and which rows failed. Its buffers serve one block after the other.
class PickFrozen {
public:
  PickFrozen(const propagation::Experiment& e, const quantities::Sampler& sampler, const std::vector<Factor>& factors)
      : e_(e), sampler_(sampler), factors_(factors), d_(e.plan().variates.size()), outputs_(e.outputs().size()),
        pointers_(d_), columns_of_(factors.size()) {
    std::vector<std::size_t> factor_of(d_);
    for (std::size_t f = 0; f < factors.size(); ++f)
      for (const std::size_t v : factors[f].variates) factor_of[v] = f;
    for (std::size_t c = 0; c < e.plan().columns.size(); ++c)
      for (const std::size_t v : e.plan().columns[c].variates) {
        auto& columns = columns_of_[factor_of[v]];
        if (columns.empty() || columns.back() != c) columns.push_back(c);
      }
  }

  void draw(std::uint64_t first, std::size_t rows) {
    const Aligned at(first);
    rows_ = rows;
    offset_ = at.offset;
    stride_ = at.offset + rows;
    a_.resize(d_ * stride_);
    b_.resize(d_ * stride_);
    status_.resize(rows);
    failed_.assign(rows, 0);
    sampler_.draw(at.begin, stride_, Purpose::sampling, a_.data(), stride_);
    sampler_.draw(at.begin, stride_, Purpose::pick_freeze, b_.data(), stride_);
  }

  /// Outputs [output * rows + i] of the unchanged row; `freezing`: run_frozen follows.
  void run(bool from_a, std::vector<double>& y, bool freezing) {
    y.resize(outputs_ * rows_);
    for (std::size_t v = 0; v < d_; ++v) pointers_[v] = column(from_a ? a_ : b_, v);
    const auto run = freezing ? &propagation::Experiment::run_and_keep : &propagation::Experiment::run;
    (e_.*run)(pointers_, rows_, workspace_, y.data(), status_.data());
    note_failed();
  }

  /// After run() for it: outputs [(f * outputs + output) * rows + i] of the rows with factor f from the other draw.
  void run_frozen(bool from_a, std::vector<double>& y) {
    y.resize(factors_.size() * outputs_ * rows_);
    const std::vector<double>&x = from_a ? a_ : b_, &other = from_a ? b_ : a_;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      for (const std::size_t v : factors_[f].variates) pointers_[v] = column(other, v);
      e_.run_changed(pointers_, columns_of_[f], rows_, workspace_, &y[f * outputs_ * rows_], status_.data());
      note_failed();
      for (const std::size_t v : factors_[f].variates) pointers_[v] = column(x, v);
    }
  }

  bool any_failed() const {
    return std::ranges::any_of(failed_, [](std::uint8_t f) { return f != 0; });
  }

  /// A failed row lies at the origin, so that it adds nothing to any sum.
  void silence_failed(std::vector<double>& y, const std::vector<double>& origin) const {
    for (std::size_t row = 0; row < y.size() / rows_; ++row)
      for (std::size_t i = 0; i < rows_; ++i)
        if (failed_[i] != 0) y[row * rows_ + i] = origin[row % outputs_];
  }

  const std::vector<std::uint8_t>& failed() const { return failed_; }

private:
  const double* column(const std::vector<double>& x, std::size_t v) const { return &x[v * stride_ + offset_]; }

  void note_failed() {
    const std::uint8_t* __restrict status = status_.data();
    std::uint8_t* __restrict failed = failed_.data();
    const std::size_t n = rows_; // a byte may alias a member
    for (std::size_t i = 0; i < n; ++i) failed[i] = static_cast<std::uint8_t>(failed[i] | status[i]);
  }

  const propagation::Experiment& e_;
  const quantities::Sampler& sampler_;
  const std::vector<Factor>& factors_;
  std::size_t d_, outputs_, rows_ = 0, offset_ = 0, stride_ = 0;
  std::vector<double> a_, b_;
  std::vector<const double*> pointers_;
  std::vector<std::vector<std::size_t>> columns_of_;
  std::vector<std::uint8_t> status_, failed_;
  propagation::Workspace workspace_;
};

/// Outputs of rows A, B, AB_i and BA_i.
struct Outputs {
  std::vector<double> a, b, c, d;
};

/// The design of one experiment. Thread-safe.
class Design {
public:
  Design(const propagation::Experiment& e, std::uint64_t n, bool mirrored)
      : e_(e), units_(units_of_rows(n)), mirrored_(mirrored), factors_(factors(e)), reaching_(reaching_variates(e)),
        sampler_(e.plan(), quantities::PointSet::monte_carlo, units_.rows) {}

  const RowUnits& units() const { return units_; }
  PickFreezeSums no_sums(std::uint64_t rows) const {
    return {rows, e_.outputs().size(), factors_.size(), (rows + units_.per_group - 1) / units_.per_group, mirrored_};
  }

  /// Sums of the rows [first, last).
  PickFreezeSums sums(std::uint64_t first, std::uint64_t last) const {
    std::call_once(once_, [&] { origin_ = origins(); });
    PickFreezeSums s = no_sums(last - first);
    PickFrozen block(e_, sampler_, factors_);
    Outputs y;
    for (std::uint64_t at = first; at < last; at += most_rows)
      add(s, block, y, at, std::min<std::uint64_t>(most_rows, last - at), (at - first) / units_.per_group);
    return s;
  }

private:
  /// Means of the outputs over the first 64 rows: from there, squares do not drown the variance.
  std::vector<double> origins() const {
    constexpr std::size_t n = 64;
    const std::size_t outputs = e_.outputs().size();
    std::vector<double> y, origin(outputs);
    PickFrozen block(e_, sampler_, factors_);
    block.draw(0, n);
    block.run(true, y, false);
    for (std::size_t o = 0; o < outputs; ++o) {
      double sum = 0, valid = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (block.failed()[i] == 0) sum += y[o * n + i], ++valid;
      if (valid > 0) origin[o] = sum / valid;
    }
    return origin;
  }

  /// Rows [first, first + rows) into the sums of the groups from `group` on.
  void add(PickFreezeSums& s, PickFrozen& block, Outputs& y, std::uint64_t first, std::size_t rows,
           std::size_t group) const {
    const std::size_t outputs = e_.outputs().size(), per_group = units_.per_group,
                      groups = (rows + per_group - 1) / per_group;
    block.draw(first, rows);
    block.run(false, y.b, mirrored_);
    if (mirrored_) block.run_frozen(false, y.d);
    block.run(true, y.a, true);
    block.run_frozen(true, y.c);
    if (block.any_failed())
      for (auto* values : {&y.a, &y.b, &y.c, &y.d}) block.silence_failed(*values, origin_);
    for (std::size_t o = 0; o < outputs; ++o) {
      const double *a = &y.a[o * rows], *b = &y.b[o * rows], from = origin_[o];
      const auto c = [&](std::size_t v) { return &y.c[(v * outputs + o) * rows]; };
      const auto mirror = [&](std::size_t v) { return &y.d[(v * outputs + o) * rows]; };
      kernels_.base(a, b, from, rows, per_group, s.base(o, 0) + group, s.groups);
      for (std::size_t g = 0; g < groups; ++g) {
        const auto begin = block.failed().begin() + static_cast<std::ptrdiff_t>(g * per_group);
        const auto end = block.failed().begin() + static_cast<std::ptrdiff_t>(std::min(rows, (g + 1) * per_group));
        s.base(o, base_n)[group + g] = static_cast<double>(std::count(begin, end, std::uint8_t{0}));
      }
      for (std::size_t v = 0; v < factors_.size(); ++v) {
        if (!reaches(reaching_[o], factors_[v])) continue;
        kernels_.frozen(a, b, c(v), from, rows, per_group, s.frozen(o, v, 0) + group, s.groups);
        if (!mirrored_) continue;
        kernels_.mirrored(a, b, c(v), mirror(v), from, rows, per_group, s.frozen(o, v, 0) + group, s.groups);
        for (std::size_t i = 0; i < v; ++i)
          if (reaches(reaching_[o], factors_[i]))
            kernels_.pair(a, b, c(i), mirror(i), c(v), mirror(v), rows, per_group, s.pair(o, i, v) + group);
      }
    }
  }

  const propagation::Experiment& e_;
  RowUnits units_;
  bool mirrored_;
  std::vector<Factor> factors_;
  std::vector<std::vector<bool>> reaching_;
  quantities::Sampler sampler_;
  const PickFreezeKernels& kernels_ = pick_freeze_kernels();
  mutable std::once_flag once_; ///< processes that are given all sums need no origin
  mutable std::vector<double> origin_;
};

} // namespace

PickFreezeSums::PickFreezeSums(std::uint64_t rows_, std::size_t outputs_, std::size_t factors_, std::size_t groups_,
                               bool mirrored_)
    : rows(rows_), outputs(outputs_), factors(factors_), groups(groups_), mirrored(mirrored_),
      values(sums() * groups_) {}

propagation::Work pick_freeze_work(const propagation::Experiment& e, std::uint64_t n, bool mirrored) {
  const auto design = std::make_shared<const Design>(e, n, mirrored);
  const RowUnits units = design->units();
  const std::size_t sums = design->no_sums(0).sums(), d = factors(e).size();
  return {.name = "sobol",
          .units = units.groups,
          .values = sums,
          .runs = units.per_group * (mirrored ? 2 * d + 2 : d + 2),
          .together = units.together(e.model().block),
          .compute = [design, units, sums](std::uint64_t first, std::uint64_t last, double* out) {
            const PickFreezeSums s = design->sums(units.row(first), units.row(last));
            units.by_unit(s.values, sums, last - first, out);
          }};
}

PickFreezeSums run_pick_freeze(const propagation::Experiment& e, std::uint64_t n, bool mirrored,
                               const propagation::Workers& workers) {
  const RowUnits units = units_of_rows(n);
  PickFreezeSums s(units.rows, e.outputs().size(), factors(e).size(), units.groups, mirrored);
  workers.run(pick_freeze_work(e, n, mirrored), [&](std::uint64_t first, std::uint64_t last, const double* values) {
    units.by_sum(values, s.sums(), first, last, s.values);
  });
  return s;
}

} // namespace gumshoe::analysis
