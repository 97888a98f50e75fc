/// Stated effects with a size are input quantities like any other. Trigger latency moves the readout by direction times
/// feed times delay: stated as that formula it must give the figures of the catalogue's effect.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "analysis/derivatives.h"
#include "analysis/differences.h"
#include "analysis/gum.h"
#include "base/text_file.h"
#include "calibration/estimated_scenario.h"
#include "choice/setup.h"
#include "places.h"
#include "unit/known_case.h"

using namespace gumshoe;
using known_case::Case;
using known_case::known;

namespace {

const std::string propagation_head = "schema = 1\nmodel = { name = \"rod_gauging\" }\n";
const std::string virtual_head = "schema = 1\nmodel = { name = \"rod_gauging\", method = \"virtual_experiment\" }\n";
const std::string readings = "[indications.spindle_z]\n"
                             "rows = [ { setup = \"1\", feed = \"4 mm/min\", values = [\"-349.259 mm\"] },\n"
                             "{ setup = \"2\", feed = \"400 mm/min\", values = [\"-349.251 mm\"] } ]\n";
const std::string places =
    "[indications.spindle_z]\n"
    "rows = [ { setup = \"1\", feed = \"4 mm/min\" }, { setup = \"2\", feed = \"400 mm/min\" } ]\n";
const std::string beam = "[quantities]\nbeam_pitch = { value = \"0.2836 deg\", u = \"0.002 deg\" }\n"
                         "rod_length = { value = \"160.591 mm\", u = \"1 um\" }\n";

std::string latency(const std::string& delay) { return "[effects.trigger_latency]\ndelay = " + delay + "\n"; }
std::string stated(const std::string& size) {
  return "[stated_effects.lag]\nformula = \"direction * feed\"\nunit = \"ms\"\nsize = " + size + "\n";
}
const std::string drawn = "{ value = \"1.5 ms\", u = \"0.2 ms\" }";

/// Outputs for one variate's values, which are the same for both.
std::vector<double> outputs(const propagation::Experiment& e, const std::vector<double>& deviations) {
  REQUIRE(e.plan().variates.size() == 1);
  propagation::Workspace w;
  std::vector<double> out(e.outputs().size() * deviations.size());
  std::vector<std::uint8_t> status(deviations.size());
  const double* variates[] = {deviations.data()};
  e.run(variates, deviations.size(), w, out.data(), status.data());
  for (const auto s : status) REQUIRE(s == 0);
  return out;
}

/// At 1e-3 s of delay heights of half a metre are shifted by micrometres: rounding of a height.
constexpr double rounding = 4e-16;

} // namespace

TEST_CASE("a stated latency is the catalogue's latency", "[stated]") {
  const std::vector<double> deviations{-6e-4, -2e-4, -1e-5, 0, 1e-5, 2e-4, 4e-4, 6e-4};
  for (const bool virtual_experiment : {false, true}) {
    const std::string head = virtual_experiment ? virtual_head + places : propagation_head + readings;
    const Case a(head + latency(drawn)), b(head + stated(drawn));
    const auto x = outputs(a.experiment, deviations), y = outputs(b.experiment, deviations);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::fabs(x[i] - y[i]) < rounding);
    // The second reading's feed makes 6.67 um of a millisecond, with the sign of direction.
    const double sign = virtual_experiment ? -1 : 1;
    const std::size_t last = y.size() - 8;
    CHECK(y[last + 7] - y[last] == Approx(sign * 0.4 / 60 * 12e-4).epsilon(1e-9));
  }
}

TEST_CASE("its budget is the catalogue's", "[stated]") {
  const Case a(propagation_head + readings + beam + latency(drawn)),
      b(propagation_head + readings + beam + stated(drawn));
  REQUIRE(a.scenario.quantities.size() == b.scenario.quantities.size());
  for (std::size_t o = 0; o < a.experiment.outputs().size(); ++o) {
    const auto x = analysis::budget(a.experiment, o, 0.95), y = analysis::budget(b.experiment, o, 0.95);
    CHECK(std::fabs(x.estimate - y.estimate) < rounding);
    CHECK(y.combined_standard_uncertainty == Approx(x.combined_standard_uncertainty).epsilon(1e-12));
    CHECK(y.second_order_uncertainty == Approx(x.second_order_uncertainty).epsilon(1e-9));
    REQUIRE(x.contributions.size() == y.contributions.size());
    for (const auto& one : x.contributions) {
      const std::string name = one.quantity == "trigger_latency.delay" ? "lag.size" : one.quantity;
      const auto same = std::ranges::find(y.contributions, name, &analysis::Contribution::quantity);
      REQUIRE(same != y.contributions.end());
      CHECK(same->sensitivity == Approx(one.sensitivity).epsilon(1e-12));
      CHECK(same->share == Approx(one.share).epsilon(1e-12));
    }
  }
}

TEST_CASE("derivatives by a size, exact and by differences", "[stated]") {
  const Case c(propagation_head + readings + beam + stated(drawn));
  const auto point = c.experiment.point(1);
  const auto exact = analysis::differentiate(c.experiment, 1, 1, point, true);
  const auto differences = analysis::differences(c.experiment, 1, point, true)[1];
  const std::size_t size = point.size() - 1, noise = size - 1;
  CHECK(exact.value == differences.value);
  // What the size moves is the readout: c = -loading times that of the readout.
  CHECK(exact.first[size] == Approx(0.4 / 60 * exact.first[noise]).epsilon(1e-14));
  CHECK(differences.first[size] == Approx(exact.first[size]).epsilon(1e-6));
  CHECK(exact.second[size * point.size() + size] == Approx(0).margin(1e-9));
}

TEST_CASE("the evaluation subtracts what the simulation adds", "[stated][law]") {
  const std::vector<double> moves{-1e-5, 0, 1e-5, 2e-5, 3e-5, 4e-5, 5e-5, 6e-5};
  const std::string one = "[quantities]\nbeam_yaw = { u = \"0.001 deg\" }\n";
  const Case bare(virtual_head + places), exact(virtual_head + places + stated("\"40 ms\""));
  REQUIRE(exact.experiment.plan().variates.empty());
  propagation::Workspace w;
  std::vector<double> errors(exact.experiment.outputs().size() * 8);
  std::vector<std::uint8_t> status(8);
  exact.experiment.run({}, 8, w, errors.data(), status.data());
  for (const double e : errors) CHECK(std::fabs(e) < 4 * rounding);
  // Nothing else moves, bit for bit: neither values nor the random numbers of others.
  const Case without(propagation_head + readings + one), with(propagation_head + readings + one + stated("\"0 s\""));
  CHECK(outputs(without.experiment, moves) == outputs(with.experiment, moves));
  const Case free(propagation_head + readings + one + stated(drawn));
  const auto &x = without.experiment.plan().variates, &y = free.experiment.plan().variates;
  REQUIRE(y.size() == x.size() + 1);
  for (const auto& v : x) {
    const auto same = std::ranges::find(y, v.name, &std::decay_t<decltype(v)>::name);
    REQUIRE(same != y.end());
    CHECK(same->key == v.key);
  }
}

namespace {

/// Readings at two set-ups and four feeds, simulated with the catalogue's latency of 1.5 ms; then the scenario that
/// estimates a stated lag and the laser's height per set-up from them.
std::string made_up(const scenario_fixture::Folder& folder, double noise) {
  std::string rows;
  for (int setup = 1; setup <= 2; ++setup)
    for (const int feed : {4, 40, 400, 1000})
      rows += fmt::format("{{ setup = \"{}\", feed = \"{} mm/min\", values = [\"0 mm\"] }},\n", setup, feed);
  const std::string heights = "[quantities.laser_z.by.setup]\n1 = \"-510 mm\"\n2 = \"-510.2 mm\"\n";
  const std::string estimated =
      "[quantities.laser_z]\nestimated = true\nby.setup = { 1 = \"-500 mm\", 2 = \"-500 mm\" }\n";
  const std::string text = "schema = 1\nmodel = { name = \"rod_gauging\" }\n[indications.spindle_z]\nrows = [\n" +
                           rows + "]\n[quantities.rod_length]\nvalue = \"160 mm\"\nestimated = true\nu = \"1 um\"\n";
  const auto truth = scenario::read(folder.write("t.toml", text + heights + latency("\"1.5 ms\"")), known());
  const propagation::Experiment experiment(truth);
  const calibration::Simulation simulation(experiment, calibration::unknowns_of(experiment), 1);
  std::vector<double> z(simulation.rows());
  const double length = 0.160;
  REQUIRE(simulation(&length, z.data(), nullptr));
  std::string data = "setup,feed,z\n";
  for (std::size_t i = 0; i < z.size(); ++i)
    data += fmt::format("{},{},{}\n", i / 4 + 1, (std::vector<int>{4, 40, 400, 1000})[i % 4],
                        (z[i] + (i % 2 ? noise : -noise)) * 1e3);
  folder.write("z.csv", data);
  return folder.write(
      "s.toml",
      "schema = 1\nmodel = { name = \"rod_gauging\" }\n[indications.spindle_z]\nreadings = { file = \"z.csv\", "
      "column = \"z\", unit = \"mm\", labels = { setup = \"setup\" }, conditions = { feed = { column = "
      "\"feed\", unit = \"mm/min\" } } }\nrepeatability = { s = \"1 um\" }\n[quantities]\nrod_length = \"160 mm\"\n" +
          estimated + stated("{ estimated = true, value = \"0 s\" }"));
}

} // namespace

TEST_CASE("estimate recovers a size, with exact derivatives and without", "[stated][estimate]") {
  const scenario_fixture::Folder folder;
  auto s = scenario::read(made_up(folder, 0), known());
  for (const bool exact : {true, false}) {
    auto model = *models::find("rod_gauging");
    if (!exact) model.simulate_gradient = nullptr;
    s.made = std::make_shared<models::Model>(model);
    const propagation::Experiment e(s);
    const auto found = calibration::estimate(e);
    CAPTURE(exact, found.solver.reason);
    CHECK(found.solver.converged);
    REQUIRE(found.parameters.size() == 3);
    const auto& size = found.parameters.back();
    CHECK(size.unknown.name == "lag.size");
    // Rows are exact to the rounding of heights, 1e-16 m; the lever is 16 mm/s.
    CHECK(size.value == Approx(1.5e-3).epsilon(1e-9));
    CHECK(found.parameters[0].value == Approx(-0.510).epsilon(1e-12));
    // Straight line with a constant per set-up: u = s / sqrt(sum of (feed - mean)^2).
    double mean = 0, squares = 0;
    for (const double f : {4., 40., 400., 1000.}) mean += f / 4;
    for (const double f : {4., 40., 400., 1000.}) squares += 2 * (f - mean) * (f - mean);
    CHECK(size.standard_uncertainty == Approx(1e-6 / (std::sqrt(squares) * 1e-3 / 60)).epsilon(1e-6));
  }
}

TEST_CASE("the estimated scenario holds the size where it belongs", "[stated][estimate]") {
  const scenario_fixture::Folder folder;
  const std::string file = made_up(folder, 1e-6);
  std::filesystem::rename(folder.path() + "/z.csv", folder.path() + "/other.csv");
  const auto s = scenario::read(file, known(), {folder.path() + "/other.csv"});
  const propagation::Experiment e(s);
  const auto found = calibration::estimate(e);
  REQUIRE(found.solver.converged);
  const std::string text = calibration::estimated_scenario(e, found, folder.path());
  const auto written = scenario::read(folder.write("w.toml", text), known()); // reads other.csv by itself
  const auto& q = written.quantities.back();
  CHECK(q.name == "lag.size");
  CHECK_FALSE(q.estimated);
  CHECK(q.entries[0].value == Approx(found.parameters.back().value).epsilon(1e-12));
  REQUIRE(q.entries[0].components.size() == 1);
  CHECK(std::sqrt(q.entries[0].components[0].distribution.variance()) ==
        Approx(found.parameters.back().standard_uncertainty).epsilon(1e-12));
  CHECK(written.correlations.size() == 1);
  CHECK(written.readings.size() == 8);
  CHECK_NOTHROW(propagation::Experiment(written));
}

TEST_CASE("weights of a joint evaluation know a size as the noise that it makes", "[stated][sphere_calibration]") {
  std::string text = read_text_file(GUMSHOE_SOURCE_DIR "/scenarios/sphere_calibration.toml", 1 << 20);
  text.replace(text.find("\"sequential\""), 12, "\"joint_weighted\"");
  const auto moved = [&](const std::string& more) {
    const Case c(text + more);
    const auto& e = c.experiment;
    std::vector<const double*> columns(e.plan().columns.size(), nullptr);
    const std::vector<double> shift(8, 4e-6);
    std::size_t q = 0;
    while (c.scenario.quantities[q].name != "E_XX") ++q;
    columns[e.plan().gather[3][q]] = shift.data();
    propagation::Workspace w;
    std::vector<double> out(e.outputs().size() * 8);
    std::vector<std::uint8_t> status(8);
    e.run_columns(columns, 8, w, out.data(), status.data());
    REQUIRE(status[0] == 0);
    std::vector<double> first;
    for (std::size_t o = 0; o < e.outputs().size(); ++o) first.push_back(out[o * 8]);
    return first;
  };
  // Half the draw, the other sign: a standard deviation of 10 um in every reading of X.
  const auto bare = moved(""),
             noise = moved(
                 "[indications.X]\ncomponents = [ { distribution = \"normal\", u = \"10 um\", per = \"reading\" } ]\n"),
             size = moved(
                 "[stated_effects.lag]\nindication = \"X\"\nformula = \"-1 / 2\"\nunit = \"um\"\nsize = { value = "
                 "\"0 um\", u = \"20 um\", per = \"reading\" }\n");
  double difference = 0;
  for (std::size_t o = 0; o < bare.size(); ++o) {
    CHECK(std::fabs(size[o] - noise[o]) < 1e-6 * std::fabs(noise[o]) + 1e-12);
    difference = std::max(difference, std::fabs(bare[o] - noise[o]) / std::fabs(noise[o]));
  }
  CHECK(difference > 0.01); // the weights do matter
}

TEST_CASE("a choice computes the formula anew for its settings", "[stated][choose]") {
  const std::string text =
      virtual_head + "[indications.spindle_z]\nrepeatability = { s = \"1 um\" }\n[conditions]\nfeed = \"4 mm/min\"\n" +
      stated(drawn) +
      "[choose]\nmeasurand = \"laser_z\"\ntarget = \"1 um\"\nvariables = { feed = [\"4 mm/min\", \"400 mm/min\"], "
      "readings = [1, 3] }\n"
      "time = { per_reading = \"travel / feed\", travel = \"1 mm\" }\n";
  const scenario_fixture::Folder folder;
  const auto s = scenario::read(folder.write("s.toml", text), known());
  std::vector<scenario::Setting> settings;
  for (const auto& v : s.choose->variables) settings.push_back({v.knob, v.values.back()});
  const auto set = choice::with(s, settings);
  REQUIRE(set.readings.size() == 3);
  REQUIRE(set.stated_effects[0].parts[0].loading.size() == 3);
  for (const double x : set.stated_effects[0].parts[0].loading) CHECK(x == Approx(-0.4 / 60).epsilon(1e-14));
  CHECK(s.stated_effects[0].parts[0].loading.size() == 1);
}

// ---- effects on a quantity of the model ----

TEST_CASE("a stated error of an axis angle is the catalogue's", "[stated][sphere_calibration]") {
  // An eccentric encoder of C: E_CC += a cos C, as an effect and as a dependence of the quantity E_CC.
  const std::string text = read_text_file(GUMSHOE_SOURCE_DIR "/scenarios/sphere_calibration.toml", 1 << 20);
  const std::string drawn_size = "{ value = \"5 arcsec\", u = \"2 arcsec\" }";
  const Case a(text + "\n[effects.c_encoder_eccentricity]\ncosine = " + drawn_size + "\n"),
      b(text + "\n[stated_effects.eccentric]\nquantity = \"E_CC\"\nformula = \"cos(C)\"\nunit = \"arcsec\"\nsize = " +
        drawn_size + "\n"),
      none(text);
  const auto outputs_of = [](const Case& c, const std::string& name) {
    const auto& e = c.experiment;
    std::size_t q = 0;
    while (q < c.scenario.quantities.size() && c.scenario.quantities[q].name != name) ++q;
    std::vector<const double*> columns(e.plan().columns.size(), nullptr);
    const std::vector<double> sizes{-2e-5, -1e-5, 0, 1e-6, 1e-5, 2e-5, 3e-5, 4e-5};
    if (q < c.scenario.quantities.size()) columns[e.plan().gather[0][q]] = sizes.data();
    propagation::Workspace w;
    std::vector<double> out(e.outputs().size() * 8);
    std::vector<std::uint8_t> status(8);
    e.run_columns(columns, 8, w, out.data(), status.data());
    for (const auto failed : status) REQUIRE(failed == 0);
    return out;
  };
  const auto x = outputs_of(a, "c_encoder_eccentricity.cosine"), y = outputs_of(b, "eccentric.size"),
             z = outputs_of(none, "");
  double moved = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(std::fabs(x[i] - y[i]) < 1e-9 * std::fabs(x[i]) + 1e-14);
    moved = std::max(moved, std::fabs(x[i] - z[i]));
  }
  CHECK(moved > 1e-6); // some parameter notices 4e-5 rad
}

TEST_CASE("a quantity that depends on a condition is the quantity with a value for each", "[stated]") {
  // rod_length grows by 2 um per 100 mm/min: by a formula, and by values of its own per set-up. Both readings are alike
  // in all else, so that a shared solve would be wrong.
  const std::string by_value = "[quantities]\nbeam_pitch = { value = \"0.2836 deg\", u = \"0.002 deg\" }\n"
                               "[quantities.rod_length.by.setup]\n1 = \"160.00008 mm\"\n2 = \"160.008 mm\"\n",
                    by_formula = "[quantities]\nbeam_pitch = { value = \"0.2836 deg\", u = \"0.002 deg\" }\n"
                                 "rod_length = \"160 mm\"\n[stated_effects.stretch]\nquantity = \"rod_length\"\n"
                                 "formula = \"feed\"\nunit = \"um/(mm/min)\"\nsize = \"0.02 um/(mm/min)\"\n";
  const std::vector<double> pitches{-6e-5, -2e-5, -1e-6, 0, 1e-6, 2e-5, 4e-5, 6e-5};
  for (const bool virtual_experiment : {false, true}) {
    const std::string head = virtual_experiment ? virtual_head + places : propagation_head + readings;
    const Case a(head + by_value), b(head + by_formula);
    const auto x = outputs(a.experiment, pitches), y = outputs(b.experiment, pitches);
    REQUIRE(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::fabs(x[i] - y[i]) < 2 * rounding);
  }
  const Case a(propagation_head + readings + by_value), b(propagation_head + readings + by_formula);
  for (std::size_t o = 0; o < a.experiment.outputs().size(); ++o) {
    const auto x = analysis::budget(a.experiment, o, 0.95), y = analysis::budget(b.experiment, o, 0.95);
    CHECK(std::fabs(x.estimate - y.estimate) < 2 * rounding);
    CHECK(y.combined_standard_uncertainty == Approx(x.combined_standard_uncertainty).epsilon(1e-9));
  }
}

TEST_CASE("derivatives by the size of an effect on a quantity", "[stated]") {
  const Case c(propagation_head + readings +
               "[quantities]\nrod_radius = { value = \"5 mm\", u = \"1 um\" }\n"
               "beam_pitch = \"0.2836 deg\"\n"
               "[stated_effects.worn]\nquantity = \"rod_radius\"\nformula = \"feed\"\nunit = \"ms\"\nsize = " +
               drawn + "\n");
  const auto point = c.experiment.point(1);
  const auto exact = analysis::differentiate(c.experiment, 1, 1, point, true);
  const auto differences = analysis::differences(c.experiment, 1, point, true)[1];
  const std::size_t size = point.size() - 1;
  std::size_t radius = 0;
  while (c.scenario.quantities[radius].name != "rod_radius") ++radius;
  CHECK(exact.value == differences.value);
  // The chain rule: 400 mm/min of feed at the second reading.
  CHECK(exact.first[size] == Approx(0.4 / 60 * exact.first[radius]).epsilon(1e-13));
  CHECK(differences.first[size] == Approx(exact.first[size]).epsilon(1e-5));
  CHECK(exact.first[radius] != 0);
}
