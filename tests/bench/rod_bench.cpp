/// Rod solves per second on one core, scalar and in lanes, and whole samples of a budget.
/// Goals: 5 M/s (must), 20 M/s (goal) full solves per second and core.
#include <random>

#include <benchmark/benchmark.h>

#include "asked.h"
#include "base/instruction_set.h"
#include "models/model.h"
#include "models/rod_gauging/shadow/trigger_height.h"

namespace {

using namespace gumshoe;

constexpr std::size_t n = 4096;

/// Eleven drawn columns around rod 2 on the beam of Fang 2022, Table 2.5.
struct Block {
  std::vector<std::vector<double>> values;
  std::vector<double> outputs = std::vector<double>(2 * n), simulated = std::vector<double>(n);
  std::vector<std::uint8_t> status = std::vector<std::uint8_t>(n);
  std::vector<double*> measurands{&outputs[0], &outputs[n]}, indications{&simulated[0]};
  propagation::ForwardModel forward{*models::find("rod_gauging"), {}, 0, {{4e-3 / 60, 0, -1}}};
  propagation::Block columns;
  models::BlockCall call;

  Block() {
    const double degree = std::numbers::pi / 180;
    const double mean[] = {
        5e-3, 3e-5, 88.041 * degree, 144.086 * degree, 0.179822, 0, 0.6241 * degree, 0.2836 * degree, 2e-4, 0.5, -0.51};
    const double u[] = {1e-6, 3e-6, 4e-5, 1e-3, 1e-6, 2e-3, 1e-4, 1e-4, 3e-6, 0.01, 1e-3};
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    for (int q = 0; q < 11; ++q) {
      values.emplace_back(n);
      for (double& x : values.back()) x = mean[q] + u[q] * normal(engine);
    }
    values.emplace_back(1); // the readout
    columns.clear(n);
    tests::add(columns, forward, 0, values);
    call = forward.call(columns, indications.data(), measurands.data(), status.data());
  }
};

void lanes(benchmark::State& state) {
  Block block;
  const auto* kernels = models::find("rod_gauging")->kernels();
  for (auto _ : state) {
    kernels->simulate(block.call);
    benchmark::DoNotOptimize(block.outputs.data());
  }
  state.SetItemsProcessed(state.iterations() * n);
  state.SetLabel(name(best_instruction_set()));
}
BENCHMARK(lanes);

template <class F> void scalar(benchmark::State& state, const F& solve) {
  Block block;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto v = [&](std::size_t q) { return block.values[q][i]; };
    const models::rod_gauging::Rod<double> rod{v(0), v(1), v(2), v(3) + v(5)};
    const models::laser_setter::Beam<double> beam{v(6), v(7), v(8), v(9)};
    benchmark::DoNotOptimize(solve(rod, beam));
    i = (i + 1) % n;
  }
  state.SetItemsProcessed(state.iterations());
}
void scalar_fast(benchmark::State& state) {
  scalar(state, [](const auto& rod, const auto& beam) { return models::rod_gauging::trigger_height(rod, beam); });
}
void scalar_general(benchmark::State& state) { scalar(state, models::rod_gauging::general_height); }
BENCHMARK(scalar_fast);
BENCHMARK(scalar_general);

/// Height with all eleven first derivatives, as a budget or a trace needs it.
void gradient(benchmark::State& state) {
  scalar(state, [](const models::rod_gauging::Rod<double>& r, const models::laser_setter::Beam<double>& b) {
    using D = models::Gradient;
    return models::rod_gauging::differentiable_height<D>(
        {D::variable(r.radius, 0), D::variable(r.fillet_radius, 1), D::variable(r.bottom_elevation, 2),
         D::variable(r.bottom_azimuth, 3)},
        {D::variable(b.yaw, 4), D::variable(b.pitch, 5), D::variable(b.radius, 6), D::variable(b.fraction, 7)});
  });
}
BENCHMARK(gradient);

} // namespace
