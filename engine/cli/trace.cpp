/// `gumshoe trace`: what is left after the model is fitted, and which effect that the scenario lacks explains it?
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <malloc.h>
#include <nlohmann/json.hpp>

#include "base/interrupt.h"
#include "base/json_text.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/generator.h"
#include "cli/print_trace.h"
#include "cli/progress_line.h"
#include "cli/trace_history.h"
#include "cli/trace_rounds.h"
#include "cli/traced_budgets.h"
#include "store/origin.h"
#include "store/trace_file.h"
#include "tracing/findings/verdict_json.h"

namespace gumshoe::cli {

namespace {

struct TraceOptions {
  std::string file, data, out, json, report, history, format = "text";
  std::optional<std::string> draws, seed;
  int threads = 0, loop = 1;
  bool force = false;
};

/// The scenario with what the command line says otherwise.
scenario::Scenario asked(const TraceOptions& o) {
  scenario::Scenario s = scenario::read(o.file, catalogue(), {o.data});
  if (o.draws) s.trace.draws = static_cast<int>(whole_number(*o.draws, "--draws", 19, "999", 1'000'000));
  if (o.seed) s.trace.seed = whole_number(*o.seed, "--seed", 0, "1");
  return s;
}

/// Every file that will be written, claimed before the work and not after it.
struct Outputs {
  store::Origin origin;
  store::Claim result, scenario, json, report;
};

Outputs claimed_outputs(const TraceOptions& o, const scenario::Scenario& s) {
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".traced.h5");
  const std::filesystem::path name = std::filesystem::path(o.file).stem();
  const std::string scenario = (std::filesystem::path(out).parent_path() / name).string() + ".traced.toml";
  const auto text = [&](const std::string& path, const char* command) {
    return path.empty() ? store::Claim() : store::claim_text(path, store::origin_of(s, command, o.force));
  };
  if (!o.report.empty()) generator_script();
  const store::Origin origin = store::origin_of(s, "trace", o.force);
  return {origin, store::claim_result(out, origin), text(scenario, "trace"), text(o.json, "trace"),
          text(o.report, "report")};
}

/// Adds the scenario with what was found, and fills the budgets of both. Without one an older one is removed, since it
/// would tell of other data.
void close_loop(const scenario::Scenario& s, const std::string& text, const Outputs& out, store::Draft& draft,
                store::TracedBudgets& budgets) {
  if (text.empty()) return draft.remove(out.scenario);
  {
    store::Draft trial; // ends before the file itself is drafted
    budgets = traced_budgets(s, scenario::read(trial.add(out.scenario, text), catalogue()));
  }
  draft.add(out.scenario, store::signed_scenario(text, out.origin));
}

/// The verdict with the rounds and the history, and with the signature by which the file may be replaced.
std::string signed_verdict(const Rounds& rounds, const History& history, const store::Origin& origin) {
  auto verdict = nlohmann::ordered_json::parse(tracing::verdict_json(rounds.first));
  const auto number = [](double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(); };
  for (const Round& r : rounds.table)
    verdict["rounds"].push_back({{"added", r.added},
                                 {"before", number(r.rms.before)},
                                 {"after", number(r.rms.after)},
                                 {"holdout_before", number(r.rms.holdout_before)},
                                 {"holdout_after", number(r.rms.holdout_after)},
                                 {"holdout_noise", number(r.rms.holdout_noise)},
                                 {"holdout_after_winsorised", number(r.rms.holdout_after_winsorised)},
                                 {"noise", number(r.rms.noise)},
                                 {"replicate_floor", number(r.rms.replicate_floor)},
                                 {"vetoed", r.vetoed}});
  if (history) verdict["history"] = history.json();
  verdict["made_by"] = store::signature(origin);
  return json_text(verdict) + '\n';
}

ExitCode trace(const TraceOptions& o) {
  // Matrices of megabytes come and go by the thousand: their pages are kept.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const scenario::Scenario s = asked(o);
  Outputs outputs = claimed_outputs(o, s);
  const std::string out = outputs.result.path();
  if (!outputs.result.remark.empty()) std::cerr << outputs.result.remark << '\n';
  const ModelCard& card = s.made ? *s.made->card : *models::find(s.model)->card;
  History history(o.history, s, card);
  ProgressLine line;
  const StudyProgress studies(line);
  const Rounds rounds = trace_rounds(s, {o.threads, progress::stage, bool(history)}, outputs.scenario, o.loop);
  line.clear();
  store::TracedBudgets budgets;
  store::Draft draft;
  close_loop(s, rounds.text, outputs, draft, budgets);
  store::write_trace(draft, outputs.result, s, card, rounds.first, budgets, rounds.table);
  std::vector<std::string> written{out};
  store::Draft with_report; // a history that has these readings refuses them, so that it appears last
  if (history) history.append(rounds.first, o.report.empty() ? draft : with_report);
  const std::string verdict = signed_verdict(rounds, history, outputs.origin);
  if (!o.json.empty()) {
    draft.add(outputs.json, verdict);
    written.push_back(o.json);
  }
  draft.publish();
  ExitCode code = ExitCode::done;
  if (!o.report.empty()) {
    when_interrupted(history ? "The result is written, its report is not, and nothing is appended. The same command "
                               "starts from the beginning."
                             : "The result is written, its report is not: gumshoe report makes it.");
    { const store::Claim done = std::move(outputs.report); } // the generator claims it
    code = generate({out, "--out", o.report, "--page-only", "--force"});
    if (code == ExitCode::done)
      written.push_back(o.report);
    else
      std::cerr << fmt::format("the result is written, its report is not: gumshoe report {} --out {} makes it\n", out,
                               o.report);
    with_report.publish();
  }
  if (o.format == "json")
    std::cout << verdict;
  else
    print_trace(rounds.first, s.title, written, rounds.text.empty() ? "" : outputs.scenario.path());
  if (o.format != "json" && o.loop > 1) std::cout << table(rounds.table);
  if (o.format != "json" && history) std::cout << history.text(s.trace.alpha);
  return code;
}

} // namespace

void add_trace(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("trace", "finds what is missing from the model, from the residuals ([trace])");
  const auto o = std::make_shared<TraceOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML) with readings")->required();
  command->add_option("--data", o->data, "CSV file with readings, instead of the files named in the scenario");
  command->add_option("-o,--out", o->out, "result file (default: results/SCENARIO.traced.h5)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--json", o->json, "file for the verdict");
  command->add_option("--report", o->report, "file for the report, one HTML page");
  command->add_option("--draws", o->draws, "data sets of the bootstrap, instead of the scenario's number");
  command->add_option("--seed", o->seed, "seed of the bootstrap, instead of the scenario's");
  command->add_option("--loop", o->loop, "traces again what was written, until nothing is added, at most so many times")
      ->check(CLI::Range(1, 20));
  command->add_option("--append", o->history, "history file, to which the evidence of these readings is added");
  add_threads(*command, o->threads);
  command->add_option("--format", o->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  command->callback([=, &action] { action = [=] { return trace(*o); }; });
}

} // namespace gumshoe::cli
