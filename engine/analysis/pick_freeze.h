#pragma once
/// The pick-freeze design of Sobol' indices.
///
/// Rows A and B are independent draws; AB_i is A with factor i taken from B, and BA_i is B with factor i taken from A.
/// The model runs for all of them, and its values are reduced to sums over groups of rows. A factor is one variate, or
/// all variates of a quantity: Sobol' indices are defined for groups as they are for single inputs. Source: Saltelli et
/// al. 2010, Computer Physics Communications 181.
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/pick_freeze_sums.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// reaches[output][variate]
std::vector<std::vector<bool>> reaching_variates(const propagation::Experiment& experiment);

/// What an index belongs to.
struct Factor {
  std::string name;
  std::vector<std::size_t> variates;
};
/// One factor per variate, or one per quantity with `by = "quantity"` in the scenario.
std::vector<Factor> factors(const propagation::Experiment& experiment);
/// True if any variate of the factor reaches the output.
bool reaches(const std::vector<bool>& variates, const Factor& factor);

/// Sums over groups of rows: by output; by output and factor; by output and pair of factors.
struct PickFreezeSums {
  std::uint64_t rows = 0;
  std::size_t outputs = 0, factors = 0, groups = 0;
  bool mirrored = false;      ///< with rows BA_i, and pairs
  std::vector<double> values; ///< [sum][group]

  PickFreezeSums(std::uint64_t rows, std::size_t outputs, std::size_t factors, std::size_t groups, bool mirrored);
  /// Sum s over the groups.
  double* base(std::size_t output, std::size_t s) { return at(output * base_sums + s); }
  double* frozen(std::size_t output, std::size_t v, std::size_t s) {
    return at(outputs * base_sums + (output * factors + v) * kept() + s);
  }
  /// of (c_i - a) (d_j - b) + (c_j - a) (d_i - b), i < j
  double* pair(std::size_t output, std::size_t i, std::size_t j) {
    return at(outputs * (base_sums + factors * kept()) + output * pairs() + j * (j - 1) / 2 + i);
  }
  std::size_t kept() const { return mirrored ? std::size_t{frozen_sums} : std::size_t{frozen_d}; }
  std::size_t pairs() const { return mirrored ? factors * (factors - 1) / 2 : 0; }
  /// Number of sums of a group.
  std::size_t sums() const { return outputs * (base_sums + factors * kept() + pairs()); }

private:
  double* at(std::size_t sum) { return &values[sum * groups]; }
};

/// The design's model runs: n rows, rounded up to a multiple of 64, take n (d + 2) runs for d factors, n (2 d + 2) if
/// mirrored. A unit is one group of rows and gives its sums.
/// @param mirrored with the rows BA_i, which second-order indices need
propagation::Work pick_freeze_work(const propagation::Experiment& experiment, std::uint64_t n, bool mirrored);

/// Runs the design and sums its values.
/// @return sums of outputs (SI) relative to an origin near their mean; a row in which any run failed is left out of all
///         sums
PickFreezeSums run_pick_freeze(const propagation::Experiment& experiment, std::uint64_t n, bool mirrored,
                               const propagation::Workers& workers);

} // namespace gumshoe::analysis
