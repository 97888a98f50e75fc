/// What every effect promises on every model that has its stage.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "contracts/examples.h"

using namespace gumshoe;
using namespace gumshoe::contracts;

TEST_CASE("an effect's card is complete: names, units, a null within limits, a typical size", "[contracts][effects]") {
  std::set<std::string> names;
  for (const EffectCard* card : effects::cards()) {
    INFO(card->name);
    CHECK(names.emplace(card->name).second);
    for (const std::string_view text : {card->title, card->meaning, card->confused_with, card->source})
      CHECK_FALSE(text.empty());
    std::set<std::string> own;
    bool amplitude = false;
    for (const QuantityCard& q : card->quantities) {
      INFO(q.name);
      CHECK(own.emplace(q.name).second);
      CHECK(is_unit_of_si(q.unit, q.si_unit));
      CHECK_FALSE(q.meaning.empty());
      CHECK(q.limits.contain(q.default_value));
      CHECK(q.role != Role::plain);
      CHECK((0 <= q.typical.low && q.typical.low <= q.typical.high));
      CHECK((q.limits.contain(q.typical.low) && q.limits.contain(q.typical.high)));
      if (q.role == Role::shape) continue;
      amplitude = true;
      CHECK(q.default_value == 0);
      CHECK(q.typical.high > 0);
    }
    CHECK(amplitude);
  }
}

TEST_CASE("at its null an effect changes no bit; freed it moves a reading; evaluation takes it off again",
          "[contracts][laws][effects]") {
  for (const Example& e : examples())
    for (const EffectCard* effect : effects_on(e.model())) {
      INFO(effect->name << " on " << e.name);
      const Subject plain(e.model()), s(e.model(), {effect});
      Draw draw(1404);
      std::size_t moved = 0, valid = 0;
      for (std::size_t n = 0; n < 24; ++n) {
        const Point p = plain.random(plain.at_null(e.readings[n % e.readings.size()]), draw);
        const auto read = plain.read(p);
        if (!read) continue;
        ++valid;
        const Point at_null = s.at_null(*read);
        REQUIRE(s.simulate({at_null})[0] == plain.simulate({*read})[0]);
        REQUIRE(s.evaluate({at_null})[0] == plain.evaluate({*read})[0]);

        Point freed = at_null;
        for (std::size_t i = s.first_effect(); i < s.first_indication(); ++i)
          if (s.card(i).role != Role::shape) freed.x[i] = typical(s.card(i));
        REQUIRE(s.possible(freed));
        const auto there = s.read(freed);
        if (!there) continue;
        const Derived by = s.evaluate_gradient(*there);
        const auto rounding = s.rounding(by, *there);
        // A thousand roundings of what the measurands are computed from: no effect of a typical size is that small.
        const std::size_t k = e.model().card->indications.size();
        const Outcome truth = s.simulate({freed})[0], back = s.evaluate({*there})[0];
        REQUIRE(back.ok());
        for (std::size_t m = 0; m < back.values.size(); ++m)
          CHECK(std::fabs(back.values[m] - truth.values[k + m]) <= rounding[m]);
        bool this_one = false;
        for (std::size_t i = s.first_indication(); i < s.size(); ++i)
          for (std::size_t m = 0; m < back.values.size(); ++m)
            this_one |= std::fabs(by.derivatives[m][i] * (there->x[i] - at_null.x[i])) > 1000 * rounding[m];
        moved += this_one;
      }
      CHECK(valid >= 12);
      CHECK(moved > 0);
    }
}

TEST_CASE("all effects of a model at null change no bit", "[contracts][laws][effects]") {
  for (const Example& e : examples()) {
    const auto all = effects_on(e.model());
    if (all.empty()) continue;
    INFO(e.name);
    const Subject plain(e.model()), s(e.model(), all);
    Draw draw(1405);
    for (std::size_t n = 0; n < 24; ++n) {
      const auto read = plain.read(plain.random(plain.at_null(e.readings[n % e.readings.size()]), draw));
      if (!read) continue;
      CHECK(s.simulate({s.at_null(*read)})[0] == plain.simulate({*read})[0]);
      CHECK(s.evaluate({s.at_null(*read)})[0] == plain.evaluate({*read})[0]);
    }
  }
}
