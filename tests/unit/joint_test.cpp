/// JCGM 102: joint coverage regions and angles, against published numbers and closed forms.
#include "gum_models.h"

#include <numbers>

#include <boost/math/distributions/normal.hpp>

#include "analysis/circular.h"
#include "analysis/joint.h"

using namespace gum_models;

namespace {

struct SharedTerm {
  static constexpr const char* inputs[] = {"x1", "x2", "x3"};
  static constexpr const char* outputs[] = {"y1", "y2"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) {
    y[0] = x[0] + x[2];
    y[1] = x[1] + x[2];
  }
};
struct Dependent {
  static constexpr const char* inputs[] = {"x1", "x2"};
  static constexpr const char* outputs[] = {"y1", "y2", "y3"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) {
    y[0] = x[0];
    y[1] = 1e6 * x[1];
    y[2] = x[0] + x[1];
  }
};
struct Constant {
  static constexpr const char* inputs[] = {"x1", "x2"};
  static constexpr const char* outputs[] = {"y1", "y2"};
  static constexpr const char* unit = "1";
  template <class T> static void f(const T* x, T* y) {
    y[0] = x[0];
    y[1] = x[1] + 0.1;
  }
};
struct Polar {
  static constexpr const char* inputs[] = {"x1", "x2"};
  static constexpr const char* outputs[] = {"radius", "angle"};
  static constexpr const char* unit = "rad";
  template <class T> static void f(const T* x, T* y) {
    y[0] = num::sqrt(x[0] * x[0] + x[1] * x[1]);
    y[1] = num::atan2(x[1], x[0]);
  }
};
struct Angle {
  static constexpr const char* inputs[] = {"x"};
  static constexpr const char* outputs[] = {"angle"};
  static constexpr const char* unit = "rad";
  template <class T> static void f(const T* x, T* y) { y[0] = num::atan2(num::sin(x[0]), num::cos(x[0])); }
};

double Phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// k with P(max |z_i| <= k) = p for two standard normals of that correlation, by quadrature and bisection.
double rectangle_factor(double r, double p) {
  const auto inside = [&](double k) {
    const int n = 4000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double z = -k + 2 * k * (i + 0.5) / n, s = std::sqrt(1 - r * r);
      sum += std::exp(-0.5 * z * z) * (Phi((k - r * z) / s) - Phi((-k - r * z) / s));
    }
    return sum * 2 * k / n / std::sqrt(2 * std::numbers::pi);
  };
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) (inside(0.5 * (low + high)) < p ? low : high) = 0.5 * (low + high);
  return low;
}

} // namespace

TEST_CASE("JCGM 102: k_p and k_q of two measurands that share a term", "[references][joint]") {
  constexpr double n = 1'000'000;
  const Input x{0, {normal(1)}};
  const auto r = analysed(scenario_of<SharedTerm>({x, x, x}, static_cast<std::uint64_t>(n)));
  REQUIRE(r.joint.size() == 1);
  const auto& j = r.joint[0];
  CHECK(std::fabs(j.correlation[1] - 0.5) < 4 * 0.75 / std::sqrt(n));
  CHECK(std::fabs(j.covariance[0] - 2) < 4 * 2 * std::sqrt(2 / n));
  CHECK(j.covariance[1] == j.covariance[2]);
  CHECK(j.gum_covariance[0] == Approx(2).epsilon(1e-12));
  CHECK(j.gum_covariance[1] == Approx(1).epsilon(1e-12));
  const double k_p = std::sqrt(-2 * std::log(0.05));
  CHECK(std::fabs(j.k_p - k_p) < 4 * j.k_p_se);
  // The Rayleigh density at k_p is k_p exp(-k_p^2 / 2) = 0.05 k_p. The error is a difference of order statistics
  // 2 sqrt(n p q) = 436 ranks apart, so that it is known to 1 / sqrt(436) = 5 %.
  CHECK(j.k_p_se == Approx(std::sqrt(0.05 * 0.95 / n) / (0.05 * k_p)).epsilon(0.2));
  const double k_q = rectangle_factor(0.5, 0.95);
  CHECK(k_q == Approx(2.212).margin(5e-4));
  CHECK(std::fabs(j.k_q - k_q) < 4 * j.k_q_se);
  CHECK(j.remark.empty());
}

TEST_CASE("JCGM 102: a rectangular shared term", "[references][joint]") {
  const Input x{0, {normal(1)}};
  const auto r = analysed(scenario_of<SharedTerm>({x, x, {0, {rectangular(std::sqrt(3.0))}}}, 1'000'000));
  CHECK(std::fabs(r.joint[0].k_p - 2.381) < 4 * r.joint[0].k_p_se + 5e-4);
  CHECK(std::fabs(r.joint[0].k_q - 2.152) < 4 * r.joint[0].k_q_se + 5e-4);
}

TEST_CASE("linearly dependent or constant measurands have no ellipsoid, whatever their scale", "[joint]") {
  const auto dependent =
      analysed(scenario_of<Dependent>({{1e5, {normal(1e-3)}}, {3, {normal(2e-3)}}}, 20'000)).joint[0];
  CHECK(std::isnan(dependent.k_p));
  CHECK(dependent.remark.find("linearly dependent") != std::string::npos);
  CHECK(dependent.k_q > 1.9);
  const auto constant = analysed(scenario_of<Constant>({{1, {normal(1)}}, {2, {}}}, 20'000)).joint[0];
  CHECK(std::isnan(constant.k_p));
  CHECK(constant.remark.find("does not vary") != std::string::npos);
  CHECK(constant.k_q == Approx(1.96).epsilon(0.03));
  // Scales that differ by 1e12 are no dependence.
  const auto scaled = analysed(scenario_of<Constant>({{0, {normal(1e-12)}}, {0, {normal(1)}}}, 20'000)).joint[0];
  CHECK(scaled.k_p == Approx(2.4477).epsilon(0.03));
}

TEST_CASE("JCGM 102 9.3: from Cartesian to polar, with statistics on the circle", "[references][joint]") {
  struct Row {
    double x1, r, radius, u_radius, angle, u_angle, correlation, gum_radius, gum_u_angle;
  };
  const Row rows[] = {{0.001, 0.0, 0.01257, 0.006567, 0, 1.7440, 0, 0.001, 10},
                      {0.100, 0.0, 0.10050, 0.009976, 0, 0.10050, 0, 0.1, 0.1},
                      {0.001, 0.9, 0.01174, 0.007959, -0.5563, 1.5987, -0.0695, 0.001, 10},
                      {0.100, 0.9, 0.10051, 0.009897, -0.00897, 0.10243, 0.8821, 0.1, 0.1}};
  for (const Row& row : rows) {
    auto s = scenario_of<Polar>({{row.x1, {normal(0.01)}}, {0, {normal(0.01)}}}, 1'000'000);
    if (row.r != 0)
      s.correlations.push_back({quantities::Correlation::Kind::pearson, {"x1", "x2"}, {1, row.r, row.r, 1}});
    const auto r = analysed(s);
    INFO("x1 = " << row.x1 << ", r = " << row.r);
    const auto& radius = r.summaries[0];
    const auto& angle = r.summaries[1];
    CHECK(std::fabs(radius.estimate - row.radius) < 4 * radius.estimate_se + 5e-6);
    CHECK(std::fabs(radius.standard_uncertainty - row.u_radius) < 4 * radius.standard_uncertainty_se + 5e-7);
    CHECK(std::fabs(angle.estimate - row.angle) < 4 * angle.estimate_se + 5e-5);
    CHECK(std::fabs(angle.standard_uncertainty - row.u_angle) < 4 * angle.standard_uncertainty_se + 5e-5);
    CHECK(std::fabs(r.joint[0].correlation[1] - row.correlation) < 4e-3 + 5e-5);
    CHECK(r.budgets[0].estimate == Approx(row.gum_radius));
    CHECK(r.budgets[0].combined_standard_uncertainty == Approx(0.01));
    CHECK(r.budgets[1].combined_standard_uncertainty == Approx(row.gum_u_angle));
    REQUIRE(r.circular.size() == 2);
    CHECK(r.circular[1].remark.empty() == (row.x1 > 0.01));
  }
}

TEST_CASE("an angle across the cut: circular statistics hold where the linear ones mislead", "[joint]") {
  constexpr double n = 200'000, u = 0.2, pi = std::numbers::pi;
  const auto r = analysed(scenario_of<Angle>({{3.1, {normal(u)}}}, static_cast<std::uint64_t>(n)));
  const auto& c = r.circular[0];
  // A wrapped normal: R = exp(-u^2 / 2), so that sqrt(-2 ln R) = u; the shortest arc is +-1.96 u.
  CHECK(std::fabs(std::remainder(c.mean_direction - 3.1, 2 * pi)) < 4 * u / std::sqrt(n));
  CHECK(c.resultant_length == Approx(std::exp(-u * u / 2)).epsilon(1e-3));
  CHECK(c.standard_deviation == Approx(u).epsilon(four_se(n)));
  CHECK(c.high - c.low == Approx(2 * 1.959964 * u).epsilon(0.02));
  CHECK(c.low < pi);
  CHECK(c.high > pi);
  CHECK(c.remark.find("across the cut") != std::string::npos);
  CHECK(r.summaries[0].standard_uncertainty > 5 * u);
}

TEST_CASE("circular statistics do not depend on where the circle is cut", "[joint]") {
  const auto r = analysed(scenario_of<Angle>({{1, {normal(0.3)}}}, 20'000));
  std::vector<double> angles;
  for (int i = 0; i < 20'000; ++i) angles.push_back(1 + 0.3 * std::sin(0.01 * i * i) + 0.1 * std::cos(3.0 * i));
  const auto at_home = analysis::circular_summary(angles, 0.95);
  CHECK(at_home.remark.empty());
  for (const double turn : {1.0, 2.2, 4.0, 100 * std::numbers::pi}) {
    auto moved = angles;
    for (double& a : moved) a = std::remainder(a + turn, 2 * std::numbers::pi);
    const auto c = analysis::circular_summary(moved, 0.95);
    CHECK(std::remainder(c.mean_direction - turn - at_home.mean_direction, 2 * std::numbers::pi) ==
          Approx(0).margin(1e-12));
    CHECK(c.standard_deviation == Approx(at_home.standard_deviation).epsilon(1e-10));
    CHECK(c.high - c.low == Approx(at_home.high - at_home.low).epsilon(1e-10));
  }
  CHECK(r.circular[0].remark.empty());
}

TEST_CASE("standard errors of circular statistics are those of the wrapped normal distribution", "[joint]") {
  // Angles at the quantiles of a normal distribution: their moments are its moments, alpha_k = exp(-k^2 s^2 / 2).
  const std::size_t n = 100'000;
  for (const double s : {0.2, 1.0, 2.0}) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < n; ++i)
      angles.push_back(1 + s * boost::math::quantile(boost::math::normal(), (static_cast<double>(i) + 0.5) / n));
    const auto c = analysis::circular_summary(angles, 0.95);
    const double R = std::exp(-s * s / 2), root = std::sqrt(static_cast<double>(n));
    CHECK(c.mean_direction_se * root == Approx(std::sqrt((1 - std::exp(-2 * s * s)) / 2) / R).epsilon(1e-3));
    CHECK(c.resultant_length_se * root == Approx((1 - R * R) / std::sqrt(2)).epsilon(2e-3));
    CHECK(c.standard_deviation_se * root == Approx((1 - R * R) / std::sqrt(2) / (R * s)).epsilon(2e-3));
  }
}
