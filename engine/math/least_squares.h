#pragma once
/// Non-linear least squares: Ceres finds the minimum, Gauss-Newton steps by QR carry it to
/// the last digits, and the report is judged anew at the end, whatever the solver said.
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace gumshoe::least_squares {

/// How a residual r counts: squared, or less where it is large (Huber and Ronchetti 2009, chapter 7). Beyond about
/// `width` it is down-weighted; residuals should be in units of their standard deviation.
enum class Loss { squared, huber, cauchy, tukey };
/// "squared", "huber", "cauchy", "tukey"
const char* name(Loss loss);
/// The width that leaves 95 % efficiency for normal residuals: 1.345, 2.385, 4.685 (1 for squared, unused).
double usual_width(Loss loss);
/// psi(r) / r, in [0, 1]: 1 for a residual that counts in full.
double weight(Loss loss, double residual, double width);

/// Minimises sum rho(r_i^2) + |A x - b|^2 over x within bounds. Plain data; p parameters, n residuals.
struct Problem {
  std::size_t residuals = 0, parameters = 0;
  /// r[n] and, unless null, jacobian[n][p] at x. False: not defined there; the step is refused and shortened.
  std::function<bool(const double* x, double* r, double* jacobian)> evaluate;
  std::vector<double> start;     ///< [p]
  std::vector<double> magnitude; ///< [p], above 0, what counts as one; empty: |start|, or 1 where that is 0
  std::vector<double> low, high; ///< [p], +-infinity where free; empty: no bounds
  /// Priors, or other linear rows, whitened: A[m][p] and b[m]. They count squared whatever the loss.
  std::vector<double> prior_matrix, prior_target;
  Loss loss = Loss::squared;
  double width = 1;
};

struct Options {
  int iterations = 2000;          ///< of each attempt
  double offset_tolerance = 1e-6; ///< relative offset, see Report
  double step_tolerance = 1e-9;   ///< next Gauss-Newton step relative to the parameters
};

struct Report {
  bool converged = false; ///< judged at the end by relative offset or step, not taken from the solver
  std::string reason;     ///< in words: by which criterion, or why not
  std::string solver;     ///< what Ceres said, and by which attempt
  int iterations = 0;     ///< of all attempts, and of the polish
  int evaluations = 0;
  double cost_before = 0, cost_after = 0; ///< half the sum
  double gradient_norm = 0;               ///< largest |d cost / d (x_j / magnitude_j)| over free parameters
  /// Bates and Watts 1981: length of the residuals' part in the tangent plane over that of the rest, per degree of
  /// freedom: the remaining step in units of standard deviations. Infinity if there is no rest.
  double relative_offset = 0;
  double step = 0;                   ///< next Gauss-Newton step, largest |dx_j| / max(|x_j|, magnitude_j)
  std::vector<std::size_t> at_bound; ///< parameters held by a bound
  std::vector<std::size_t> vanished; ///< parameters that acted on the residuals at the start and no longer do
};

struct Solution {
  std::vector<double> x;         ///< [p]
  std::vector<double> residuals; ///< [n], as the callback gives them
  std::vector<double> jacobian;  ///< [n][p], likewise
  std::vector<double> weights;   ///< [n], of the loss
  Report report;
};

/// Attempts from the same start (Levenberg-Marquardt, dogleg, both with cautious first steps) until two find the same
/// minimum; the lowest wins.
/// One thread, same bits every time. Never throws for numerical reasons: see Report::converged.
Solution solve(const Problem& problem, const Options& options = {});

} // namespace gumshoe::least_squares
