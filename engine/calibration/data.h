#pragma once
/// What a fit sees of a scenario: the unknowns, the measured indications with their noise, and the simulated ones.
#include <cmath>
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::calibration {

/// Throws an InputError about the scenario.
[[noreturn]] void refuse(const std::string& file, std::string what, std::string why = {}, std::string remedy = {});

/// One value to be found: a quantity marked `estimated`, or one of its entries where it has values per label.
struct Unknown {
  std::string name;                                ///< "beam_pitch", "rod_length[rod 1]"
  std::size_t quantity = 0, entry = 0, column = 0; ///< in the scenario, and of the plan
  std::string unit, si_unit;
  double start = 0;         ///< SI; with a prior its mean
  double prior_u = 0;       ///< SI; 0: free
  double low = 0, high = 0; ///< limits of its card, SI
  double magnitude = 1;     ///< what counts as one
};

/// Throws InputError: no quantity is marked, or a prior has no standard uncertainty.
std::vector<Unknown> unknowns_of(const propagation::Experiment& experiment);

/// Rows are [reading][indication], in the order of the scenario.
struct Data {
  std::vector<double> measured; ///< SI, expectation of the noise included
  std::vector<double> weight;   ///< share of a row's variance where no noise is declared: repeats of the mean
  bool noise_declared = false;
  double pure_error = 0;   ///< sum of squares of repeats about their means, and its degrees of freedom: part of s
  double pure_freedom = 0; ///< where no noise is declared
  std::vector<double> u;   ///< standard uncertainty of each row's noise, SI
  /// Degrees of freedom of the declared noise where one s serves all readings (GUM G.4.1); infinite where it is known,
  /// or each reading has its own.
  double noise_freedom = HUGE_VAL;
  /// Lower Cholesky factor of the noise's covariance matrix, row-major, where rows share draws; else empty.
  std::vector<double> cholesky;
  std::vector<std::string> notes;
};

/// Throws InputError: nothing was read, some indications declare noise and others do not, or rows share noise and have
/// none of their own.
Data data_of(const propagation::Experiment& experiment);

/// Residuals of a whitened row: divided by u, or solved by the Cholesky factor. `columns` values per row, in place.
void whiten(const Data& data, double* rows, std::size_t columns);

/// Simulated indications and their derivatives by the unknowns.
class Simulation {
public:
  /// Throws InputError if the model has no simulation.
  Simulation(const propagation::Experiment& experiment, std::vector<Unknown> unknowns, int threads);
  std::size_t rows() const { return points_.size() * forward_.layout().indications.size(); }
  /// simulated[row] and, unless null, jacobian[row][unknown] at x, SI. False where the model gives no value.
  bool operator()(const double* x, double* simulated, double* jacobian) const;
  /// Whether a simulated indication at x changes where the quantity is shifted up or down; true if that cannot be
  /// known.
  bool depends_on(const double* x, std::size_t quantity, double shift) const;
  /// Whether derivatives are exact; else they are central differences.
  bool exact() const { return forward_.has_derivatives(); }

  struct Failure {
    std::size_t reading = 0;
    Status status = Status::ok;
  };
  /// Failure of the last call that returned false.
  Failure failure() const { return failure_; }

private:
  /// Until the next call.
  const propagation::Points& points_at(const double* x) const;
  propagation::ForwardModel forward_;
  std::vector<Unknown> unknowns_;
  mutable propagation::Points points_; ///< the unknowns at the last x, all other quantities at their estimates
  std::vector<propagation::Partial> partials_;
  mutable Failure failure_;
};

} // namespace gumshoe::calibration
