#pragma once
/// Keeps the samples of a run in memory, for studies without a file and for tests.
#include <memory>
#include <span>

#include "propagation/run.h"

namespace gumshoe::propagation {

class MemoryStore : public SampleStore {
public:
  explicit MemoryStore(std::size_t outputs, std::uint64_t samples = 0) : outputs_(outputs) { resize(samples); }
  void write(const ResultBlock& block) override;
  std::uint64_t samples_done() const override { return done_; }
  std::uint64_t samples() const override { return samples_; }
  void resize(std::uint64_t samples) override;
  std::vector<double> read(std::size_t output, std::uint64_t first, std::uint64_t count) const override;
  std::vector<std::uint8_t> read_status(std::uint64_t first, std::uint64_t count) const override;
  /// The samples so far of one output, and the status of all of them, where they lie.
  std::span<const double> values(std::size_t output) const { return {values_.get() + output * samples_, done_}; }
  std::span<const std::uint8_t> status() const { return {status_.data(), done_}; }

private:
  std::size_t outputs_;
  std::uint64_t samples_ = 0, done_ = 0;
  std::unique_ptr<double[]> values_; ///< [output][sample]; not set before they are written
  std::vector<std::uint8_t> status_;
};

} // namespace gumshoe::propagation
