#include "tracing/candidates/lags.h"

#include <algorithm>
#include <cmath>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "tracing/candidates/smooth_basis.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// What follows a condition, by place in the sequence; over the range of the condition.
class Lags {
public:
  Lags(const Observations& o, const Covariate& condition, const Covariate& time, std::size_t indication)
      : every_(index(o.indications)), indication_(index(indication)), x_(over_the_range(o, condition)),
        t_(over_the_range(o, time)) {}

  /// @param share  time constant over the duration
  Matrix column(double share) const {
    Matrix out = Matrix::Zero(x_.size() * every_, 1);
    double follows = x_[0];
    for (Index i = 0; i < x_.size(); ++i) {
      if (const double steps = i > 0 ? (t_[i] - t_[i - 1]) / share : 0; steps > 0) {
        const double behind = (x_[i] - x_[i - 1]) / steps; // of a straight rise, once it has settled
        follows = x_[i] - behind + (follows - x_[i - 1] + behind) * std::exp(-steps);
      }
      out(i * every_ + indication_, 0) = follows;
    }
    return out;
  }

private:
  Index every_, indication_;
  Vector x_, t_;
};

/// Time where it was recorded, else the order of measurement; null: neither.
const Covariate* time_of(const Observations& o) {
  const Covariate* out = nullptr;
  for (const Covariate& c : o.covariates)
    if (c.course && !c.comes_back && (!out || (c.si_unit == "s" && out->si_unit != "s"))) out = &c;
  return out;
}

/// What may act late: no place or angle that a slide was sent to, no direction, and nothing that never returns, as time
/// does.
bool may_act_late(const Covariate& c) {
  const bool place = c.commanded && (c.si_unit == "m" || c.si_unit == "rad");
  const bool direction = c.commanded && c.si_unit == "1" && c.levels == std::vector<double>{-1, 1};
  return !c.course && !c.angle && !place && !direction && c.levels.size() > 1;
}

/// Whether another condition or column was recorded that goes along with what follows: the temperature of a column,
/// which follows that of the spindle, says it better than the latter's lag.
bool is_recorded(const Observations& o, const Covariate& condition, std::size_t indication, const Candidate& late) {
  const Vector follows = late.columns(Eigen::seq(index(indication), Eigen::last, index(o.indications)), 0),
               about = follows.array() - follows.mean();
  return std::ranges::any_of(o.covariates, [&](const Covariate& other) {
    if (other.course || other.name == condition.name) return false;
    Vector x = over_the_range(o, other);
    x.array() -= x.mean();
    return std::fabs(x.dot(about)) > criteria.recorded_lag * x.norm() * about.norm();
  });
}

} // namespace

std::pair<double, double> limits_of_lag(const Covariate& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.levels.size(); ++i) steps.push_back(time.levels[i] - time.levels[i - 1]);
  const auto middle = steps.begin() + index(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  const double longest = std::log(0.5);
  return {std::min(std::log(0.5 * *middle / (time.levels.back() - time.levels.front())), longest), longest};
}

Candidate lag(const Observations& o, const Covariate& condition, const Covariate& time, std::size_t indication,
              double logarithm) {
  const double constant = std::exp(logarithm) * (time.levels.back() - time.levels.front());
  Candidate out;
  out.family = Family::shape;
  out.name = "lag:" + condition.name + (o.indications > 1 ? " of " + o.names[indication] : "");
  out.shape =
      fmt::format("time constant {:.2g}{}", units::from_si(constant, time.unit, time.si_unit, units::Kind::difference),
                  units::suffix(time.unit));
  out.columns = Lags(o, condition, time, indication).column(std::exp(logarithm));
  out.form = Form::lag;
  out.parameter = logarithm;
  out.amplitudes.resize(1);
  out.amplitudes[0].quantity = Amplitude::npos;
  out.amplitudes[0].name = "size";
  out.depends_on = {condition.name, time.name};
  return out;
}

std::vector<Candidate> lags(const Observations& o, const Gain& gain) {
  std::vector<Candidate> out;
  const Covariate* time = time_of(o);
  if (!time || o.readings < criteria.readings_for_correlation) return out;
  const auto [low, high] = limits_of_lag(*time);
  for (const Covariate& condition : o.covariates)
    for (std::size_t i = 0; may_act_late(condition) && i < o.indications; ++i) {
      const Lags columns(o, condition, *time, i);
      const auto loss = [&, share = criteria.absorbed_share](double logarithm) {
        return -gain(columns.column(std::exp(logarithm)), 1, share)[0];
      };
      constexpr int grid = 12, bits = 12;
      const double step = (high - low) / grid;
      double best = low, least = 0;
      for (int k = 0; k <= grid; ++k)
        if (const double here = loss(low + step * k); here < least) least = here, best = low + step * k;
      best = boost::math::tools::brent_find_minima(loss, std::max(low, best - step), std::min(high, best + step), bits)
                 .first;
      Candidate one = lag(o, condition, *time, i, best);
      if (is_recorded(o, condition, i, one)) continue;
      one.searched = criteria.lag_forms;
      out.push_back(std::move(one));
    }
  return out;
}

} // namespace gumshoe::tracing
