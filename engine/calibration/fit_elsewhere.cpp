/// A start from which the fit cannot go on, because nothing depends on an unknown there: a time constant so short that
/// all has decayed.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "calibration/fit.h"
#include "math/parameter_covariance.h"

namespace gumshoe::calibration {

/// Unknowns that no residual depends on at the values reached.
std::vector<std::size_t> Fit::unseen() const {
  std::vector<std::size_t> out;
  const auto seen = least_squares::parameter_covariance(solution_.jacobian, n_, p_, magnitudes());
  for (const least_squares::Direction& direction : seen.unseen) {
    constexpr double alone = 1e-6;
    const auto acts = [](double share) { return std::fabs(share) > alone; };
    if (std::ranges::count_if(direction.share, acts) == 1)
      out.push_back(static_cast<std::size_t>(std::ranges::find_if(direction.share, acts) - direction.share.begin()));
  }
  return out;
}

/// Whether, with the others where they are, a residual changes with an unknown by as much as rounding shows.
bool Fit::acts_at(std::size_t unknown, double value) const {
  std::vector<double> x = x_, r(n_), jacobian(n_ * p_);
  x[unknown] = value;
  if (!evaluate(x.data(), r.data(), jacobian.data(), sigma_)) return false;
  double most = 0, all = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    most = std::max(most, std::fabs(jacobian[i * p_ + unknown] * value));
    for (std::size_t j = 0; j < p_; ++j) all = std::max(all, std::fabs(jacobian[i * p_ + j] * x[j]));
  }
  constexpr double shows = 1e-6;
  return most > shows * all;
}

void Fit::begin_elsewhere() {
  if (!defined()) return;
  const std::vector<std::size_t> sought = unseen();
  std::size_t left = sought.size();
  for (const std::size_t j : sought) {
    const Unknown& u = unknowns_[j];
    for (const double decade : {1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0, -4.0, 5.0, -5.0, 6.0, -6.0}) {
      const double value = u.start * std::pow(10, decade);
      if (u.start == 0 || value < u.low || value > u.high || !acts_at(j, value)) continue;
      Fit other(*this);
      other.x_[j] = value;
      other.solve_from_start();
      if (!other.defined() || !other.solution_.report.converged || other.unseen().size() >= left ||
          !(other.solution_.report.cost_after < solution_.report.cost_after))
        continue;
      left = other.unseen().size();
      x_ = std::move(other.x_);
      solution_ = std::move(other.solution_);
      sigma_ = other.sigma_;
      iterations_ = other.iterations_;
      evaluations_ = other.evaluations_;
      scale_settled_ = other.scale_settled_;
      const auto shown = [&](double si) {
        return fmt::format("{:.6g}{}", units::from_si(si, u.unit, u.si_unit), units::suffix(u.unit));
      };
      notes_.push_back(fmt::format("fitted from {} = {}: from {}, as stated, the indications do not depend on it",
                                   u.name, shown(value), shown(u.start)));
      break;
    }
  }
}

} // namespace gumshoe::calibration
