/// `gumshoe choose`: which settings measure within a target expanded uncertainty in the least time?
#include <memory>

#include <fmt/format.h>

#include "base/version.h"
#include "choice/candidates.h"
#include "cli/command.h"
#include "cli/ranks.h"
#include "cli/requested_choice.h"

namespace gumshoe::cli {

namespace {

struct ChooseOptions {
  std::string file, out, shard, format = "text";
  RunRequest request;
  int threads = 0;
  bool force = false;
};

/// What fixes the figures of the candidates, for ranks to compare.
std::string same_choice(const scenario::Scenario& s) {
  return fmt::format("scenario {}, seed {}, {} samples, version {}", s.hash, s.run.seed, s.choose->samples, version);
}

/// What a rank other than the first does: it assesses candidates.
Offer offer(const ChooseOptions& o) {
  const auto s = std::make_shared<const scenario::Scenario>(scenario_of_choice(o.file, o.request));
  const propagation::Work grid = choice::assessment_work(*s, choice::coarse_places(*s));
  return {same_choice(*s), {{}, [s, grid](const std::string& name) {
                              return name == grid.name ? grid : choice::assessment_work(*s, name);
                            }}};
}

ExitCode choose(const ChooseOptions& o) {
  auto ranks = o.shard.empty() ? propagation::Ranks::join() : nullptr; // shards share nothing
  if (ranks && !ranks->first()) return help_first_rank(*ranks, o.threads, [&] { return offer(o); });
  const scenario::Scenario s = scenario_of_choice(o.file, o.request);
  const std::string out = choice_output(o.out, o.file, o.shard);
  if (!o.shard.empty()) return choose_shard(s, o.shard, o.request, out, o.threads, o.force);
  propagation::Workers workers(ranks ? ranks->threads(o.threads) : o.threads);
  if (ranks) workers.elsewhere = ranks->begin(same_choice(s)).units;
  return complete_choice(s, workers, out, o.format, o.force);
}

} // namespace

void add_choose(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("choose", "finds the fastest settings that reach a target expanded uncertainty ([choose])");
  const auto o = std::make_shared<ChooseOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML) with [choose]")->required();
  command->add_option("--samples", o->request.samples, "samples per candidate, instead of the scenario's, e.g. 1e4");
  command->add_option("--seed", o->request.seed, "instead of the scenario's");
  add_threads(*command, o->threads);
  auto* shard = command->add_option("--shard", o->shard,
                                    "3/16: the third of sixteen parts of the coarse grid, for gumshoe merge");
  command->add_option("-o,--out", o->out, "result file (default: results/SCENARIO.choose.h5)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--format", o->format, "text, csv or json")->check(CLI::IsMember({"text", "csv", "json"}));
  shard->excludes("--format"); // it has no result to print
  command->callback([=, &action] { action = [=] { return choose(*o); }; });
}

} // namespace gumshoe::cli
