/// What follows a condition with a lag of first order.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tracing/candidates/lags.h"
#include "unit/tracing_made_design.h"

using namespace tracing_design;

namespace {

/// Readings in the order of their rows, at these times, of a condition.
Observations observed(const std::vector<double>& time, const std::vector<double>& condition) {
  Observations o;
  o.readings = time.size();
  o.indications = 1;
  o.names = {"z"};
  for (std::size_t i = 0; i < time.size(); ++i) o.sequence.push_back(i);
  o.covariates = {covariate("load", "N", condition), covariate("time", "s", time)};
  o.covariates.back().course = true;
  return o;
}

/// The column of a lag in units of the condition, from zero at its first reading.
Vector of_the_condition(const Observations& o, double constant) {
  const Covariate &load = o.covariates[0], &time = o.covariates[1];
  const Candidate one = lag(o, load, time, 0, std::log(constant / (time.levels.back() - time.levels.front())));
  return (one.columns.col(0).array() - one.columns(0, 0)) * (load.levels.back() - load.levels.front());
}

} // namespace

TEST_CASE("what follows a rise with a lag trails it by slope times time constant", "[tracing]") {
  // tau ds/dt + s = a t, s(0) = 0: s = a (t - tau + tau exp(-t / tau)).
  const std::vector<double> time{0, 1, 1, 4, 4.5, 20, 60};
  std::vector<double> load;
  for (const double t : time) load.push_back(3 * t);
  const double tau = 5;
  const Vector follows = of_the_condition(observed(time, load), tau);
  for (std::size_t i = 0; i < time.size(); ++i)
    CHECK(follows[static_cast<Index>(i)] == Approx(3 * (time[i] - tau + tau * std::exp(-time[i] / tau))).margin(1e-12));
}

TEST_CASE("a lag agrees with small steps of its differential equation", "[tracing]") {
  const std::vector<double> time{0, 2, 3, 7, 8, 15, 16}, load{1, 4, -2, -2, 6, 0, 3};
  const double tau = 2.5;
  const Vector follows = of_the_condition(observed(time, load), tau);
  double s = load[0];
  for (std::size_t i = 1; i < time.size(); ++i) {
    constexpr int steps = 20000;
    const double h = (time[i] - time[i - 1]) / steps;
    for (int k = 0; k < steps; ++k) { // the midpoint rule: its error falls with h^2
      const auto rate = [&](double share, double at) {
        return (load[i - 1] + share * (load[i] - load[i - 1]) - at) / tau;
      };
      const double half = s + 0.5 * h * rate(static_cast<double>(k) / steps, s);
      s += h * rate((k + 0.5) / steps, half);
    }
    CHECK(follows[static_cast<Index>(i)] == Approx(s - load[0]).margin(1e-7));
  }
}

TEST_CASE("the time constant of a lag is found", "[tracing]") {
  std::vector<double> time, load;
  for (int i = 0; i < 60; ++i) {
    time.push_back(i + 0.3 * (i % 3));
    load.push_back(std::sin(0.4 * i) + ((i / 11) % 2));
  }
  const Observations o = observed(time, load);
  for (const double tau : {1.0, 3.0, 12.0}) {
    const Vector readings = of_the_condition(o, tau), about = readings.array() - readings.mean();
    const auto found = lags(o, [&](const Matrix& columns, Index, double) {
      const Matrix centred = columns.rowwise() - columns.colwise().mean();
      return Vector((centred.transpose() * about).array().square() /
                    centred.colwise().squaredNorm().transpose().array());
    });
    REQUIRE(found.size() == 1); // of the load, and none of time
    CHECK(found[0].name == "lag:load");
    CHECK(found[0].depends_on == std::vector<std::string>{"load", "time"});
    CHECK(std::exp(found[0].parameter) * (time.back() - time.front()) == Approx(tau).epsilon(0.01)); // Brent's 12 bits
    CHECK(with_parameter(o, found[0], found[0].parameter).columns == found[0].columns);
  }
}

TEST_CASE("places that a slide was sent to act at once", "[tracing]") {
  Observations o = observed({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, {0, 1, 2, 3, 4, 5, 5, 4, 3, 2, 1, 0});
  const Gain none = [](const Matrix& columns, Index, double) { return Vector(Vector::Zero(columns.cols())); };
  REQUIRE(lags(o, none).size() == 1);
  o.covariates[0].si_unit = "m";
  CHECK(lags(o, none).size() == 1); // recorded alone: the length of a rod that grows
  o.covariates[0].commanded = true;
  CHECK(lags(o, none).empty());
}
