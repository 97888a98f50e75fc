/// Exact derivatives of every model against differences, at random points around its example, by all that it reads.
#include <catch2/catch.hpp>

#include <cmath>

#include "contracts/examples.h"

using namespace gumshoe;
using namespace gumshoe::contracts;

namespace {

/// Central differences with steps h and h/2. Truncation is of the second order in h, so that of the smaller step is a
/// third of their distance; `rounding` is that of one value.
struct Difference {
  double value, truncation, rounding;
  Difference(double up, double down, double half_up, double half_down, double h, double of_one)
      : value((half_up - half_down) / h), truncation(std::fabs((up - down) / (2 * h) - value)),
        rounding(2 * of_one / h) {}
  double error() const { return truncation + rounding; }
  /// A jump or a kink lies between the points: nothing to compare.
  bool broken(double exact) const {
    return truncation > rounding && truncation > 1e-2 * (std::fabs(value) + std::fabs(exact));
  }
};

Point moved(Point p, std::size_t i, double by) {
  p.x[i] += by;
  return p;
}

/// Effects whose derivatives differences show.
std::vector<const EffectCard*> smooth_effects(const models::Model& model) {
  auto out = effects_on(model);
  std::erase_if(out, [](const EffectCard* e) { return e->moves_in_steps; });
  return out;
}

struct Tally {
  std::size_t compared = 0, telling = 0, broken = 0;
  void compare(double exact, const Difference& d) {
    CAPTURE(exact, d.value, d.error());
    if (d.broken(exact)) {
      ++broken;
      return;
    }
    ++compared;
    telling += std::fabs(exact) > 100 * d.error();
    CHECK(std::fabs(exact - d.value) <= d.error());
  }
};

/// f(subject, point, what is found there, its number, tally) at six random points around the example, where there are
/// derivatives.
template <class F> Tally at_points(const Example& e, unsigned seed, const F& f) {
  const Subject s(e.model(), smooth_effects(e.model()));
  Draw draw(seed);
  Tally tally;
  for (std::size_t n = 0; n < 6; ++n) {
    const auto p = s.read(s.random(s.at_null(e.readings[n % e.readings.size()]), draw, true));
    if (!p) continue;
    if (const Derived at = s.evaluate_gradient(*p); at.ok() && !at.kink) f(s, *p, at, n, tally);
  }
  return tally;
}

} // namespace

TEST_CASE("gradients agree with differences", "[contracts][laws][models]") {
  for (const Example& e : examples()) {
    if (!e.model().evaluate_gradient) continue;
    INFO(e.name);
    const auto compare = [&](const Subject& s, const Point& p, const Derived& at, std::size_t, Tally& tally) {
      const auto rounding = s.rounding(at, p);
      for (std::size_t i = 0; i < s.size(); ++i) {
        const double h = 1e-4 * s.spread(i, p);
        const std::vector<Point> around{moved(p, i, h), moved(p, i, -h), moved(p, i, h / 2), moved(p, i, -h / 2)};
        if (!std::ranges::all_of(around, [&](const Point& q) { return s.possible(q); })) continue; // a whole number
        const auto y = s.evaluate(around);
        if (!std::ranges::all_of(y, &Outcome::ok)) continue;
        for (std::size_t m = 0; m < at.values.size(); ++m) {
          CAPTURE(s.name(i), e.model().card->measurands[m].name);
          tally.compare(at.derivatives[m][i], {y[0].values[m], y[1].values[m], y[2].values[m], y[3].values[m], h,
                                               rounding[m]});
        }
      }
    };
    const Tally tally = at_points(e, 1402, compare);
    // Most derivatives are known to 1 % by their differences: a factor or a sign that is wrong is seen.
    CAPTURE(tally.compared, tally.telling, tally.broken);
    CHECK(tally.telling >= 20);
    CHECK(tally.broken * 10 < tally.compared);
  }
}

TEST_CASE("curvatures agree with differences of gradients", "[contracts][laws][models]") {
  for (const Example& e : examples()) {
    if (!e.model().evaluate_curvature) continue;
    INFO(e.name);
    const auto compare = [&](const Subject& s, const Point& p, const Derived& at, std::size_t n, Tally& tally) {
      const auto rounding = s.rounding(at, p);
      std::vector<std::size_t> by;
      for (std::size_t j = 0; j < std::min<std::size_t>(8, s.size()); ++j) by.push_back((n * 8 + j) % s.size());
      const auto second = s.curvature(p, by);
      for (std::size_t b = 0; b < by.size(); ++b) {
        const double h = 1e-2 * s.spread(by[b], p);
        std::vector<Derived> g;
        for (const double step : {h, -h, h / 2, -h / 2})
          if (const Point q = moved(p, by[b], step); s.possible(q)) g.push_back(s.evaluate_gradient(q));
        if (g.size() < 4 || !std::ranges::all_of(g, &Outcome::ok)) continue;
        for (std::size_t m = 0; m < at.values.size(); ++m)
          for (std::size_t a = 0; a < by.size(); ++a) {
            const auto first = [&](std::size_t which) { return g[which].derivatives[m][by[a]]; };
            CAPTURE(s.name(by[a]), s.name(by[b]), e.model().card->measurands[m].name);
            // A gradient rounds as the value does, over the spread of its variable.
            tally.compare(second[m][8 * a + b],
                          {first(0), first(1), first(2), first(3), h,
                           rounding[m] / s.spread(by[a], p) + 1e-11 * std::fabs(at.derivatives[m][by[a]])});
          }
      }
    };
    const Tally tally = at_points(e, 1403, compare);
    CAPTURE(tally.compared, tally.telling, tally.broken);
    CHECK(tally.telling >= 5);
  }
}
