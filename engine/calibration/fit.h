#pragma once
/// The least-squares fit behind an estimate: solved first, then described. Of calibration alone.
#include <string>
#include <vector>

#include "calibration/estimate.h"
#include "calibration/priors.h"

namespace gumshoe::calibration {

/// Middle of the values; the mean of the two middle ones of an even number.
double median_of(std::vector<double> x);

class Fit {
public:
  /// Throws InputError: more unknowns than readings and priors, or noise that cannot be known.
  Fit(const propagation::Experiment& experiment, const Options& options);
  void solve();

  void describe(Estimate& out) const;
  /// Covariance, rank and what the data cannot see; s and its degrees of freedom.
  void covariance(Estimate& out) const;
  void rows(Estimate& out) const;
  void goodness(Estimate& out) const;
  void remarks(Estimate& out) const;

private:
  using Loss = least_squares::Loss;
  void check() const;
  void solve_from_start();
  /// Where the indications do not depend on an unknown at the values reached, but do at a multiple of its start:
  /// from there, if that fit is better and knows all (fit_elsewhere.cpp).
  void begin_elsewhere();
  std::vector<std::size_t> unseen() const;
  bool acts_at(std::size_t unknown, double value) const;
  /// Whitened residuals over `sigma`, and their Jacobian.
  bool evaluate(const double* x, double* r, double* jacobian, double sigma) const;
  void solve_with(Loss loss, double width, double sigma, bool with_priors);
  void solve_at(double sigma);
  bool defined() const;
  /// Scale of the whitened residuals, in units of sigma = 1.
  double scale_of_residuals() const;
  /// n minus the trace of the data's share in the fit: n - p without priors.
  double freedom() const;
  void find_scale();
  std::vector<double> magnitudes() const;
  /// Jacobian of data and priors.
  std::vector<double> stacked() const;
  double variance_factor(Estimate& out, std::size_t rank) const;
  void beyond_priors(Estimate& out) const;
  void contradicted_priors(Estimate& out) const;
  void outlier(Estimate& out) const;

  const propagation::Experiment& experiment_;
  std::vector<Unknown> unknowns_;
  Data data_;
  Simulation simulation_;
  Priors priors_;
  std::size_t n_, p_; ///< rows of the data, unknowns
  Loss loss_;
  double width_ = 1;
  std::vector<double> x_;
  least_squares::Solution solution_;
  double sigma_ = 1, cost_before_ = 0;
  int iterations_ = 0, evaluations_ = 0;
  bool scale_settled_ = true;
  /// The fit without priors, where the noise is not declared: values, u and degrees of freedom. u = 0: not determined.
  struct Alone {
    std::vector<double> x, u;
    double freedom = 0;
  } alone_;
  Alone alone() const;
  std::vector<std::string> notes_; ///< of the starts
};

} // namespace gumshoe::calibration
