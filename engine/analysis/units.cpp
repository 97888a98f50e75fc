#include "analysis/units.h"

#include <algorithm>
#include <bit>

namespace gumshoe::analysis {

RowUnits units_of_rows(std::uint64_t n) {
  RowUnits u;
  u.rows = (n + 63) / 64 * 64;
  u.per_group = std::clamp<std::size_t>(std::bit_ceil((u.rows + 1023) / 1024), 8, most_rows);
  u.groups = static_cast<std::size_t>((u.rows + u.per_group - 1) / u.per_group);
  return u;
}

std::uint64_t RowUnits::row(std::uint64_t group) const { return std::min(rows, group * per_group); }

std::uint64_t RowUnits::together(std::size_t liked) const {
  const std::uint64_t wanted = std::min<std::uint64_t>(rows / 16, 8 * most_rows);
  return std::max<std::uint64_t>(1, std::max(wanted, std::min<std::uint64_t>(liked, most_rows)) / per_group);
}

void RowUnits::by_unit(const std::vector<double>& series, std::size_t sums, std::uint64_t count, double* values) const {
  for (std::uint64_t group = 0; group < count; ++group)
    for (std::size_t s = 0; s < sums; ++s) *values++ = series[s * count + group];
}

void RowUnits::by_sum(const double* values, std::size_t sums, std::uint64_t first, std::uint64_t last,
                      std::vector<double>& series) const {
  for (std::uint64_t group = first; group < last; ++group)
    for (std::size_t s = 0; s < sums; ++s) series[s * groups + group] = *values++;
}

std::uint64_t points_in_a_call(const propagation::Experiment& e) {
  return std::clamp<std::uint64_t>(e.model().block / 64 * 64, 64, 8192);
}

} // namespace gumshoe::analysis
