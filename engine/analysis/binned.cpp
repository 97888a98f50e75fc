#include "analysis/binned.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/sort/pdqsort/pdqsort.hpp>

namespace gumshoe::analysis {

Binned::Binned(const std::vector<double>& values) {
  constexpr std::size_t values_a_bin = 16;
  if (values.empty()) return;
  const auto range = std::ranges::minmax(values);
  const double least = range.min, most = range.max; // no structured binding: clang 14 does not capture one
  std::size_t count = std::max<std::size_t>(1, values.size() / values_a_bin);
  const double per_width = static_cast<double>(count) / (most - least);
  if (!std::isfinite(per_width) || !std::isfinite(most - least)) count = 1;
  const auto bin = [&](double v) { // rises with v, however it is rounded
    return count == 1 ? 0 : std::min(count - 1, static_cast<std::size_t>((v - least) * per_width));
  };
  std::vector<std::uint32_t> at(values.size());
  std::vector<std::size_t> place(count + 1, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    at[i] = static_cast<std::uint32_t>(bin(values[i]));
    ++place[at[i] + 1];
  }
  for (std::size_t b = 0; b < count; ++b) place[b + 1] += place[b];
  for (std::size_t b = 0; b < count; ++b)
    if (place[b] < place[b + 1]) bins_.push_back({place[b], place[b + 1]});
  values_.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) values_[place[at[i]]++] = values[i];
  for (Bin& b : bins_) {
    const auto ends =
        std::minmax_element(values_.begin() + static_cast<long>(b.first), values_.begin() + static_cast<long>(b.last));
    b.least = *ends.first, b.most = *ends.second;
  }
  sorted_.assign(bins_.size(), false);
}

const Binned::Bin& Binned::bin_of(std::size_t rank) const {
  return *std::ranges::upper_bound(bins_, rank, {}, &Bin::last);
}

const double* Binned::sorted(std::size_t first, std::size_t last) const {
  for (auto b = static_cast<std::size_t>(&bin_of(first) - bins_.data()); b < bins_.size() && bins_[b].first < last;
       ++b) {
    if (sorted_[b]) continue;
    boost::sort::pdqsort_branchless(values_.begin() + static_cast<long>(bins_[b].first),
                                    values_.begin() + static_cast<long>(bins_[b].last));
    sorted_[b] = true;
  }
  return values_.data() + first;
}

} // namespace gumshoe::analysis
