/// `gumshoe choose`: which settings measure within a target expanded uncertainty in the least time?
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/progress.h"
#include "choice/choose.h"
#include "cli/command.h"
#include "cli/print_choice.h"
#include "cli/progress_line.h"
#include "store/choice_file.h"
#include "store/origin.h"

namespace gumshoe::cli {

namespace {

struct Options {
  std::string file, out, format = "text";
  std::optional<std::string> samples, seed;
  int threads = 0;
  bool force = false;
};

ExitCode choose(const Options& o) {
  scenario::Scenario s = scenario::read(o.file, catalogue());
  if (!s.choose)
    throw InputError(
        {{{s.file}, "[choose] is missing", "it defines the variables and the target", "[choose] target = \"...\""}});
  if (o.samples) s.choose->samples = whole_number(*o.samples, "--samples", 200, "1e6");
  if (o.seed) s.run.seed = whole_number(*o.seed, "--seed", 0, "1");
  const std::string out = !o.out.empty() ? o.out : default_output(o.file, ".choose.h5");
  require_different(out, o.file);
  const store::Claim claim = store::claim_result(out, store::origin_of(s, "choose", o.force)); // before the work
  if (!claim.remark.empty()) std::cerr << claim.remark << '\n';
  ProgressLine line;
  const StudyProgress studies(line);
  const choice::Result result =
      choice::choose(s, {o.threads, [](const choice::Progress& p) {
                           progress::stage(p.total > 0 ? fmt::format("{}, {} of {} candidates", p.what, p.done, p.total)
                                                       : p.what);
                         }});
  line.clear();
  store::Draft draft;
  store::write_choice(draft, claim, s, result);
  draft.publish();
  print_choice(result, out, o.format);
  return ExitCode::done;
}

} // namespace

void add_choose(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("choose", "finds the fastest settings that reach a target expanded uncertainty ([choose])");
  const auto o = std::make_shared<Options>();
  command->add_option("scenario", o->file, "scenario file (TOML) with [choose]")->required();
  command->add_option("--samples", o->samples, "samples per candidate, instead of the scenario's, e.g. 1e4");
  command->add_option("--seed", o->seed, "instead of the scenario's");
  command->add_option("--threads", o->threads, "0: all processors")->check(CLI::Range(0, 1024));
  command->add_option("--out", o->out, "result file (default: results/SCENARIO.choose.h5)");
  add_force(*command, o->force);
  add_external(*command);
  command->add_option("--format", o->format, "text, csv or json")->check(CLI::IsMember({"text", "csv", "json"}));
  command->callback([=, &action] { action = [=] { return choose(*o); }; });
}

} // namespace gumshoe::cli
