/// Models without derivatives, with wishes and with failures: differences against closed forms and against the exact
/// derivatives of the rod; blocks before a failure.
#include <catch2/catch.hpp>

#include <atomic>
#include <cmath>
#include <map>

#include "analysis/derivatives.h"
#include "analysis/gum.h"
#include "base/error.h"
#include "models/made_card.h"
#include "propagation/propagate.h"

using namespace gumshoe;
using quantities::Family;

namespace {

/// Two quantities, two measurands: a cubic, whose differences have no error but rounding, and |a - 1|.
struct Cubic {
  Cubic()
      : card([] {
          models::CardTexts texts;
          texts.name = "cubic";
          texts.quantities = {{"a", "1", "1", ""}, {"b", "1", "1", ""}, {"c", "1", "1", ""}};
          texts.measurands = {{"y", "1", "1", ""}, {"z", "1", "1", ""}};
          return texts;
        }()) {
    static constexpr models::Kernels kernels{nullptr, &evaluate};
    model.card = &card.card();
    model.kernels = [] { return &kernels; };
    model.check = [](const models::PointCall<double>&) { return std::string(); };
    model.solve_reads = [](std::size_t) { return true; };
    model.context = this;
  }
  static void evaluate(const models::BlockCall& call) {
    const auto& self = *static_cast<const Cubic*>(call.context);
    ++self.calls;
    if (call.first_sample != models::unnumbered && call.first_sample + call.samples > self.fails_at)
      throw InputError("the model is away");
    for (std::size_t i = 0; i < call.samples; ++i) {
      const auto x = [&](std::size_t q) { return call.quantities[q].data[i * call.quantities[q].stride]; };
      const double a = x(0), b = x(1);
      call.measurands[0][i] = 2 + 3 * a + a * a * b + b * b * b - a * b + x(2);
      call.measurands[1][i] = std::fabs(a - 1);
    }
  }
  models::MadeCard card;
  models::Model model{};
  mutable std::atomic<int> calls{0};
  std::uint64_t fails_at = models::unnumbered;
};

struct Case {
  std::shared_ptr<Cubic> cubic = std::make_shared<Cubic>();
  scenario::Scenario s;
  Case() {
    s.model = "cubic";
    s.evaluation = "full";
    s.made = models::MadeModel(cubic, &cubic->model);
    const double values[] = {1, 2, 5}, u[] = {0.1, 0.3, 0};
    for (std::size_t q = 0; q < 3; ++q) {
      const std::string name(cubic->card.card().quantities[q].name);
      s.quantities.push_back({name, "1", "1", {{{}, values[q], {}, ""}}});
      quantities::Component c;
      c.name = "c1";
      c.distribution = {Family::normal, {0, u[q]}, nullptr, nullptr};
      if (u[q] > 0) s.quantities.back().entries[0].components = {c};
    }
    s.readings.push_back({{}, {}, {}, 1});
    s.run.samples = 50'001;
  }
};

struct Memory : propagation::Sink {
  std::vector<double> y;
  std::uint64_t next = 0;
  void write(const propagation::ResultBlock& b) override {
    REQUIRE(b.first_sample == next);
    next += b.samples;
    y.insert(y.end(), b.outputs.begin(), b.outputs.begin() + static_cast<long>(b.samples));
  }
};

} // namespace

TEST_CASE("differences of a cubic are its derivatives, from one call of the model", "[differences]") {
  const Case c;
  const propagation::Experiment e(c.s);
  const double a = 1, b = 2;
  const auto d = analysis::differentiate(e, 0, 0, e.point(0), true);
  CHECK(c.cubic->calls == 1);
  CHECK_FALSE(d.exact);
  CHECK(d.status == Status::ok);
  CHECK(d.value == 2 + 3 * a + a * a * b + b * b * b - a * b + 5);
  // Rounding: values of 20 have errors of 4e-15; divided by h = 0.06, h^2, h^3 and by the smaller half step.
  CHECK(d.first[0] == Approx(3 + 2 * a * b - b).margin(1e-12));
  CHECK(d.first[1] == Approx(a * a + 3 * b * b - a).margin(1e-12));
  CHECK(std::isnan(d.first[2])); // exact here: nobody asks
  CHECK(d.second[0] == Approx(2 * b).margin(3e-11));
  CHECK(d.second[4] == Approx(6 * b).margin(3e-11));
  CHECK(d.second[1] == Approx(2 * a - 1).margin(3e-11));
  CHECK(d.second[1] == d.second[3]);
  CHECK(d.third[0] == Approx(0).margin(2e-9));
  CHECK(d.third[4] == Approx(6).margin(2e-9));
  CHECK(d.third[1] == Approx(0).margin(2e-9)); // d^3 y / da db^2
  CHECK(d.third[3] == Approx(2).margin(2e-9)); // d^3 y / db da^2
}

TEST_CASE("second-order terms by differences: few calls of the model", "[differences]") {
  const Case c;
  const propagation::Experiment e(c.s);
  const auto budget = analysis::budget(e, 0, 0.95);
  CHECK(c.cubic->calls <= 2);
  const double ua2 = 0.01, ub2 = 0.09, ca = 5, cb = 12, haa = 4, hbb = 12, hab = 1;
  CHECK(budget.combined_standard_uncertainty == Approx(std::sqrt(ca * ca * ua2 + cb * cb * ub2)).epsilon(1e-12));
  CHECK(budget.second_order_bias == Approx(0.5 * (haa * ua2 + hbb * ub2)).epsilon(1e-9));
  // JCGM 100 5.1.2 note with y_aab = 2, y_bbb = 6, the other third derivatives 0.
  const double extra =
      0.5 * haa * haa * ua2 * ua2 + (0.5 * hbb * hbb + cb * 6) * ub2 * ub2 + (hab * hab + cb * 2) * ua2 * ub2;
  CHECK(budget.second_order_uncertainty == Approx(std::sqrt(ca * ca * ua2 + cb * cb * ub2 + extra)).epsilon(1e-9));
}

TEST_CASE("differences find a kink at the estimate and none near it", "[differences]") {
  Case c;
  {
    const propagation::Experiment e(c.s);
    const auto d = analysis::differentiate(e, 0, 1, e.point(0), false);
    CHECK_FALSE(d.differentiable[0]);
    CHECK(std::isnan(d.first[0]));
    CHECK(d.differentiable[1]);
    CHECK(d.first[1] == 0);
    CHECK_FALSE(analysis::budget(e, 1, 0.95).applicable);
  }
  c.s.quantities[0].entries[0].value = 1.3;
  const propagation::Experiment e(c.s);
  const auto d = analysis::differentiate(e, 0, 1, e.point(0), false);
  CHECK(d.differentiable[0]);
  CHECK(d.first[0] == Approx(1).margin(1e-13));
}

TEST_CASE("differences of the rod agree with its exact derivatives", "[differences]") {
  const double um = 1e-6, deg = 3.14159265358979323846 / 180;
  const models::Model& rod = *models::find("rod_gauging");
  scenario::Scenario s;
  s.model = "rod_gauging";
  s.evaluation = "full";
  const std::map<std::string, std::pair<double, double>> known{{"rod_radius", {5e-3, um}},
                                                               {"fillet_radius", {3e-5, 5 * um}},
                                                               {"bottom_elevation", {88.041 * deg, 0.002 * deg}},
                                                               {"rod_length", {0.179822, um}},
                                                               {"beam_yaw", {0.6 * deg, 0}},
                                                               {"bottom_azimuth", {144 * deg, 0.05 * deg}},
                                                               {"beam_pitch", {0.28 * deg, 0.005 * deg}},
                                                               {"trigger_fraction", {0.5, 0.02}}};
  for (const auto& q : rod.card->quantities) {
    const auto it = known.find(std::string(q.name));
    const auto [value, u] = it == known.end() ? std::pair(q.default_value, 0.0) : it->second;
    s.quantities.push_back({std::string(q.name), std::string(q.unit), std::string(q.si_unit), {{{}, value, {}, ""}}});
    quantities::Component c;
    c.name = "c1";
    c.distribution = {Family::normal, {0, u}, nullptr, nullptr};
    if (u > 0) s.quantities.back().entries[0].components = {c};
  }
  s.quantities.push_back({"spindle_z", "mm", "m", {{{}, 0.0, {}, ""}}});
  s.readings.push_back({{}, {4e-3 / 60, 0, -1}, {-0.33}, 1});
  const propagation::Experiment exact(s);
  auto without = std::make_shared<models::Model>(rod);
  without->evaluate_gradient = nullptr;
  without->evaluate_curvature = nullptr;
  s.made = without;
  const propagation::Experiment by_differences(s);
  const auto x = exact.point(0);
  const auto truth = analysis::differentiate(exact, 0, 1, x, true),
             d = analysis::differentiate(by_differences, 0, 1, x, true);
  REQUIRE(truth.exact);
  REQUIRE_FALSE(d.exact);
  // In the output's unit, per standard uncertainty: values of 0.5 m round to 6e-17 m, the solve to a few 1e-16 m;
  // truncation is of the fourth order in u and far below a thousandth of the contribution.
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto& components = s.quantities[i].entries[0].components;
    if (components.empty()) continue;
    const double u = components[0].distribution.parameters[1];
    CHECK(d.first[i] * u == Approx(truth.first[i] * u).epsilon(1e-5).margin(1e-14));
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (s.quantities[j].entries[0].components.empty()) continue;
      const double v = s.quantities[j].entries[0].components[0].distribution.parameters[1];
      CHECK(d.second[i * x.size() + j] * u * v ==
            Approx(truth.second[i * x.size() + j] * u * v).epsilon(1e-2).margin(1e-13));
    }
  }
}

TEST_CASE("numbers do not depend on the block that a model wants", "[propagation]") {
  std::vector<double> first;
  // What it likes in a call, and samples of a block: four calls of few samples, in multiples of 64.
  const std::pair<std::size_t, std::size_t> blocks[] = {
      {0, 2048}, {1, 64}, {100, 384}, {600, 2048}, {2048, 2048}, {10'000, 8192}, {1'000'000, 999'424}};
  for (const auto& [block, samples] : blocks) {
    Case c;
    c.cubic->model.block = block;
    const propagation::Experiment e(c.s);
    c.cubic->calls = 0;
    Memory m;
    propagation::RunSettings settings;
    settings.threads = 2;
    REQUIRE(propagation::propagate(e, m, settings) == 50'001);
    CHECK(static_cast<std::size_t>(c.cubic->calls) == (50'001 + samples - 1) / samples);
    if (first.empty()) first = m.y;
    CHECK(m.y == first);
  }
}

TEST_CASE("every block before the one that fails is handed over, then the failure goes on", "[propagation]") {
  const Case whole;
  Memory all;
  propagation::propagate(propagation::Experiment(whole.s), all, {});
  for (const int threads : {1, 2, 7})
    for (const std::uint64_t fails_at : {0, 2048, 20'000, 50'000}) {
      Case c;
      c.cubic->fails_at = fails_at;
      const propagation::Experiment e(c.s);
      Memory m;
      propagation::RunSettings settings;
      settings.threads = threads;
      REQUIRE_THROWS_AS(propagation::propagate(e, m, settings), InputError);
      CHECK(m.next == fails_at / 2048 * 2048); // the failing block and none before it
      c.cubic->fails_at = models::unnumbered;
      settings.first = m.next;
      REQUIRE(propagation::propagate(e, m, settings) == 50'001);
      CHECK(m.y == all.y);
    }
}
