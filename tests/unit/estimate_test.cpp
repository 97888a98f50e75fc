/// Estimation of quantities from readings: recovery, derivatives, singular directions, robust losses.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "calibration/estimated_scenario.h"
#include "effects/catalogue.h"
#include "models/model.h"
#include "places.h"
#include "unit/scenario_fixture.h"

using namespace gumshoe;

namespace {

scenario::Catalogue known() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  return c;
}

/// A scenario and its experiment, which refers to it.
struct Case {
  scenario_fixture::Folder folder;
  scenario::Scenario scenario;
  propagation::Experiment experiment;
  explicit Case(const std::string& text)
      : scenario(scenario::read(folder.write("s.toml", text), known())), experiment(scenario) {}
};

const calibration::Parameter& parameter(const calibration::Estimate& e, const std::string& name) {
  for (const auto& p : e.parameters)
    if (p.unknown.name == name) return p;
  throw InputError("no parameter " + name);
}

std::string first_problem(const std::string& text) {
  try {
    const Case c(text);
    calibration::estimate(c.experiment);
  } catch (const InputError& error) {
    return error.problems().front().what;
  }
  return {};
}

/// Rods of different radius and bottom: heights of a beam pitched by `pitch` degrees whose axis lies at `z` mm.
struct RodCase {
  double radius, fillet, elevation, azimuth;
};
constexpr RodCase rods[] = {{5, 0.03, 90, 0}, {5, 0.5, 89, 60}, {3, 0, 90, 0}, {8, 1, 88.5, 200}, {2, 2, 90, 0}};

std::string rod_scenario(const std::string& estimated, const std::vector<std::string>& readings,
                         const std::string& noise) {
  std::string text = "schema = 1\n[model]\nname = \"rod_gauging\"\n" + estimated;
  const auto by = [&](const char* name, const char* unit, auto member) {
    text += fmt::format("[quantities.{}.by.rod]\n", name);
    for (std::size_t i = 0; i < std::size(rods); ++i)
      text += fmt::format("r{} = \"{} {}\"\n", i, rods[i].*member, unit);
  };
  by("rod_radius", "mm", &RodCase::radius);
  by("fillet_radius", "mm", &RodCase::fillet);
  by("bottom_elevation", "deg", &RodCase::elevation);
  by("bottom_azimuth", "deg", &RodCase::azimuth);
  text += "[indications.spindle_z]\n" + noise + "rows = [\n";
  for (std::size_t i = 0; i < readings.size(); ++i)
    text += fmt::format("  {{ rod = \"r{}\", values = [\"{} mm\"] }},\n", i, readings[i]);
  return text + "]\n";
}

/// Indications of the rods for given quantities, as the model has them.
std::vector<std::string> simulated(double z_mm, double pitch_deg) {
  const std::vector<std::string> nothing(std::size(rods), "0");
  const Case c(
      rod_scenario("[quantities.laser_z]\nestimated = true\n[quantities.beam_pitch]\nestimated = true\n", nothing, ""));
  const auto unknowns = calibration::unknowns_of(c.experiment);
  const calibration::Simulation simulation(c.experiment, unknowns, 1);
  std::vector<double> x, out(simulation.rows());
  for (const auto& u : unknowns) x.push_back(u.name == "laser_z" ? z_mm * 1e-3 : pitch_deg * scenario_fixture::degree);
  REQUIRE(simulation(x.data(), out.data(), nullptr));
  std::vector<std::string> text;
  for (const double v : out) text.push_back(fmt::format("{:.17g}", v * 1e3));
  return text;
}

std::string line(const std::vector<double>& x, const std::vector<double>& y, const std::string& more,
                 const std::string& noise = "") {
  std::string text = "schema = 1\n[model]\nname = \"expression\"\n[model.indications]\ny = \"a + b * x\"\n"
                     "[model.measurands]\ny_2 = \"a + 2 * b\"\n[conditions]\nx = 0\n" +
                     more + "[indications.y]\n" + noise + "rows = [\n";
  for (std::size_t i = 0; i < x.size(); ++i)
    text += fmt::format("  {{ x = {:.17g}, values = [{:.17g}] }},\n", x[i], y[i]);
  return text + "]\n";
}
const std::string free_line =
    "[quantities.a]\nestimated = true\nvalue = 0.5\n[quantities.b]\nestimated = true\nvalue = 0.5\n";

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
      // The height is solved to 1e-15 m: over 2 h that is the error of the difference; beside it h^2 of the value.
      const double tolerance = 4e-15 / h + 1e-7 * std::fabs(jacobian[i * x.size() + j]);
      CHECK(std::fabs((above[i] - below[i]) / (2 * h) - jacobian[i * x.size() + j]) < tolerance);
    }
  }
}

TEST_CASE("pulls of 400 simulated sets have mean 0 and standard deviation 1", "[calibration]") {
  // y = a + b x with s = 0.1 declared: (estimate - truth) / u is standard normal. With n sets the mean's standard
  // error is 1/sqrt(n), that of the standard deviation 1/sqrt(2 n). A factor of 1.2 in u would be seen.
  constexpr int sets = 400;
  const double a = 1.5, b = -0.7, s = 0.1;
  std::mt19937_64 generator(20);
  std::normal_distribution<double> normal;
  double sum[2] = {}, squares[2] = {}, chi = 0;
  for (int k = 0; k < sets; ++k) {
    std::vector<double> x, y;
    for (int i = 0; i < 8; ++i) {
      x.push_back(i * i * 0.1);
      y.push_back(a + b * x.back() + s * normal(generator));
    }
    const Case c(line(x, y, free_line, "repeatability = { s = 0.1 }\n"));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    const double pulls[] = {(parameter(e, "a").value - a) / parameter(e, "a").standard_uncertainty,
                            (parameter(e, "b").value - b) / parameter(e, "b").standard_uncertainty};
    for (int j = 0; j < 2; ++j) {
      sum[j] += pulls[j];
      squares[j] += pulls[j] * pulls[j];
    }
    chi += e.chi_squared;
    CHECK(e.degrees_of_freedom == 6);
  }
  for (int j = 0; j < 2; ++j) {
    const double mean = sum[j] / sets, sd = std::sqrt(squares[j] / sets - mean * mean);
    CHECK(std::fabs(mean) < 4 / std::sqrt(sets));
    CHECK(std::fabs(sd - 1) < 4 / std::sqrt(2.0 * sets));
  }
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
               "components = [ { u = 3 }, { u = 1, per = \"reading\" } ]\n"
               "rows = [ { x = 1, values = [1] }, { x = 2, values = [2] }, { x = 3, values = [4] }, { x = 4, values = "
               "[5] } ]\n");
  const auto e = calibration::estimate(c.experiment);
  CHECK(e.parameters[0].value == Approx(3).epsilon(1e-12));
  CHECK(e.parameters[0].standard_uncertainty == Approx(std::sqrt(9.25)).epsilon(1e-12));
}

TEST_CASE("what the data cannot tell apart is named", "[calibration]") {
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
                    [](const std::string& n) { return n.starts_with("reading 8 stands out"); }));
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

TEST_CASE("the written scenario holds what was found", "[calibration]") {
  const scenario::Scenario s = scenario::read(GUMSHOE_SOURCE_DIR "/scenarios/gauge/gum_h3.toml", known());
  const propagation::Experiment experiment(s);
  const auto e = calibration::estimate(experiment);
  const scenario_fixture::Folder folder;
  const std::string text = calibration::estimated_scenario(experiment, e, folder.path());
  const scenario::Scenario written = scenario::read(folder.write("w.toml", text), known());
  for (const auto& p : e.parameters) {
    const auto& q = scenario_fixture::quantity(written, p.unknown.name);
    CHECK(q.entries[0].value == p.value);
    CHECK(std::sqrt(q.entries[0].components.at(0).distribution.variance()) ==
          Approx(p.standard_uncertainty).epsilon(1e-14));
    CHECK(q.entries[0].components[0].degrees_of_freedom == e.degrees_of_freedom);
    CHECK_FALSE(q.estimated);
    CHECK_THAT(q.entries[0].source + q.entries[0].components[0].source, Catch::Contains(s.hash));
  }
  REQUIRE(written.correlations.size() == 1);
  CHECK(written.correlations[0].matrix[1] == e.correlation[1]);
}

TEST_CASE("values per label are one unknown each, and stay tied in the written scenario", "[calibration]") {
  // Rods of unknown length against one beam whose height is known to 1 um: lengths share that error.
  std::string text =
      "schema = 1\n[model]\nname = \"rod_gauging\"\n[quantities.laser_z]\nestimated = true\nvalue = \"-500 "
      "mm\"\nu = \"1 um\"\n[quantities.rod_length]\nestimated = true\nby.rod.one = \"150 mm\"\nby.rod.two = "
      "\"160 mm\"\n[indications.spindle_z]\nrepeatability = { s = \"0.5 um\" }\nrows = [ { rod = \"one\", "
      "values = [\"-349.99 mm\"] }, { rod = \"two\", values = [\"-340.02 mm\"] } ]\n";
  const Case c(text);
  const auto e = calibration::estimate(c.experiment);
  REQUIRE(e.parameters.size() == 3);
  const double u = std::sqrt(1e-12 + 0.25e-12);
  CHECK(parameter(e, "rod_length[rod one]").standard_uncertainty == Approx(u).epsilon(1e-9));
  const std::size_t one = 0, two = 1;
  REQUIRE(e.parameters[one].unknown.name == "rod_length[rod one]");
  REQUIRE(e.parameters[two].unknown.name == "rod_length[rod two]");
  CHECK(e.correlation[one * 3 + two] == Approx(1 / 1.25).epsilon(1e-9));
  const Case written(calibration::estimated_scenario(c.experiment, e, c.folder.path()));
  REQUIRE(written.experiment.plan().copulas.size() == 1);
  CHECK(written.experiment.plan().copulas[0].variates.size() == 3);
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

TEST_CASE("pulls of a rod's fit have mean 0 and standard deviation 1", "[calibration]") {
  // Five rods read to 0.5 um: curvature over u(pitch) is small, so the pulls are normal to first order.
  constexpr int sets = 200;
  const double z = -350, pitch = 0.5;
  const auto exact = simulated(z, pitch);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  double sum[2] = {}, squares[2] = {};
  for (int k = 0; k < sets; ++k) {
    auto readings = exact;
    for (auto& r : readings) r = fmt::format("{:.17g}", std::stod(r) + 0.5e-3 * normal(generator));
    const Case c(rod_scenario("[quantities.laser_z]\nestimated = true\n"
                              "[quantities.beam_pitch]\nestimated = true\nvalue = \"0.4 deg\"\n",
                              readings, "repeatability = { s = \"0.5 um\" }\n"));
    const auto e = calibration::estimate(c.experiment);
    REQUIRE(e.solver.converged);
    const auto &a = parameter(e, "laser_z"), &b = parameter(e, "beam_pitch");
    const double pulls[] = {(a.value - z * 1e-3) / a.standard_uncertainty,
                            (b.value - pitch * scenario_fixture::degree) / b.standard_uncertainty};
    for (int j = 0; j < 2; ++j) {
      sum[j] += pulls[j];
      squares[j] += pulls[j] * pulls[j];
    }
  }
  for (int j = 0; j < 2; ++j) {
    const double mean = sum[j] / sets, sd = std::sqrt(squares[j] / sets - mean * mean);
    CHECK(std::fabs(mean) < 4 / std::sqrt(sets));
    CHECK(std::fabs(sd - 1) < 4 / std::sqrt(2.0 * sets));
  }
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

TEST_CASE("a prior beside noise that nobody declared is weighed by the noise found", "[calibration]") {
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

TEST_CASE("what cannot be estimated is said", "[calibration]") {
  CHECK_THAT(first_problem(line({1, 2, 3}, {1, 2, 3}, "[quantities.a]\nvalue = 1\n[quantities.b]\nvalue = 1\n")),
             Catch::Contains("no quantity is marked estimated"));
  CHECK_THAT(first_problem(line({1}, {1}, free_line)), Catch::Contains("cannot determine 2"));
  CHECK_THAT(first_problem(line({1, 2}, {1, 2},
                                "[quantities.a]\nestimated = true\nvalue = 1\nu = 1\nper = \"reading\"\n"
                                "[quantities.b]\nvalue = 1\n")),
             Catch::Contains("estimated beside per"));
}
