/// What a run says of its own readings and samples: differences between readings, and where samples failed.
#include "analysis/comparison.h"
#include "analysis/failures.h"
#include "unit/gum_models.h"
#include "unit/known_case.h"

using namespace gum_models;

namespace {

/// A run of a scenario, and its summaries.
struct Run {
  known_case::Case c;
  propagation::MemoryStore store;
  std::vector<analysis::Summary> summaries;

  explicit Run(const std::string& text) : c(text), store(c.experiment.outputs().size(), c.scenario.run.samples) {
    propagation::propagate(c.experiment, store, {});
    for (std::size_t o = 0; o < c.experiment.outputs().size(); ++o)
      summaries.push_back(analysis::summarise(c.experiment.outputs()[o], analysis::Column(store.values(o)), 0.95));
  }
};

} // namespace

TEST_CASE("readings that are compared share what they share", "[comparison]") {
  // y = a + scale: a with 30 um of its own in each reading, the scale with 40 um in all of them.
  const Run run(R"(schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + scale"
[quantities.scale]
value = "0 mm"
u = "40 um"
[indications.a]
rows = [
  { rod = "1", day = "1", values = ["1 mm"] }, { rod = "2", day = "1", values = ["1.2 mm"] },
  { rod = "1", day = "2", values = ["3 mm"] }, { rod = "2", day = "2", values = ["3.5 mm"] },
]
components = [ { distribution = "normal", u = "30 um", per = "reading" } ]
[[analysis.comparisons]]
measurand = "y"
between = "rod"
within = "day"
[run]
samples = 100_000
seed = 1
)");
  const auto rows = analysis::compare(run.c.experiment, analysis::view_of(run.store).values, run.summaries,
                                      std::vector<analysis::Budget>(run.summaries.size()), 1);
  REQUIRE(rows.size() == 2); // of one day each, never of two
  const double n = 1e5, u = std::hypot(30e-6, 30e-6), alone = std::hypot(50e-6, 50e-6),
               difference[] = {-0.2e-3, -0.5e-3};
  for (const std::size_t i : {0u, 1u}) {
    CHECK(rows[i].name == "y: 1 - 2, day " + std::to_string(i + 1));
    CHECK(rows[i].difference == Approx(difference[i]).margin(5 * u / std::sqrt(n)));
    CHECK(rows[i].standard_uncertainty == Approx(u).epsilon(four_se(n)));
    CHECK(rows[i].root_sum_square == Approx(alone).epsilon(2 * four_se(n)));
    // The end of the interval has the standard error sqrt(0.95 0.05 / n) / density(1.96 u) of both tails: below 0.5 %
    // of U.
    CHECK(rows[i].expanded_uncertainty == Approx(1.959964 * u).epsilon(0.02));
    CHECK(rows[i].normalised_error == Approx(rows[i].difference / rows[i].expanded_uncertainty));
  }
}

TEST_CASE("failed samples are counted by reason, with the inputs that have them", "[failures]") {
  // sqrt(x + 2) has no value for the 2.275 % of x below two standard deviations; z has nothing to do with it.
  const Run run(R"(schema = 1
[model]
name = "expression"
[model.measurands]
y = "sqrt(x + 2) + z"
[quantities.x]
value = 0
u = 1
[quantities.z]
value = 0
u = 1
[run]
samples = 20_000
seed = 3
)");
  const analysis::Failures failures = failures_of(run.c.experiment, analysis::view_of(run.store));
  const double expected = 20'000 * 0.02275;
  CHECK(std::fabs(static_cast<double>(failures.samples) - expected) < 4 * std::sqrt(expected));
  std::uint64_t first = 0, count = 0;
  for (std::size_t i = run.store.values(0).size(); i-- > 0;)
    if (std::isnan(run.store.values(0)[i])) first = i, ++count;
  CHECK(failures.samples == count);
  REQUIRE(failures.reasons.size() == 1);
  const std::string& reason = failures.reasons[0];
  INFO(reason);
  CHECK(reason.find(": " + std::to_string(count) + " samples, the first is sample " + std::to_string(first) + " ") !=
        std::string::npos);
  CHECK(reason.find("; x is -") != std::string::npos);
  CHECK(reason.find(" to -2.0") != std::string::npos); // up to the edge
  CHECK(reason.find("; z is") == std::string::npos);
  CHECK(reason.find("as in about 2.") != std::string::npos); // per cent of all samples
}

TEST_CASE("a run without failures names no reason", "[failures]") {
  const Run run(R"(schema = 1
model = { name = "expression", measurands = { y = "2 * x" } }
quantities = { x = { value = 0, u = 1 } }
run = { samples = 1000 }
)");
  CHECK(failures_of(run.c.experiment, analysis::view_of(run.store)).reasons.empty());
}
