/// Triggers of a round-insert mill per second on one core: geometry sampled, geometry known, a characteristic curve.
/// Goals: 0.5 M/s (must), 2 M/s (goal) with geometry sampled; 360 start angles of one geometry well under 5 ms.
#include <random>

#include <benchmark/benchmark.h>

#include "laws/mill_rows.h"
#include "propagation/forward_model.h"

namespace {

using namespace gumshoe;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded;

constexpr std::size_t n = 4096;
constexpr double pi = 3.14159265358979323846, deg = pi / 180, mm = 1e-3;

/// The tool of Fang 2022, Tables 3.3 and 3.4, all of its geometry drawn; tilted beams and other shares if asked.
struct Block {
  std::vector<std::vector<double>> values = std::vector<std::vector<double>>(tests::quantities, std::vector<double>(n));
  std::vector<double> outputs = std::vector<double>(3 * n), simulated = std::vector<double>(n), angles;
  std::vector<std::uint8_t> status = std::vector<std::uint8_t>(n);
  std::vector<double*> measurands{&outputs[0], &outputs[n], &outputs[2 * n]}, indications{&simulated[0]};
  double condition[6] = {1000 * 2 * pi / 60, 30 * mm / 60, 0, 5 * mm, 0, -1};
  propagation::ForwardModel forward{*models::find("tool_length")};
  propagation::Block columns;
  models::BlockCall call;

  explicit Block(double inserts, bool tilted, bool drawn = true) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    const auto& cards = models::find("tool_length")->card->quantities;
    const auto fill = [&](std::size_t q, double mean, double u) {
      for (double& x : values[q]) x = mean + (drawn ? u * normal(engine) : 0);
    };
    for (std::size_t q = 0; q < tests::quantities; ++q) fill(q, cards[q].default_value, 0);
    fill(Row::tool_radius, 10 * mm, 2e-6);
    fill(Row::insert_radius, 5 * mm, 2e-6);
    fill(Row::insert_thickness, 3.2 * mm, 1e-5);
    fill(Row::clearance_angle, 15 * deg, 1e-3);
    fill(Row::insert_radial_angle, -12 * deg, 1e-3);
    fill(Row::insert_axial_angle, 6 * deg, 1e-3);
    fill(Row::inserts, inserts, 0);
    for (std::size_t k = 0; k < chain::most_inserts; ++k) fill(Row::wear_1 + k, 2e-6 * static_cast<double>(k % 2), 1e-6);
    fill(Row::offset, 4.9 * mm, 2e-5);
    fill(Row::beam_radius, 0.2 * mm, 3e-6);
    if (tilted) fill(Row::beam_yaw, 0, 1e-4), fill(Row::beam_pitch, 0, 1e-4), fill(Row::trigger_fraction, 0.5, 0.01);
    for (std::size_t i = 0; i < n; ++i) angles.push_back(2 * pi * static_cast<double>(i) / n);
    values.emplace_back(1); // the readout
    std::vector<models::Column> row, conditions;
    for (auto& v : values) row.push_back({v.data(), v.size() > 1 ? 1u : 0u});
    for (double& c : condition) conditions.push_back({&c, 0});
    conditions[Commanded::start_angle] = {angles.data(), 1};
    columns.clear(n);
    forward.add(columns, 0, row, conditions);
    call = forward.call(columns, indications.data(), measurands.data(), status.data());
  }
};

void run(benchmark::State& state, Block& block) {
  const auto* kernels = models::find("tool_length")->kernels();
  for (auto _ : state) {
    kernels->simulate(block.call);
    benchmark::DoNotOptimize(block.outputs.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(block.call.samples));
}
void tool_trigger_sampled(benchmark::State& state) {
  Block block(static_cast<double>(state.range(0)), false);
  run(state, block);
}
BENCHMARK(tool_trigger_sampled)->Arg(1)->Arg(2)->Arg(4);
void tool_trigger_tilted(benchmark::State& state) {
  Block block(2, true);
  run(state, block);
}
BENCHMARK(tool_trigger_tilted);
void tool_trigger_known(benchmark::State& state) {
  Block block(2, false, false);
  run(state, block);
}
BENCHMARK(tool_trigger_known);

/// 360 start angles of one geometry: the time per iteration is that of a curve.
void characteristic_curve(benchmark::State& state) {
  Block block(2, false, false);
  block.call.samples = 360;
  for (std::size_t i = 0; i < 360; ++i) block.angles[i] = static_cast<double>(i) * deg;
  run(state, block);
}
BENCHMARK(characteristic_curve);

/// Every way by itself, one sample of the block after the other.
template <class F> void each(benchmark::State& state, const F& solve) {
  Block block(2, false);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto v = [&](std::size_t q) { return block.values[q][i]; };
    const models::tool_length::Insert<double> insert{v(Row::tool_radius),
                                       v(Row::insert_radius),
                                       v(Row::insert_thickness),
                                       v(Row::clearance_angle),
                                       v(Row::insert_radial_angle),
                                       v(Row::insert_axial_angle),
                                       0,
                                       -v(Row::offset)};
    const models::tool_length::Flute<double> flutes[] = {{insert, 0, v(Row::wear_1)}, {insert, pi, v(Row::wear_1 + 1)}};
    benchmark::DoNotOptimize(
        solve(std::span<const models::tool_length::Flute<double>>(flutes), models::laser_setter::Beam<double>{0, 0, v(Row::beam_radius), 0.5},
              models::tool_length::InsertMotion{block.angles[i], 5 * mm, block.condition[1] / block.condition[0]}));
    i = (i + 1) % n;
  }
  state.SetItemsProcessed(state.iterations());
}
void walk_alone(benchmark::State& state) {
  models::tool_length::TriggerSolver solver;
  each(state, [&](const auto&... call) { return solver.walk(call...); });
}
void search_alone(benchmark::State& state) {
  models::tool_length::TriggerSolver solver;
  each(state, [&](const auto&... call) { return solver.search(call...); });
}
void flute_alone(benchmark::State& state) {
  models::tool_length::TriggerSolver solver;
  double level = 0;
  Block block(2, false, false);
  const models::tool_length::Insert<double> insert{10 * mm, 5 * mm, 3.2 * mm, 15 * deg, -12 * deg, 6 * deg, 0, -4.9 * mm};
  const double drop = block.condition[1] / block.condition[0];
  for (auto _ : state)
    benchmark::DoNotOptimize(solver.alone({insert, 0, 0}, {0, 0, 0.2 * mm, 0.5}, level += 0.01 * drop, drop));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(walk_alone);
BENCHMARK(search_alone);
BENCHMARK(flute_alone);

} // namespace
