#pragma once
/// Pearson's coefficients of the variates of a plan, as the law of propagation of uncertainty takes them.
#include <cstddef>
#include <vector>

#include "quantities/sample_plan.h"

namespace gumshoe::quantities {

/// Each coefficient is computed when it is first asked for. For one thread; the plan must outlive it.
class Correlations {
public:
  explicit Correlations(const SamplePlan& plan);

  /// Correlation coefficient of two variates: 1 of one with itself, 0 if nothing ties them. For a multivariate t it is
  /// that of the scales.
  double between(std::size_t a, std::size_t b);
  /// That times both standard uncertainties, SI.
  double covariance(std::size_t a, std::size_t b);

  std::size_t groups() const { return plan_.copulas.size(); }
  /// Index into the plan's copulas; groups(), if the variate is in none.
  std::size_t group_of(std::size_t variate) const { return places_[variate].group; }
  /// Whether the group's coefficients are stated apart from its draws, as of results of earlier runs: the degrees of
  /// freedom of these are those of sums, which other sums do not have.
  bool of_results(std::size_t group) const { return !plan_.copulas[group].pearson.empty(); }

  std::size_t estimates() const { return plan_.estimates.size(); }
  /// Index into the plan's common estimates; estimates(), if the variate's u is an estimate of its own.
  std::size_t estimate_of(std::size_t variate) const { return estimate_of_[variate]; }

private:
  struct Place {
    std::size_t group, member;
  };
  double coefficient(std::size_t group, std::size_t i, std::size_t j);

  const SamplePlan& plan_;
  std::vector<Place> places_;                     ///< by variate
  std::vector<std::size_t> estimate_of_;          ///< by variate
  std::vector<std::vector<double>> coefficients_; ///< by group, n x n; NaN: not computed
};

} // namespace gumshoe::quantities
