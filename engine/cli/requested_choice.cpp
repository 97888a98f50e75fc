#include "cli/requested_choice.h"

#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "base/interrupt.h"
#include "base/progress.h"
#include "choice/candidates.h"
#include "choice/choose.h"
#include "cli/command.h"
#include "cli/print_choice.h"
#include "store/choice_file.h"
#include "store/origin.h"
#include "store/stored_samples.h"

namespace gumshoe::cli {

namespace {

/// A shard's file holds a candidate as a sample: what is known of it are its outputs.
std::vector<propagation::Output> outputs_of(const scenario::Scenario& s) {
  std::vector<propagation::Output> outputs;
  for (const std::string& name : choice::assessment_names(s)) outputs.push_back({name, name, 0, "1", "1"});
  return outputs;
}

propagation::Work grid_of(const scenario::Scenario& s) { return choice::assessment_work(s, choice::coarse_places(s)); }

/// The shard's candidates; none: there are fewer than shards.
propagation::SampleRange part_of(const propagation::Work& grid, const propagation::Shard& shard) {
  const auto portions = shard.portions({grid});
  if (portions.empty()) return {};
  return {portions[0].first, portions[0].last};
}

} // namespace

scenario::Scenario scenario_of_choice(const std::string& file, const RunRequest& request,
                                      const scenario::Overrides& overrides) {
  scenario::Scenario s = scenario::read(file, catalogue(), overrides);
  if (!s.choose)
    throw InputError(
        {{{s.file}, "[choose] is missing", "it defines the variables and the target", "[choose] target = \"...\""}});
  if (request.samples) s.choose->samples = whole_number(*request.samples, "--samples", 200, "1e6");
  if (request.seed) s.run.seed = whole_number(*request.seed, "--seed", 0, "1");
  return s;
}

ExitCode choose_shard(const scenario::Scenario& s, const std::string& shard, const RunRequest& request,
                      const std::string& out, int threads, bool force) {
  const propagation::Shard wanted = propagation::shard_of(shard, "--shard");
  const propagation::Work grid = grid_of(s);
  const propagation::SampleRange part = part_of(grid, wanted);
  if (grid.units < wanted.of)
    throw InputError(fmt::format("--shard: {} candidates are too few for {} shards", grid.units, wanted.of),
                     "a shard holds one or more candidates of the coarse grid", "use fewer shards");
  store::Identity identity = store::identity_of(s);
  identity.command = choice_shard_command;
  identity.shard = wanted.text();
  identity.options = request.words();
  identity.samples = part.size();
  identity.design_hash = choice::coarse_grid_hash(s);
  const auto outputs = outputs_of(s);
  store::ResultFile file(out, identity, outputs, {"coarse grid"}, force);
  if (!file.remark().empty()) std::cerr << file.remark() << '\n';
  if (file.samples_done() > 0 && file.samples_done() < file.samples())
    std::cerr << fmt::format("resuming after {} candidates\n", file.samples_done());
  when_interrupted("The candidates so far are kept. Repeat the command to resume.");
  ProgressLine line;
  const StudyProgress studies(line);
  progress::stage("coarse grid");
  const std::uint64_t first = part.first + file.samples_done();
  const auto take = [&](std::uint64_t from, std::uint64_t to, const double* values) {
    const auto n = static_cast<std::size_t>(to - from);
    propagation::ResultBlock block{from - part.first, n, std::vector<double>(n * outputs.size()),
                                   std::vector<std::uint8_t>(n)};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t o = 0; o < outputs.size(); ++o) block.outputs[o * n + i] = values[i * outputs.size() + o];
    file.write(block);
  };
  if (first < part.last) propagation::Workers(threads).run(grid, first, part.last, take);
  file.settle();
  line.clear();
  std::cout << fmt::format("shard {}: candidates {} to {} of {} of the coarse grid\n{}\n", identity.shard, part.first,
                           part.last - 1, grid.units, out);
  return ExitCode::done;
}

propagation::Workers workers_of_choice(const scenario::Scenario& s, const ShardSet& shards, int threads) {
  const auto outputs = outputs_of(s);
  const propagation::Work grid = grid_of(s);
  if (const std::string hash = choice::coarse_grid_hash(s); hash != shards.identity.design_hash)
    throw InputError("the shards have other candidates than the coarse grid of " + s.file,
                     "design hash " + shards.identity.design_hash + ", the scenario has " + hash,
                     "make the shards again");
  const auto files = std::make_shared<std::vector<std::unique_ptr<store::StoredSamples>>>();
  for (std::size_t k = 0; k < shards.files.size(); ++k) {
    if (store::read_identity(shards.files[k]).identity.samples != part_of(grid, {k + 1, shards.of}).size())
      throw InputError(shards.files[k] + ": the shard has another number of candidates than its part of the grid", "",
                       "make the shard again");
    files->push_back(std::make_unique<store::StoredSamples>(shards.files[k], outputs));
  }
  propagation::Workers workers(threads);
  workers.known = [=, of = shards.of, width = outputs.size()](const propagation::Work& work,
                                                              const propagation::TakeUnits& take) {
    if (work.name != grid.name) return false;
    for (std::size_t k = 0; k < files->size(); ++k) {
      const propagation::SampleRange part = part_of(grid, {k + 1, of});
      std::vector<double> values(part.size() * width);
      for (std::size_t o = 0; o < width; ++o) {
        const auto column = (*files)[k]->read(o, 0, part.size());
        for (std::size_t i = 0; i < column.size(); ++i) values[i * width + o] = column[i];
      }
      take(part.first, part.last, values.data());
    }
    return true;
  };
  return workers;
}

std::string choice_output(const std::string& out, const std::string& scenario, const std::string& shard) {
  return !out.empty() ? out : default_output(scenario, ".choose" + ending_of(shard));
}

ExitCode complete_choice(const scenario::Scenario& s, const propagation::Workers& workers, const std::string& out,
                         const std::string& format, bool force) {
  const store::Claim claim = store::claim_result(out, store::origin_of(s, "choose", force)); // before the work
  if (!claim.remark.empty()) std::cerr << claim.remark << '\n';
  ProgressLine line;
  const StudyProgress studies(line);
  const choice::Result result = choice::choose(s, {workers, progress::stage});
  line.clear();
  store::Draft draft;
  store::write_choice(draft, claim, s, result);
  draft.publish();
  print_choice(result, out, format);
  return ExitCode::done;
}

} // namespace gumshoe::cli
