#pragma once
/// Shards: parts of a run's samples and of its studies' model runs, computed by processes that share nothing. `run
/// --shard` makes them, `merge` joins them.
#include <string>
#include <vector>

#include "cli/requested_run.h"
#include "propagation/propagate.h"
#include "propagation/shard.h"

namespace gumshoe::cli {

/// What a shard does of a run.
struct ShardPart {
  propagation::SampleRange samples;
  std::vector<propagation::Work> studies;       ///< of the whole run
  std::vector<propagation::Portion> portions{}; ///< its units of them
  ShardPart(const propagation::Experiment& experiment, const propagation::Shard& shard);
};

/// Turns the identity of a run into that of its shard "3/16". Returns what the shard does. Throws InputError: no shard,
/// fewer samples than shards, an adaptive run.
ShardPart make_shard(const propagation::Experiment& experiment, store::Identity& identity, const std::string& shard,
                     const RunRequest& request);

/// Ending of a result's name: ".h5", of a shard ".3-of-16.h5".
std::string ending_of(const std::string& shard);

/// Draws the samples of the shard and does the units of studies that its file does not have yet. False: a signal came
/// first. Throws Interrupted likewise.
bool compute_shard(const propagation::Experiment& experiment, const ShardPart& part, store::ResultFile& file,
                   propagation::RunSettings settings);

/// Says what the file holds.
void print_shard(const store::Identity& identity, const ShardPart& part, std::uint64_t samples,
                 const store::ResultFile& file, const std::string& out);

/// Throws InputError where a command needs a whole run.
void refuse_shard(const store::Identity& identity, const std::string& file);
/// Throws InputError if the scenario of a result is not where the result says, seen from the present folder.
void require_scenario(const store::Identity& identity, const std::string& file, const std::string& or_else = "");

/// What made a finished result. Throws InputError if it is a shard, or was interrupted.
store::Identity require_finished(const std::string& file);

/// All shards of one run, finished and sound.
struct ShardSet {
  store::Identity identity; ///< of any of them
  std::uint64_t of = 0;
  std::vector<std::string> files; ///< in the order of the run
};

/// Finds them among files in any order. Throws InputError with a problem for each file that is of no use and for the
/// shards that are missing, after the commands that make these were printed on standard output.
ShardSet gather_shards(const std::vector<std::string>& files);

/// These threads, and what the shards know of studies.
propagation::Workers workers_of(const propagation::Experiment& experiment, const ShardSet& shards, int threads);

} // namespace gumshoe::cli
