/// Points of a laser scan: one after the other, and profiles as a run computes them.
#include <benchmark/benchmark.h>

#include <vector>

#include "models/model.h"

using namespace gumshoe;

namespace {

constexpr double deg = 3.14159265358979323846 / 180;

/// A block of 1,024 samples of a circle, set-up errors drawn. @param evaluation 0: points, 1: the profile judged
void profile_points(benchmark::State& state) {
  const models::Model& model = *models::find("laser_scan");
  const auto readings = static_cast<std::size_t>(state.range(0)), samples = std::size_t{1024};
  const auto& card = *model.card;
  const std::size_t nq = card.quantities.size(), nc = card.conditions.size();
  std::vector<double> defaults, drawn(samples), indicated(samples);
  for (const QuantityCard& q : card.quantities) defaults.push_back(q.default_value);
  for (std::size_t i = 0; i < samples; ++i) drawn[i] = 1e-8 * static_cast<double>(i);
  std::vector<double> conditions;
  for (std::size_t r = 0; r < readings; ++r)
    for (const VariableCard& c : card.conditions)
      conditions.push_back(c.name == "theta" || c.name == "C" ? 360.0 * deg * static_cast<double>(r) / static_cast<double>(readings)
                                                              : c.default_value);
  std::vector<models::Column> q, c, read(readings, {indicated.data(), 1});
  for (std::size_t r = 0; r < readings; ++r) {
    for (std::size_t j = 0; j < nq; ++j)
      q.push_back(j < 5 ? models::Column{drawn.data(), 1} : models::Column{&defaults[j], 0}); // e_x ... e_b
    for (std::size_t j = 0; j < nc; ++j) c.push_back({&conditions[r * nc + j], 0});
  }
  const bool joint = state.range(1) == 1;
  const std::size_t rows = joint ? card.evaluations[1].measurands.size() : readings;
  std::vector<double> out(rows * samples);
  std::vector<double*> to;
  for (std::size_t i = 0; i < rows; ++i) to.push_back(&out[i * samples]);
  std::vector<std::size_t> solved(readings);
  for (std::size_t r = 0; r < readings; ++r) solved[r] = r;
  std::vector<std::uint8_t> status(samples);
  models::BlockCall call;
  call.samples = samples, call.readings = readings, call.quantities = q.data(), call.conditions = c.data();
  call.indications = read.data(), call.measurands = to.data(), call.solved_as = solved.data(), call.status = status.data();
  call.evaluation = joint ? 1 : 0;
  for (auto _ : state) {
    model.kernels()->evaluate(call);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples * readings));
}
BENCHMARK(profile_points)->Args({36, 0})->Args({36, 1})->Args({3600, 1});

} // namespace
