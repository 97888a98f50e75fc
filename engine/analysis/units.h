#pragma once
/// Rows of a study as units of work: groups, whose sums are what the study needs.
#include <cstdint>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Rows that go through the model in one call at most.
inline constexpr std::uint64_t most_rows = 1024;

/// n rows in groups, each of which is a unit: about a thousand, enough to know a standard error within 3 %.
struct RowUnits {
  std::uint64_t rows = 0;    ///< n rounded up to a multiple of 64
  std::size_t per_group = 0; ///< a power of 2, from 8 to most_rows
  std::size_t groups = 0;

  /// Where a group begins.
  std::uint64_t row(std::uint64_t group) const;
  /// Units that are best done in one call: 16 calls or more, of at most 8192 rows; but no fewer rows than the model
  /// likes in a call (models::Model::block).
  std::uint64_t together(std::size_t liked) const;
  /// From `series`, [sum][group] over so many groups, to [group][sum].
  void by_unit(const std::vector<double>& series, std::size_t sums, std::uint64_t count, double* values) const;
  /// Back: groups [first, last) into series over all of them.
  void by_sum(const double* values, std::size_t sums, std::uint64_t first, std::uint64_t last,
              std::vector<double>& series) const;
};

RowUnits units_of_rows(std::uint64_t n);

/// Draws begin at multiples of 64: where those of a row do, and how far before it.
struct Aligned {
  std::uint64_t begin;
  std::size_t offset;
  explicit Aligned(std::uint64_t row) : begin(row / 64 * 64), offset(static_cast<std::size_t>(row - begin)) {}
};

/// Points that a unit of a screening holds: what a model runs at once.
inline constexpr std::size_t points_per_unit = 8;
/// Points of a screening that go through the model in one call: many where a call is costly (a program), and a multiple
/// of 64.
std::uint64_t points_in_a_call(const propagation::Experiment& experiment);

} // namespace gumshoe::analysis
