/// The budgets of a scenario as it was and with what was found.
#include <cmath>

#include <catch2/catch.hpp>

#include "cli/command.h"
#include "cli/traced_budgets.h"
#include "unit/scenario_fixture.h"

using namespace gumshoe;

namespace {

const std::string rod = R"(schema = 1
[model]
name = "rod_gauging"
[conditions]
feed = "60 mm/min"
[quantities.beam_pitch]
value = "0.3 deg"
[quantities.rod_length]
value = "150 mm"
u = "1 um"
[indications.spindle_z]
readings = ["-360 mm", "-360.001 mm"]
components = [ { distribution = "normal", u = "0.4 um", per = "reading" } ]
)";

scenario::Scenario read(const std::string& text) {
  const scenario_fixture::Folder folder;
  return scenario::read(folder.write("s.toml", text), cli::catalogue());
}

} // namespace

TEST_CASE("what was found stands in the second budget only", "[tracing][budget]") {
  const auto before = read(rod),
             after = read(rod + "[effects.trigger_latency]\ndelay = { value = \"1.5 ms\", u = \"0.3 ms\" }\n");
  const auto found = cli::traced_budgets(before, after);
  REQUIRE(found.before.size() == found.after.size());
  bool seen = false;
  for (std::size_t k = 0; k < found.before.size(); ++k) {
    const auto &b = found.before[k], &a = found.after[k];
    CHECK(b.output.name == a.output.name);
    if (b.output.measurand != "laser_z") continue;
    seen = true;
    CHECK(a.contributions.size() == b.contributions.size() + 1);
    // 60 mm/min is 1 mm/s: 0.3 ms is 0.3 um, and 1.5 ms is 1.5 um that a downward approach reads too low.
    const double added = std::pow(a.combined_standard_uncertainty, 2) - std::pow(b.combined_standard_uncertainty, 2);
    CHECK(std::sqrt(added) * 1e6 == Approx(0.3).epsilon(1e-6));
    CHECK(a.estimate - b.estimate == Approx(1.5e-6).epsilon(1e-6));
  }
  CHECK(seen);
  auto virtual_one = after;
  virtual_one.method = scenario::Method::virtual_experiment;
  CHECK(cli::traced_budgets(before, virtual_one).before.empty());
}
