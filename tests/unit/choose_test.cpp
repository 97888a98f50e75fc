/// The choice of settings against closed forms.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "choice/choose.h"
#include "choice/figures.h"
#include "choice/setup.h"
#include "scenario_fixture.h"

using namespace gumshoe;

namespace {

constexpr double k95 = 1.959964, um = 1e-6, s_delay = 1e-3, s_noise = 2 * um;
using Definition = scenario::Choose::Definition;

/// z = length + feed delay + noise: u^2 = (feed u_delay)^2 + u_noise^2 / n, and n (way / feed + 0.5 s) + 5 s.
std::string text(const std::string& choose) {
  return R"(schema = 1
[model]
name = "expression"
method = "virtual_experiment"
[model.measurands]
length = "z"
[model.indications]
z = "length + feed * delay + noise"
[conditions]
feed = "10 mm/min"
[quantities]
length = "100 mm"
delay = { value = "6 ms", u = "1 ms" }
noise = { value = "0 um", u = "2 um", per = "reading" }
[choose.time]
per_reading = "way / feed + retract"
once = "start"
way = "5 mm"
retract = "0.5 s"
start = "5 s"
)" + choose;
}

scenario::Scenario read(const std::string& choose) {
  const scenario_fixture::Folder folder;
  return scenario::read(folder.write("s.toml", text(choose)), {});
}

const std::string ranges = R"(
[choose.variables]
feed = { low = "10 mm/min", high = "1000 mm/min", steps = 5, scale = "log" }
readings = [1, 2, 3, 4, 6]
)";

/// Values at the middle of n parts of equal probability: a sample without chance.
template <class Quantile> std::vector<double> even(std::size_t n, const Quantile& quantile) {
  std::vector<double> x;
  // Distant parts next to each other, so that either half of the sample is also even.
  for (std::size_t i = 0; i < n; ++i) x.push_back(quantile((static_cast<double>(i) + 0.5) / static_cast<double>(n)));
  return x;
}

} // namespace

TEST_CASE("the optimum of a closed form", "[choose]") {
  const auto s = read("[choose]\ntarget = \"3 um\"\nsamples = 20000\nconfirm_samples = 400000\n" + ranges);
  const auto r = choice::choose(s, {});
  const auto& best = r.candidates[r.best];
  const double u = 3 * um / k95;
  double least = INFINITY, feed = 0;
  int readings = 0;
  for (const int n : {1, 2, 3, 4, 6}) {
    const double rest = u * u - s_noise * s_noise / n;
    if (rest <= 0) continue;
    const double f = std::sqrt(rest) / s_delay, time = 5 + n * (5e-3 / f + 0.5);
    if (time < least) least = time, feed = f, readings = n;
  }
  REQUIRE(readings == 3); // 21.4 s; next is n = 2 with 23.1 s
  INFO(r.statement);
  CHECK(r.reached);
  CHECK(r.confirmed);
  CHECK(best.values[1] == readings);
  // Relative standard error of U: that of a normal's 95 % interval from half the sample, 0.30 % at 1e5 and as
  // 1/sqrt(n). d ln f = d ln U u^2 / (f u_delay)^2 = 2.3 d ln U. Two steps of the grid, because the first try may be
  // refused.
  const double step = std::pow(100.0, 1.0 / 128), search = 4 * 2.3 * 0.0067, fresh = 2 * 2.3 * 0.0015;
  CHECK(best.values[0] < feed * (1 + fresh));
  CHECK(best.values[0] > feed / (1 + search) / step / step);
  CHECK(best.time == Approx(5 + 3 * (5e-3 / best.values[0] + 0.5)).epsilon(1e-12));
  CHECK(r.fresh.time == best.time);
  CHECK(choice::asked(r.fresh, false).expanded ==
        Approx(k95 * std::hypot(best.values[0] * s_delay, s_noise / std::sqrt(3.0))).epsilon(4 * 0.0015));
  // What limits it: the noise of each of the readings has a ninth of its variance in that of the mean.
  const double variance = std::pow(best.values[0] * s_delay, 2) + s_noise * s_noise / 3;
  REQUIRE(r.sensitivity.indices.size() == 4);
  for (const auto& index : r.sensitivity.indices) {
    const double exact =
        index.input == "delay" ? std::pow(best.values[0] * s_delay, 2) / variance : s_noise * s_noise / 9 / variance;
    INFO(index.input);
    CHECK(index.total == Approx(exact).margin(2 * (index.total_high - index.total)));
  }
  // The mean error is the delay's way, and the correction takes it off.
  CHECK(r.fresh.average.mean == Approx(6e-3 * best.values[0]).margin(4 * r.fresh.average.mean_se));
}

TEST_CASE("the Pareto front is not beaten, and everything off it is", "[choose]") {
  const auto r = choice::choose(read("[choose]\ntarget = \"3 um\"\nsamples = 1000\n" + ranges), {});
  for (const auto& c : r.candidates) {
    const auto beats = [&](const choice::Candidate& o) {
      return o.time <= c.time && o.average.expanded <= c.average.expanded &&
             (o.time < c.time || o.average.expanded < c.average.expanded);
    };
    CHECK(c.pareto == std::ranges::none_of(r.candidates, beats));
  }
}

TEST_CASE("both definitions of U against closed forms", "[choose]") {
  constexpr std::size_t n = 40'000;
  const double spacing = 60.0 / n; // of the values at the ends of the halves' intervals, and the ranks' rounding
  const auto exponential = even(n, [](double p) { return 1 - std::log(1 - p); }); // 1 + an exponential of mean 1
  const auto corrected = choice::average_figures(exponential, 0.95, Definition::corrected);
  CHECK(corrected.mean == Approx(2).margin(spacing));
  // +-U about the mean covers 95 %: all below it, so that U = -ln 0.05 - 1. Half of the shortest interval, [0, -ln 0.05],
  // is 1.498, about which 92 % lie.
  CHECK(corrected.expanded == Approx(-std::log(0.05) - 1).margin(spacing));
  CHECK(corrected.left == 0);
  const auto plain = choice::average_figures(exponential, 0.95, Definition::uncorrected);
  CHECK(plain.expanded == Approx(1 - std::log(0.05)).margin(spacing)); // all are positive
  CHECK(plain.left == plain.mean);

  // In a case the average's correction stays: |x - 0.5| of a rectangular x from 0 to 2 has its 95 % quantile at 1.4.
  const auto rectangular = even(n, [](double p) { return 2 * p; });
  const auto one = choice::case_figures(rectangular, 0.95, 0.5);
  CHECK(one.left == Approx(0.5).margin(spacing));
  CHECK(one.expanded == Approx(1.4).margin(spacing));
}

TEST_CASE("the correction's own uncertainty is in U", "[choose]") {
  // Of 64 equally likely values, 62 lie within 30.5 spacings about the mean.
  const auto few = even(64, [](double p) { return 64 * p; });
  const auto f = choice::average_figures(few, 0.95, Definition::corrected);
  CHECK(std::floor(0.95 * 64 + 0.5) == 61); // JCGM 101, 7.7.2: from rank 0 to rank 61
  CHECK(f.expanded == Approx(30.5 * std::sqrt(1 + 1.0 / 64)).epsilon(1e-12));
}

TEST_CASE("common random numbers make differences of U certain", "[choose]") {
  const auto s = read("[choose]\ntarget = \"3 um\"\n" + ranges);
  const auto& knob = s.choose->variables[0].knob;
  const auto expanded = [&](double feed, std::uint64_t seed) {
    auto seeded = s;
    seeded.run.seed = seed;
    const choice::Setup setup(seeded, {{knob, feed}});
    return choice::average_figures(choice::errors({&setup}, 2000, quantities::Purpose::sampling, 1)[0][0], 0.95,
                                   Definition::uncorrected)
        .expanded;
  };
  double common = 0, independent = 0, both = 0;
  constexpr int n = 40;
  for (int i = 0; i < n; ++i) {
    const double a = expanded(1e-3, 2 * i), b = expanded(1.1e-3, 2 * i), c = expanded(1.1e-3, 2 * i + 1);
    common += (b - a) / n, independent += (c - a) / n;
  }
  double variance_common = 0, variance_independent = 0;
  for (int i = 0; i < n; ++i) {
    const double a = expanded(1e-3, 2 * i), b = expanded(1.1e-3, 2 * i), c = expanded(1.1e-3, 2 * i + 1);
    variance_common += std::pow(b - a - common, 2), variance_independent += std::pow(c - a - independent, 2);
    both += b - a;
  }
  // Correlation of the two U is that of the errors' signs and sizes, above 0.9 here: the ratio is far below 1; F(39,
  // 39) exceeds 3 by chance with a probability below 0.001.
  CHECK(variance_common < variance_independent / 3);
}

TEST_CASE("fresh numbers decide, and their probability is calibrated", "[choose]") {
  // U is exactly the target: the stated probability must be uniform over seeds, so that "95 %" errs in 5 %.
  const double feed = 1e-3, exact = k95 * std::hypot(feed * s_delay, s_noise);
  const auto s = read("[choose]\ntarget = \"3 um\"\n" + ranges);
  constexpr int n = 300;
  int sure = 0, likely = 0, refused = 0;
  for (int i = 0; i < n; ++i) {
    auto seeded = s;
    seeded.run.seed = static_cast<std::uint64_t>(i);
    const choice::Setup setup(seeded, {{s.choose->variables[0].knob, feed}});
    const auto f = choice::average_figures(choice::errors({&setup}, 2000, quantities::Purpose::fresh, 1)[0][0], 0.95,
                                           Definition::corrected);
    const double p = choice::probability_below(f.expanded, f.expanded_se, exact);
    sure += p > 0.95, likely += p > 0.5, refused += p < 0.05;
  }
  // Binomial, four standard deviations; 0.02 for the rank, which lies between two values.
  const auto chance = [](double share) { return 4 * std::sqrt(share * (1 - share) / n); };
  CHECK(sure / double(n) < 0.05 + chance(0.05));
  CHECK(std::fabs(likely / double(n) - 0.5) < 0.02 + chance(0.5));
  CHECK(refused / double(n) < 0.05 + chance(0.05));

  const auto r = choice::choose(read("[choose]\ntarget = \"3 um\"\nsamples = 1000\n" + ranges), {});
  CHECK(r.fresh.average.mean != r.candidates[r.best].average.mean);
  CHECK(r.fresh.average.valid == r.asked.confirm_samples);
}

TEST_CASE("cases: the truth changes, the evaluation and the correction do not", "[choose]") {
  // feed 1 mm/s turns a delay of 9 ms into 9 um; on average 6 um are expected and subtracted: 3 um remain.
  const auto s = read(R"(
[[choose.cases]]
name = "late"
values = { delay = "9 ms" }
[[choose.cases]]
name = "in time"
values = { delay = "6 ms" }
[choose]
target = "8 um"
target_of = "worst_case"
[choose.variables]
feed = ["60 mm/min"]
)");
  const auto r = choice::choose(s, {});
  REQUIRE(r.fresh.cases.size() == 2);
  const auto &late = r.fresh.cases[0], &in_time = r.fresh.cases[1];
  CHECK(r.fresh.worst == 0);
  CHECK(late.left == Approx(3 * um).margin(4 * std::hypot(late.mean_se, r.fresh.average.mean_se)));
  CHECK(in_time.left == Approx(0).margin(4 * std::hypot(in_time.mean_se, r.fresh.average.mean_se)));
  CHECK(late.standard_deviation == Approx(s_noise).epsilon(0.02));
  // P(|N(3, 2)| < q) = 0.95 at q = 6.290: 1.645 standard deviations above 3 but for the far tail.
  CHECK(late.expanded == Approx(6.2903 * um).margin(4 * late.expanded_se));
  CHECK(in_time.expanded == Approx(k95 * s_noise).margin(4 * in_time.expanded_se));
  CHECK(r.reached);
  auto strict = s;
  strict.choose->bias = 2 * um; // smaller than what is left
  CHECK_FALSE(choice::choose(strict, {}).reached);
}

TEST_CASE("a target that none meets", "[choose]") {
  const auto r = choice::choose(read("[choose]\ntarget = \"1 um\"\nsamples = 2000\n" + ranges), {});
  CHECK_FALSE(r.reached);
  CHECK(r.statement.starts_with("No candidate meets the target"));
  CHECK(r.candidates[r.best].values[1] == 6);
  for (const auto& c : r.candidates) CHECK(c.average.expanded >= r.candidates[r.best].average.expanded);
  CHECK(r.probability < 1e-6);
  CHECK(r.sensitivity.indices.size() == 7);
}

TEST_CASE("the same bits for one and two threads", "[choose]") {
  const auto s = read("[choose]\ntarget = \"3 um\"\nsamples = 3000\n" + ranges);
  const auto a = choice::choose(s, {1, {}}), b = choice::choose(s, {2, {}});
  REQUIRE(a.candidates.size() == b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    CHECK(a.candidates[i].values == b.candidates[i].values);
    CHECK(a.candidates[i].average.expanded == b.candidates[i].average.expanded);
    CHECK(a.candidates[i].average.mean == b.candidates[i].average.mean);
  }
  CHECK(a.best == b.best);
  CHECK(a.fresh.average.expanded == b.fresh.average.expanded);
  CHECK(a.probability == b.probability);
  for (std::size_t i = 0; i < a.sensitivity.indices.size(); ++i)
    CHECK(a.sensitivity.indices[i].total == b.sensitivity.indices[i].total);
}
