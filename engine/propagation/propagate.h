#pragma once
/// Runs the samples of an experiment, block by block, in parallel and in order (the only door to oneTBB).
#include <atomic>
#include <functional>

#include "propagation/experiment.h"
#include "propagation/parallel.h"

namespace gumshoe::propagation {

struct Progress {
  std::uint64_t done = 0, total = 0;
};

/// Draws and evaluates a block, samples [first, last).
using MakeBlock = std::function<ResultBlock(std::uint64_t first, std::uint64_t last)>;

struct RunSettings {
  int threads = 0;                         ///< 0: all processors
  std::uint64_t first = 0;                 ///< resume here; a multiple of the block size or 0
  std::uint64_t last = 0;                  ///< end here; 0: the scenario's number of samples
  const std::atomic<bool>* stop = nullptr; ///< set from a signal handler: finish the blocks under way, then return
  std::function<void(const Progress&)> progress; ///< called in order, from one thread at a time
  std::vector<MakeBlock> elsewhere; ///< other processes, each of which makes a block at a time besides these threads
};

/// Samples per block of a model that does not say how many it likes in a call (Model::block). Numbers do not depend on
/// it.
inline constexpr std::size_t block_samples = 2048;

/// Draws and evaluates samples [first, last) and hands them to the sink in order.
/// Returns the number of samples done (fewer than asked for if stopped). Where the model throws, every block before
/// the one that failed has been handed to the sink; then the exception goes on.
std::uint64_t propagate(const Experiment& experiment, Sink& sink, const RunSettings& settings);

/// What makes the blocks of propagate(). Several threads may call it at once; the experiment must outlive it.
MakeBlock block_maker(const Experiment& experiment);

/// Draws the variates of a run again: called with (first, count, values), it writes samples [first, first + count) of
/// every variate, SI: values[variate * count + i].
std::function<void(std::uint64_t, std::size_t, double*)> variate_draws(const Experiment& experiment);

/// The variates of one sample, as in the run. For replay.
std::vector<double> variates_of(const Experiment& experiment, std::uint64_t sample);

quantities::PointSet point_set(scenario::Design design);

} // namespace gumshoe::propagation
