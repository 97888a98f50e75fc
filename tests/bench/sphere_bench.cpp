/// The sphere model's kernels: one block of 2,048 samples at the 33 poses of the thesis.
#include <benchmark/benchmark.h>

#include "models/sphere_calibration/sphere_calibration.h"

using namespace gumshoe;
namespace sphere = gumshoe::models::sphere_calibration;

namespace {

void commands(benchmark::State& state) {
  constexpr std::size_t samples = 2048, readings = 33;
  const auto* model = models::find("sphere_calibration");
  std::vector<std::vector<double>> q;
  for (const auto& card : model->card->quantities) q.emplace_back(samples, card.default_value);
  for (std::size_t i = 0; i < samples; ++i) q[sphere::E_CC][i] = 1e-9 * static_cast<double>(i);
  const double zero = 0;
  std::vector<double> angle(2 * readings);
  std::vector<models::Column> quantities, conditions;
  std::vector<double> out(readings * 6 * samples);
  std::vector<double*> simulated, truth;
  std::vector<std::size_t> itself;
  for (std::size_t r = 0; r < readings; ++r) {
    angle[2 * r] = r < 19 ? 0 : 0.08 * (static_cast<double>(r) - 23);
    angle[2 * r + 1] = r < 19 ? 0.08 * static_cast<double>(r) : 1.5;
    for (std::size_t j = 0; j < sphere::count; ++j)
      quantities.push_back({q[j].data(), j < sphere::S_XY || state.range(1) ? std::size_t{1} : std::size_t{0}});
    for (int c = 0; c < sphere::conditions; ++c)
      conditions.push_back({c == sphere::B ? &angle[2 * r] : c == sphere::C ? &angle[2 * r + 1] : &zero, 0});
    for (std::size_t k = 0; k < 3; ++k) {
      simulated.push_back(&out[(6 * r + k) * samples]);
      truth.push_back(&out[(6 * r + 3 + k) * samples]);
    }
    itself.push_back(r);
  }
  std::vector<std::uint8_t> status(samples, 0);
  models::BlockCall call;
  call.samples = samples;
  call.readings = readings;
  call.quantities = quantities.data();
  call.conditions = conditions.data();
  call.simulated = simulated.data();
  call.measurands = truth.data();
  call.solved_as = itself.data();
  call.status = status.data();
  call.evaluation = static_cast<int>(state.range(0));
  for (auto _ : state) {
    model->kernels()->simulate(call);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * samples * readings));
}
BENCHMARK(commands)->ArgNames({"variant", "squareness"})->ArgsProduct({{0, 1}, {0, 1}});

} // namespace
