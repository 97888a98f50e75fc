/// `gumshoe plan`: which further readings distinguish effects, detect one, or determine a quantity, at least cost?
#include <filesystem>
#include <iostream>
#include <memory>

#include "base/progress.h"
#include "cli/command.h"
#include "cli/print_plan.h"
#include "cli/progress_line.h"
#include "tracing/planning/planning.h"

namespace gumshoe::cli {

namespace {

struct PlanOptions {
  std::string file, data, out, format = "text";
  int threads = 0, verify = 0;
  bool force = false;
};

ExitCode plan(const PlanOptions& o) {
  const scenario::Scenario s = scenario::read(o.file, catalogue(), {o.data});
  if (!s.plan)
    throw InputError({{{s.file},
                       "[plan] is missing",
                       "it says which further readings are allowed, and what they must reach",
                       "[plan.readings] with the values of conditions and labels"}});
  ProgressLine line;
  const StudyProgress studies(line);
  const tracing::Planned result = tracing::plan(s, {o.threads, o.verify, progress::stage});
  line.clear();
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".plan.csv");
  write_table(out, plan_table(s, result), o.force);
  print_plan(s, result, out, o.format);
  return ExitCode::done;
}

} // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "finds the further readings that reach a goal at least cost ([plan])");
  const auto o = std::make_shared<PlanOptions>();
  command->add_option("scenario", o->file, "scenario file (TOML) with [plan]")->required();
  command->add_option("--data", o->data, "CSV file with readings, instead of the files named in the scenario");
  command->add_option("-o,--out", o->out,
                      "table of the readings, to be filled in (default: results/SCENARIO.plan.csv)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--verify", o->verify, "simulated data sets of each effect, on which gumshoe trace is tried")
      ->check(CLI::Range(0, 10'000));
  add_threads(*command, o->threads);
  command->add_option("--format", o->format, "text, csv (the table) or json")
      ->check(CLI::IsMember({"text", "csv", "json"}));
  command->callback([=, &action] { action = [=] { return plan(*o); }; });
}

} // namespace gumshoe::cli
