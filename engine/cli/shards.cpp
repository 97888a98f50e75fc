#include "cli/shards.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

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

propagation::SampleRange make_shard(store::Identity& identity, const std::string& shard, const RunRequest& request) {
  const propagation::Shard wanted = propagation::shard_of(shard, "--shard");
  if (!identity.adaptive.empty())
    throw InputError("--shard: an adaptive run cannot be divided", "its number of samples follows from the samples",
                     "give the number with --samples");
  if (propagation::Shard{1, wanted.of}.samples(identity.samples).size() == 0)
    throw InputError(fmt::format("--shard: {} samples are too few for {} shards", identity.samples, wanted.of),
                     "a shard holds 64 samples or more", "use fewer shards");
  const propagation::SampleRange part = wanted.samples(identity.samples);
  identity.command = shard_command;
  identity.shard = wanted.text();
  identity.options = request.words();
  identity.samples = part.size();
  return part;
}

std::string ending_of(const std::string& shard) {
  if (shard.empty()) return ".h5";
  std::string ending = "." + shard + ".h5";
  return ending.replace(ending.find('/'), 1, "-of-");
}

bool sample_shard(const propagation::Experiment& experiment, const propagation::SampleRange& part,
                  store::ResultFile& file, propagation::RunSettings settings) {
  ShardSink sink(file, part.first);
  settings.last = part.last;
  const bool whole = propagation::propagate(experiment, sink, settings) == part.last;
  file.settle();
  return whole;
}

void print_shard(const store::Identity& identity, const propagation::SampleRange& part, std::uint64_t samples,
                 const store::ResultFile& file, const std::string& out) {
  const auto status = file.read_status(0, part.size());
  std::cout << fmt::format("shard {}: samples {} to {} of {}, {} failed\n{}\n", identity.shard, part.first,
                           part.last - 1, samples,
                           part.size() - static_cast<std::uint64_t>(std::ranges::count(status, 0)), out);
}

void refuse_shard(const store::Identity& identity, const std::string& file) {
  if (identity.shard.empty()) return;
  throw InputError(file + ": the file holds a part of a run", "shard " + identity.shard,
                   "join all shards with gumshoe merge");
}

store::Identity require_finished(const std::string& file) {
  store::Stored stored = store::read_identity(file);
  refuse_shard(stored.identity, file);
  if (!stored.complete)
    throw InputError(file + ": the run is not finished", "it was interrupted",
                     "run the same command again to resume it");
  return std::move(stored.identity);
}

} // namespace gumshoe::cli
