#pragma once
/// Fits the quantities a scenario marks `estimated` to its readings: residual = measured minus simulated indication,
/// weighed by the declared noise, priors from the quantities' distributions.
#include <string>
#include <vector>

#include "calibration/data.h"
#include "math/least_squares.h"

namespace gumshoe::calibration {

/// One estimated value. SI.
struct Parameter {
  Unknown unknown;
  double value = 0;
  double standard_uncertainty = 0; ///< infinity if the data do not determine it; NaN if there is no way to know
  bool at_limit = false;           ///< held by a limit of its card: its uncertainty is one-sided
};

/// One reading of one indication, SI.
struct Row {
  std::size_t reading = 0;
  std::size_t indication = 0;
  double measured = 0, simulated = 0, residual = 0;
  double normalised = 0; ///< whitened residual in standard deviations
  double weight = 1;     ///< of the robust loss; below 1 it is down-weighted
};

struct Estimate {
  std::vector<Parameter> parameters;
  std::vector<double> covariance, correlation; ///< [p][p], SI; NaN where a parameter is not determined
  bool noise_declared = false;
  /// Standard deviation of a residual: of a single readout in the indication's SI unit where no noise is declared,
  /// else the factor (1 expected) on the declared noise that the residuals show.
  double s = 0;
  double degrees_of_freedom = 0;      ///< of s
  double noise_freedom = 0;           ///< of the declared noise, Data::noise_freedom
  double chi_squared = 0;             ///< of data and priors, where noise is declared; NaN else
  double chi_squared_probability = 0; ///< of a larger value; NaN without declared noise
  double residual_sum_of_squares = 0; ///< whitened by the declared noise, else in SI
  std::size_t rank = 0;               ///< of the data alone, priors left out
  double condition = 0;               ///< likewise, columns of length one
  /// In words, one per direction that the data alone cannot see: "laser_z is indistinguishable from rod_length".
  std::vector<std::string> indistinguishable;
  bool determined = true; ///< data and priors together determine every parameter
  std::vector<Row> rows;
  least_squares::Loss loss = least_squares::Loss::squared;
  double loss_width = 0; ///< standard deviations
  least_squares::Report solver;
  std::vector<std::string> held; ///< uncertain quantities that are not fitted: their uncertainty is in no result
  std::vector<std::string> notes;
};

struct Options {
  int threads = 1;
};

/// Throws InputError: nothing to estimate, nothing read, more unknowns than readings and priors, no simulation. What
/// the data cannot determine, and a solver that does not converge, are reported in the result. Least squares by
/// engine/math/least_squares.h; covariance: engine/calibration/README.md.
Estimate estimate(const propagation::Experiment& experiment, const Options& options = {});

} // namespace gumshoe::calibration
