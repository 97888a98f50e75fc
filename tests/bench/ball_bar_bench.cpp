/// Laser ball bars: trilaterations, and contours of 100 readings.
#include <benchmark/benchmark.h>

#include "models/laser_ball_bar/laser_ball_bar.h"

using namespace gumshoe;
using namespace gumshoe::models::laser_ball_bar;
using models::Outcome, models::array_of;

namespace {

template <template <class> class Named, class Cards> void defaults(Named<double>& values, const Cards& cards) {
  for (std::size_t i = 0; i < cards.size(); ++i) array_of(values)[i] = cards[i].default_value;
}
At<double> at_defaults() {
  At<double> at;
  defaults<Rows::Quantities>(at.q, LaserBallBar::card.quantities);
  defaults<Rows::Conditions>(at.c, LaserBallBar::card.conditions);
  return at;
}

void trilateration(benchmark::State& state) {
  const auto base = sockets(at_defaults().q);
  Distances<double> l{0.41, 0.42, 0.43};
  for (auto _ : state) {
    l.to_1 += 1e-12;
    benchmark::DoNotOptimize(trilaterate(base, l));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trilateration);

/// A whole reading: frame, corrections of the bars, deviation from the contour.
void reading(benchmark::State& state) {
  const auto at = at_defaults();
  Rows::Indications<double> read{0.41, 0.42, 0.43};
  Outcome<double> outcome;
  for (auto _ : state) {
    read.length_1 += 1e-12;
    benchmark::DoNotOptimize(evaluate(at, read, outcome));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(reading);

/// 100 readings over a contour, its start from rest included.
void contour(benchmark::State& state) {
  auto at = at_defaults();
  at.c.contour = static_cast<double>(state.range(0)), at.c.order = static_cast<double>(state.range(1));
  const double end = contour_of(at.c).move()->end();
  Outcome<double> outcome;
  for (auto _ : state) {
    at.q.loop_gain += 1e-9;
    for (int i = 0; i < 100; ++i) {
      at.c.time = end * (i + 1) / 100;
      benchmark::DoNotOptimize(simulate(at, outcome));
    }
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(contour)->ArgNames({"contour", "order"})->ArgsProduct({{1, 2}, {1, 2}});

} // namespace
