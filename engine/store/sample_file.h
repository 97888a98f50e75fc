#pragma once
/// The samples of a result, read and written at their places in the file, without HDF5. Each block of each row has a
/// digest. The numbers that a shard keeps of studies are one row without status. Private to this folder.
#include <cstdint>
#include <span>
#include <vector>

#include "propagation/run.h"
#include "store/raw_file.h"
#include "store/record.h"

namespace gumshoe::store {

/// Samples to a digest; a block of a run holds whole ones.
inline constexpr std::uint64_t digest_samples = 2048;
/// Digests of a row.
constexpr std::uint64_t digest_blocks(std::uint64_t samples) { return (samples + digest_samples - 1) / digest_samples; }

/// The rows of a record: measurand and reading of each output.
std::vector<std::pair<std::string, std::uint64_t>> rows_of(const std::vector<propagation::Output>& outputs);

class SampleFile {
public:
  SampleFile() = default;
  /// Throws OutputError if the record's places do not hold its samples.
  SampleFile(RawFile file, const Record& record);
  /// The same of a shard's values of studies, "samples" of one row.
  static SampleFile of_studies(RawFile file, const Record& record);

  std::size_t rows() const { return rows_.size(); }
  std::uint64_t samples() const { return samples_; }
  /// Where in the file a value lies.
  std::uint64_t place(std::size_t row, std::uint64_t sample) const { return rows_[row] + 8 * sample; }
  /// Samples [first, first + count) of a row, or their status, of those that are in the file: flush() puts all there.
  void read(std::size_t row, std::uint64_t first, std::uint64_t count, double* values) const;
  void read_status(std::uint64_t first, std::uint64_t count, std::uint8_t* status) const;
  /// Blocks come in order, each once. Short ones are gathered: a file system takes half as long for few long writes.
  void write(const propagation::ResultBlock& block);
  /// The same for samples [first, first + status.size()); rows[row] points to as many values.
  void write(std::uint64_t first, const std::vector<const double*>& rows, std::span<const std::uint8_t> status);
  /// Puts what is gathered into the file.
  void flush();

  /// The progress marker.
  std::uint64_t marked() const { return marked_; }
  /// Moves it, after the digests of what it counts; if `durable`, after the data are on the disk.
  void mark(std::uint64_t done, bool durable);
  /// Moves it, and returns once everything is on the disk.
  void settle(std::uint64_t done);
  /// How many of the samples counted by the marker stand before the first that is not as it was written. Samples from
  /// there on may be written again.
  std::uint64_t sound();
  /// Copies samples [0, count), all in the file, with their digests into a new one, which may have room for fewer or
  /// more, on `threads` threads.
  void copy_to(SampleFile& other, std::uint64_t count, int threads) const;

private:
  /// Samples of consecutive blocks, [row * most + i].
  struct Gathered {
    std::uint64_t first = 0;
    std::size_t count = 0, most = 0;
    std::vector<double> values;
    std::vector<std::uint8_t> status;
  };

  void put(std::uint64_t first, const std::vector<const double*>& rows, std::span<const std::uint8_t> status);
  void require_whole(const Span& status, const Span& digests, const Span& marker);
  std::uint64_t width() const { return rows_.size() + 1; } ///< digests of a block
  std::uint64_t& digest(std::uint64_t block, std::size_t row) { return digests_[(block - held_) * width() + row]; }
  /// Has digests for so many blocks, in the file or in memory.
  void hold(std::uint64_t blocks);

  RawFile file_;
  std::uint64_t samples_ = 0, marked_ = 0;
  std::vector<std::uint64_t> rows_; ///< where each row begins
  std::uint64_t status_ = 0, digests_at_ = 0, marker_ = 0;
  bool has_status_ = true;
  std::uint64_t held_ = 0;             ///< the first block whose digests are in memory; the marker counts those before
  std::vector<std::uint64_t> digests_; ///< [block from held_][row], the status last
  Gathered gathered_;
};

} // namespace gumshoe::store
