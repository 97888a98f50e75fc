#include "calibration/fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "base/error.h"
#include "base/special_values.h"
#include "math/parameter_covariance.h"

namespace gumshoe::calibration {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double median_of(std::vector<double> x) {
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  if (x.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(x.begin(), middle)) / 2;
}

Fit::Fit(const propagation::Experiment& e, const Options& options)
    : experiment_(e), unknowns_(unknowns_of(e)), data_(data_of(e)), simulation_(e, unknowns_, options.threads),
      priors_(priors_of(e, unknowns_)), n_(data_.measured.size()), p_(unknowns_.size()),
      loss_(e.scenario().estimate.loss) {
  width_ = e.scenario().estimate.width > 0 ? e.scenario().estimate.width : least_squares::usual_width(loss_);
  check();
}

void Fit::solve() {
  for (const Unknown& u : unknowns_) x_.push_back(u.start);
  solve_from_start();
  begin_elsewhere();
}

void Fit::solve_from_start() {
  if (data_.noise_declared || (loss_ == Loss::squared && priors_.target.empty()))
    solve_at(1);
  else
    find_scale();
}

void Fit::check() const {
  const auto& s = experiment_.scenario();
  const std::size_t m = priors_.target.size();
  if (n_ + m < p_)
    refuse(s.file,
           fmt::format("{} readings{} cannot determine {} estimated quantities", n_,
                       m > 0 ? fmt::format(" and {} priors", m) : "", p_),
           "each unknown needs a reading or a prior", "add readings, or give some of them a prior (u)");
  if (data_.noise_declared) return;
  const auto& indications = experiment_.model().card->indications;
  for (const auto& i : indications)
    if (i.si_unit != indications[0].si_unit)
      refuse(s.file, fmt::format("indications {} and {} have no declared noise", indications[0].name, i.name),
             "readings in different units cannot be weighted without it", "repeatability = { s = \"...\" }");
  if (m > 0 && n_ <= p_ && !(data_.pure_freedom > 0))
    refuse(s.file, fmt::format("{} readings cannot determine their own noise in addition to {} unknowns", n_, p_),
           "it is needed to weight the priors", "repeatability = { s = \"...\" }");
}

bool Fit::evaluate(const double* x, double* r, double* jacobian, double sigma) const {
  if (!simulation_(x, r, jacobian)) return false;
  for (std::size_t i = 0; i < n_; ++i) r[i] = (data_.measured[i] - r[i]) / sigma;
  whiten(data_, r, 1);
  if (!jacobian) return true;
  for (std::size_t i = 0; i < n_ * p_; ++i) jacobian[i] = -jacobian[i] / sigma;
  whiten(data_, jacobian, p_);
  return true;
}

void Fit::solve_with(Loss loss, double width, double sigma, bool with_priors) {
  least_squares::Problem problem;
  problem.residuals = n_;
  problem.parameters = p_;
  problem.start = x_;
  for (const Unknown& u : unknowns_) {
    problem.magnitude.push_back(u.magnitude);
    problem.low.push_back(u.low > -1e290 ? u.low : -infinity);
    problem.high.push_back(u.high < 1e290 ? u.high : infinity);
  }
  if (with_priors) {
    problem.prior_matrix = priors_.matrix;
    problem.prior_target = priors_.target;
  }
  problem.loss = loss;
  problem.width = width;
  problem.evaluate = [&](const double* x, double* r, double* jacobian) { return evaluate(x, r, jacobian, sigma); };
  least_squares::Options options;
  options.iterations = experiment_.scenario().estimate.iterations;
  const int before = iterations_, evaluations = evaluations_;
  const double first = cost_before_;
  solution_ = least_squares::solve(problem, options);
  iterations_ = before + solution_.report.iterations;
  evaluations_ = evaluations + solution_.report.evaluations;
  cost_before_ = evaluations == 0 ? solution_.report.cost_before : first;
  x_ = solution_.x;
  sigma_ = sigma;
}

void Fit::solve_at(double sigma) {
  // Redescending losses need a start near the minimum: Huber's has one only.
  if (loss_ == Loss::tukey || loss_ == Loss::cauchy)
    solve_with(Loss::huber, least_squares::usual_width(Loss::huber), sigma, true);
  if (defined()) solve_with(loss_, width_, sigma, true);
}

bool Fit::defined() const { return solution_.residuals.empty() || std::isfinite(solution_.residuals.front()); }

double Fit::scale_of_residuals() const {
  std::vector<double> sizes;
  double squares = 0;
  for (const double r : solution_.residuals) {
    sizes.push_back(std::fabs(r) * sigma_);
    squares += r * sigma_ * r * sigma_;
  }
  // What is left of exact data is rounding.
  double floor = 0;
  for (const double y : data_.measured) floor = std::max(floor, std::fabs(y) * 1e-14);
  if (loss_ != Loss::squared) return std::max(median_of(sizes) / 0.6744897501960817, floor);
  return std::max(std::sqrt((squares + data_.pure_error) / freedom()), floor);
}

double Fit::freedom() const {
  const auto c = least_squares::parameter_covariance(stacked(), n_ + priors_.target.size(), p_, magnitudes());
  const auto n = static_cast<Eigen::Index>(n_), p = static_cast<Eigen::Index>(p_);
  const Eigen::Map<const Matrix> jacobian(solution_.jacobian.data(), n, p), matrix(c.matrix.data(), p, p);
  return static_cast<double>(n_) + data_.pure_freedom - (jacobian * matrix).cwiseProduct(jacobian).sum();
}

Fit::Alone Fit::alone() const {
  Alone out{x_, std::vector<double>(p_, 0), 0};
  if (!defined()) return out;
  const auto c = least_squares::parameter_covariance(solution_.jacobian, n_, p_, magnitudes());
  out.freedom = static_cast<double>(n_ - c.rank) + data_.pure_freedom;
  double squares = data_.pure_error;
  for (const double r : solution_.residuals) squares += r * r;
  for (std::size_t j = 0; j < p_ && out.freedom > 0; ++j)
    if (c.determined[j]) out.u[j] = std::sqrt(c.matrix[j * p_ + j] * squares / out.freedom);
  return out;
}

/// For unknown noise with priors or a robust loss: alternates between the scale and the fit until both converge.
void Fit::find_scale() {
  if (n_ > p_ || priors_.target.empty()) {
    solve_with(Loss::squared, 1, 1, false);
    alone_ = alone();
  }
  double sigma = 0;
  for (int turn = 0; turn < 50 && defined(); ++turn) {
    const double next = scale_of_residuals();
    if (std::fabs(next - sigma) <= 1e-10 * next) return;
    sigma = next;
    solve_at(sigma);
  }
  if (defined()) scale_settled_ = false;
}

std::vector<double> Fit::magnitudes() const {
  std::vector<double> out;
  for (std::size_t j = 0; j < p_; ++j) out.push_back(std::max(std::fabs(x_[j]), unknowns_[j].magnitude));
  return out;
}

std::vector<double> Fit::stacked() const {
  std::vector<double> out = solution_.jacobian;
  out.insert(out.end(), priors_.matrix.begin(), priors_.matrix.end());
  return out;
}

} // namespace gumshoe::calibration
