/// Estimates and noise: pulls, priors, shared noise, outliers, repeats.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "unit/estimate_case.h"

using namespace estimate_case;

namespace {

/// (estimate - truth) / u of many sets is standard normal. With n sets the mean's standard error is 1/sqrt(n), that of
/// the standard deviation 1/sqrt(2 n): of 400 sets a factor of 1.2 in u would be seen.
class Pulls {
public:
  void add(const calibration::Parameter& found, double truth) {
    const double pull = (found.value - truth) / found.standard_uncertainty;
    sum_ += pull;
    squares_ += pull * pull;
    ++sets_;
  }
  void check() const {
    const double n = sets_, mean = sum_ / n, sd = std::sqrt(squares_ / n - mean * mean);
    CHECK(std::fabs(mean) < 4 / std::sqrt(n));
    CHECK(std::fabs(sd - 1) < 4 / std::sqrt(2 * n));
  }

private:
  double sum_ = 0, squares_ = 0;
  int sets_ = 0;
};

} // namespace

TEST_CASE("pulls of 400 simulated sets have mean 0 and standard deviation 1", "[calibration]") {
  // y = a + b x with s = 0.1 declared.
  constexpr int sets = 400;
  const double a = 1.5, b = -0.7, s = 0.1;
  std::mt19937_64 generator(20);
  std::normal_distribution<double> normal;
  Pulls pulls_a, pulls_b;
  double chi = 0;
  for (int k = 0; k < sets; ++k) {
    std::vector<double> x, y;
    for (int i = 0; i < 8; ++i) {
      x.push_back(i * i * 0.1);
      y.push_back(a + b * x.back() + s * normal(generator));
    }
    const Case c(line(x, y, free_line, "repeatability = { s = 0.1 }\n"));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    pulls_a.add(parameter(e, "a"), a);
    pulls_b.add(parameter(e, "b"), b);
    chi += e.chi_squared;
    CHECK(e.degrees_of_freedom == 6);
  }
  pulls_a.check();
  pulls_b.check();
  CHECK(std::fabs(chi / sets - 6) < 4 * std::sqrt(12.0 / sets));
}

TEST_CASE("a prior and a reading meet at the mean weighed by 1/u^2", "[calibration]") {
  // One unknown: prior 10 +- 2, two readings of it 13 and 15 +- 1: mean = (10/4 + 13 + 15) / (1/4 + 2).
  const std::string text = "schema = 1\n[model]\nname = \"expression\"\n[model.indications]\ny = \"a + 0 * x\"\n"
                           "[conditions]\nx = 0\n[quantities.a]\nestimated = true\nvalue = 10\nu = 2\n"
                           "[indications.y]\nrepeatability = { s = 1 }\nrows = [ { x = 1, values = [13] }, { x = 2, "
                           "values = [15] } ]\n";
  const Case c(text);
  const auto e = calibration::estimate(c.experiment);
  CHECK(e.parameters[0].value == Approx((2.5 + 28) / 2.25).epsilon(1e-12));
  CHECK(e.parameters[0].standard_uncertainty == Approx(1 / 1.5).epsilon(1e-12));
  CHECK(e.degrees_of_freedom == 2);
}

TEST_CASE("noise shared by readings is not averaged away", "[calibration]") {
  // y_i = a + common + own, common 3, own 1, n = 4: u^2(a) = 9 + 1/4.
  const Case c("schema = 1\n[model]\nname = \"expression\"\n[model.indications]\ny = \"a + 0 * x\"\n[conditions]\n"
               "x = 0\n[quantities.a]\nestimated = true\nvalue = 1\n[indications.y]\n"
               "components = [ { u = 3, per = [] }, { u = 1, per = \"reading\" } ]\n"
               "rows = [ { x = 1, values = [1] }, { x = 2, values = [2] }, { x = 3, values = [4] }, { x = 4, values = "
               "[5] } ]\n");
  const auto e = calibration::estimate(c.experiment);
  CHECK(e.parameters[0].value == Approx(3).epsilon(1e-12));
  CHECK(e.parameters[0].standard_uncertainty == Approx(std::sqrt(9.25)).epsilon(1e-12));
}

TEST_CASE("a robust loss leaves an outlier aside and names it", "[calibration]") {
  std::vector<double> x, y;
  for (int i = 0; i < 20; ++i) {
    x.push_back(i);
    y.push_back(2 + 3 * i + 0.01 * ((i * 7) % 5 - 2));
  }
  y[7] += 100;
  for (const char* loss : {"huber", "cauchy", "tukey"}) {
    INFO(loss);
    const Case c(line(x, y, free_line + "[estimate]\nloss = \"" + loss + "\"\n", "repeatability = { s = 0.015 }\n"));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    CHECK(e.rows[7].weight < 0.01);
    // Squared, the outlier alone would move b by 100 (7 - 9.5) / 665 = -0.38.
    CHECK(std::fabs(parameter(e, "b").value - 3) < 0.01);
    // Noise unknown: the scale comes from the residuals' median.
    const Case u(line(x, y, free_line + "[estimate]\nloss = \"" + loss + "\"\n"));
    const auto f = calibration::estimate(u.experiment);
    REQUIRE(f.solver.converged);
    CHECK(f.rows[7].weight < 0.01);
    CHECK(f.s < 0.03);
    CHECK(std::fabs(parameter(f, "b").value - 3) < 0.01);
  }
  const Case c(line(x, y, free_line));
  const auto e = calibration::estimate(c.experiment);
  CHECK(std::any_of(e.notes.begin(), e.notes.end(),
                    [](const std::string& n) { return n.starts_with("reading 8") && n.find("stands out") != n.npos; }));
}

TEST_CASE("pulls of a rod's fit have mean 0 and standard deviation 1", "[calibration]") {
  // Five rods read to 0.5 um: curvature over u(pitch) is small, so the pulls are normal to first order.
  constexpr int sets = 200;
  const double z = -350, pitch = 0.5;
  const auto exact = simulated(z, pitch);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  Pulls of_z, of_pitch;
  for (int k = 0; k < sets; ++k) {
    auto readings = exact;
    for (auto& r : readings) r = fmt::format("{:.17g}", std::stod(r) + 0.5e-3 * normal(generator));
    const Case c(rod_scenario("[quantities.laser_z]\nestimated = true\n"
                              "[quantities.beam_pitch]\nestimated = true\nvalue = \"0.4 deg\"\n",
                              readings, "repeatability = { s = \"0.5 um\" }\n"));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    of_z.add(parameter(e, "laser_z"), z * 1e-3);
    of_pitch.add(parameter(e, "beam_pitch"), pitch * scenario_fixture::degree);
  }
  of_z.check();
  of_pitch.check();
}

TEST_CASE("a reading that Tukey's loss rejects leaves the degrees of freedom, too", "[calibration]") {
  const std::vector<double> x{0, 1, 2, 3, 4, 5, 6, 7}, y{1.1, 2.9, 5.2, 6.8, 9.1, 11.05, 13.0, 15.1};
  auto far_x = x, far_y = y;
  far_x.push_back(3.5), far_y.push_back(400);
  const std::string tukey = "[estimate]\nloss = \"tukey\"\n";
  const auto without = calibration::estimate(Case(line(x, y, free_line + tukey)).experiment);
  const auto rejected = calibration::estimate(Case(line(far_x, far_y, free_line + tukey)).experiment);
  REQUIRE(rejected.rows.back().weight == 0);
  CHECK(without.degrees_of_freedom == 6);
  CHECK(rejected.degrees_of_freedom == 6);
}

TEST_CASE("with undeclared noise, a prior is weighted by the noise found", "[calibration]") {
  // A weak prior must leave the fit as it is without one, a strong one must hold the quantity.
  const std::vector<double> x{0, 1, 2, 3, 4, 5}, y{1.1, 2.9, 5.2, 6.8, 9.1, 11.05};
  const Case alone(line(x, y, free_line));
  const auto without = calibration::estimate(alone.experiment);
  const Case weak(line(x, y, free_line + "u = 1000\n"));
  const auto loose = calibration::estimate(weak.experiment);
  CHECK(parameter(loose, "b").value == Approx(parameter(without, "b").value).epsilon(1e-6));
  CHECK(parameter(loose, "b").standard_uncertainty ==
        Approx(parameter(without, "b").standard_uncertainty).epsilon(1e-6));
  CHECK(loose.degrees_of_freedom == Approx(4).epsilon(1e-6));
  const Case strong(line(x, y, free_line + "u = 1e-9\n"));
  const auto held = calibration::estimate(strong.experiment);
  CHECK(parameter(held, "b").value == Approx(0.5).epsilon(1e-6));
  CHECK(held.degrees_of_freedom == Approx(5).epsilon(1e-6)); // one unknown is left to the data
}

TEST_CASE("repeats under the same conditions count like readouts of their own", "[calibration]") {
  // Labels keep the readouts apart in one scenario, equal conditions merge them in the other: the same fit.
  const std::vector<double> x{0, 0, 0, 1, 1, 2, 3, 3}, y{1.1, 0.9, 1.3, 2.9, 3.2, 5.2, 6.8, 7.1};
  const Case merged(line(x, y, free_line));
  std::string text = line(x, y, free_line);
  for (std::size_t i = 0, at = 0; i < x.size(); ++i) {
    at = text.find("{ x =", at) + 2;
    text.insert(at, fmt::format("n = \"{}\", ", i));
  }
  const Case apart(text);
  REQUIRE(merged.scenario.readings.size() == 4);
  REQUIRE(apart.scenario.readings.size() == 8);
  const auto a = calibration::estimate(merged.experiment), b = calibration::estimate(apart.experiment);
  CHECK(a.degrees_of_freedom == b.degrees_of_freedom);
  CHECK(a.s == Approx(b.s).epsilon(1e-12));
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(a.parameters[j].value == Approx(b.parameters[j].value).epsilon(1e-12));
    CHECK(a.parameters[j].standard_uncertainty == Approx(b.parameters[j].standard_uncertainty).epsilon(1e-12));
  }
}

TEST_CASE("only a quantity that the indications depend on is held at its estimate", "[calibration]") {
  const auto held = [](const std::string& formula) {
    std::string text = line({0, 1, 2, 3, 4}, {1, 3, 5.1, 7, 9}, free_line + "[quantities.c]\nvalue = 1\nu = 0.1\n");
    text.insert(text.find(formula) + formula.size(), " + c");
    const Case c(text);
    const auto e = calibration::estimate(c.experiment);
    return std::any_of(e.notes.begin(), e.notes.end(),
                       [](const std::string& n) { return n.starts_with("c is held at its estimate"); });
  };
  CHECK(held("a + b * x"));
  CHECK_FALSE(held("a + 2 * b"));
}
