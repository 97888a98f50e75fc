/// Estimation of quantities from readings: recovery, derivatives, singular directions, refusals.
#include <catch2/catch.hpp>

#include <cmath>

#include "calibration/estimated_scenario.h"
#include "places.h"
#include "unit/estimate_case.h"

using namespace estimate_case;
using known_case::known;

namespace {

std::string first_problem(const std::string& text) {
  try {
    const Case c(text);
    calibration::estimate(c.experiment);
  } catch (const InputError& error) {
    return error.problems().front().what;
  }
  return {};
}

} // namespace

TEST_CASE("noiseless readings give the quantities back", "[calibration]") {
  // Cases away from the start; the tolerance is what the issue of exact data asks for, 1e-7 relative.
  for (const auto& [z, pitch] : {std::pair{-350.25, 0.2836}, {-12.5, -1.7}, {120.0, 0.011}}) {
    INFO("z " << z << ", pitch " << pitch);
    const Case c(rod_scenario("[quantities.laser_z]\nestimated = true\n"
                              "[quantities.beam_pitch]\nestimated = true\nvalue = \"0.5 deg\"\n",
                              simulated(z, pitch), ""));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    CHECK(parameter(e, "laser_z").value == Approx(z * 1e-3).epsilon(1e-9));
    CHECK(parameter(e, "beam_pitch").value == Approx(pitch * scenario_fixture::degree).epsilon(1e-7));
  }
}

TEST_CASE("derivatives of the simulated indications equal differences", "[calibration]") {
  const Case c(rod_scenario("[quantities.laser_z]\nestimated = true\nvalue = \"-350 mm\"\n"
                            "[quantities.rod_length]\nestimated = true\nvalue = \"150 mm\"\n"
                            "[quantities.beam_radius]\nestimated = true\nvalue = \"0.2 mm\"\n"
                            "[quantities.beam_yaw]\nestimated = true\nvalue = \"10 deg\"\n"
                            "[quantities.holder_angle]\nestimated = true\nvalue = \"5 deg\"\n"
                            "[quantities.beam_pitch]\nestimated = true\nvalue = \"0.5 deg\"\n"
                            "[quantities.trigger_fraction]\nestimated = true\nvalue = 0.4\n"
                            "[effects.z_scale]\nE_ZZ = { estimated = true, value = \"5 um/m\" }\n"
                            "[effects.rod_expansion]\ntemperature_difference = { estimated = true, value = \"1 K\" }\n"
                            "[effects.trigger_latency]\ndelay = { estimated = true, value = \"1 ms\" }\n",
                            simulated(-350, 0.5), ""));
  const auto unknowns = calibration::unknowns_of(c.experiment);
  REQUIRE(unknowns.size() == 10); // more than one chunk of 8
  const calibration::Simulation simulation(c.experiment, unknowns, 1);
  std::vector<double> x, y(simulation.rows()), jacobian(y.size() * x.size());
  for (const auto& u : unknowns) x.push_back(u.start);
  jacobian.resize(y.size() * x.size());
  REQUIRE(simulation(x.data(), y.data(), jacobian.data()));
  for (std::size_t j = 0; j < x.size(); ++j) {
    auto up = x, down = x;
    std::vector<double> above(y.size()), below(y.size());
    const double h = 1e-5 * unknowns[j].magnitude;
    up[j] += h;
    down[j] -= h;
    REQUIRE(simulation(up.data(), above.data(), nullptr));
    REQUIRE(simulation(down.data(), below.data(), nullptr));
    for (std::size_t i = 0; i < y.size(); ++i) {
      INFO(unknowns[j].name << ", row " << i);
      // The height is solved to 1e-15 m: over 2 h that is the error of the difference, in addition to h^2 of the value.
      const double tolerance = 4e-15 / h + 1e-7 * std::fabs(jacobian[i * x.size() + j]);
      CHECK(std::fabs((above[i] - below[i]) / (2 * h) - jacobian[i * x.size() + j]) < tolerance);
    }
  }
}

TEST_CASE("quantities that the data cannot distinguish are named", "[calibration]") {
  const auto readings = simulated(-350, 0.5);
  const std::string two = "[quantities.laser_z]\nestimated = true\nvalue = \"-350.001 mm\"\n"
                          "[quantities.rod_length]\nestimated = true\nvalue = \"150 mm\"\n";
  const Case c(rod_scenario(two, readings, "resolution = \"1 um\"\n"));
  const auto e = calibration::estimate(c.experiment);
  CHECK(e.solver.converged);
  CHECK(e.rank == 1);
  CHECK_FALSE(e.determined);
  REQUIRE(e.indistinguishable.size() == 1);
  CHECK_THAT(e.indistinguishable[0], Catch::Contains("rod_length is indistinguishable from laser_z") &&
                                         Catch::Contains("rod_length +1 mm and laser_z -1 mm"));
  CHECK(std::isinf(parameter(e, "laser_z").standard_uncertainty));
  CHECK_THROWS_AS(calibration::estimated_scenario(c.experiment, e, ""), InputError);

  // A prior on one of them settles it; the data alone are still judged blind.
  const Case settled(rod_scenario(two + "u = \"2 um\"\n", readings, "resolution = \"1 um\"\n"));
  const auto f = calibration::estimate(settled.experiment);
  CHECK(f.rank == 1);
  CHECK(f.determined);
  CHECK(f.indistinguishable.size() == 1);
  // laser_z follows from the sum, known to 1 um / sqrt(12) / sqrt(5), and the length, known to 2 um.
  CHECK(parameter(f, "laser_z").standard_uncertainty == Approx(std::sqrt(4e-12 + 1e-12 / 60)).epsilon(1e-6));
  CHECK(f.correlation[1] < -0.99);
}

TEST_CASE("correlated quantities that are not normal are fitted with Pearson's coefficient", "[calibration]") {
  const auto rectangular = [](const char* name) {
    return fmt::format("[quantities.{}]\nestimated = true\nvalue = 0\ndistribution = \"rectangular\"\nhalf_width = 1\n",
                       name);
  };
  const double r = 0.8, v = 1.0 / 3, noise = 0.25;
  const Case c(line({0}, {0.9}, rectangular("a") + rectangular("b"), "u = 0.5\n") +
               "[[correlations]]\nkind = \"pearson\"\ncoefficient = 0.8\nquantities = [\"a\", \"b\"]\n");
  const auto e = calibration::estimate(c.experiment);
  // The reading is of a alone; b follows by its regression on a. The copula's coefficient, 0.8135, is not r.
  const double a = v / (v + noise) * 0.9;
  CHECK(parameter(e, "a").value == Approx(a).epsilon(1e-9));
  CHECK(parameter(e, "b").value == Approx(r * a).epsilon(1e-6)); // r -> copula -> r: 1e-7
  CHECK(parameter(e, "b").standard_uncertainty == Approx(std::sqrt(v * (1 - r * r * v / (v + noise)))).epsilon(1e-6));
}

TEST_CASE("GUM H.3: line of a thermometer's corrections", "[calibration][references]") {
  // JCGM 100:2008, H.3, with more digits than printed (published-numbers: 9 digits, so half a unit of the last).
  const scenario::Scenario s = scenario::read(GUMSHOE_SOURCE_DIR "/scenarios/gauge/gum_h3.toml", known());
  const propagation::Experiment experiment(s);
  const auto e = calibration::estimate(experiment);
  REQUIRE(e.solver.converged);
  CHECK(std::fabs(parameter(e, "y1").value - -0.171203790) < 1e-9);
  CHECK(std::fabs(parameter(e, "y2").value - 0.002182698) < 1e-9);
  CHECK(std::fabs(parameter(e, "y1").standard_uncertainty - 0.00287760) < 5e-9);
  CHECK(std::fabs(parameter(e, "y2").standard_uncertainty - 0.000667939) < 1e-9);
  CHECK(std::fabs(e.correlation[1] - -0.930430) < 5e-7);
  CHECK(std::fabs(e.s - 0.00349756) < 5e-9);
  CHECK(e.degrees_of_freedom == 9);
}

TEST_CASE("a model without derivatives is fitted by differences", "[calibration]") {
  std::vector<double> x, y;
  for (int i = 0; i < 9; ++i) {
    x.push_back(0.3 * i);
    y.push_back(2 * std::exp(-1.3 * x.back()) + 0.01 * ((i * 5) % 3));
  }
  std::string text = line(x, y, free_line);
  text.replace(text.find("a + b * x"), 9, "a * exp(-b * x)");
  Case c(text);
  const auto exact = calibration::estimate(c.experiment);
  auto blind = std::make_shared<models::Model>(*c.scenario.made);
  blind->simulate_gradient = nullptr;
  const auto keep = c.scenario.made; // owns what the copy points to
  c.scenario.made = blind;
  const propagation::Experiment experiment(c.scenario);
  const auto e = calibration::estimate(experiment);
  REQUIRE(e.solver.converged);
  // Central differences with a relative step h = 6e-6 err by about h^2 + 1e-16 / h = 5e-11 of the derivatives.
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(std::fabs(e.parameters[j].value - exact.parameters[j].value) <
          1e-8 * exact.parameters[j].standard_uncertainty);
    CHECK(e.parameters[j].standard_uncertainty == Approx(exact.parameters[j].standard_uncertainty).epsilon(1e-8));
  }
}

TEST_CASE("a start without slope is no minimum", "[calibration]") {
  // y = b^2 x has no slope at b = 0, and y = a b none at a = b = 0.
  std::string square = line({1, 2, 3, 4}, {4, 8, 12, 16.1}, "[quantities.b]\nestimated = true\nvalue = 0\n");
  square.replace(square.find("a + b * x"), 9, "b^2 * x");
  square.replace(square.find("a + 2 * b"), 9, "2 * b");
  const Case c(square);
  const auto e = calibration::estimate(c.experiment);
  REQUIRE(e.solver.converged);
  CHECK(std::fabs(e.parameters[0].value) == Approx(std::sqrt(120.4 / 30)).epsilon(1e-9));
}

TEST_CASE("any number of threads gives the same bits", "[calibration]") {
  std::vector<double> x, y;
  for (int i = 0; i < 700; ++i) {
    x.push_back(0.01 * i);
    y.push_back(std::sin(0.7 * i) + 0.3 * x.back());
  }
  const Case c(line(x, y, free_line));
  const auto one = calibration::estimate(c.experiment, {1}), three = calibration::estimate(c.experiment, {3});
  CHECK(one.covariance == three.covariance);
  for (std::size_t j = 0; j < 2; ++j) CHECK(one.parameters[j].value == three.parameters[j].value);
}

TEST_CASE("what cannot be estimated is said", "[calibration]") {
  CHECK_THAT(first_problem(line({1, 2, 3}, {1, 2, 3}, "[quantities.a]\nvalue = 1\n[quantities.b]\nvalue = 1\n")),
             Catch::Contains("no quantity is marked estimated"));
  CHECK_THAT(first_problem(line({1}, {1}, free_line)), Catch::Contains("cannot determine 2"));
  CHECK_THAT(first_problem(line({1, 2}, {1, 2},
                                "[quantities.a]\nestimated = true\nvalue = 1\nu = 1\nper = \"reading\"\n"
                                "[quantities.b]\nvalue = 1\n")),
             Catch::Contains("estimated is given together with per"));
}
