#include "cli/shards.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "analysis/studies.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "store/earlier_result.h"
#include "store/stored_samples.h"

namespace gumshoe::cli {

namespace {

constexpr const char* shard_command = "run --shard";

/// Writes blocks of the run into the file of a shard, which counts its samples from 0.
class ShardSink : public propagation::Sink {
public:
  ShardSink(store::ResultFile& file, std::uint64_t first) : file_(file), first_(first) {}
  void write(const propagation::ResultBlock& block) override {
    propagation::ResultBlock moved = block;
    moved.first_sample -= first_;
    file_.write(moved);
  }

private:
  store::ResultFile& file_;
  std::uint64_t first_;
};

} // namespace

ShardPart::ShardPart(const propagation::Experiment& e, const propagation::Shard& shard)
    : samples(shard.samples(e.scenario().run.samples)), studies(analysis::studies_of(e)),
      portions(shard.portions(studies)) {}

ShardPart make_shard(const propagation::Experiment& experiment, store::Identity& identity, const std::string& shard,
                     const RunRequest& request) {
  const propagation::Shard wanted = propagation::shard_of(shard, "--shard");
  if (!identity.adaptive.empty())
    throw InputError("--shard: an adaptive run cannot be divided", "its number of samples follows from the samples",
                     "give the number with --samples");
  if (propagation::Shard{1, wanted.of}.samples(identity.samples).size() == 0)
    throw InputError(fmt::format("--shard: {} samples are too few for {} shards", identity.samples, wanted.of),
                     "a shard holds 64 samples or more", "use fewer shards");
  ShardPart part(experiment, wanted);
  identity.command = shard_command;
  identity.shard = wanted.text();
  identity.options = request.words();
  identity.samples = part.samples.size();
  identity.study_values = propagation::values_of(part.portions, part.studies);
  return part;
}

std::string ending_of(const std::string& shard) {
  if (shard.empty()) return ".h5";
  std::string ending = "." + shard + ".h5";
  return ending.replace(ending.find('/'), 1, "-of-");
}

bool compute_shard(const propagation::Experiment& experiment, const ShardPart& part, store::ResultFile& file,
                   propagation::RunSettings settings) {
  ShardSink sink(file, part.samples.first);
  settings.last = part.samples.last;
  const bool whole = propagation::propagate(experiment, sink, settings) == part.samples.last;
  file.settle();
  if (!whole) return false;
  std::uint64_t begin = 0; // of a portion's values in the file
  for (const propagation::Portion& portion : part.portions) {
    const propagation::Work& work = part.studies[portion.work];
    const std::uint64_t there = (std::max(begin, file.study_values_done()) - begin) / work.values;
    const std::uint64_t first = std::min(portion.last, portion.first + there);
    progress::stage("studies, " + work.name);
    if (first < portion.last)
      propagation::Workers(settings.threads)
          .run(work, first, portion.last, [&](std::uint64_t from, std::uint64_t to, const double* values) {
            file.write_study_values(begin + (from - portion.first) * work.values,
                                    {values, static_cast<std::size_t>((to - from) * work.values)});
          });
    begin += (portion.last - portion.first) * work.values;
  }
  file.settle();
  return true;
}

void print_shard(const store::Identity& identity, const ShardPart& part, std::uint64_t samples,
                 const store::ResultFile& file, const std::string& out) {
  const std::uint64_t size = part.samples.size();
  const auto status = file.read_status(0, size);
  std::uint64_t runs = 0;
  for (const auto& [work, first, last] : part.portions) runs += (last - first) * part.studies[work].runs;
  std::cout << fmt::format("shard {}: samples {} to {} of {}, {} failed{}\n{}\n", identity.shard, part.samples.first,
                           part.samples.last - 1, samples,
                           size - static_cast<std::uint64_t>(std::ranges::count(status, 0)),
                           runs > 0 ? fmt::format("; about {} model runs of studies", runs) : "", out);
}

propagation::Workers workers_of(const propagation::Experiment& experiment, const ShardSet& shards, int threads) {
  /// Units [first, last) of a work stand in a file from number `at` on.
  struct Place {
    std::string file;
    std::uint64_t first, last, at;
  };
  const auto kept = std::make_shared<std::map<std::string, std::vector<Place>>>(); // by work, in the order of its units
  const std::vector<propagation::Work> studies = analysis::studies_of(experiment);
  for (std::uint64_t k = 1; k <= shards.of; ++k) {
    std::uint64_t at = 0;
    for (const auto& [work, first, last] : propagation::Shard{k, shards.of}.portions(studies)) {
      (*kept)[studies[work].name].push_back({shards.files[k - 1], first, last, at});
      at += (last - first) * studies[work].values;
    }
  }
  propagation::Workers workers(threads);
  workers.known = [kept](const propagation::Work& work, const propagation::TakeUnits& take) {
    const auto found = kept->find(work.name);
    if (found == kept->end()) return false;
    constexpr std::uint64_t most = std::uint64_t{1} << 18; // 2 MiB
    const std::uint64_t step = std::max<std::uint64_t>(1, most / work.values);
    std::vector<double> values;
    for (const Place& place : found->second) {
      const store::StoredStudyValues file(place.file); // one open at a time: there may be thousands
      for (std::uint64_t first = place.first; first < place.last; first += step) {
        stop_if_interrupted();
        const std::uint64_t last = std::min(place.last, first + step);
        values.resize((last - first) * work.values);
        file.read(place.at + (first - place.first) * work.values, values.size(), values.data());
        take(first, last, values.data());
      }
    }
    return true;
  };
  return workers;
}

void refuse_shard(const store::Identity& identity, const std::string& file) {
  if (identity.shard.empty()) return;
  throw InputError(file + ": the file holds a part of a run", "shard " + identity.shard,
                   "join all shards with gumshoe merge");
}

void require_scenario(const store::Identity& identity, const std::string& file, const std::string& or_else) {
  if (std::filesystem::exists(identity.scenario_file)) return;
  throw InputError(file + ": its scenario " + identity.scenario_file + " is not there",
                   "the result names it as seen from the folder where it was made",
                   "go to that folder, or bring the scenario and its data here" + or_else);
}

store::Identity require_finished(const std::string& file) {
  store::Stored stored = store::open_result(file);
  refuse_shard(stored.identity, file);
  store::require_complete(stored, file);
  return std::move(stored.identity);
}

} // namespace gumshoe::cli
