#pragma once
/// The result file (layout: README.md in this folder).
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/run.h"
#include "scenario/scenario.h"
#include "store/draft.h"

namespace gumshoe::store {

/// What fixes a run's numbers; a file is resumed only if all of it matches.
struct Identity {
  std::string scenario_hash, scenario_text, scenario_file, model, method, evaluation, design, version, instruction_set;
  std::string adaptive; ///< the stopping rule; then `samples` is only how many there is room for
  std::uint64_t seed = 0, samples = 0;
  bool store_samples = true;
  std::string design_hash;     ///< propagation::design_hash; empty in files older than it
  std::string command = "run"; ///< that made it
  /// Whether the file holds results of outputs, and no choice, trace or map.
  bool has_outputs() const { return command == "run" || command == "analyse"; }
  std::string scenario_place;     ///< place_of(scenario_file)
  std::string external;           ///< Scenario::external
  std::string shard;              ///< "3/16": the file holds this part of a run, `samples` of them; empty: a whole run
  std::string options;            ///< of a shard: the options of `run` that determine the whole run's numbers
  std::uint64_t study_values = 0; ///< of a shard: numbers that its part of the studies' model runs gives
};

/// What a scenario says of it and this program adds: all but `adaptive`, `design_hash` and `command`.
Identity identity_of(const scenario::Scenario& scenario);

/// The samples of a run, written block by block in order. Throws OutputError naming path and reason
/// (unwritable, disk full, not one of our files: never overwritten).
///
/// Few samples (16 MiB) stay in memory for their first quarter of a second: a short run writes one file, when it is
/// complete, and a longer one has its samples in a file from then on.
class ResultFile : public propagation::SampleStore {
public:
  /// Creates the file, or opens it to resume if it holds an unfinished run of the same identity. Replaces what the same
  /// command wrote for the same scenario; with `force` any file.
  ResultFile(const std::string& path, const Identity& identity, const std::vector<propagation::Output>& outputs,
             const std::vector<std::string>& reading_labels, bool force = false);
  ~ResultFile() override;
  /// Said of what stood there and is replaced: an unfinished run of other settings, a damaged result. Empty: neither.
  std::string remark() const;
  /// Samples already there, 0 for a new file.
  std::uint64_t samples_done() const override;
  std::uint64_t samples() const override;
  /// Where there is no room for so many: a new file with the samples so far takes the place of the old one.
  void resize(std::uint64_t samples) override;
  void write(const propagation::ResultBlock& block) override;
  /// A shard keeps what studies gave, one number after the other, once it is settled. `first`: where these stand; those
  /// that are there already stay.
  void write_study_values(std::uint64_t first, std::span<const double> values);
  std::uint64_t study_values_done() const;
  std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const override;
  std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const override;
  /// The samples so far, where they lie in memory or read from the file part by part: valid until the next change.
  analysis::Samples view() const;
  /// Returns once the samples and values so far are on the disk and counted. A shard ends so.
  void settle();
  /// A new file with the samples and everything else, complete, takes the place of the old one.
  /// @param threads that copy the samples; 0: one per processor
  void finish(const analysis::Results& results, int threads = 1);

private:
  bool resumed();

  struct Impl;
  Claim claim_;
  std::unique_ptr<Impl> impl_;
};

/// What the record of an existing result says. Throws InputError if the path is no result of ours (a directory,
/// garbage, another program's HDF5), or one that is damaged anywhere but in its samples.
struct Stored {
  Identity identity;
  std::uint64_t samples_done = 0, study_values_done = 0;
  bool complete = false;
  /// The command that made it; results of "choose" and "trace" hold no samples.
  const std::string& command() const { return identity.command; }
};
Stored read_identity(const std::string& path);
/// The same of a result that the process reads: no output may replace it (base/inputs.h).
Stored open_result(const std::string& path);
/// What both throw of a file that is no result at all, and not a damaged one.
class NotAResult : public InputError {
public:
  using InputError::InputError;
};
/// Throws InputError if stored samples, or a shard's values of studies, are not those that were written.
void require_sound_samples(const std::string& path);

} // namespace gumshoe::store
