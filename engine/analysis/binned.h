#pragma once
/// Order statistics of values in memory, sorted only where they are asked for.
#include <cstddef>
#include <vector>

namespace gumshoe::analysis {

/// Values in bins of equal width, a few to a bin, each bin sorted when a rank in it is first read. Linear in their
/// number unless they crowd into few bins, where it sorts. For one thread at a time.
class Binned {
public:
  Binned() = default;
  explicit Binned(const std::vector<double>& values); ///< without NaN

  std::size_t size() const { return values_.size(); }
  /// The values of ranks [first, last), from 0; valid as long as this.
  const double* sorted(std::size_t first, std::size_t last) const;
  double operator[](std::size_t rank) const { return *sorted(rank, rank + 1); }

  struct Bin {
    std::size_t first = 0, last = 0; ///< ranks of its values
    double least = 0, most = 0;
  };
  /// The bins with values, rising.
  const std::vector<Bin>& bins() const { return bins_; }
  const Bin& bin_of(std::size_t rank) const;

private:
  mutable std::vector<double> values_; ///< bin by bin
  mutable std::vector<bool> sorted_;
  std::vector<Bin> bins_;
};

} // namespace gumshoe::analysis
