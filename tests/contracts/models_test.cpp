/// What every model promises, swept over the catalogue and over the models that a scenario describes: a new row is
/// tested by being one. Random points lie around the model's example.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "contracts/examples.h"
#include "propagation/memory_store.h"
#include "propagation/propagate.h"

using namespace gumshoe;
using namespace gumshoe::contracts;

namespace {

constexpr std::size_t points = 64;

std::vector<Point> random_points(const Subject& s, const Example& e, Draw& draw, bool with_effects = false) {
  std::vector<Point> out;
  for (std::size_t n = 0; n < points; ++n)
    out.push_back(s.random(s.at_null(e.readings[n % e.readings.size()]), draw, with_effects));
  return out;
}

void check_variable(const VariableCard& v, std::set<std::string>& names) {
  INFO(v.name);
  CHECK(names.emplace(v.name).second);
  CHECK_FALSE(v.meaning.empty());
  CHECK(is_unit_of_si(v.unit, v.si_unit));
}

} // namespace

TEST_CASE("a model's card is complete: names, units, defaults, meanings", "[contracts][models]") {
  for (const models::Model* model : models::catalogue()) {
    const ModelCard& card = *model->card;
    INFO(card.name);
    CHECK_FALSE(card.title.empty());
    CHECK_FALSE(card.summary.empty());
    CHECK_FALSE(card.source.empty());
    CHECK_FALSE(card.indications.empty());
    CHECK_FALSE(card.evaluations.empty());
    std::set<std::string> inputs, outputs, evaluations;
    for (const QuantityCard& q : card.quantities) {
      check_variable({q.name, q.unit, q.si_unit, q.default_value, q.meaning}, inputs);
      INFO(q.name);
      CHECK(q.limits.contain(q.default_value));
    }
    for (const auto* list : {&card.conditions, &card.indications})
      for (const VariableCard& v : *list) check_variable(v, inputs);
    for (const VariableCard& v : card.measurands) check_variable(v, outputs);
    for (const EvaluationCard& e : card.evaluations) {
      INFO(e.name);
      CHECK(evaluations.emplace(e.name).second);
      CHECK_FALSE(e.meaning.empty());
      CHECK_FALSE(e.equations.empty());
      for (const EquationCard& equation : e.equations) CHECK(equation.text.find(" = ") != std::string_view::npos);
      std::set<std::string> own;
      for (const VariableCard& v : e.measurands) check_variable(v, own);
    }
  }
}

TEST_CASE("every model's example runs, and no sample fails", "[contracts][models]") {
  for (Example& e : examples()) {
    INFO(e.name);
    e.scenario->run.samples = 100;
    const propagation::Experiment experiment(*e.scenario);
    propagation::MemoryStore store(experiment.outputs().size(), 100);
    REQUIRE(propagation::propagate(experiment, store, {}) == 100);
    for (const std::uint8_t status : store.read_status(0, 100)) CHECK(status == 0);
    REQUIRE_FALSE(experiment.outputs().empty());
    for (std::size_t o = 0; o < experiment.outputs().size(); ++o) {
      const auto values = store.read(o, 0, 100);
      for (const double v : values) CHECK(std::isfinite(v));
    }
  }
}

TEST_CASE("evaluation undoes simulation, and does not read the true value", "[contracts][laws][models]") {
  // Simulation adds up what evaluation takes away, so they differ by roundings alone: 64 of every contribution. An
  // evaluation that forgets a term, or has its sign wrong, is off by far more than a millionth of what the spreads of the
  // quantities make of the measurand; the tolerance is less than that.
  for (const Example& e : examples())
    for (const bool with_effects : {false, true}) {
      INFO(e.name << (with_effects ? ", all effects" : ""));
      const Subject s(e.model(), with_effects ? effects_on(e.model()) : std::vector<const EffectCard*>{});
      if (!s.simulates() || !e.model().evaluate_gradient) continue;
      Draw draw(1400);
      std::size_t compared = 0;
      for (const Point& p : random_points(s, e, draw, with_effects)) {
        const auto there = s.read(p);
        if (!there) continue;
        const Outcome truth = s.simulate({p})[0], back = s.evaluate({*there})[0];
        REQUIRE(back.ok());
        const Derived by = s.evaluate_gradient(*there);
        const auto rounding = s.rounding(by, *there);
        const std::size_t k = e.model().card->indications.size();
        for (std::size_t m = 0; m < back.values.size(); ++m) {
          CAPTURE(e.model().card->measurands[m].name);
          CHECK(std::fabs(back.values[m] - truth.values[k + m]) <= rounding[m]);
          double largest = 0;
          for (std::size_t i = 0; i < s.size(); ++i)
            largest = std::max(largest, std::fabs(by.derivatives[m][i]) * s.spread(i, *there));
          // An error of an axis that the machine of this evaluation does not have is always 0.
          CHECK((rounding[m] < 1e-6 * largest || (largest == 0 && back.values[m] == 0)));
        }
        ++compared;
        // A quantity with a measurand's name is its true value: only simulation reads it.
        for (const VariableCard& m : e.model().card->measurands)
          for (std::size_t i = 0; i < s.first_effect(); ++i) {
            if (s.name(i) != m.name) continue;
            Point other = *there;
            other.x[i] += s.spread(i, other);
            CHECK(s.evaluate({other})[0] == back);
          }
      }
      CHECK(compared > points / 2);
    }
}

TEST_CASE("a sample does not depend on its neighbours, and a point has its value", "[contracts][laws][models]") {
  // Neighbours: to the bit. A point call that differentiates through a root corrects it by one Newton step in dual
  // numbers, whose value may differ by a few roundings; a copy of the physics that differs in a term does so by far
  // more.
  for (const Example& e : examples()) {
    INFO(e.name);
    const Subject s(e.model(), effects_on(e.model()));
    Draw draw(1401);
    std::vector<Point> all;
    for (const Point& p : random_points(s, e, draw, true))
      if (const auto there = s.read(p); there && all.size() < 24) all.push_back(*there);
    REQUIRE(all.size() >= 12);
    const auto together = s.evaluate(all);
    for (std::size_t i = 0; i < all.size(); i += 5) CHECK(s.evaluate({all[i]})[0] == together[i]);
    if (s.simulates()) {
      const auto simulated = s.simulate(all);
      for (std::size_t i = 0; i < all.size(); i += 5) CHECK(s.simulate({all[i]})[0] == simulated[i]);
      for (std::size_t i = 0; i < all.size() && e.model().simulate_gradient; ++i) {
        const Derived at = s.simulate_gradient(all[i]);
        const auto rounding = s.rounding(at, all[i]);
        for (std::size_t k = 0; k < at.values.size(); ++k)
          CHECK(std::fabs(at.values[k] - simulated[i].values[k]) <= rounding[k] / 16);
      }
    }
    for (std::size_t i = 0; i < all.size() && e.model().evaluate_gradient; ++i) {
      const Derived at = s.evaluate_gradient(all[i]);
      CHECK(at.status == together[i].status);
      const auto rounding = s.rounding(at, all[i]);
      for (std::size_t m = 0; m < at.values.size(); ++m)
        CHECK(std::fabs(at.values[m] - together[i].values[m]) <= rounding[m] / 16);
    }
  }
}
