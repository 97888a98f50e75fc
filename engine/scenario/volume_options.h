#pragma once
/// The section [volume]: how far is a point of the tool from where the commands say, over the working volume?
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "models/model.h"

namespace gumshoe::scenario {

/// An axis that goes through its range, evenly spaced, both ends included.
struct VolumeRange {
  std::size_t axis = 0; ///< condition of the chain
  double from = 0, to = 0;
  std::size_t points = 2;
  double at(std::size_t i) const {
    return from + (to - from) * static_cast<double>(i) / static_cast<double>(points - 1);
  }
};

struct Volume {
  models::MadeModel chain;                   ///< serial_chain on the scenario's machine: the target is the tool's point
  std::vector<double> commands;              ///< [condition of the chain], m, rad or kg, of what has no range
  std::vector<VolumeRange> ranges;           ///< one to three, in the machine's order
  std::optional<std::array<double, 3>> tool; ///< point from the last component's frame, m; empty: the model's own
  std::uint64_t samples = 10'000;
  std::size_t points() const;
  /// Conditions of the chain at a point; the last range goes fastest.
  std::vector<double> commands_at(std::size_t point) const;
};

} // namespace gumshoe::scenario
