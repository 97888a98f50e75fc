#include "analysis/weighted_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/certificate.h"
#include "analysis/combine.h"
#include "analysis/shared_inputs.h"
#include "analysis/validation.h"
#include "base/error.h"
#include "math/variance_ratio.h"

namespace gumshoe::analysis {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The results of one measurand on their way to the mean.
class Combining {
public:
  Combining(const std::vector<NamedResult>& results, const std::vector<std::string>& same, const std::string& output)
      : same_(same) {
    for (std::size_t i = 0; i < results.size(); ++i)
      for (const Summary& s : results[i].results.summaries)
        if (s.output.name == output && !s.output.diagnostic) add(i, results[i], s);
    settle_uncertainties();
  }

  WeightedMean combine(double coverage_probability) {
    find_shared();
    for (std::size_t i = 0; i < size(); ++i) separate(i);
    solve();
    const std::vector<double> weights = own_weights();
    judge(weights);
    add_weighing(weights);
    expand_mean(coverage_probability);
    compare();
    find_alike();
    return std::move(out_);
  }

private:
  std::size_t size() const { return out_.parts.size(); }

  void add(std::size_t i, const NamedResult& result, const Summary& of_samples) {
    const std::string where = result.name + ": " + of_samples.output.name;
    const Budget* b = budget_of(result.results, of_samples.output.name);
    const Summary s = with_stated_uncertainty(of_samples, b);
    const double u = s.standard_uncertainty;
    if (!(u > 0) || !std::isfinite(u) || !std::isfinite(s.estimate))
      throw InputError(where + " has no standard uncertainty", "its weight would not be known", "leave the result out");
    require_proportional(same_, b, of_samples, where);
    if (!std::isfinite(of_samples.standard_uncertainty)) without_variance_.push_back(where);
    if (out_.parts.empty()) out_.mean.output = s.output;
    const propagation::Output& first = out_.mean.output;
    if (s.output.si_unit != first.si_unit)
      throw InputError(where + ": the results have different dimensions",
                       fmt::format("{} and {}", first.unit, s.output.unit));
    WeightedPart part;
    part.result = i;
    part.summary = s;
    part.summary.output.unit = first.unit;
    out_.parts.push_back(part);
    budgets_.push_back(b);
    names_.push_back(where);
    accounted_.push_back(b && b->applicable && b->combined_standard_uncertainty > 0 &&
                         accounts_for_variance(*b, of_samples));
    by_framework_ = by_framework_ && accounted_.back();
  }

  /// One kind of u for all: a mean must not move because one result has enough samples to be validated.
  void settle_uncertainties() {
    if (!by_framework_ && !without_variance_.empty())
      throw InputError(without_variance_[0] + " has no variance by Monte Carlo",
                       "the framework, which states its standard uncertainty, does not account for that of the others",
                       "leave the result out");
    for (std::size_t i = 0; i < size(); ++i) {
      Summary& s = out_.parts[i].summary;
      s.degrees_of_freedom = infinite;
      if (!by_framework_) continue;
      s.standard_uncertainty = budgets_[i]->combined_standard_uncertainty;
      if (const double freedom = budgets_[i]->effective_degrees_of_freedom; freedom > 0) s.degrees_of_freedom = freedom;
    }
  }

  /// What a component adds to u. That of samples has a t's standard deviation, not its scale.
  double contribution(const Contribution& c) const {
    return signed_contribution(c) * (by_framework_ ? 1 : std::sqrt(variance_over_scale(c)));
  }

  bool is_same(const Contribution& c) const { return std::ranges::find(same_, c.quantity) != same_.end(); }

  /// The components of `same` that two budgets have.
  void find_shared() {
    std::map<std::string, std::vector<const Contribution*>> found;
    for (std::size_t i = 0; i < size(); ++i)
      if (budgets_[i])
        for (const Contribution& c : budgets_[i]->contributions)
          if (is_same(c)) found.try_emplace(c.name, size(), nullptr).first->second[i] = &c;
    for (const auto& [name, by_part] : found) {
      if (std::ranges::count(by_part, nullptr) > static_cast<std::ptrdiff_t>(size()) - 2) continue;
      SharedPart shared;
      shared.name = name;
      shared.degrees_of_freedom = infinite;
      for (std::size_t i = 0; i < size(); ++i) {
        const Contribution* c = by_part[i];
        shared.contributions.push_back(c ? contribution(*c) : 0);
        if (c && by_framework_) shared.degrees_of_freedom = std::min(shared.degrees_of_freedom, c->degrees_of_freedom);
        if (c) shared.quantity = c->quantity;
      }
      out_.shared.push_back(std::move(shared));
    }
  }

  bool shares(const std::string& component, std::size_t i) const {
    return std::ranges::any_of(out_.shared,
                               [&](const SharedPart& s) { return s.name == component && s.contributions[i] != 0; });
  }

  /// Divides the u of part i into what is shared and what is its own.
  void separate(std::size_t i) {
    WeightedPart& part = out_.parts[i];
    part.own = part.summary.standard_uncertainty;
    part.own_degrees_of_freedom = part.summary.degrees_of_freedom;
    const bool sharing = std::ranges::any_of(out_.shared, [&](const SharedPart& s) { return s.contributions[i] != 0; });
    if (!sharing) return;
    double all = 0, own = 0, satterthwaite = 0;
    for (const Contribution& c : budgets_[i]->contributions) {
      const double square = std::pow(contribution(c), 2);
      if (!std::isfinite(square))
        throw InputError(names_[i] + ": what it shares is not known",
                         fmt::format("its budget has no sensitivity coefficient of {}", c.name),
                         "leave --same out, or combine other results");
      all += square;
      if (shares(c.name, i)) continue;
      own += square;
      satterthwaite += square * square / c.degrees_of_freedom;
    }
    if (!accounted_[i]) { // only what is shared is known from the budget
      double rest = part.own * part.own;
      for (const SharedPart& s : out_.shared) rest -= s.contributions[i] * s.contributions[i];
      part.own = std::sqrt(std::max(rest, 0.0));
      return;
    }
    const double scale = part.own / std::sqrt(all);
    part.own = scale * std::sqrt(own);
    part.own_degrees_of_freedom = by_framework_ && satterthwaite > 0 ? own * own / satterthwaite : infinite;
    for (SharedPart& s : out_.shared) s.contributions[i] *= scale;
  }

  void solve() {
    const auto n = static_cast<Eigen::Index>(size());
    // In units of the u's: the matrix of the correlations.
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < i; ++j) {
        double both = 0;
        for (const SharedPart& s : out_.shared) both += s.contributions[at(i)] * s.contributions[at(j)];
        correlation(i, j) = correlation(j, i) = both / (u(i) * u(j));
      }
    const Eigen::LLT<Eigen::MatrixXd> factor(correlation);
    if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-12)) // the weights would be rounding
      throw InputError(out_.mean.output.name + ": the results cannot be combined",
                       "two of them differ by nothing but what they share", "leave one of them out");
    Eigen::VectorXd ones(n), y(n);
    const double origin = out_.parts[0].summary.estimate; // keeps the digits of what differs
    for (Eigen::Index i = 0; i < n; ++i) {
      ones[i] = 1 / u(i);
      y[i] = (out_.parts[at(i)].summary.estimate - origin) / u(i);
    }
    const Eigen::VectorXd solved = factor.solve(ones);
    const double information = ones.dot(solved), shift = solved.dot(y) / information;
    out_.mean.estimate = origin + shift;
    out_.mean.standard_uncertainty = 1 / std::sqrt(information);
    for (Eigen::Index i = 0; i < n; ++i) out_.parts[at(i)].weight = solved[i] / (u(i) * information);
    const Eigen::VectorXd residuals = y - shift * ones;
    out_.chi_squared = std::max(0.0, residuals.dot(factor.solve(residuals)));
  }

  /// Weights of the parts by what is their own; of one that is known exactly 1.
  std::vector<double> own_weights() const {
    const double largest = std::ranges::max_element(out_.parts, {}, &WeightedPart::own)->own;
    std::vector<double> out;
    double sum = 0;
    for (const WeightedPart& p : out_.parts) sum += out.emplace_back(std::pow(std::max(p.own / largest, 1e-9), -2));
    for (double& p : out) p /= sum;
    return out;
  }

  /// Welch's test of equal means with unequal variances.
  void judge(const std::vector<double>& p) {
    const auto n = static_cast<double>(size());
    double estimated = 0;
    for (std::size_t i = 0; i < size(); ++i) estimated += std::pow(1 - p[i], 2) / out_.parts[i].own_degrees_of_freedom;
    out_.ratio = out_.chi_squared / (n - 1) / (1 + 2 * (n - 2) / (n * n - 1) * estimated);
    out_.ratio_degrees_of_freedom = estimated > 0 ? (n * n - 1) / (3 * estimated) : infinite;
    out_.probability = p_of_variance_ratio(out_.ratio, n - 1, out_.ratio_degrees_of_freedom);
  }

  /// Its degrees of freedom are such that those of the mean stay as they are.
  void add_weighing(const std::vector<double>& p) {
    double own = 0, share = 0, satterthwaite = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const WeightedPart& part = out_.parts[i];
      own += std::pow(part.weight * part.own, 2);
      satterthwaite += std::pow(part.weight * part.own, 4) / part.own_degrees_of_freedom;
      share += 4 * p[i] * (1 - p[i]) / std::max(part.own_degrees_of_freedom - 2, 1.0);
    }
    const double more = share * own;
    if (!(more > 0)) return;
    out_.weighing = std::sqrt(more);
    const double freedom = own * own / satterthwaite;
    out_.weighing_degrees_of_freedom = more * more * freedom / (std::pow(own + more, 2) - own * own);
    out_.mean.standard_uncertainty = std::hypot(out_.mean.standard_uncertainty, out_.weighing);
  }

  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  double u(Eigen::Index i) const { return out_.parts[at(i)].summary.standard_uncertainty; }

  void expand_mean(double coverage_probability) {
    double satterthwaite = 0;
    for (const WeightedPart& p : out_.parts) satterthwaite += std::pow(p.weight * p.own, 4) / p.own_degrees_of_freedom;
    for (const SharedPart& s : out_.shared) {
      double sum = 0;
      for (std::size_t i = 0; i < size(); ++i) sum += out_.parts[i].weight * s.contributions[i];
      satterthwaite += std::pow(sum, 4) / s.degrees_of_freedom;
    }
    if (out_.weighing > 0) satterthwaite += std::pow(out_.weighing, 4) / out_.weighing_degrees_of_freedom;
    CombinedVariance variance;
    variance.independent = std::pow(out_.mean.standard_uncertainty, 2);
    if (satterthwaite > 0)
      variance.effective_degrees_of_freedom = variance.independent * variance.independent / satterthwaite;
    const Expansion x = expand(variance, coverage_probability);
    out_.mean.coverage_factor = x.coverage_factor;
    out_.mean.expanded_uncertainty = x.expanded_uncertainty;
    out_.mean.degrees_of_freedom = x.effective_degrees_of_freedom;
    out_.mean.certificate = certificate_line(out_.mean, coverage_probability);
  }

  /// Each result with the mean: cov(y_i, mean) = u(mean)^2, with the weights as they are.
  void compare() {
    const double of_mean = std::pow(out_.mean.standard_uncertainty, 2) - std::pow(out_.weighing, 2);
    for (WeightedPart& p : out_.parts) {
      p.difference = p.summary.estimate - out_.mean.estimate;
      const double square = std::pow(p.summary.standard_uncertainty, 2) - of_mean;
      p.normalised_error = square > 0 ? p.difference / (out_.mean.coverage_factor * std::sqrt(square))
                                      : std::numeric_limits<double>::quiet_NaN();
    }
  }

  void find_alike() {
    std::map<std::string, double> effect; // on u^2 of the mean, by quantity
    for (std::size_t i = 0; i < size(); ++i)
      for (const Contribution& a : budgets_[i] ? budgets_[i]->contributions : std::vector<Contribution>{})
        for (std::size_t j = 0; j < i; ++j) {
          const Contribution* b = find_contribution(budgets_[j], a.name);
          if (!b || is_same(a) || !alike(a, *b)) continue;
          const double both = signed_contribution(a) * signed_contribution(*b);
          if (std::isfinite(both)) effect[a.quantity] += 2 * out_.parts[i].weight * out_.parts[j].weight * both;
        }
    for (const auto& [name, change] : effect)
      if (std::fabs(change) > 0.01 * std::pow(out_.mean.standard_uncertainty, 2)) out_.alike.push_back(name);
  }

  const std::vector<std::string>& same_;
  /// u and degrees of freedom are those of the budgets; else u is that of the samples, which has both.
  bool by_framework_ = true;
  std::vector<const Budget*> budgets_; ///< by part; null: none
  std::vector<bool> accounted_;        ///< by part: by the budget, for the variance of the samples
  std::vector<std::string> names_;     ///< by part: "a.h5: laser_z"
  std::vector<std::string> without_variance_; ///< by Monte Carlo
  WeightedMean out_;
};

/// Names of the outputs, each with the files that have it, in the order of the files.
std::vector<std::pair<std::string, std::vector<std::string>>> outputs_of(const std::vector<NamedResult>& results) {
  std::vector<std::pair<std::string, std::vector<std::string>>> out;
  for (const NamedResult& r : results)
    for (const Summary& s : r.results.summaries) {
      if (s.output.diagnostic) continue;
      auto known = std::ranges::find(out, s.output.name, [](const auto& o) { return o.first; });
      if (known == out.end()) known = out.insert(out.end(), {s.output.name, {}});
      known->second.push_back(r.name);
    }
  return out;
}

/// Throws InputError if `measurand` is not one that two or more results have.
void require_common(const std::string& measurand,
                    const std::vector<std::pair<std::string, std::vector<std::string>>>& outputs) {
  std::vector<std::string> common;
  for (const auto& [output, files] : outputs)
    if (files.size() > 1) common.push_back(output);
  if (std::ranges::find(common, measurand) != common.end()) return;
  const std::string near = nearest(measurand, common);
  throw InputError(fmt::format("--measurand {}: no two results have it", measurand),
                   common.empty() ? "they have no measurand in common"
                                  : fmt::format("they have {}", fmt::join(common, ", ")),
                   near.empty() ? "" : "did you mean '" + near + "'?");
}

} // namespace

WeightedMeans weighted_means(const std::vector<NamedResult>& results, const std::vector<std::string>& shared,
                             const std::string& measurand) {
  if (results.size() < 2) throw InputError("a single result cannot be combined", "", "name two or more result files");
  std::vector<const Results*> all;
  for (const NamedResult& r : results) all.push_back(&r.results);
  require_one_coverage(all);
  require_shared(shared, all);
  const auto outputs = outputs_of(results);
  if (!measurand.empty()) require_common(measurand, outputs);
  WeightedMeans out;
  for (const auto& [output, files] : outputs) {
    if (files.size() < 2) {
      out.single.push_back(fmt::format("{} ({})", output, files[0]));
      continue;
    }
    if (!measurand.empty() && output != measurand) continue;
    try {
      out.rows.push_back(Combining(results, shared, output).combine(all[0]->coverage_probability));
    } catch (const InputError& e) {
      out.left_out.push_back({output, e.problems()[0]});
    }
  }
  if (!out.rows.empty()) return out;
  if (out.left_out.empty())
    throw InputError("the results have no measurand in common", fmt::format("{}", fmt::join(out.single, ", ")),
                     "labels are part of a name. Use the same labels in all scenarios");
  std::vector<Problem> problems;
  for (const LeftOut& l : out.left_out) problems.push_back(l.problem);
  throw InputError(std::move(problems));
}

} // namespace gumshoe::analysis
