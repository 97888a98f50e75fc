/// What was read enters the evaluation at its place, each indication of each reading with noise of its own.
#include "unit/gum_models.h"
#include "unit/known_case.h"

using namespace gum_models;

TEST_CASE("each indication has its own value and noise, in every reading", "[propagation]") {
  // The factor 10 shows indications that are interchanged; one that is left out is missing from estimate and u.
  const known_case::Case c(R"(schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + 10 * b"
[indications.a]
rows = [{ place = "1", values = ["1 mm"] }, { place = "2", values = ["2 mm"] }]
components = [ { distribution = "normal", u = "30 um", per = "reading" } ]
[indications.b]
rows = [{ place = "1", values = ["3 mm"] }, { place = "2", values = ["5 mm"] }]
components = [ { distribution = "normal", u = "4 um", per = "reading" } ]
[run]
samples = 100_000
seed = 1
)");
  REQUIRE(c.experiment.outputs().size() == 2);
  Memory memory(2);
  propagation::propagate(c.experiment, memory, {});
  const double samples = 1e5, u = 50e-6, value[] = {31e-3, 52e-3}; // sqrt(30^2 + (10 x 4)^2) um
  for (const std::size_t o : {0u, 1u}) {
    const auto m = analysis::moments(memory.rows[o]);
    CHECK(std::fabs(m.mean - value[o]) < 4 * u / std::sqrt(samples));
    CHECK(std::sqrt(m.variance) == Approx(u).epsilon(four_se(samples)));
  }
  double product = 0;
  for (std::size_t i = 0; i < memory.rows[0].size(); ++i)
    product += (memory.rows[0][i] - value[0]) / u * (memory.rows[1][i] - value[1]) / u / samples;
  CHECK(std::fabs(product) < 4 / std::sqrt(samples)); // readings are independent
}
