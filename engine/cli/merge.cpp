/// `gumshoe merge`: the shards of a run or a choice become its result.
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "analysis/studies.h"
#include "base/interrupt.h"
#include "cli/command.h"
#include "cli/requested_choice.h"
#include "store/stored_samples.h"

namespace gumshoe::cli {

namespace {

struct MergeOptions {
  std::vector<std::string> files;
  std::string scenario, out;
  PrintOptions print;
  int threads = 0;
  bool force = false;
};

/// The scenario must be, with its data, the one that the shards were made of.
/// @param file one of them
scenario::Scenario scenario_of_shards(const store::Identity& shard, const std::string& file, const std::string& other) {
  if (other.empty()) require_scenario(shard, file, ", or name it with --scenario");
  const auto read = shard.command == choice_shard_command ? &scenario_of_choice : &scenario_of_run;
  scenario::Scenario s =
      read(other.empty() ? shard.scenario_file : other, RunRequest::of(shard.options), {.external = shard.external});
  if (s.hash != shard.scenario_hash)
    throw InputError(s.file + ": not the scenario of these shards",
                     "its hash is " + s.hash + ", that of the shards " + shard.scenario_hash,
                     "restore the scenario and its data, or make the shards again");
  return s;
}

/// What the record of the shards says of the model and of their samples must hold for the run.
void require_same_design(const propagation::Experiment& experiment, const store::Identity& run,
                         const ShardSet& shards) {
  if (run.design_hash != shards.identity.design_hash)
    throw InputError("the shards have another design than " + run.scenario_file,
                     "design hash " + shards.identity.design_hash + ", the scenario has " + run.design_hash,
                     "make the shards again");
  const std::vector<propagation::Work> studies = analysis::studies_of(experiment);
  for (std::size_t k = 0; k < shards.files.size(); ++k) {
    const propagation::Shard shard{k + 1, shards.of};
    const store::Identity there = store::read_identity(shards.files[k]).identity;
    if (there.samples != shard.samples(run.samples).size() ||
        there.study_values != propagation::values_of(shard.portions(studies), studies))
      throw InputError(shards.files[k] + ": the shard has another number of samples than its part of the run", "",
                       "make the shard again");
  }
}

ExitCode merge(const MergeOptions& o) {
  const Begun begun;
  const ShardSet shards = gather_shards(o.files);
  const scenario::Scenario s = scenario_of_shards(shards.identity, shards.files.front(), o.scenario);
  if (shards.identity.command == choice_shard_command) {
    const std::string out = choice_output(o.out, s.file, "");
    return complete_choice(s, workers_of_choice(s, shards, o.threads), out, o.print.format, o.force);
  }
  const propagation::Experiment experiment(s, propagation::Trial::made_elsewhere);
  const store::Identity identity = identity_of_run(experiment);
  require_same_design(experiment, identity, shards);
  const std::string out = !o.out.empty() ? o.out : default_output(s.file, ".h5");

  store::ResultFile file(out, identity, experiment.outputs(), experiment.place_names(), o.force);
  if (!file.remark().empty()) std::cerr << file.remark() << '\n';
  when_interrupted("The shards are unchanged. The same command goes on.");
  ProgressLine line;
  for (std::uint64_t k = 1; k <= shards.of; ++k) {
    const propagation::SampleRange part = propagation::Shard{k, shards.of}.samples(s.run.samples);
    line.show("merging", part.first, s.run.samples, "samples/s");
    store::append_samples(file, store::StoredSamples(shards.files[k - 1], experiment.outputs()),
                          experiment.outputs().size(), part.first, part.last);
  }
  return complete_run(experiment, file, {}, begun, out, workers_of(experiment, shards, o.threads), o.print, line);
}

} // namespace

void add_merge(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("merge", "joins the shards of a run or a choice and writes its result file");
  const auto o = std::make_shared<MergeOptions>();
  command->add_option("shards", o->files, "files of gumshoe run --shard or gumshoe choose --shard, in any order")
      ->required();
  command->add_option("--scenario", o->scenario, "instead of the place that the shards name; the same scenario");
  command->add_option("-o,--out", o->out,
                      "result file (default: results/SCENARIO.h5, of a choice results/SCENARIO.choose.h5)");
  add_threads(*command, o->threads);
  add_force(*command, o->force);
  add_external(*command);
  add_print(*command, o->print);
  command->callback([=, &action] { action = [=] { return merge(*o); }; });
}

} // namespace gumshoe::cli
