#include "math/rows.h"

#include <cmath>

#include "base/special_values.h"

namespace gumshoe::least_squares {
namespace {

/// sign(r) sqrt(rho(r^2)) and its slope by r.
struct Folded {
  double value, slope;
};
Folded fold(Loss loss, double r, double width) {
  if (loss == Loss::squared || r == 0) return {r, 1};
  const double a = std::fabs(r), q = (a / width) * (a / width);
  double root = a;
  if (loss == Loss::huber)
    root = a <= width ? a : std::sqrt(2 * width * a - width * width);
  else if (loss == Loss::cauchy)
    root = width * std::sqrt(std::log1p(q));
  else // Tukey's biweight: rho = width^2 / 3 (1 - (1 - q)^3) up to the width
    root = q < 1 ? a * std::sqrt((3 - 3 * q + q * q) / 3) : width / std::sqrt(3.0);
  return {std::copysign(root, r), weight(loss, r, width) * a / root};
}

} // namespace

Rows::Rows(const Problem& problem)
    : problem_(problem), n_(static_cast<Eigen::Index>(problem.residuals)),
      m_(static_cast<Eigen::Index>(problem.prior_target.size())), p_(static_cast<Eigen::Index>(problem.parameters)),
      magnitude_(p_), low_(p_), high_(p_) {
  for (Eigen::Index j = 0; j < p_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double own = std::fabs(problem.start[i]);
    magnitude_[j] = !problem.magnitude.empty() ? problem.magnitude[i] : own > 0 ? own : 1.0;
    low_[j] = problem.low.empty() ? -infinity : problem.low[i] / magnitude_[j];
    high_[j] = problem.high.empty() ? infinity : problem.high[i] / magnitude_[j];
  }
}

Vector Rows::start() const {
  return clamp(Eigen::Map<const Vector>(problem_.start.data(), p_).cwiseQuotient(magnitude_));
}

bool Rows::evaluate(const double* z, double* r, double* jacobian) const {
  ++evaluations_;
  const Vector x = Eigen::Map<const Vector>(z, p_).cwiseProduct(magnitude_);
  if (!problem_.evaluate(x.data(), r, jacobian)) return false;
  for (Eigen::Index i = 0; i < n_; ++i) {
    const Folded f = fold(problem_.loss, r[i], problem_.width);
    r[i] = f.value;
    if (!std::isfinite(r[i])) return false;
    for (Eigen::Index j = 0; jacobian && j < p_; ++j) {
      double& d = jacobian[i * p_ + j];
      d *= f.slope * magnitude_[j];
      if (!std::isfinite(d)) return false;
    }
  }
  for (Eigen::Index i = 0; i < m_; ++i) {
    const double* row = problem_.prior_matrix.data() + i * p_;
    double sum = -problem_.prior_target[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < p_; ++j) {
      sum += row[j] * x[j];
      if (jacobian) jacobian[(n_ + i) * p_ + j] = row[j] * magnitude_[j];
    }
    r[n_ + i] = sum;
  }
  return true;
}

bool Rows::evaluate(const Vector& z, Vector& r, Matrix* jacobian) const {
  r.resize(rows());
  if (jacobian) jacobian->resize(rows(), p_);
  return evaluate(z.data(), r.data(), jacobian ? jacobian->data() : nullptr);
}

} // namespace gumshoe::least_squares
