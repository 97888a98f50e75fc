#pragma once
/// Blocks of a forward model from plain numbers.
#include <vector>

#include "propagation/forward_model.h"

namespace gumshoe::tests {

/// Adds a reading to a block; columns[i], in the order of the layout, holds one value or one per sample and must
/// outlive the block.
inline void add(propagation::Block& block, const propagation::ForwardModel& forward, std::size_t reading,
                const std::vector<std::vector<double>>& columns) {
  std::vector<models::Column> row;
  for (const auto& values : columns) row.push_back({values.data(), values.size() > 1 ? std::size_t{1} : 0});
  forward.add(block, reading, row);
}

/// One reading of `samples` samples.
inline propagation::Block block_of(const propagation::ForwardModel& forward, std::size_t samples,
                                   const std::vector<std::vector<double>>& columns) {
  propagation::Block block;
  block.clear(samples);
  add(block, forward, 0, columns);
  return block;
}

/// A column for each value.
inline std::vector<std::vector<double>> columns_of(const std::vector<double>& values) {
  std::vector<std::vector<double>> out;
  for (const double x : values) out.push_back({x});
  return out;
}

template <class T> std::vector<T> joined(std::vector<T> a, const std::vector<T>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::vector<const EffectCard*> cards_of(const std::vector<effects::Active>& active) {
  std::vector<const EffectCard*> out;
  for (const effects::Active& a : active) out.push_back(effects::cards()[a.effect]);
  return out;
}

} // namespace gumshoe::tests
