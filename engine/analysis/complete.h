#pragma once
/// Columns without the samples that have no value in some of them.
#include <cstdint>
#include <vector>

#include "analysis/column.h"

namespace gumshoe::analysis {

/// The samples in which `holds` is true of every column, without copies: how many each leaf has is counted once, and
/// they are picked out again whenever they are read.
class Complete {
public:
  Complete(std::vector<Column> columns, bool (*holds)(double), int threads);
  std::size_t size() const { return size_; }
  /// Values of one column in these samples, in order. Refers to this object.
  Column column(std::size_t a) const;

private:
  void read(std::size_t a, std::size_t first, std::span<double> out) const;
  /// Calls body(i) for the samples of a leaf that are complete; `room` holds [column][sample] of the leaf.
  template <class Body> void each(std::size_t leaf, std::vector<double>& room, const Body& body) const;

  std::vector<Column> columns_;
  bool (*holds_)(double);
  std::size_t all_ = 0, size_ = 0;
  std::vector<std::uint64_t> before_; ///< complete samples before each part
  std::vector<std::uint16_t> leaves_; ///< complete samples of each leaf
};

} // namespace gumshoe::analysis
