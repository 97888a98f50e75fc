/// The single socket method: both steps from six bar readings, and its second step alone; 2,048 samples a block.
#include <benchmark/benchmark.h>

#include "asked.h"
#include "models/single_socket/single_socket.h"
#include "models/single_socket_rotation/single_socket_rotation.h"

using namespace gumshoe;

namespace {

constexpr std::size_t samples = 2048;

/// Runs the evaluation of readings; an item is one identification.
void evaluate(benchmark::State& state, const models::Model& model, std::size_t evaluation,
              const std::vector<std::vector<double>>& conditions) {
  const std::size_t shown = model.card->indications.size(), readings = conditions.size();
  std::vector<double> defaults;
  for (const auto& card : model.card->quantities) // a ball that every machine can turn
    defaults.push_back(card.name == "point_x" || card.name == "point_y" ? 0.1 : card.default_value);
  auto q = tests::columns_of(defaults);
  for (std::size_t k = 0; k < shown; ++k) {
    q.emplace_back(samples);
    for (std::size_t i = 0; i < samples; ++i) q.back()[i] = 1e-8 * static_cast<double>(i + k);
  }
  const propagation::ForwardModel forward(model, {}, evaluation, conditions);
  const std::size_t rows = forward.measurands(defaults.data()).size();
  std::vector<double> out(rows * samples);
  std::vector<double*> found;
  for (std::size_t m = 0; m < rows; ++m) found.push_back(&out[m * samples]);
  std::vector<std::uint8_t> status(samples, 0);
  propagation::Block block;
  block.clear(samples);
  for (std::size_t r = 0; r < readings; ++r) tests::add(block, forward, r, q);
  const auto call = forward.call(block, nullptr, found.data(), status.data());
  for (auto _ : state) {
    model.kernels()->evaluate(call);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * samples));
}

void bars(benchmark::State& state) {
  constexpr double at[][3] = {{0.15, 0, 0}, {0, 0.15, 0}, {0, 0, 0.15}};
  std::vector<std::vector<double>> conditions;
  for (const double step : {1.0, 2.0})
    for (const auto& p : at) conditions.push_back({p[0], p[1], p[2], step, step == 2 ? 0.5 : 0, 0, 0, -1, 0, 0});
  const auto evaluation = models::single_socket::rotated + (state.range(0) ? 4 : 0);
  evaluate(state, *models::find("single_socket"), static_cast<std::size_t>(evaluation), conditions);
}
BENCHMARK(bars)->ArgName("linear")->Arg(0)->Arg(1);

void rotations(benchmark::State& state) {
  const auto evaluation = static_cast<std::size_t>(state.range(0));
  evaluate(state, *models::find("single_socket_rotation"), evaluation, {{0.5, 0.4, 0.3}});
}
BENCHMARK(rotations)->ArgName("evaluation")->DenseRange(0, 7);

} // namespace
