/// `gumshoe run`: samples, analysis, result file.
#include <atomic>
#include <chrono>
#include <csignal>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "analysis/analyse.h"
#include "analysis/stopping.h"
#include "cli/command.h"
#include "cli/print.h"
#include "propagation/propagate.h"
#include "store/result_file.h"

namespace gumshoe::cli {

namespace {

struct Options {
  std::string file, out, format = "text";
  std::optional<std::string> samples, seed;
  int threads = 0;
  bool force = false;
};

std::atomic<bool> stop{false};
void on_signal(int) { stop = true; }

/// One line on stderr, rewritten: rate, share, time left. Silent when stderr is no terminal.
class ProgressLine {
public:
  void operator()(const propagation::Progress& p) {
    if (!terminal_) return;
    const auto now = std::chrono::steady_clock::now();
    if (first_ == 0) first_ = p.done, started_ = now;
    if (p.done < p.total && now - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = now;
    const double seconds = std::chrono::duration<double>(now - started_).count();
    const double rate = seconds > 0 ? static_cast<double>(p.done - first_) / seconds : 0;
    std::cerr << fmt::format("\r{:5.1f} %  {:.3g} samples/s  {:.0f} s left   ",
                             100.0 * static_cast<double>(p.done) / static_cast<double>(p.total), rate,
                             rate > 0 ? static_cast<double>(p.total - p.done) / rate : 0)
              << (p.done == p.total ? "\n" : "") << std::flush;
  }

private:
  bool terminal_ = isatty(2) != 0;
  std::uint64_t first_ = 0;
  std::chrono::steady_clock::time_point started_, shown_;
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

ExitCode run(const Options& o) {
  scenario::Scenario s = scenario::read(o.file, catalogue());
  if (o.samples) {
    s.run.samples = whole_number(*o.samples, "--samples", 2);
    s.run.adaptive = {}; // the number is given
  }
  if (s.run.adaptive.rule != scenario::StoppingRule::fixed)
    s.run.samples = propagation::block_samples; // room is made as the run goes
  if (o.seed) s.run.seed = whole_number(*o.seed, "--seed", 0);
  const propagation::Experiment experiment(s);
  if (experiment.outputs().empty())
    throw InputError(
        {{{s.file}, "model: there is nothing to measure", "a run evaluates measurands", "add [model.measurands]"}});
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".h5");

  store::Identity identity = store::identity_of(s);
  identity.adaptive = adaptive_text(s.run.adaptive);
  identity.design_hash = propagation::design_hash(experiment);
  store::ResultFile file(out, identity, experiment.outputs(), experiment.place_names(), o.force);

  if (!file.remark().empty()) std::cerr << file.remark() << '\n';

  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  propagation::RunSettings settings;
  settings.threads = o.threads;
  settings.first = file.samples_done();
  settings.stop = &stop;
  settings.progress = [line = ProgressLine()](const propagation::Progress& p) mutable { line(p); };
  if (settings.first > 0) std::cerr << fmt::format("resuming after {} samples\n", settings.first);
  analysis::StoppingRecord stopping;
  if (!sample(s, experiment, file, settings, out, stopping)) {
    const std::uint64_t done = file.samples_done();
    std::cerr << fmt::format("\ninterrupted after {} of {} samples. Repeat the command to resume.\n", done,
                             s.run.samples);
    return ExitCode::interrupted;
  }
  const analysis::Samples samples{[&](std::size_t output) { return file.read(output, 0, s.run.samples); },
                                  [&] { return file.read_status(0, s.run.samples); }};
  analysis::Results results = analysis::analyse(experiment, samples, o.threads);
  results.stopping = stopping;
  file.finish(results);
  return print_results(results, out, o.format, s.run.max_failed_share);
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
  command->add_option("--format", o->format, "text, csv or json")->check(CLI::IsMember({"text", "csv", "json"}));
  command->callback([=, &action] { action = [=] { return run(*o); }; });
}

} // namespace gumshoe::cli
