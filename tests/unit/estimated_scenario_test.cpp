/// The scenario that an estimate writes.
#include <catch2/catch.hpp>

#include <cmath>

#include "calibration/estimated_scenario.h"
#include "places.h"
#include "unit/estimate_case.h"

using namespace estimate_case;
using known_case::known;

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
    CHECK(q.entries[0].components.at(0).distribution.standard_uncertainty() ==
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
