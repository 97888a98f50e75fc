/// From values to intervals: a whole summary, the two coverage intervals alone, two order statistics by
/// std::nth_element (goal: 3 ns a value, at most 0.4 of nth_element), joint regions. Items are values, of joint regions
/// samples.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "analysis/joint.h"
#include "analysis/ordered_tails.h"
#include "analysis/summary.h"
#include "base/hash.h"
#include "quantities/distribution.h"
#include "quantities/quantile_kernels.h"
#include "quantities/sample_plan.h"

namespace {

using namespace gumshoe;

constexpr std::size_t n = 1'000'000;

std::vector<double> normals(std::string_view name) {
  std::vector<double> x(n);
  const random::Stream stream{hash64(name), 0, 0, 0};
  const quantities::QuantileFunction normal(quantities::Distribution{quantities::Family::normal, {0, 1}, {}, {}});
  quantities::kernels().uniforms(&stream, 0, n, x.data());
  normal(x.data(), x.data(), n);
  return x;
}

void summary(benchmark::State& state) {
  const auto x = normals("x");
  for (auto _ : state) benchmark::DoNotOptimize(analysis::summarise({}, x, 0.95, static_cast<int>(state.range(0))));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(summary)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime();

void intervals(benchmark::State& state) {
  const auto x = normals("x");
  const std::size_t span = analysis::covered_ranks(n, 0.95);
  for (auto _ : state) {
    const auto tails = analysis::ordered_tails(x, n, n / 18, 1);
    benchmark::DoNotOptimize(tails[n / 40] + tails[n - n / 40] + tails[tails.shortest(span)]);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(intervals);

void nth_element(benchmark::State& state) {
  const auto x = normals("x");
  for (auto _ : state) {
    auto copy = x;
    benchmark::DoNotOptimize(analysis::symmetric_ends(copy, 0.95));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(nth_element);

void joint_region(benchmark::State& state) {
  std::vector<std::vector<double>> x;
  std::vector<analysis::Column> values;
  for (int i = 0; i < state.range(0); ++i) x.push_back(normals(std::string(1, static_cast<char>('a' + i))));
  for (const auto& one : x) values.emplace_back(one);
  for (auto _ : state) benchmark::DoNotOptimize(analysis::joint_region(values, 0.95));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(joint_region)->ArgName("measurands")->Arg(2)->Arg(8);

} // namespace
