/// Random numbers and designs, a strip at a time as the sampler draws them. Goals: 1,500 million uniforms, 350 million
/// normal deviates and 500 million Latin hypercube points per second and core.
#include <vector>

#include <benchmark/benchmark.h>

#include "base/hash.h"
#include "quantities/distribution.h"
#include "quantities/quantile_kernels.h"
#include "quantities/sample_plan.h"
#include "random/sobol.h"

namespace {

using namespace gumshoe;

constexpr std::size_t strip = 512;
const random::Stream stream{hash64("bench"), 0, 0, 0};

/// Calls draw(first, out) for one strip after the other.
template <class Draw> void strips(benchmark::State& state, const Draw& draw) {
  std::vector<double> out(strip);
  std::uint64_t first = 0;
  for (auto _ : state) {
    draw(first, out.data());
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
    first += strip;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(strip));
}

void uniforms(benchmark::State& state) {
  strips(state, [](std::uint64_t first, double* out) { quantities::kernels().uniforms(&stream, first, strip, out); });
}
BENCHMARK(uniforms);

void normals(benchmark::State& state) {
  const quantities::QuantileFunction normal(quantities::Distribution{quantities::Family::normal, {0, 1}, {}, {}});
  strips(state, [&](std::uint64_t first, double* out) {
    quantities::kernels().uniforms(&stream, first, strip, out);
    normal(out, out, strip);
  });
}
BENCHMARK(normals);

/// A million samples, for which hardly any stratum is walked twice, and 2^20 + 1, for which three of four are.
void latin_hypercube(benchmark::State& state) {
  const random::Permutation strata = random::strata(stream, static_cast<std::uint64_t>(state.range(0)));
  strips(state, [&](std::uint64_t first, double* out) {
    quantities::kernels().latin_hypercube(&stream, &strata, first % (1 << 19), strip, out);
  });
}
BENCHMARK(latin_hypercube)->ArgName("of")->Arg(1'000'000)->Arg((1 << 20) + 1);

void sobol_points(benchmark::State& state) {
  const random::SobolDimension dimension(3, 1);
  strips(state, [&](std::uint64_t first, double* out) { dimension(first, strip, out); });
}
BENCHMARK(sobol_points);

} // namespace
