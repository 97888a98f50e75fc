/// `gumshoe run`: samples, analysis, result file.
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "analysis/analyse.h"
#include "analysis/selection.h"
#include "analysis/stopping.h"
#include "base/interrupt.h"
#include "cli/command.h"
#include "cli/print.h"
#include "cli/progress_line.h"
#include "propagation/propagate.h"
#include "store/result_file.h"

namespace gumshoe::cli {

namespace {

struct Options {
  std::string file, out, format = "text";
  std::optional<std::string> samples, seed;
  int threads = 0;
  bool force = false, budget = false, all = false, predict = false;
};

/// The options of an adaptive run that determine its results, in addition to the scenario.
std::string adaptive_text(const scenario::Adaptive& a) {
  if (a.rule == scenario::StoppingRule::fixed) return {};
  return fmt::format("{} {} {}", name(a.rule), a.digits, a.most);
}

/// Draws the samples, as many as asked for or until the stopping rule is satisfied. False: a signal came first. A model
/// that stops the run (a command that dies) leaves what was done: that is said.
bool sample(scenario::Scenario& s, const propagation::Experiment& e, store::ResultFile& file,
            const propagation::RunSettings& settings, const std::string& out, analysis::StoppingRecord& stopping) {
  try {
    if (s.run.adaptive.rule == scenario::StoppingRule::fixed)
      return propagation::propagate(e, file, settings) == s.run.samples;
    bool stopped = false;
    stopping = analysis::run_adaptively(e, file, settings, stopped);
    s.run.samples = file.samples();
    return !stopped;
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

/// When, where and how long: of a file that is to be reproduced byte by byte (SOURCE_DATE_EPOCH) only the given time.
void stamp(analysis::Results& r, std::time_t started, std::chrono::steady_clock::time_point began) {
  r.date = date_text(started);
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  char name[256] = {};
  if (gethostname(name, sizeof name - 1) == 0) r.host = name;
  r.duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// A scenario that measures nothing is asked for its readings. They may be many: as many samples as fit in 400 MB.
void predict(scenario::Scenario& s, const Options& o) {
  const models::Model* model = s.made ? s.made.get() : models::find(s.model);
  const bool measures = !scenario::evaluated_card(*model->card, s.evaluation).measurands.empty();
  if (measures && !o.predict) return;
  predict_readings(s);
  if (!measures && !o.predict) s.notes.push_back("no measurands: the readings are predicted");
  if (o.samples) return;
  constexpr std::uint64_t most_values = 50'000'000, least = 10'000;
  const std::uint64_t values = s.readings.size() * model->card->indications.size(), stated = s.run.samples;
  while (s.run.samples * values > most_values && s.run.samples / 10 >= least) s.run.samples /= 10;
  if (s.run.samples != stated)
    s.notes.push_back(fmt::format("{} samples instead of {}, for {} readings; --samples sets them", s.run.samples,
                                  stated, s.readings.size()));
}

ExitCode run(const Options& o) {
  const auto began = std::chrono::steady_clock::now();
  const std::time_t started = std::time(nullptr);
  scenario::Scenario s = scenario::read(o.file, catalogue());
  if (o.samples) {
    s.run.samples = whole_number(*o.samples, "--samples", 2, "1e6");
    s.run.adaptive = {}; // the number is given
  }
  if (s.run.adaptive.rule != scenario::StoppingRule::fixed)
    s.run.samples = propagation::block_samples; // room is made as the run goes
  if (o.seed) s.run.seed = whole_number(*o.seed, "--seed", 0, "1");
  predict(s, o);
  const propagation::Experiment experiment(s);
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".h5");

  store::Identity identity = store::identity_of(s);
  identity.adaptive = adaptive_text(s.run.adaptive);
  identity.design_hash = propagation::design_hash(experiment);
  store::ResultFile file(out, identity, experiment.outputs(), experiment.place_names(), o.force);

  if (!file.remark().empty()) std::cerr << file.remark() << '\n';

  propagation::RunSettings settings;
  settings.threads = o.threads;
  settings.first = file.samples_done();
  settings.stop = &interrupted();
  ProgressLine line;
  settings.progress = [&](const propagation::Progress& p) { line.show("sampling", p.done, p.total, "samples/s"); };
  if (settings.first > 0) std::cerr << fmt::format("resuming after {} samples\n", settings.first);
  when_interrupted("The samples so far are kept. Repeat the command to resume.");
  analysis::StoppingRecord stopping;
  if (!sample(s, experiment, file, settings, out, stopping)) {
    line.clear();
    std::cerr << fmt::format("interrupted after {} of {} samples. Repeat the command to resume.\n", file.samples_done(),
                             s.run.samples);
    return ExitCode::interrupted;
  }
  const StudyProgress studies(line);
  const analysis::Samples samples{[&](std::size_t output) { return file.read(output, 0, s.run.samples); },
                                  [&] { return file.read_status(0, s.run.samples); }};
  analysis::Results results = analysis::analyse(experiment, samples, o.threads);
  results.stopping = stopping;
  stamp(results, started, began);
  analysis::keep_measurands(results, s.analysis.measurands);
  file.finish(results);
  line.clear();
  return print_results(results, out, {o.format, o.budget, o.all, s.run.max_failed_share});
}

} // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("run", "runs a scenario and writes its result file");
  const auto o = std::make_shared<Options>();
  command->add_option("scenario", o->file, "scenario file (TOML)")->required();
  command->add_option("--samples", o->samples, "instead of the scenario's, e.g. 1e6");
  command->add_option("--seed", o->seed, "instead of the scenario's");
  command->add_option("--threads", o->threads, "0: all processors")->check(CLI::Range(0, 1024));
  command->add_option("--out", o->out, "result file (default: results/SCENARIO.h5)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--format", o->format, "text, csv or json")->check(CLI::IsMember({"text", "csv", "json"}));
  command->add_flag("--budget", o->budget, "text: with the uncertainty budgets; csv: these instead of the summary");
  command->add_flag("--predict", o->predict,
                    "the readings as they are expected, before they are taken, instead of the measurands");
  command->add_flag("--all", o->all, "text: every output, where one line would stand for many readings");
  command->callback([=, &action] { action = [=] { return run(*o); }; });
}

} // namespace gumshoe::cli
