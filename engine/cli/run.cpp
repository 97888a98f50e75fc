/// `gumshoe run`: samples, analysis, result file; or one shard of the samples.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "analysis/stopping.h"
#include "analysis/studies.h"
#include "base/interrupt.h"
#include "cli/command.h"
#include "cli/ranks.h"
#include "cli/recomputed.h"
#include "cli/requested_run.h"
#include "cli/shards.h"
#include "propagation/propagate.h"
#include "store/earlier_result.h"

namespace gumshoe::cli {

namespace {

struct RunOptions {
  std::string file, out, shard;
  RunRequest request;
  PrintOptions print;
  int threads = 0;
  bool force = false;
};

/// Calls `draw`, which says whether all samples came. False: a signal came first. A model that stops the run (a command
/// that dies) leaves what was done: that is said.
template <class Draw> bool keeping(const store::ResultFile& file, const std::string& out, const Draw& draw) {
  try {
    return draw();
  } catch (const Interrupted&) {
    return false;
  } catch (const OutputError&) {
    throw;
  } catch (const InputError& error) {
    auto problems = error.problems();
    problems.back().remedy +=
        fmt::format("{}{} of {} samples are kept in {}. Repeat the command to resume",
                    problems.back().remedy.empty() ? "" : ". ", file.samples_done(), file.samples(), out);
    throw InputError(problems);
  }
}

/// Draws the samples, as many as asked for or until the stopping rule is satisfied.
bool sample(scenario::Scenario& s, const propagation::Experiment& e, store::ResultFile& file,
            const propagation::RunSettings& settings, analysis::StoppingRecord& stopping) {
  if (s.run.adaptive.rule == scenario::StoppingRule::fixed)
    return propagation::propagate(e, file, settings) == s.run.samples;
  bool stopped = false;
  stopping = analysis::run_adaptively(e, file, settings, stopped);
  s.run.samples = file.samples();
  return !stopped;
}

/// What fixes the samples of a run, for ranks to compare.
std::string same_run(const store::Identity& i) {
  return fmt::format("scenario {}, design {}, seed {}, {} samples, version {}", i.scenario_hash, i.design_hash, i.seed,
                     i.samples, i.version);
}

/// The run of a rank other than the first.
struct RankRun {
  scenario::Scenario scenario;
  propagation::Experiment experiment;
  std::vector<propagation::Work> studies;
  explicit RankRun(const RunOptions& o)
      : scenario(scenario_of_run(o.file, o.request)), experiment(scenario), studies(analysis::studies_of(experiment)) {}
};

Offer offer(const RunOptions& o) {
  const auto run = std::make_shared<const RankRun>(o);
  return {same_run(identity_of_run(run->experiment)),
          {propagation::block_maker(run->experiment), [run](const std::string& name) {
             return *std::ranges::find(run->studies, name, &propagation::Work::name);
           }}};
}

/// How far the file has come, in words.
std::string progress_of(const store::ResultFile& file, const store::Identity& identity) {
  std::string text = fmt::format("{} of {} samples", file.samples_done(), file.samples());
  if (file.study_values_done() > 0)
    text += fmt::format(" and {} of {} values of studies", file.study_values_done(), identity.study_values);
  return text;
}

/// A run that goes on with another model, or with another file that its program reads, would mix both.
void require_same_model(const propagation::Experiment& e, const store::ResultFile& file, std::uint64_t begin,
                        const std::string& out) {
  const auto read = [&](std::size_t output, std::uint64_t first, std::uint64_t count) {
    return file.read(output, first - begin, count);
  };
  const Same same = e.scenario().external.empty() ? Same::bits : Same::rounding;
  const std::string how = first_difference(e, {{begin, begin + file.samples_done()}, read}, same);
  if (!how.empty())
    throw InputError(out + ": the samples there come from another model", how,
                     "restore what the model was then, or remove the file to start again");
}

ExitCode run(const RunOptions& o) {
  const Begun begun;
  auto ranks = o.shard.empty() ? propagation::Ranks::join() : nullptr; // shards share nothing
  if (ranks && !ranks->first()) return help_first_rank(*ranks, o.threads, [&] { return offer(o); });
  scenario::Scenario s = scenario_of_run(o.file, o.request);
  const propagation::Experiment experiment(s);
  store::Identity identity = identity_of_run(experiment);
  propagation::RunSettings settings;
  settings.threads = ranks ? ranks->threads(o.threads) : o.threads;
  propagation::Workers workers(settings.threads);
  if (ranks) {
    propagation::Help help = ranks->begin(same_run(identity));
    settings.elsewhere = std::move(help.blocks);
    workers.elsewhere = std::move(help.units);
  }
  std::optional<ShardPart> part;
  if (!o.shard.empty()) part = make_shard(experiment, identity, o.shard, o.request);
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ending_of(identity.shard));
  store::ResultFile file(out, identity, experiment.outputs(), experiment.place_names(), o.force);
  if (!file.remark().empty()) std::cerr << file.remark() << '\n';

  const std::uint64_t begin = part ? part->samples.first : 0;
  settings.first = begin + file.samples_done();
  settings.stop = &interrupted();
  ProgressLine line;
  settings.progress = [&](const propagation::Progress& p) {
    line.show("sampling", p.done - begin, p.total - begin, "samples/s");
  };
  const bool finished =
      part && file.samples_done() == file.samples() && file.study_values_done() == identity.study_values;
  if (file.samples_done() > 0 && !finished) {
    require_same_model(experiment, file, begin, out);
    std::cerr << fmt::format("resuming after {} samples\n", file.samples_done());
  }
  when_interrupted("The samples so far are kept. Repeat the command to resume.");
  analysis::StoppingRecord stopping;
  const bool whole = keeping(file, out, [&] {
    if (!part) return sample(s, experiment, file, settings, stopping);
    const StudyProgress studies(line);
    return compute_shard(experiment, *part, file, settings);
  });
  if (!whole) {
    line.clear();
    std::cerr << fmt::format("interrupted after {}{}. Repeat the command to resume.\n", progress_of(file, identity),
                             store::said_of_earlier(out));
    return ExitCode::interrupted;
  }
  if (!part) return complete_run(experiment, file, stopping, begun, out, workers, o.print, line);
  line.clear();
  print_shard(identity, *part, s.run.samples, file, out);
  return ExitCode::done;
}

} // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("run", "runs a scenario and writes its result file");
  const auto o = std::make_shared<RunOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML)")->required();
  command->add_option("--samples", o->request.samples, "instead of the scenario's, e.g. 1e6");
  command->add_option("--seed", o->request.seed, "instead of the scenario's");
  add_threads(*command, o->threads);
  auto* shard =
      command->add_option("--shard", o->shard, "3/16: the third of sixteen parts of the work, for gumshoe merge");
  command->add_option("-o,--out", o->out, "result file (default: results/SCENARIO.h5)");
  add_force(*command, o->force);
  add_external(*command);
  add_print(*command, o->print);
  shard->excludes("--format", "--budget", "--all"); // it has no result to print
  command->add_flag("--predict", o->request.predict,
                    "the readings as they are expected, before they are taken, instead of the measurands");
  command->callback([=, &action] { action = [=] { return run(*o); }; });
}

} // namespace gumshoe::cli
