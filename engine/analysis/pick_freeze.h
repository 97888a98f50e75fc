#pragma once
/// The pick-freeze design: rows A and B of independent draws, AB_i = A with factor i from B, and BA_i = B with
/// factor i from A; the model run for all of them, reduced to sums over groups of rows. A factor is a variate, or all
/// variates of a quantity: Sobol' indices hold for groups as they do for single inputs.
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/pick_freeze_sums.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// How many rows make a group: about a thousand groups, enough to know a standard error within 3 %.
std::size_t rows_per_group(std::uint64_t rows);

/// reaches[output][variate]
std::vector<std::vector<bool>> reaching_variates(const propagation::Experiment& experiment);

struct Factor {
  std::string name;
  std::vector<std::size_t> variates;
};
/// By the scenario's choice: one per variate, or one per quantity that has any.
std::vector<Factor> factors(const propagation::Experiment& experiment);
/// True if any variate of the factor reaches the output.
bool reaches(const std::vector<bool>& variates, const Factor& factor);

struct PickFreezeSums {
  std::uint64_t rows = 0;
  std::size_t outputs = 0, factors = 0, groups = 0;
  bool mirrored = false; ///< with rows BA_i, and pairs
  std::vector<double> base_values, frozen_values, pair_values;

  /// Sum s over the groups.
  double* base(std::size_t output, std::size_t s) { return &base_values[(output * base_sums + s) * groups]; }
  double* frozen(std::size_t output, std::size_t v, std::size_t s) {
    return &frozen_values[((output * factors + v) * kept() + s) * groups];
  }
  /// of (c_i - a) (d_j - b) + (c_j - a) (d_i - b), i < j
  double* pair(std::size_t output, std::size_t i, std::size_t j) {
    return &pair_values[(output * pairs() + j * (j - 1) / 2 + i) * groups];
  }
  std::size_t kept() const { return mirrored ? std::size_t{frozen_sums} : std::size_t{frozen_d}; }
  std::size_t pairs() const { return factors * (factors - 1) / 2; }
};

/// n rows, rounded up to a multiple of 64; n (d + 2) model runs for d factors, with `mirrored` n (2 d + 2). Outputs are taken from
/// an origin near their mean. A row in which any run failed is left out of all sums.
PickFreezeSums run_pick_freeze(const propagation::Experiment& experiment, const std::vector<Factor>& factors,
                               std::uint64_t n, bool mirrored, int threads);

} // namespace gumshoe::analysis
