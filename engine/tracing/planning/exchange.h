#pragma once
/// Which readings, of those allowed, reach goals at least cost: greedy addition, exchange, removal of what is
/// superfluous (Fedorov, *Theory of Optimal Experiments*, 1972). Nothing here knows a scenario.
#include <limits>
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

/// A goal on some columns, with others as nuisances.
struct PlanGoal {
  enum class Kind {
    size,        ///< smallest non-centrality of a vector of amplitudes with components up to `weight`
    uncertainty, ///< 1 / variance of the sum of the columns' coefficients times `weight`
  };
  Kind kind = Kind::size;
  std::vector<Index> of, others; ///< columns; all that are in neither are zero in the model of this goal
  Vector weight;                 ///< by `of`
  double required = 1;
};

struct PlanTask {
  Matrix base;              ///< information on the columns before any further reading, priors included
  std::vector<Matrix> rows; ///< by allowed reading: derivatives by the columns over the noise, indications x columns
  std::vector<double> cost; ///< by allowed reading, above 0
  std::vector<std::vector<std::size_t>> opens; ///< by allowed reading: set-ups that it needs
  std::vector<double> opening;                 ///< cost by set-up, paid once
  std::vector<PlanGoal> goals;                 ///< none: the determinant of the information on `free`
  std::vector<Index> free;
  int most = 1; ///< readings
  double budget = std::numeric_limits<double>::infinity();
};

/// Share of what is required that counts as all of it: far above rounding, and above the small share of every reading's
/// noise that keeps a design from being exact.
inline constexpr double enough = 1 - 1e-6;

/// Value of a goal at an information matrix, in units of its requirement: reached from `enough` on.
double reached(const PlanGoal& goal, const Matrix& information);
/// ln of the determinant of the information on the free columns, all others eliminated.
double log_determinant(const PlanTask& task, const Matrix& information);
/// Information with so many of each allowed reading.
Matrix information(const PlanTask& task, const std::vector<int>& count);

struct PlanFound {
  std::vector<int> count; ///< by allowed reading
  double cost = 0;
  bool met = false; ///< all goals reached; without goals true
};

/// The cheapest plan found that meets all goals. If none within the limits does: the one that comes closest, by the sum
/// of the logarithms of what is missing. Deterministic. Exact on the cases that a test compares with all plans.
PlanFound find_plan(const PlanTask& task);

} // namespace gumshoe::tracing
