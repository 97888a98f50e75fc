#pragma once
/// The samples of a finished result, read only.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/results.h"
#include "propagation/run.h"
#include "store/result_file.h"

namespace gumshoe::store {

class StoredSamples {
public:
  /// Throws InputError if the file has no samples of these outputs. require_sound_samples() checks them.
  StoredSamples(const std::string& path, const std::vector<propagation::Output>& outputs);
  ~StoredSamples();
  /// Values of one output row (SI, NaN where failed), samples [first, first + count).
  std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const;
  std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const;
  /// How the run came to its number of samples; an empty rule if that was given.
  analysis::StoppingRecord read_stopping() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The values that a finished shard keeps of studies.
class StoredStudyValues {
public:
  /// Throws InputError if the file has none. require_sound_samples() checks them.
  explicit StoredStudyValues(const std::string& path);
  ~StoredStudyValues();
  void read(std::uint64_t first, std::uint64_t count, double* values) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Appends the samples of `from`, which are [first, last) of the run, to the file of that run, from where that stands.
/// Stops between parts where interrupted; Interrupted is thrown.
void append_samples(ResultFile& to, const StoredSamples& from, std::size_t outputs, std::uint64_t first,
                    std::uint64_t last);

} // namespace gumshoe::store
