#include "propagation/propagate.h"

#include <algorithm>
#include <memory>

#include "propagation/in_order.h"

namespace gumshoe::propagation {

quantities::PointSet point_set(scenario::Design design) {
  switch (design) {
  case scenario::Design::latin_hypercube:
    return quantities::PointSet::latin_hypercube;
  case scenario::Design::sobol:
    return quantities::PointSet::sobol;
  default:
    return quantities::PointSet::monte_carlo;
  }
}

namespace {

std::shared_ptr<const quantities::Sampler> make_sampler(const Experiment& e) {
  const auto& run = e.scenario().run;
  return std::make_shared<const quantities::Sampler>(e.plan(), point_set(run.design), run.samples);
}

struct ThreadBuffers {
  Workspace workspace;
  std::vector<double> variates, outputs;
  std::vector<std::uint8_t> status;
};

/// Samples [first, first + count) into a block; drawn in multiples of 8, the surplus is cut off.
ResultBlock run_block(const Experiment& e, const quantities::Sampler& sampler, std::uint64_t first, std::size_t count,
                      ThreadBuffers& b) {
  const std::size_t n = (count + 7) / 8 * 8, variates = e.plan().variates.size(), rows = e.outputs().size();
  b.variates.resize(variates * n);
  b.outputs.resize(rows * n);
  b.status.resize(n);
  sampler.draw(first, n, quantities::Purpose::sampling, b.variates.data(), n);
  std::vector<const double*> pointers(variates);
  for (std::size_t v = 0; v < variates; ++v) pointers[v] = &b.variates[v * n];
  b.workspace.first_sample = first;
  e.run(pointers, n, b.workspace, b.outputs.data(), b.status.data());
  ResultBlock block{
      first, count, std::vector<double>(rows * count), {b.status.begin(), b.status.begin() + static_cast<long>(count)}};
  for (std::size_t r = 0; r < rows; ++r) std::copy_n(&b.outputs[r * n], count, &block.outputs[r * count]);
  return block;
}

/// As many samples as the model likes in a call, or in four if these are few: then each is costly, and blocks are
/// shared among processes. In multiples of 64, at which every design can begin.
std::uint64_t samples_per_block(std::size_t liked) {
  if (liked >= block_samples) return liked / block_samples * block_samples;
  return liked == 0 ? block_samples : std::clamp<std::uint64_t>(4 * liked / 64 * 64, 64, block_samples);
}

} // namespace

MakeBlock block_maker(const Experiment& e) {
  return [&e, sampler = make_sampler(e)](std::uint64_t first, std::uint64_t last) {
    ThreadBuffers own;
    return run_block(e, *sampler, first, static_cast<std::size_t>(last - first), own);
  };
}

std::uint64_t propagate(const Experiment& e, Sink& sink, const RunSettings& settings) {
  const auto sampler = make_sampler(e);
  const std::uint64_t total = settings.last > 0 ? settings.last : e.scenario().run.samples;
  const std::uint64_t per_block = samples_per_block(e.model().block);
  return in_order<ThreadBuffers>(
      {settings.first, total, per_block}, settings.threads, settings.elsewhere, settings.stop,
      [&](std::uint64_t first, std::uint64_t last, ThreadBuffers& own) {
        return run_block(e, *sampler, first, static_cast<std::size_t>(last - first), own);
      },
      [&](const ResultBlock& block, std::uint64_t, std::uint64_t done) {
        sink.write(block);
        if (settings.progress) settings.progress({done, total});
      });
}

std::function<void(std::uint64_t, std::size_t, double*)> variate_draws(const Experiment& e) {
  return [sampler = make_sampler(e), variates = e.plan().variates.size()](std::uint64_t first, std::size_t count,
                                                                          double* values) {
    const std::uint64_t begin = first / 64 * 64;
    const std::size_t n = static_cast<std::size_t>((first + count - begin + 63) / 64 * 64);
    std::vector<double> drawn(variates * n);
    sampler->draw(begin, n, quantities::Purpose::sampling, drawn.data(), n);
    for (std::size_t v = 0; v < variates; ++v) std::copy_n(&drawn[v * n + (first - begin)], count, values + v * count);
  };
}

std::vector<double> variates_of(const Experiment& e, std::uint64_t sample) {
  std::vector<double> one(e.plan().variates.size());
  variate_draws(e)(sample, 1, one.data());
  return one;
}

} // namespace gumshoe::propagation
