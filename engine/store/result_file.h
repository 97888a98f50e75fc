#pragma once
/// The result file (layout: README.md in this folder). The only door to HDF5.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results.h"
#include "propagation/run.h"
#include "scenario/scenario.h"

namespace gumshoe::store {

/// What fixes a run's numbers; a file is resumed only if all of it matches.
struct Identity {
  std::string scenario_hash, scenario_text, scenario_file, model, method, evaluation, design, version, instruction_set;
  std::string adaptive; ///< the stopping rule; then `samples` is only how many there is room for
  std::uint64_t seed = 0, samples = 0;
  bool store_samples = true;
  std::string design_hash; ///< propagation::design_hash; empty in files older than it
};

/// What a scenario says of it and this program adds: all but `adaptive` and `design_hash`.
Identity identity_of(const scenario::Scenario& scenario);

/// Throws OutputError if a result cannot be put there: a missing folder, a file that is no result of ours.
void require_writable(const std::string& path);

/// The samples of a run, written block by block in order. Throws OutputError naming path and reason
/// (unwritable, disk full, not one of our files: never overwritten).
class ResultFile : public propagation::SampleStore {
public:
  /// Creates the file, or opens it to resume if it holds an unfinished run of the same identity.
  ResultFile(const std::string& path, const Identity& identity, const std::vector<propagation::Output>& outputs,
             const std::vector<std::string>& reading_labels);
  ~ResultFile() override;
  /// Said of what stood there: a result of ours that cannot be read, so that the run begins anew. Empty: no such thing.
  std::string remark() const;
  /// Samples already there, 0 for a new file.
  std::uint64_t samples_done() const override;
  std::uint64_t samples() const override;
  /// Where there is no room for so many: a new file with the samples so far takes the place of the old one.
  void resize(std::uint64_t samples) override;
  void write(const propagation::ResultBlock& block) override;
  std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const override;
  std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const override;
  /// A new file with the samples and everything else, complete, takes the place of the old one.
  void finish(const analysis::Results& results);

private:
  bool resumed(const std::string& path);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The attributes of an existing result, for `replay` and for resuming. Throws InputError if the
/// path is no result of ours (a directory, garbage, another program's HDF5).
struct Stored {
  Identity identity;
  std::uint64_t samples_done = 0;
  bool complete = false;
  std::string made_by; ///< "choose" or "trace", whose results hold no samples; empty: a run
};
Stored read_identity(const std::string& path);

} // namespace gumshoe::store
