/// The sphere model's kernels: one block of 2,048 samples at the 33 poses of the thesis.
#include <benchmark/benchmark.h>

#include "asked.h"
#include "laws/sphere_rows.h"

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded;

namespace {

void commands(benchmark::State& state) {
  constexpr std::size_t samples = 2048, readings = 33;
  const auto* model = models::find("sphere_calibration");
  std::vector<std::vector<double>> q;
  for (const auto& card : model->card->quantities) q.emplace_back(samples, card.default_value);
  for (std::size_t i = 0; i < samples; ++i) q[Row::E_CC][i] = 1e-9 * static_cast<double>(i);
  for (int k = 0; k < 3; ++k) q.push_back({0}); // the readouts
  std::vector<std::vector<double>> conditions(readings, std::vector<double>(tests::conditions));
  std::vector<double> out(readings * 6 * samples);
  std::vector<double*> simulated, truth;
  for (std::size_t r = 0; r < readings; ++r) {
    conditions[r][Commanded::B] = r < 19 ? 0 : 0.08 * (static_cast<double>(r) - 23);
    conditions[r][Commanded::C] = r < 19 ? 0.08 * static_cast<double>(r) : 1.5;
    for (std::size_t k = 0; k < 3; ++k) {
      simulated.push_back(&out[(6 * r + k) * samples]);
      truth.push_back(&out[(6 * r + 3 + k) * samples]);
    }
  }
  std::vector<std::uint8_t> status(samples, 0);
  const propagation::ForwardModel forward(*model, {}, static_cast<std::size_t>(state.range(0)), conditions);
  if (!state.range(1))
    for (std::size_t j = Row::S_XY; j < tests::quantities; ++j) q[j].resize(1);
  propagation::Block block;
  block.clear(samples);
  for (std::size_t r = 0; r < readings; ++r) tests::add(block, forward, r, q);
  const auto call = forward.call(block, simulated.data(), truth.data(), status.data());
  for (auto _ : state) {
    model->kernels()->simulate(call);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * samples * readings));
}
BENCHMARK(commands)->ArgNames({"variant", "squareness"})->ArgsProduct({{0, 1}, {0, 1}});

} // namespace
