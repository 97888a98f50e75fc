/// What a fit supposes of the noise: declared or estimated, how it differs from reading to reading, and which structure
/// it may have.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/noise/pure_error.h"

namespace gumshoe::tracing {

/// A display says how well a reading can be known, not how readings repeat: that they show themselves, if they can.
bool Fitter::declares_noise() const {
  const bool shown = rows_.size() > unknowns_.size();
  const auto& layout = experiment_.layout().indications;
  return std::ranges::any_of(draws_, [&](const Draw& d) {
    return std::ranges::any_of(d.moves, [&](const auto& move) {
      return layout.contains(move.second) &&
             !(shown && experiment_.scenario().quantities[move.second].display_alone > 0);
    });
  });
}

void Fitter::need_independent_noise() const {
  const auto& s = experiment_.scenario();
  const propagation::Range noise = experiment_.layout().indications;
  for (std::size_t k = 0; k < noise.size(); ++k) {
    const auto independent = [&](const Draw& d) {
      return d.local && d.u > 0 && std::any_of(d.moves.begin(), d.moves.end(), [&](const auto& move) {
               return move.second == noise[k] || !noise.contains(move.second);
             });
    };
    if (std::any_of(draws_.begin(), draws_.end(), independent)) continue;
    const std::string name = s.quantities[noise[k]].name;
    throw InputError({{propagation::find_line(s, "[indications." + name),
                       fmt::format("indications.{}: no noise is declared that differs from reading to reading", name),
                       "residuals are judged by it",
                       "give the noise per = \"reading\", or declare none: it is then estimated from the residuals"}});
  }
}

namespace {

/// Robust standard deviation of independent numbers of median zero. Readings that are alone in their cell are zero but
/// for rounding, and say nothing.
double scale_of(std::vector<double> x) {
  for (double& one : x) one = std::fabs(one);
  const double largest = *std::ranges::max_element(x);
  std::erase_if(x, [&](double one) { return !(one > 1e-9 * largest); });
  if (x.empty()) return 0;
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle / 0.6744897501960817;
}

} // namespace

void Fitter::find_spread() {
  if (noise_declared_ || observations_.indications == 1) return;
  const auto found = scatter_about_cells();
  if (!observations_.one_kind && !found)
    throw InputError(
        {{propagation::find_line(experiment_.scenario(), "[indications"),
          "indications of different kinds have no noise stated",
          "too few readings of equal conditions tell how much each of them scatters",
          "state u of a reading under each [indications.NAME], or trace each kind in a scenario of its own"}});
  if (found && (found->unequal || !observations_.one_kind)) spread_ = found->size / found->size[0];
}

std::optional<NoiseGrowth> Fitter::growth_without(const std::vector<Index>& bad) const {
  std::vector<Index> rows;
  std::ranges::set_difference(rows_, bad, std::back_inserter(rows));
  const JointFit fit = linearised(1);
  if (!fit.valid) return std::nullopt;
  const auto about = about_cells(fit, rows, replicates_);
  if (!about) return std::nullopt;
  return tracing::noise_growth(observations_, replicates_, rows, *about);
}

std::optional<Vector> Fitter::about_cells(const JointFit& fit, const std::vector<Index>& rows,
                                          const Replicates& replicates) const {
  const PureError pure(fit.design, rows, replicates, threads_);
  if (!pure.known()) return std::nullopt; // what the model lacks would count as noise
  return Vector(pure.about_cells(fit.residual(rows)).col(0));
}

Vector Fitter::relative_variance(std::size_t reading) const {
  const auto k = index(observations_.indications);
  if (growth_) return Vector::Constant(k, growth_->variance[index(reading)]);
  return by_label_ ? Vector(by_label_->variance.row(index(reading)).transpose()) : Vector(Vector::Ones(k));
}

std::optional<NoiseByLabel> Fitter::by_label_without(const std::vector<Index>& bad, const JointFit& found,
                                                     const Replicates& replicates) {
  std::vector<Index> rows;
  std::ranges::set_difference(rows_, bad, std::back_inserter(rows));
  const auto about = [&] {
    JointFit fit = found;
    return linearise(fit) ? about_cells(fit, rows, replicates) : std::nullopt;
  };
  by_label_.reset();
  std::optional<NoiseByLabel> best;
  if (const auto equal = about())
    for (const NoiseByLabel& one : noise_by_labels(observations_, replicates, rows, *equal)) {
      by_label_ = one;
      constexpr int rounds = 4; // each comes closer by a share of about one in the readings of a condition
      for (int i = 0; i < rounds; ++i)
        if (const auto weighted = about()) by_label_ = refined(*by_label_, observations_, replicates, rows, *weighted);
      if (by_label_->plain && (!best || by_label_->gain > best->gain)) best = by_label_;
    }
  by_label_.reset();
  return best;
}

/// As in find_growth(), without readings that stand out with these weights and without them.
bool Fitter::weigh_by_label(const JointFit& found) {
  if (noise_declared_ || growth_ || !coarse_.empty()) return false;
  JointFit equally = found;
  if (!linearise(equally)) return false;
  const Replicates replicates =
      PureError(equally.design, rows_, replicates_, threads_).without_idle_factors(equally.residual(rows_));
  const auto best = by_label_without({}, found, replicates);
  if (!best) return false;
  const auto outlying = [&] {
    JointFit fit = found;
    return linearise(fit) ? outlying_in_cells(fit, replicates) : std::vector<Index>{};
  };
  const std::vector<Index> with_equal = outlying();
  by_label_ = best;
  std::vector<Index> bad;
  std::ranges::set_intersection(with_equal, outlying(), std::back_inserter(bad));
  by_label_ = bad.empty() ? best : by_label_without(bad, found, replicates);
  if (!by_label_) return false;
  covariance_models_.clear();
  find_covariance_models();
  return true;
}

std::vector<Index> Fitter::outlying_in_cells(const JointFit& fit, const Replicates& replicates) const {
  std::vector<Index> out;
  if (!fit.valid) return out;
  const auto k = index(observations_.indications);
  for (const Index i : PureError(fit.design, rows_, replicates, threads_).outlying(fit.residual(rows_)))
    for (Index j = i / k * k; j < i / k * k + k; ++j) out.push_back(rows_[index(j)]);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// A reading that stands out, whether noise grows or not, moves the mean of its cell, so that in every pass one reading
/// there seems to scatter more: growth must be there without it.
void Fitter::find_growth() {
  if (noise_declared_ || !coarse_.empty()) return; // rounding scatters by where between two steps a place lies
  const auto grows = growth_without({});
  if (!grows) return;
  const std::vector<Index> with_equal = outlying_in_cells(linearised(1), replicates_);
  growth_ = grows;
  std::vector<Index> bad;
  std::ranges::set_intersection(with_equal, outlying_in_cells(linearised(1), replicates_), std::back_inserter(bad));
  if (bad.empty()) return;
  growth_.reset();
  growth_ = growth_without(bad);
}

double Fitter::mean_readouts() const {
  const auto& all = observations_.readouts;
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

void Fitter::find_coarse() {
  const JointFit fit = linearised(1);
  if (!fit.valid) return;
  const PureError pure(fit.design, rows_, replicates_, threads_);
  if (!pure.known()) return;
  const Vector scatter = pure.scale_by_indication(fit.residual(rows_));
  const double readouts = mean_readouts();
  for (std::size_t k = 0; k < observations_.indications; ++k) {
    const double s = scatter[index(k)] * fit.design.reference[k] * std::sqrt(readouts), step = observations_.step[k];
    std::set<double> values;
    for (std::size_t r = 0; r < observations_.readings; ++r)
      values.insert(observations_.measured[r * observations_.indications + k]);
    constexpr double rounding = 1e-6; // of a step: readings that come back are all equal
    const bool shown = s > rounding * step || values.size() >= criteria.values_of_steps;
    coarse_.push_back(shown && s < criteria.coarse * step);
  }
  if (std::ranges::find(coarse_, true) == coarse_.end()) coarse_.clear();
}

std::optional<Fitter::Scatter> Fitter::scatter_about_cells() const {
  const auto k = index(observations_.indications);
  const JointFit fit = linearised(1);
  if (!fit.valid || rows_.size() < 8 * index(k)) return std::nullopt;
  const PureError pure(fit.design, rows_, replicates_, threads_);
  if (!pure.known()) return std::nullopt; // what the model lacks would count as noise
  const Matrix about = pure.about_cells(fit.residual(rows_));
  Scatter out{Vector(k), false};
  for (Index i = 0; i < k; ++i) {
    std::vector<double> x; // second differences: of what is smooth in time little is left
    for (Index row = i; row + 2 * k < about.rows(); row += k)
      x.push_back((about(row, 0) - 2 * about(row + k, 0) + about(row + 2 * k, 0)) / std::sqrt(6.0));
    // Equal readings are no noise of zero: what rounding of numbers leaves would be the scale.
    const double step = observations_.step[index(i)] / fit.design.reference[index(i)];
    out.size[i] = std::max(scale_of(std::move(x)), step / std::sqrt(12 * mean_readouts()));
  }
  if (!(out.size.minCoeff() > 0)) return std::nullopt;
  // The median has 0.37 of the information of the mean square, and second differences about half of the readings'.
  const double each = pure.freedom() / static_cast<double>(k), u = std::sqrt(1 / (0.37 * 0.5 * each));
  const double ratio = out.size.maxCoeff() / out.size.minCoeff();
  constexpr double sure = 3; // standard deviations
  out.unequal = ratio > criteria.unequal_spread && std::log(ratio) > sure * u;
  return out;
}

/// What comes back in every block is no noise, nor is a slow drift, however well a serial correlation or a variance
/// component would explain it: models of more of either than the scatter about the cells' means admits are left out,
/// and of more correlation than the scatter about a straight line for every pass admits.
void Fitter::find_covariance_models() {
  const JointFit fit = linearised(1);
  if (!fit.valid) return;
  const PureError pure(fit.design, rows_, replicates_, threads_);
  if (!pure.known() || pure.cells() * observations_.indications > criteria.most_cells_of_noise) return;
  Design d = fit.design;
  add_fixed(d, rows_, d.random(rows_, Eigen::all));
  d.random.resize(d.random.rows(), 0);
  d.bent.clear();
  add_fixed(d, rows_, columns_by_group(rows_, d.indications, replicates_.cell, false));
  const Vector residual = fit.residual(rows_);
  const auto models = covariance_models(d, rows_.size());
  const Vector about_cells = criteria_of(d, rows_, residual, threads_);
  for (const bool line : {false, true})
    add_fixed(d, rows_, columns_by_group(rows_, d.indications, replicates_.pass, line));
  const Vector about_lines = criteria_of(d, rows_, residual, threads_);
  const bool few = static_cast<double>(rows_.size() - independent(d, rows_).size()) < criteria.least_pure_freedom;
  for (std::size_t i = 0; i < models.size(); ++i) {
    double least = about_cells[index(i)], least_by_lines = about_lines[index(i)];
    for (std::size_t j = 0; j < models.size(); ++j) {
      const auto &a = models[j], &b = models[i];
      const bool same = a.scatter == b.scatter && a.indication == b.indication;
      if (a.correlation > b.correlation) continue;
      if (a.scatter < 0 || (same && a.ratio <= b.ratio)) least = std::min(least, about_cells[index(j)]);
      if (same && a.ratio == b.ratio) least_by_lines = std::min(least_by_lines, about_lines[index(j)]);
    }
    if (about_cells[index(i)] - least > criteria.too_much_structure) continue;
    if (few || about_lines[index(i)] - least_by_lines <= criteria.too_much_structure)
      covariance_models_.push_back(models[i]);
  }
}

} // namespace gumshoe::tracing
