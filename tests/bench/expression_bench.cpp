/// Samples per second of formulas on one core, model evaluation alone: columns drawn beforehand.
#include <random>

#include <benchmark/benchmark.h>

#include "asked.h"
#include "models/expression/expression.h"

namespace {

using namespace gumshoe;

constexpr std::size_t block = 4096;

models::MadeModel model_of(const std::vector<std::string>& names, const std::string& text) {
  formula::Statement s;
  for (const auto& name : names) s.quantities.push_back({name, "1", "1", ""});
  formula::Stated f;
  f.formula.name = "y";
  f.formula.text = text;
  s.measurands.push_back(f);
  std::vector<std::string> notes;
  return models::expression::make(std::move(s), notes);
}

void evaluate(benchmark::State& state, const std::vector<std::string>& names, const std::string& text) {
  const auto model = model_of(names, text);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> unit(-3.14, 3.14);
  std::vector<std::vector<double>> x(names.size(), std::vector<double>(block));
  for (auto& column : x)
    for (double& v : column) v = unit(engine);
  std::vector<double> out(block);
  std::vector<std::uint8_t> status(block);
  double* row = out.data();
  const propagation::ForwardModel forward(*model);
  const auto columns = tests::block_of(forward, block, x);
  const auto call = forward.call(columns, nullptr, &row, status.data());
  for (auto _ : state) {
    model->kernels()->evaluate(call);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(block));
}

void additive(benchmark::State& state) { evaluate(state, {"a", "b", "c", "d"}, "a + b + c + d"); }
/// JCGM 101 9.5.
void gauge_block(benchmark::State& state) {
  evaluate(state, {"LS", "D", "d1", "d2", "aS", "th0", "De", "da", "dt"},
           "LS + D + d1 + d2 - LS * (da * (th0 + De) + aS * dt) - 50000000");
}
void ishigami(benchmark::State& state) {
  evaluate(state, {"x1", "x2", "x3"}, "sin(x1) + 7 * sin(x2)^2 + 0.1 * x3^4 * sin(x1)");
}

BENCHMARK(additive);
BENCHMARK(gauge_block);
BENCHMARK(ishigami);

} // namespace
