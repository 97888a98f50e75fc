#include "propagation/memory_store.h"

#include <algorithm>
#include <stdexcept>

namespace gumshoe::propagation {

void MemoryStore::write(const ResultBlock& block) {
  if (block.first_sample != done_ || done_ + block.samples > samples_)
    throw std::logic_error("blocks must come whole and in sample order");
  for (std::size_t o = 0; o < outputs_; ++o)
    std::copy_n(&block.outputs[o * block.samples], block.samples, values_.get() + o * samples_ + done_);
  std::copy_n(block.status.begin(), block.samples, status_.begin() + static_cast<std::ptrdiff_t>(done_));
  done_ += block.samples;
}

void MemoryStore::resize(std::uint64_t samples) {
  auto values = std::make_unique_for_overwrite<double[]>(outputs_ * samples);
  const std::uint64_t kept = std::min(done_, samples);
  for (std::size_t o = 0; o < outputs_; ++o)
    std::copy_n(values_.get() + o * samples_, kept, values.get() + o * samples);
  values_ = std::move(values);
  status_.resize(samples);
  samples_ = samples;
  done_ = kept;
}

std::vector<double> MemoryStore::read(std::size_t output, std::uint64_t first, std::uint64_t count) const {
  if (output >= outputs_ || first > done_ || count > done_ - first)
    throw std::out_of_range("samples that are not there");
  const double* const from = values_.get() + output * samples_ + first;
  return {from, from + count};
}

std::vector<std::uint8_t> MemoryStore::read_status(std::uint64_t first, std::uint64_t count) const {
  if (first > done_ || count > done_ - first) throw std::out_of_range("samples that are not there");
  const auto from = status_.begin() + static_cast<std::ptrdiff_t>(first);
  return {from, from + static_cast<std::ptrdiff_t>(count)};
}

} // namespace gumshoe::propagation
