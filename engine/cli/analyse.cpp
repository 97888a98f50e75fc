/// `gumshoe analyse`: the stored samples of a result analysed anew, into a new file.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "analysis/analyse.h"
#include "analysis/selection.h"
#include "base/instruction_set.h"
#include "base/interrupt.h"
#include "base/version.h"
#include "cli/command.h"
#include "cli/print.h"
#include "cli/progress_line.h"
#include "cli/recomputed.h"
#include "cli/shards.h"
#include "propagation/propagate.h"
#include "store/earlier_result.h"
#include "store/origin.h"
#include "store/result_file.h"
#include "store/stored_samples.h"

namespace gumshoe::cli {

namespace {

struct AnalyseOptions {
  std::string file, scenario, out;
  PrintOptions print;
  int threads = 0;
  bool force = false;
};

void refuse_unusable(const store::Stored& stored, const std::string& file) {
  refuse_shard(stored.identity, file);
  if (!stored.identity.has_outputs())
    throw InputError(file + ": the file holds no samples", "gumshoe " + stored.command() + " made it",
                     "use gumshoe run");
  if (!stored.identity.store_samples)
    throw InputError(file + ": the file holds no samples", "its scenario has store_samples = false",
                     "run again with store_samples = true");
  store::require_complete(stored, file);
  if (stored.identity.design_hash.empty())
    throw InputError(file + ": the design of its samples is not recorded", "an older version wrote it", "run again");
}

/// The design hash knows a model by name only. The file may come from another instruction set.
void refuse_other_model(const propagation::Experiment& e, const store::StoredSamples& stored, const std::string& file) {
  const auto read = [&](std::size_t output, std::uint64_t first, std::uint64_t count) {
    return stored.read(output, first, count);
  };
  const std::string how = first_difference(e, {{0, e.scenario().run.samples}, read}, Same::rounding);
  if (!how.empty()) throw InputError(file + ": its samples come from another model", how, "run the scenario again");
}

ExitCode analyse(const AnalyseOptions& o) {
  const store::Stored stored = store::open_result(o.file);
  refuse_unusable(stored, o.file);
  store::require_sound_samples(o.file);
  if (o.scenario.empty()) require_scenario(stored.identity, o.file, ", or name it with --scenario");
  scenario::Scenario s = scenario::read(o.scenario.empty() ? stored.identity.scenario_file : o.scenario, catalogue(),
                                        {.external = stored.identity.external});
  s.run.samples = stored.identity.samples;
  s.run.seed = stored.identity.seed;
  if (stored.identity.method == name(scenario::Method::prediction)) predict_readings(s);
  const propagation::Experiment experiment(s);
  const std::string hash = propagation::design_hash(experiment);
  if (hash != stored.identity.design_hash)
    throw InputError(o.file + ": its samples have another design than " + s.file,
                     "design hash " + stored.identity.design_hash + ", the scenario has " + hash,
                     "only [analysis] may differ. Run the scenario again");
  const std::string out =
      !o.out.empty() ? o.out : std::filesystem::path(o.file).replace_extension(".analysed.h5").string();
  const std::uint64_t samples = s.run.samples;
  const store::StoredSamples source(o.file, experiment.outputs());
  refuse_other_model(experiment, source, o.file);

  when_interrupted("The result itself is unchanged. The same command makes the analysis again.");
  store::Identity identity = stored.identity;
  identity.scenario_hash = s.hash;
  identity.scenario_text = s.text;
  identity.scenario_file = s.file;
  identity.scenario_place = store::place_of(s.file);
  identity.command = "analyse";
  store::ResultFile file(out, identity, experiment.outputs(), experiment.place_names(), o.force);
  store::append_samples(file, source, experiment.outputs().size(), 0, samples);
  s.notes.push_back("analysed again from the samples of " + o.file);
  ProgressLine line;
  const StudyProgress studies(line);
  analysis::Results results = analysis::analyse(experiment, file.view(), o.threads);
  results.stopping = source.read_stopping();
  analysis::keep_measurands(results, s.analysis.measurands);
  file.finish(results, o.threads);
  line.clear();
  PrintOptions print = o.print;
  print.max_failed_share = s.run.max_failed_share;
  return print_results(results, out, print);
}

} // namespace

void add_analyse(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("analyse", "analyses the stored samples of a result again and writes a new file");
  const auto o = std::make_shared<AnalyseOptions>();
  command->add_option("result", o->file, "result file (HDF5)")->required();
  command->add_option("--scenario", o->scenario, "instead of the one it was made from; only [analysis] may differ");
  command->add_option("-o,--out", o->out, "new result file (default: RESULT.analysed.h5)");
  add_force(*command, o->force);
  add_external(*command);
  add_threads(*command, o->threads);
  add_print(*command, o->print);
  command->callback([=, &action] { action = [=] { return analyse(*o); }; });
}

} // namespace gumshoe::cli
