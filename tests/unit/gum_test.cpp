/// The GUM framework and Sobol' indices on the rod, against hand calculation and against each other.
#include <catch2/catch.hpp>

#include <map>

#include <fmt/format.h>

#include "analysis/analyse.h"
#include "analysis/derivatives.h"
#include "analysis/gum.h"
#include "analysis/scale_points.h"
#include "analysis/sobol.h"
#include "analysis/summary.h"
#include "analysis/validation.h"
#include "base/error.h"
#include "effects/effect.h"
#include "gum_models.h"
#include "propagation/propagate.h"
#include "unit/estimate_case.h"
#include "unit/known_case.h"

using namespace gumshoe;
using gum_models::Memory;
using quantities::Family;

namespace {

constexpr double deg = 3.14159265358979323846 / 180, um = 1e-6;

/// Rod 2 on the beam of Table 2.5; uncertain is what `uncertain` says.
scenario::Scenario rod2(const std::map<std::string, std::vector<quantities::Component>>& uncertain,
                        const std::map<std::string, double>& values = {}) {
  scenario::Scenario s;
  s.model = "rod_gauging";
  s.evaluation = "full";
  const std::map<std::string, double> rod{{"rod_radius", 5e-3},
                                          {"fillet_radius", 3e-5},
                                          {"bottom_elevation", 88.041 * deg},
                                          {"bottom_azimuth", 144.086 * deg},
                                          {"rod_length", 0.179822},
                                          {"beam_yaw", 0.6241 * deg},
                                          {"beam_pitch", 0.2836 * deg}};
  for (const auto& q : models::find("rod_gauging")->card->quantities) {
    const std::string name(q.name);
    double value = rod.count(name) ? rod.at(name) : q.default_value;
    if (values.count(name)) value = values.at(name);
    s.quantities.push_back({name, std::string(q.unit), std::string(q.si_unit), {{{}, value, {}, ""}}});
    if (uncertain.count(name)) s.quantities.back().entries[0].components = uncertain.at(name);
  }
  s.quantities.push_back({"spindle_z", "mm", "m", {{{}, 0.0, {}, ""}}});
  if (uncertain.count("spindle_z")) s.quantities.back().entries[0].components = uncertain.at("spindle_z");
  s.readings.push_back({{}, {4e-3 / 60, 0, -1}, {-0.329932}, 3});
  s.run.samples = 200'000;
  return s;
}

quantities::Component component(Family family, std::array<double, 4> p, double dof = HUGE_VAL, const char* name = "c1") {
  quantities::Component c;
  c.name = name;
  c.distribution = {family, p, nullptr, nullptr};
  c.degrees_of_freedom = dof;
  c.evaluation = std::isfinite(dof) ? 'A' : 'B';
  return c;
}

} // namespace

TEST_CASE("terms of second order: of 100 inputs that vary, not of 101, which the budget says", "[gum]") {
  for (const int n : {100, 101}) {
    std::string products = "x0^2", inputs = "x0 = { value = \"1\", u = \"0.1\" }\n";
    for (int i = 1; i < n; ++i) {
      products += fmt::format(" + x{}^2", i);
      inputs += fmt::format("x{} = {{ value = \"1\", u = \"0.1\" }}\n", i);
    }
    const estimate_case::Case sum("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"" + products +
                                  "\"\n[quantities]\n" + inputs + "[run]\nsamples = 100\n");
    const auto budget = gum_models::analysed(sum.scenario).budgets[0];
    CHECK(budget.combined_standard_uncertainty == Approx(0.2 * std::sqrt(n)).epsilon(1e-12));
    if (n == 100) {
      CHECK(budget.second_order_bias == Approx(0.01 * n).epsilon(1e-12));
      CHECK(budget.second_order_uncertainty == Approx(std::sqrt((0.04 + 0.0002) * n)).epsilon(1e-9)); // H = 2
      CHECK(budget.remark.empty());
    } else {
      CHECK(std::isnan(budget.second_order_bias));
      CHECK(std::isnan(budget.second_order_uncertainty));
      CHECK(budget.remark == "no terms of second order: more than 100 inputs vary");
    }
  }
}

TEST_CASE("terms of second order take each input's own moments: a square is known exactly", "[gum]") {
  // Var x^2 from the raw moments: of a rectangular law in +-0.6 about 0, of an exponential one of mean 1, of both; of a
  // t as of a normal law with its u, as the law of propagation takes it.
  const auto of = [](const std::string& x) {
    const estimate_case::Case square("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"x^2\"\n" +
                                     x + "[run]\nsamples = 100\n");
    return gum_models::analysed(square.scenario).budgets[0].second_order_uncertainty;
  };
  CHECK(of("[quantities.x]\nvalue = \"0\"\nhalf_width = \"0.6\"\ndistribution = \"rectangular\"\n") ==
        Approx(0.36 * std::sqrt(4.0 / 45)).epsilon(1e-9));
  CHECK(of("[quantities.x]\ndistribution = \"exponential\"\nmean = \"1\"\n") == Approx(std::sqrt(20)).epsilon(1e-9));
  CHECK(of("[quantities.x]\nvalue = \"0\"\nu = \"0.2\"\ndegrees_of_freedom = 3\n") ==
        Approx(0.04 * std::sqrt(2)).epsilon(1e-9));
  // Two components: cumulants add.
  CHECK(
      of("[quantities.x]\nvalue = \"0\"\ncomponents = [ { distribution = \"rectangular\", half_width = \"0.6\" }, "
         "{ u = \"0.2\" } ]\n") ==
      Approx(std::sqrt(std::pow(0.6, 4) / 5 + 6 * 0.12 * 0.04 + 3 * 0.0016 - std::pow(0.12 + 0.04, 2))).epsilon(1e-9));
}

TEST_CASE("terms of second order that exceed the variance are not stated", "[gum]") {
  const estimate_case::Case steep("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"sin(x)\"\n"
                                  "[quantities.x]\nvalue = \"0\"\nu = \"2\"\n[run]\nsamples = 100\n");
  const auto budget = gum_models::analysed(steep.scenario).budgets[0]; // u^2 - u^4 < 0
  CHECK(std::isnan(budget.second_order_uncertainty));
  CHECK(budget.remark.find("exceed the variance") != std::string::npos);
}

TEST_CASE("budget of laser_z: lengths enter with slope one, pitch with the rod's lever", "[gum]") {
  const auto s = rod2({{"rod_length", {component(Family::normal, {0, 1 * um})}},
                       {"spindle_z", {component(Family::rectangular, {-0.5 * um, 0.5 * um})}},
                       {"beam_pitch", {component(Family::normal, {0, 0.01 * deg})}}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  REQUIRE(b.applicable);
  REQUIRE(b.contributions.size() == 3);
  double sum = 0;
  for (const auto& c : b.contributions) {
    if (c.quantity == "rod_length") CHECK(c.sensitivity == -1);
    if (c.quantity == "spindle_z") CHECK(c.contribution == Approx(0.5 * um / std::sqrt(3.0)).epsilon(1e-12));
    // 0.01 deg = 0.87 um at 4.97 mm/rad; laser_z = ... - bottom_height, whose slope is -4.97 for rod 2.
    if (c.quantity == "beam_pitch") CHECK(c.sensitivity == Approx(4.97e-3).epsilon(2e-3));
    sum += c.share;
  }
  CHECK(sum + b.correlation_share == Approx(1).epsilon(1e-12));
  CHECK(b.combined_standard_uncertainty ==
        Approx(std::hypot(1 * um, 0.5 * um / std::sqrt(3.0), 4.97e-3 * 0.01 * deg)).epsilon(2e-3));
  CHECK(std::isinf(b.effective_degrees_of_freedom));
  CHECK(b.coverage_factor == Approx(1.959964));
}

TEST_CASE("effective degrees of freedom are truncated, and k is from t", "[gum]") {
  const auto s = rod2({{"rod_length", {component(Family::normal, {0, 3 * um})}},
                       {"spindle_z", {component(Family::t, {0, 4 * um, 5}, 5)}}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  // Welch-Satterthwaite: 25^2 / (16^2 / 5) = 12.207 -> 12; k = t_0.975(12) = 2.1788.
  CHECK(b.combined_standard_uncertainty == Approx(5 * um).epsilon(1e-12));
  CHECK(b.effective_degrees_of_freedom == 12);
  CHECK(b.coverage_factor == Approx(2.17881).epsilon(1e-5));
}

TEST_CASE("fully correlated inputs that cancel leave no variance, and no degrees of freedom to ask for", "[gum]") {
  // z - L with r = 1 and equal u, by a copula: what is left of the variance is rounding, of either sign.
  for (const double u : {0.1 * um, 0.7 * um, 3 * um}) {
    auto s = rod2({{"rod_length", {component(Family::t, {0, u, 9}, 9)}}, {"spindle_z", {component(Family::t, {0, u, 9}, 9)}}});
    s.correlations.push_back({quantities::Correlation::Kind::copula, {"rod_length", "spindle_z"}, {1, 1, 1, 1}});
    const propagation::Experiment e(s);
    const auto b = analysis::budget(e, 1, 0.95);
    CHECK(b.combined_standard_uncertainty <= 1e-6 * u);
    CHECK(std::isinf(b.effective_degrees_of_freedom));
    CHECK(b.expanded_uncertainty <= 2e-6 * u);
  }
}

TEST_CASE("correlated inputs: one correlation row, and no Welch-Satterthwaite", "[gum]") {
  auto s = rod2({{"rod_length", {component(Family::normal, {0, 3 * um})}},
                 {"spindle_z", {component(Family::normal, {0, 4 * um}, 9)}}});
  s.correlations.push_back({quantities::Correlation::Kind::pearson, {"rod_length", "spindle_z"}, {1, 0.5, 0.5, 1}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  // laser_z = z - L: variance 9 + 16 - 2 * 0.5 * 12 = 13 um^2.
  CHECK(b.combined_standard_uncertainty == Approx(std::sqrt(13.0) * um).epsilon(1e-9));
  CHECK(b.correlation_share == Approx(-12.0 / 13).epsilon(1e-9));
  CHECK(std::isnan(b.effective_degrees_of_freedom));
  CHECK_THROWS_AS(analysis::sobol_indices(e, 1024, 1), InputError);
  Memory memory(2);
  propagation::propagate(e, memory, {});
  const auto summary = analysis::summarise(e.outputs()[1], memory.rows[1], 0.95);
  CHECK(summary.standard_uncertainty == Approx(std::sqrt(13.0) * um).epsilon(4 * std::sqrt(0.5 / 2e5)));
}

TEST_CASE("the law of propagation takes Pearson's coefficient, not the copula's", "[gum]") {
  // Two equal rectangular lengths, r = 0.5, in a difference: u_c^2 = u^2 (1 + 1 - 2 * 0.5) = u^2. With the copula's
  // coefficient, 2 sin(pi / 12) = 0.5176, u_c would be 1.8 % smaller.
  const double u = 2 * um / std::sqrt(3.0);
  const quantities::Distribution d{Family::rectangular, {-2 * um, 2 * um}, nullptr, nullptr};
  auto s =
      rod2({{"rod_length", {component(d.family, d.parameters)}}, {"spindle_z", {component(d.family, d.parameters)}}});
  s.correlations.push_back({quantities::Correlation::Kind::pearson, {"rod_length", "spindle_z"}, {1, 0.5, 0.5, 1}});
  const propagation::Experiment e(s);
  CHECK(analysis::budget(e, 1, 0.95).combined_standard_uncertainty == Approx(u).epsilon(1e-9));
  Memory memory(2);
  propagation::propagate(e, memory, {});
  CHECK(analysis::summarise(e.outputs()[1], memory.rows[1], 0.95).standard_uncertainty ==
        Approx(u).epsilon(4 * std::sqrt(0.5 / 2e5)));
}

TEST_CASE("a kink by an exact quantity leaves the first-order budget, not the second", "[gum]") {
  const auto s = rod2({{"rod_length", {component(Family::normal, {0, 1 * um})}}},
                      {{"bottom_elevation", 90 * deg}, {"beam_pitch", 0}, {"beam_yaw", 0}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  CHECK(b.applicable);
  CHECK(b.combined_standard_uncertainty == Approx(1 * um).epsilon(1e-6));
  CHECK(std::isnan(b.second_order_uncertainty));
}

TEST_CASE("an aligned square rod: the framework does not apply, and says by what", "[gum]") {
  const auto s = rod2({{"beam_pitch", {component(Family::normal, {0, 0.01 * deg})}},
                       {"rod_length", {component(Family::normal, {0, 1 * um})}}},
                      {{"bottom_elevation", 90 * deg}, {"beam_pitch", 0}, {"beam_yaw", 0}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  CHECK_FALSE(b.applicable);
  CHECK(b.reason == "there is no derivative at the estimate with respect to beam_pitch");
  Memory memory(2);
  propagation::propagate(e, memory, {});
  const auto summary = analysis::summarise(e.outputs()[0], memory.rows[0], 0.95);
  CHECK(analysis::validate(b, summary, 0.95, 2).verdict == "not applicable");
  // 5 mm times |pitch|, pitch ~ N(0, 0.01 deg): bias 4.97 mm E|pitch| = 0.70 um.
  const double exact = 4.97e-3 * 0.01 * deg * std::sqrt(2 / 3.14159265358979);
  CHECK(exact == Approx(0.69 * um).epsilon(0.01));
  CHECK(summary.estimate == Approx(exact).epsilon(0.01));
}

TEST_CASE("a kink of one measurand leaves the budgets of the others", "[gum]") {
  // Differences over a fixed step do not resolve 10 kHz added to 473 THz, nor 5 Pa added to 210 GPa.
  const known_case::Case c(
      "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\nf = \"f0 + df\"\np = \"E + dp\"\n"
      "sag = { formula = \"L * tilt^2 / 2\", unit = \"um\" }\ncube = \"x^3\"\ng = \"abs(df)\"\nh = \"abs(x) + df / "
      "f0\"\n"
      "[quantities]\nf0 = { value = \"473.6127 THz\" }\ndf = { value = \"0 Hz\", u = \"10 kHz\" }\nE = { value = \"210 "
      "GPa\" }\n"
      "dp = { value = \"0 Pa\", u = \"5 Pa\" }\nL = { value = \"1 m\" }\ntilt = { value = \"0 mrad\", u = \"1 mrad\" "
      "}\n"
      "x = { value = 0, u = 1 }\n");
  const auto budget = [&](std::size_t output) { return analysis::budget(c.experiment, output, 0.95); };
  CHECK(budget(0).combined_standard_uncertainty == Approx(1e4).epsilon(1e-12));
  CHECK(budget(1).combined_standard_uncertainty == Approx(5).epsilon(1e-12));
  CHECK(budget(2).applicable);
  CHECK(budget(2).combined_standard_uncertainty == 0);
  CHECK(budget(2).second_order_bias == Approx(0.5e-6).epsilon(1e-9)); // u^2 / 2
  CHECK(budget(3).combined_standard_uncertainty == 0);
  CHECK(budget(3).second_order_uncertainty == 0); // its third derivative has no term to this order
  CHECK_FALSE(budget(4).applicable);
  CHECK(budget(4).reason == "there is no derivative at the estimate with respect to df");
  CHECK(budget(5).reason == "there is no derivative at the estimate with respect to x");
}

TEST_CASE("second-order terms: mean and u agree with Monte Carlo where curvature matters", "[gum]") {
  // Pitch so uncertain that the height's curvature shows; the fraction too.
  const auto s = rod2({{"trigger_fraction", {component(Family::normal, {0, 0.12})}}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 0, 0.95);
  Memory memory(2);
  propagation::propagate(e, memory, {});
  const auto summary = analysis::summarise(e.outputs()[0], memory.rows[0], 0.95);
  const double first_error = std::fabs(b.combined_standard_uncertainty - summary.standard_uncertainty);
  const double second_error = std::fabs(b.second_order_uncertainty - summary.standard_uncertainty);
  CHECK(first_error > 8 * summary.standard_uncertainty_se);
  CHECK(second_error < 0.4 * first_error);
}

TEST_CASE("Sobol' indices of a nearly linear budget are its GUM shares", "[sobol]") {
  const auto s = rod2({{"rod_length", {component(Family::normal, {0, 1 * um})}},
                       {"beam_pitch", {component(Family::normal, {0, 0.02 * deg})}},
                       {"fillet_radius", {component(Family::rectangular, {-5 * um, 5 * um})}},
                       {"spindle_z", {component(Family::rectangular, {-1 * um, 1 * um})}}});
  const propagation::Experiment e(s);
  const auto b = analysis::budget(e, 1, 0.95);
  const auto sobol = analysis::sobol_indices(e, 16384, 2);
  REQUIRE(sobol[1].indices.size() == b.contributions.size());
  double sum = 0;
  for (std::size_t i = 0; i < b.contributions.size(); ++i) {
    const auto& index = sobol[1].indices[i];
    INFO(index.input);
    const double slack = index.first_high - index.first_low;
    CHECK(std::fabs(index.first - b.contributions[i].share) < slack + 1e-4);
    CHECK(std::fabs(index.total - b.contributions[i].share) < index.total_high - index.total_low + 1e-4);
    CHECK(slack < 0.05);
    sum += index.first;
  }
  CHECK(sum == Approx(1).margin(0.03));
}

TEST_CASE("bits do not depend on threads; the first samples of a long run are the short run", "[propagation]") {
  auto s = rod2({{"beam_pitch", {component(Family::normal, {0, 0.02 * deg})}},
                 {"fillet_radius", {component(Family::t, {0, 1 * um, 4}, 4)}}});
  s.run.samples = 10'007;
  const propagation::Experiment e(s);
  Memory one(2), two(2), seven(2);
  propagation::RunSettings settings;
  settings.threads = 1;
  propagation::propagate(e, one, settings);
  settings.threads = 2;
  propagation::propagate(e, two, settings);
  settings.threads = 7;
  propagation::propagate(e, seven, settings);
  REQUIRE(one.rows[0].size() == 10'007);
  CHECK(one.rows == two.rows);
  CHECK(one.rows == seven.rows);
  auto shorter = s;
  shorter.run.samples = 3'001;
  const propagation::Experiment f(shorter);
  Memory head(2);
  propagation::propagate(f, head, settings);
  CHECK(std::equal(head.rows[1].begin(), head.rows[1].end(), one.rows[1].begin()));
  // One sample alone, as replay does it: the same bits.
  const auto variates = propagation::variates_of(e, 9'999);
  std::vector<std::vector<double>> drawn;
  std::vector<const double*> pointers;
  for (const double v : variates) drawn.emplace_back(8, v);
  for (const auto& row : drawn) pointers.push_back(row.data());
  propagation::Workspace workspace;
  std::vector<double> outputs(2 * 8);
  std::vector<std::uint8_t> status(8);
  e.run(pointers, 8, workspace, outputs.data(), status.data());
  CHECK(outputs[0] == one.rows[0][9'999]);
  CHECK(outputs[8] == one.rows[1][9'999]);
  CHECK(outputs[0] != one.rows[0][9'998]);
}

TEST_CASE("a virtual experiment of a perfect evaluation shows only what was drawn", "[propagation]") {
  auto s = rod2({{"rod_length", {component(Family::normal, {0, 2 * um})}}});
  s.method = scenario::Method::virtual_experiment;
  const propagation::Experiment e(s);
  Memory memory(2);
  propagation::propagate(e, memory, {});
  const auto error = analysis::summarise(e.outputs()[1], memory.rows[1], 0.95);
  // The rod is longer than stated by d: the evaluation puts the beam too high by d.
  CHECK(error.standard_uncertainty == Approx(2 * um).epsilon(4 * std::sqrt(0.5 / 2e5)));
  CHECK(std::fabs(error.estimate) < 4 * error.estimate_se);
  s.evaluation = "conventional";
  const propagation::Experiment conventional(s);
  Memory biased(2);
  propagation::propagate(conventional, biased, {});
  // Ignoring the geometry of rod 2 puts the beam 0.1119 mm too high.
  CHECK(analysis::summarise(e.outputs()[1], biased.rows[1], 0.95).estimate == Approx(0.111943e-3).epsilon(1e-3));
}

TEST_CASE("too few trials give no interval, and no verdict on a linear normal model", "[gum]") {
  auto s = rod2({{"rod_length", {component(Family::normal, {0, 3 * um})}},
                 {"spindle_z", {component(Family::normal, {0, 4 * um})}}});
  for (const std::uint64_t samples : {2, 8, 20, 100, 1000, 2000, 5000, 20'000})
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      s.run.samples = samples;
      s.run.seed = seed;
      const propagation::Experiment e(s);
      Memory memory(2);
      propagation::propagate(e, memory, {});
      const auto summary = analysis::summarise(e.outputs()[1], memory.rows[1], 0.95);
      const auto v = analysis::validate(analysis::budget(e, 1, 0.95), summary, 0.95, 2);
      INFO(samples << " trials: " << v.verdict << ", " << v.reason);
      // 1 / (1 - p) = 20 trials are the least of which an interval leaves one out.
      CHECK(std::isnan(summary.symmetric.low) == (samples < 20));
      CHECK(v.verdict == "undecided");
      CHECK_THAT(v.reason, Catch::Contains(samples < 2000 ? "too few to compare" : "trials are needed"));
    }
}

TEST_CASE("the law accounts for the variance where u_c squared is that of the samples", "[gum]") {
  analysis::Budget b;
  b.combined_standard_uncertainty = 5 * um;
  b.contributions.resize(2);
  b.contributions[0].share = b.contributions[1].share = 0.5;
  b.contributions[1].degrees_of_freedom = HUGE_VAL;
  analysis::Summary s;
  const auto accounts = [&](double u, double se = 0) {
    s.standard_uncertainty = u, s.standard_uncertainty_se = se;
    return analysis::accounts_for_variance(b, s);
  };
  CHECK(accounts(5.05 * um));
  CHECK_FALSE(accounts(7.5 * um));
  CHECK_FALSE(accounts(4.5 * um));
  CHECK(accounts(7.5 * um, 1.5 * um)); // few trials
  CHECK_FALSE(accounts(7.5 * um, std::nan("")));
  CHECK(accounts(std::nan(""))); // nothing to compare with
  // A t with 5 degrees of freedom has 5/3 of the variance that its scale has: 25 (1 + 0.5 2/3) = 33.3.
  b.contributions[0].distribution = "t", b.contributions[0].degrees_of_freedom = 5;
  CHECK(accounts(std::sqrt(100.0 / 3) * um));
  CHECK_FALSE(accounts(5 * um));
  b.combined_standard_uncertainty = 0;
  CHECK_FALSE(accounts(1 * um));
}

TEST_CASE("a sum and a difference of temperatures in degC are noted, a mean is not", "[gum]") {
  const auto notes = [](const std::string& formula, const std::string& unit) {
    const known_case::Case c("schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\nt = { formula = \"" + formula +
                             "\", unit = \"" + unit +
                             "\" }\n[quantities.a]\nvalue = \"20 degC\"\nu = \"1 degC\"\n[quantities.b]\nvalue = \"1 "
                             "degC\"\n[quantities.d]\nvalue = \"1 K\"\n");
    return analysis::scale_point_notes(c.experiment);
  };
  CHECK(notes("(a + b) / 2", "degC").empty());
  CHECK(notes("a + d", "degC").empty());
  CHECK(notes("a - b", "K").empty());
  CHECK(notes("a", "K").empty());
  CHECK(notes("1.4 * a", "K").empty());
  REQUIRE(notes("a + b", "K").size() == 1);
  CHECK_THAT(notes("a + b", "K")[0], Catch::Contains("2 inputs with a zero of their own, such as degC, are added"));
  REQUIRE(notes("a + b", "degC").size() == 1);
  CHECK_THAT(notes("a + b", "degC")[0], Catch::Contains("add up to 2, not to 1"));
  CHECK_THAT(notes("a - b", "degC")[0], Catch::Contains("state a difference of temperatures in K"));
}
