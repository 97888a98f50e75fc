/// Sizes with which a mill's readings jump: the best of those tried and of others between them, and how often they
/// count.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "tracing/criteria.h"
#include "tracing/fit/jumping_unknowns.h"
#include "tracing/fit/starts.h"
#include "tracing/trace.h"
#include "unit/tracing_case.h"

using namespace tracing_case;

namespace {

constexpr int readings = 24;
constexpr double step = 1.5e-7; // m

/// Four inserts of different heights; a tooth feeds 0.2 um to 2.2 um.
/// @param wear_3  as it is declared
std::string mill(double u, const std::string& wear_3 = "{ value = \"0.1 um\", u = \"0.02 um\" }") {
  std::string rows;
  for (int i = 0; i < readings; ++i)
    rows +=
        fmt::format("{{ start_angle = \"{} deg\", feed = \"{} mm/min\", spindle_speed = \"{} rpm\", time = \"{} s\", "
                    "values = [\"-990 mm\"] }},\n",
                    (i * 137) % 360,
                    (i % 3 == 0   ? 4
                     : i % 3 == 1 ? 20
                                  : 40),
                    (i % 2 == 0 ? 4500 : 8000), 100 * i);
  return "schema = 1\nmodel = { name = \"tool_length\", method = \"propagation\" }\n"
         "[conditions]\nstart_height = \"2 mm\"\n"
         "[quantities]\ntool_length = { estimated = true, value = \"176.6 mm\" }\nlaser_z = \"-1172.015 mm\"\n"
         "inserts = 4\ninsert_radius = \"5 mm\"\ninsert_thickness = \"3.2 mm\"\n"
         "wear_2 = \"0.4 um\"\nwear_3 = " +
         wear_3 + "\nwear_4 = \"0.3 um\"\n" + "[indications.spindle_z]\nrows = [\n" + rows +
         fmt::format("]\ncomponents = [ {{ distribution = \"normal\", u = \"{} m\", per = \"reading\" }} ]\n", u);
}

/// Sizes of both signs, a step apart.
gumshoe::tracing::Matrix sizes() {
  gumshoe::tracing::Matrix out(1, 64);
  for (Index k = 0; k < 64; ++k) out(0, k) = step * static_cast<double>(k < 32 ? k - 32 : k - 31);
  return out;
}

Vector noise(double u, std::uint64_t seed) { return u * gumshoe::tracing::normals(readings, 1, seed, 9).col(0); }

Start best(Case& c) {
  const JointFit base = c.fitter->fit({}, 1);
  REQUIRE(base.valid);
  const auto out = c.fitter->best_start(base, c.term(base, "declared:wear_3").candidate, sizes(), step);
  REQUIRE(out);
  return *out;
}

/// p-value of one signature that explains as much (2 ln L), of a constant and noise of unknown size.
double by_chance(double ratio) {
  if (ratio <= 0) return 1;
  const double freedom = readings - 1, t = std::sqrt((freedom - 1) * std::expm1(ratio / freedom));
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(freedom - 1), t));
}

} // namespace

TEST_CASE("a narrow best size is found between those of a coarse grid", "[tracing]") {
  // Two readings, off by 1 without a size; the second is right only within 0.01 of 0.53, the first within 0.3.
  const auto left = [](const gumshoe::tracing::Matrix& at) {
    gumshoe::tracing::Matrix out(2, at.cols());
    for (Index k = 0; k < at.cols(); ++k) {
      out(0, k) = std::fabs(at(0, k) - 0.53) < 0.3 ? 0.1 : 1;
      out(1, k) = std::fabs(at(0, k) - 0.53) < 0.01 ? 0.1 : 1;
    }
    return out;
  };
  constexpr double grid = 0.1;
  gumshoe::tracing::Matrix coarse(1, 20);
  for (Index k = 0; k < 20; ++k) coarse(0, k) = grid * static_cast<double>(k < 10 ? k - 10 : k - 9);
  gumshoe::tracing::Starts starts(Vector::Ones(2), 1, 10);
  starts.add(coarse, left(coarse), std::vector<bool>(20, true));
  CHECK(starts.best()->ratio == Approx(10 * std::log(2 / 1.01))); // none of the grid is right for both
  const auto between = starts.between_best(grid, 0);
  starts.add(between, left(between), std::vector<bool>(static_cast<std::size_t>(between.cols()), true));
  CHECK(std::fabs(starts.best()->sizes[0] - 0.53) < 0.01);
  CHECK(starts.best()->ratio == Approx(10 * std::log(2 / 0.02)));
}

TEST_CASE("sizes count as often as their signature turns, and without a value not at all", "[tracing]") {
  gumshoe::tracing::Matrix at(1, 3), straight(2, 3), turning(2, 3);
  at << 1, 2, 3;
  straight << 0.9, 0.8, 0.7, 1, 1, 1; // one signature, three times as large
  turning << 0.9, 1, 0.9, 1, 0.9, 1;  // one reading, the other, again the one
  const std::vector<bool> valid(3, true);
  gumshoe::tracing::Starts once(Vector::Ones(2), 1, 10), each(Vector::Ones(2), 1, 10), none(Vector::Ones(2), 1, 10);
  once.add(at, straight, valid);
  each.add(at, turning, valid);
  none.add(at, straight, std::vector<bool>(3, false));
  CHECK(once.best()->tries == Approx(1).margin(1e-6));
  CHECK(each.best()->tries == 2);
  CHECK_FALSE(none.best());
}

TEST_CASE("a height between those tried explains readings that jump", "[tracing]") {
  constexpr double u = 1e-7;
  Case c(mill(u));
  for (const double off : {-0.63e-6, -0.5e-6, -0.8e-6}) {
    Points at = c.simulator->estimates();
    for (auto& reading : at) reading[c.quantity("wear_3")] += off;
    c.measure(at, noise(u, 1));
    const Start start = best(c);
    CAPTURE(off, start.sizes[0], start.ratio, start.tries);
    CHECK(std::fabs(start.sizes[0] - off) < step); // readings say no more than which teeth trigger
    // What is left is the noise: 2 ln L of all squares over those of the noise, but for what chance gives the noise.
    const JointFit base = c.fitter->fit({}, 1);
    const double squares = base.residual.squaredNorm() / (u * u), freedom = readings - 1;
    CHECK(start.ratio > 0.5 * freedom * std::log(squares / freedom));
  }
}

TEST_CASE("an estimated size with which readings jump is found from afar, and no other is said to jump", "[tracing]") {
  constexpr double u = 1e-7;
  Case c(mill(u, "{ estimated = true, value = \"0.1 um\" }"));
  for (const double off : {-0.63e-6, -0.5e-6, -0.8e-6}) {
    Points at = c.simulator->estimates();
    for (auto& reading : at) reading[c.quantity("wear_3")] += off;
    c.measure(at, noise(u, 2));
    const auto found = with_jumping_found(c.scenario, *c.experiment, *c.simulator, c.observations, *c.fitter, 1);
    REQUIRE(found);
    CAPTURE(off);
    REQUIRE(found->trace.jumping.size() == 1); // not tool_length
    CHECK(found->trace.jumping[0].first == "wear_3");
    CHECK(std::fabs(found->trace.jumping[0].second + off) < 2 * step);
    Case from(*found);
    CHECK(std::fabs(from.scenario.quantities[from.quantity("wear_3")].entries[0].value - 0.1e-6 - off) < step);
    const JointFit fit = from.fitter->fit({}, 1);
    CHECK(fit.converged);
    CHECK(fit.residual.squaredNorm() / (u * u) < boost::math::quantile(boost::math::chi_squared(readings - 2), 0.999));
    // Named, they are not sought again.
    CHECK_FALSE(
        with_jumping_found(from.scenario, *from.experiment, *from.simulator, from.observations, *from.fitter, 1));
  }
}

TEST_CASE("an estimated size that an earlier trace of these readings found is not sought again", "[tracing]") {
  constexpr double u = 1e-7;
  const std::string wear = "{ estimated = true, value = \"0.1 um\" }";
  const auto sought = [&](const std::string& of_trace) {
    Case c(mill(u, wear) + of_trace);
    Points at = c.simulator->estimates();
    for (auto& reading : at) reading[c.quantity("wear_3")] -= 0.63e-6;
    c.measure(at, noise(u, 2));
    return with_jumping_found(c.scenario, *c.experiment, *c.simulator, c.observations, *c.fitter, 1).has_value();
  };
  CHECK(sought("[trace]\nalpha = 0.05\n"));
  CHECK_FALSE(sought("[trace]\nfree = [ \"wear_3\" ]\n"));
  CHECK_FALSE(sought("[trace.priors]\nwear_3 = " + wear + "\n"));
}

TEST_CASE("a trace states an estimated size with which readings jump, and no other", "[tracing]") {
  constexpr double u = 1e-7, off = -0.63e-6;
  Case c(mill(u, "{ estimated = true, value = \"0.1 um\" }") + "[trace]\ndraws = 99\n");
  Points at = c.simulator->estimates();
  for (auto& reading : at) reading[c.quantity("wear_3")] += off;
  c.measure(at, noise(u, 2));
  const auto found = gumshoe::tracing::trace(c.scenario, {.threads = 1});
  std::vector<std::string> stated;
  for (const std::string& text : found.statements)
    if (text.starts_with("estimated where readings jump with it")) stated.push_back(text);
  REQUIRE(stated.size() == 1); // not tool_length
  CAPTURE(stated[0]);
  const std::string start = "estimated where readings jump with it: wear_3 = ";
  REQUIRE(stated[0].starts_with(start));
  CHECK(std::fabs(std::stod(stated[0].substr(start.size())) * 1e-3 - (0.1e-6 + off)) < step); // in mm
}

TEST_CASE("readings that were not fitted may jump where sizes as likely as the best say so", "[tracing]") {
  constexpr double u = 2e-8, jump = 1e-7; // m; far beyond the noise
  constexpr Index draws = 200;
  Case c(mill(u));
  int jumped = 0, foreseen = 0;
  double expected = 0;
  for (int set = 0; set < 12; ++set) {
    Points at = c.simulator->estimates();
    for (auto& reading : at) reading[c.quantity("wear_3")] -= 0.4e-6 + 0.05e-6 * set;
    const Vector e = noise(u, static_cast<std::uint64_t>(set + 1));
    c.measure(at, e);
    std::vector<Index> fitted, others;
    for (Index r = 0; r < readings; ++r) (r % 3 == set % 3 ? others : fitted).push_back(r);
    const Fitter some(*c.experiment, *c.simulator, c.observations, fitted, 1);
    const JointFit base = some.fit({}, 1);
    Term term = c.term(base, "declared:wear_3");
    const auto start = some.best_start(base, term.candidate, sizes(), step);
    REQUIRE(start);
    term.candidate.start.assign(start->sizes.begin(), start->sizes.end());
    term.size = start->sizes;
    const JointFit fit = some.fit({term}, 1);
    REQUIRE(fit.valid);
    const gumshoe::tracing::Matrix changes = some.across_jumps(fit, draws);
    CHECK(some.across_jumps(base, draws).isZero(0));
    REQUIRE(changes.cols() == draws);
    for (const Index r : others) {
      const double error = fit.residual[r] - e[r]; // of the prediction, without the reading's own noise
      expected += static_cast<double>((changes.row(r).array().abs() > jump).count()) / draws;
      if (std::fabs(error) < jump) continue;
      ++jumped;
      foreseen += ((changes.row(r).array() - error).abs() < jump).any();
    }
  }
  CAPTURE(jumped, foreseen, expected);
  CHECK(jumped >= 5); // of 96: else nothing is tested
  CHECK(foreseen >= 0.9 * jumped);
  CHECK(std::fabs(jumped - expected) < 3 * std::sqrt(expected) + 1); // several readings of a set jump together
}

/// Sets of noise alone in which the best start passes at 0.05, and the mean number of tries for which it counts.
struct OfNoise {
  int passed = 0;
  double tries = 0;
};

/// @param best  ratio and tries of the best start of the case's readings
OfNoise of_noise(double u, int sets, std::uint64_t seed, const std::function<std::pair<double, double>(Case&)>& best) {
  Case c(mill(u));
  OfNoise out;
  for (int set = 1; set <= sets; ++set) {
    c.measure(c.simulator->estimates(), noise(u, seed + static_cast<std::uint64_t>(set)));
    const auto [ratio, tries] = best(c);
    out.tries += tries / sets;
    out.passed += by_chance(ratio) * tries < 0.05;
  }
  return out;
}

TEST_CASE("sizes that are tried count so often that noise passes for one no more often than it may", "[tracing]") {
  constexpr double u = 1e-6; // no size shows above it
  const OfNoise one = of_noise(u, 60, 100, [](Case& c) {
    const Start start = best(c);
    return std::pair{start.ratio, start.tries};
  });
  CHECK(one.passed <= 6); // of 0.05 * 60; 7 were each to count once
  CHECK(one.tries > 8);   // a tooth of each reading at least changes on the way
  CHECK(one.tries <= 64 + 256);
}

TEST_CASE("of pairs of sizes, too, noise passes for one no more often than it may", "[tracing]") {
  constexpr double u = 2e-6; // as large as the largest jump: a run-out takes many forms
  const OfNoise pair = of_noise(u, 40, 300, [](Case& c) {
    const JointFit base = c.fitter->fit({}, 1);
    const auto candidates = physical_candidates(
        *c.experiment, *c.simulator, base.at, c.observations, criteria.secant_step * u,
        [](const Candidate& a) { return a.name != "tool_runout"; },
        [&](const Candidate& a, const gumshoe::tracing::Matrix& at, double apart) {
          return c.fitter->best_start(base, a, at, apart);
        });
    const auto start = std::ranges::find_if(candidates, [](const Candidate& a) { return !a.start.empty(); });
    REQUIRE(start != candidates.end());
    return std::pair{start->exact_ratio, start->searched};
  });
  CHECK(pair.passed <= 5); // of 0.05 * 40; 23 were each to count once
  CHECK(pair.tries > 50);
  CHECK(pair.tries < 0.6 * (12 * 32 + 256)); // of all that were tried: neighbours are much alike
}
