#pragma once
/// Values in sample order, wherever they are kept: the passes of the analysis read them part by part.
#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>

namespace gumshoe::analysis {

/// Room for values that are read; used again as long as it suffices.
class Room {
public:
  static constexpr std::size_t page = 4096;
  /// Some processors copy three to five times slower if the target lies a few bytes past the source, in their pages.
  /// @param phase  where in a page the values begin, bytes
  std::span<double> of(std::size_t count, std::size_t phase = 0) {
    if (const std::size_t wanted = count * sizeof(double) + 2 * page; wanted > bytes_) {
      memory_ = std::make_unique_for_overwrite<std::byte[]>(wanted);
      bytes_ = wanted;
    }
    const auto at = reinterpret_cast<std::uintptr_t>(memory_.get());
    const std::size_t start = (page - at % page) % page + phase / sizeof(double) * sizeof(double) % page;
    return {new (memory_.get() + start) double[count], count};
  }

private:
  std::unique_ptr<std::byte[]> memory_;
  std::size_t bytes_ = 0;
};

/// Values in memory, in a file, or computed from other columns; SI, NaN where a sample failed. Refers to what it reads,
/// which must outlive it. Reading is safe on several threads at the same time.
class Column {
public:
  /// Writes values [first, first + out.size()).
  using Fill = std::function<void(std::size_t first, std::span<double> out)>;

  Column() = default;
  /// Values in memory.
  template <class Values>
  requires std::convertible_to<const Values&, std::span<const double>> Column(const Values& values)
      : values_(values), size_(values_.size()) {}
  /// @param phase  where in a page of its file the first value lies, bytes
  Column(std::size_t size, Fill fill, std::size_t phase = 0) : size_(size), phase_(phase), fill_(std::move(fill)) {}

  std::size_t size() const { return size_; }
  std::size_t phase() const { return phase_; }
  bool in_memory() const { return !fill_; }

  /// Values [first, first + count): where they lie in memory, or read into `room`.
  std::span<const double> read(std::size_t first, std::size_t count, Room& room) const {
    if (!fill_) return values_.subspan(first, count);
    const std::span<double> out = room.of(count, phase_ + first * sizeof(double));
    fill_(first, out);
    return out;
  }
  /// Copies values [first, first + out.size()).
  void copy(std::size_t first, std::span<double> out) const {
    if (fill_)
      fill_(first, out);
    else
      std::ranges::copy(values_.subspan(first, out.size()), out.begin());
  }
  double operator[](std::size_t i) const {
    double value = 0;
    copy(i, {&value, 1});
    return value;
  }

private:
  std::span<const double> values_;
  std::size_t size_ = 0, phase_ = 0;
  Fill fill_;
};

} // namespace gumshoe::analysis
