/// First-order and total Sobol' indices of the g function of ten inputs, stated as a formula: N (d + 2) model runs.
/// The peers' task in scripts/bench; goals against OpenTURNS 30x (must), 75x (goal), against numpy 6x and 10x.
#include <filesystem>
#include <fstream>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "analysis/shapley.h"
#include "analysis/sobol.h"
#include "cli/command.h"

namespace {

using namespace gumshoe;

scenario::Scenario g_function() {
  std::string formula, quantities;
  for (int i = 0; i < 10; ++i) {
    formula += fmt::format("{}((abs(4*x{} - 2) + {})/(1 + {}))", i == 0 ? "" : "*", i, i, i);
    quantities += fmt::format("[quantities.x{}]\ndistribution = \"rectangular\"\nlow = 0\nhigh = 1\n", i);
  }
  const auto path = std::filesystem::temp_directory_path() / "gumshoe_sobol_bench.toml";
  std::ofstream(path) << "schema = 1\n[model]\nname = \"expression\"\n[model.measurands]\ny = \"" << formula << "\"\n"
                      << quantities;
  scenario::Scenario s = scenario::read(path.string(), cli::catalogue());
  std::filesystem::remove(path);
  return s;
}

void sobol_indices(benchmark::State& state) {
  const scenario::Scenario s = g_function();
  const propagation::Experiment experiment(s);
  for (auto _ : state)
    benchmark::DoNotOptimize(analysis::sobol_indices(experiment, 100'000, static_cast<int>(state.range(0))));
}
BENCHMARK(sobol_indices)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void second_order(benchmark::State& state) {
  scenario::Scenario s = g_function();
  s.analysis.sensitivity.second_order = true;
  const propagation::Experiment experiment(s);
  for (auto _ : state)
    benchmark::DoNotOptimize(analysis::sobol_indices(experiment, 100'000, static_cast<int>(state.range(0))));
}
BENCHMARK(second_order)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void shapley_effects(benchmark::State& state) {
  const scenario::Scenario s = g_function();
  const propagation::Experiment experiment(s);
  for (auto _ : state)
    benchmark::DoNotOptimize(analysis::shapley_effects(experiment, 100'000, static_cast<int>(state.range(0))));
}
BENCHMARK(shapley_effects)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
