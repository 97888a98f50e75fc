#pragma once
/// What `choose` and `merge` share: the choice that was asked for, its shards, and its end.
#include <string>

#include "cli/requested_run.h"
#include "cli/shards.h"
#include "propagation/work.h"
#include "scenario/scenario.h"
#include "store/draft.h"

namespace gumshoe::cli {

/// The command in the identity of its shards.
inline constexpr const char* choice_shard_command = "choose --shard";

/// The scenario of a file as the choice takes it: samples of the request are those of each candidate.
scenario::Scenario scenario_of_choice(const std::string& file, const RunRequest& request,
                                      const scenario::Overrides& overrides = {});

/// Does the candidates of the coarse grid that are the shard's, or those that its file does not have yet.
ExitCode choose_shard(const scenario::Scenario& scenario, const std::string& shard, const RunRequest& request,
                      const std::string& out, int threads, bool force);
/// These threads, and what the shards know of the coarse grid. Throws InputError for shards of another grid.
propagation::Workers workers_of_choice(const scenario::Scenario& scenario, const ShardSet& shards, int threads);

/// Where the choice is written unless told otherwise.
std::string choice_output(const std::string& out, const std::string& scenario, const std::string& shard);
/// Chooses, writes the file and prints the result.
ExitCode complete_choice(const scenario::Scenario& scenario, const propagation::Workers& workers,
                         const std::string& out, const std::string& format, bool force);

} // namespace gumshoe::cli
