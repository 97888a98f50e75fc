/// `gumshoe trace`: what is left after the model is fitted, and which effect that the scenario lacks explains it?
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/generator.h"
#include "cli/print_trace.h"
#include "cli/traced_budgets.h"
#include "store/result_file.h"
#include "store/trace_file.h"
#include "tracing/findings/verdict_json.h"
#include "tracing/scenario_out/traced_scenario.h"

namespace gumshoe::cli {

namespace {

struct Options {
  std::string file, data, out, json, report, format = "text";
  std::optional<std::string> draws, seed;
  int threads = 0;
};

/// The scenario with what the command line says otherwise.
scenario::Scenario asked(const Options& o) {
  scenario::Scenario s = scenario::read(o.file, catalogue(), {o.data});
  if (o.draws)
    s.trace.draws = static_cast<int>(std::min<std::uint64_t>(whole_number(*o.draws, "--draws", 19), 1'000'000));
  if (o.seed) s.trace.seed = whole_number(*o.seed, "--seed", 0);
  return s;
}

/// A scenario that an earlier trace wrote.
bool ours(const std::string& path) {
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  return text.find("# Written by gumshoe ") != std::string::npos;
}

struct Outputs {
  std::string result, scenario;
};

/// Every file that will be written, checked before the work and not after it.
Outputs checked_outputs(const Options& o) {
  const std::string name = std::filesystem::path(o.file).stem().string();
  const std::string out = !o.out.empty() ? o.out : "results/" + name + ".traced.h5";
  const std::string scenario = (std::filesystem::path(out).parent_path() / (name + ".traced.toml")).string();
  if (o.out.empty()) std::filesystem::create_directories("results");
  if (std::filesystem::exists(scenario) && !ours(scenario))
    throw OutputError(scenario + ": the file exists and was not written by gumshoe",
                      "the traced scenario would replace it");
  for (const std::string& path : {out, o.json, o.report})
    if (path == scenario)
      throw OutputError(path + ": the traced scenario is written to this file",
                        "two outputs cannot have the same name");
  for (const std::string& path : {out, o.json, o.report, scenario}) {
    if (path.empty()) continue;
    require_different(path, o.file);
    if (!o.data.empty()) require_different(path, o.data);
  }
  store::require_writable(out);
  for (const std::string& path : {o.json, o.report}) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    if (!path.empty() && !folder.empty() && !std::filesystem::is_directory(folder))
      throw OutputError(path + ": cannot be written", "no folder '" + folder.string() + "'");
  }
  return {out, scenario};
}

/// Writes the scenario with what was found, and fills the budgets of both. False if there is none; an older one is
/// removed, since it would tell of other data.
bool close_loop(const scenario::Scenario& s, tracing::Trace& found, const std::string& path,
                store::TracedBudgets& budgets) {
  const std::string text = tracing::traced_scenario(s, found, std::filesystem::path(path).parent_path().string());
  if (text.empty()) {
    std::filesystem::remove(path);
    return false;
  }
  write_text(path, text);
  try {
    budgets = traced_budgets(s, scenario::read(path, catalogue()));
  } catch (const InputError& error) {
    std::filesystem::remove(path);
    for (const Problem& p : error.problems())
      found.statements.push_back("no traced scenario is written, because it could not be read: " + p.what +
                                 (p.why.empty() ? "" : " (" + p.why + ")"));
    return false;
  }
  return true;
}

/// One line on stderr, rewritten; silent when stderr is no terminal.
void show(const std::string& what) {
  if (isatty(2) != 0) std::cerr << fmt::format("\r{:<70}", what) << std::flush;
}

ExitCode trace(const Options& o) {
  // Matrices of megabytes come and go by the thousand: their pages are kept.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const scenario::Scenario s = asked(o);
  const Outputs outputs = checked_outputs(o);
  const std::string& out = outputs.result;
  const ModelCard& card = s.made ? *s.made->card : *models::find(s.model)->card;
  tracing::Trace found = tracing::trace(s, {o.threads, show});
  if (isatty(2) != 0) std::cerr << '\n';
  store::TracedBudgets budgets;
  const bool closed = close_loop(s, found, outputs.scenario, budgets);
  std::vector<std::string> written{out};
  store::write_trace(out, s, card, found, budgets);
  if (!o.json.empty()) {
    write_text(o.json, tracing::verdict_json(found) + '\n');
    written.push_back(o.json);
  }
  ExitCode code = ExitCode::done;
  if (!o.report.empty()) {
    code = generate({out, "--out", o.report, "--page-only"});
    if (code == ExitCode::done) written.push_back(o.report);
  }
  if (o.format == "json")
    std::cout << tracing::verdict_json(found) << '\n';
  else
    print_trace(found, s.title, written, closed ? outputs.scenario : "");
  return code;
}

} // namespace

void add_trace(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("trace", "finds what is missing from the model, from the residuals ([trace])");
  const auto o = std::make_shared<Options>();
  command->add_option("scenario", o->file, "scenario file (TOML) with readings")->required();
  command->add_option("--data", o->data, "CSV file with readings, instead of the files named in the scenario");
  command->add_option("--out", o->out, "result file (default: results/SCENARIO.traced.h5)");
  command->add_option("--json", o->json, "file for the verdict");
  command->add_option("--report", o->report, "file for the report, one HTML page");
  command->add_option("--draws", o->draws, "seed of the bootstrap, instead of the scenario's");
  command->add_option("--seed", o->seed, "instead of the scenario's");
  command->add_option("--threads", o->threads, "0: all processors")->check(CLI::Range(0, 1024));
  command->add_option("--format", o->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  command->callback([=, &action] { action = [=] { return trace(*o); }; });
}

} // namespace gumshoe::cli
