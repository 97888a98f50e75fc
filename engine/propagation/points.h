#pragma once
/// Points at which a model is evaluated, and its results there.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "base/status.h"
#include "models/model.h"

namespace gumshoe::propagation {

/// values[reading][quantity], SI: one point per reading, quantities in the order of Layout.
using Points = std::vector<std::vector<double>>;

/// Sets or shifts one quantity.
struct Change {
  std::size_t quantity = 0;
  double value = 0;                    ///< SI
  bool absolute = false;               ///< `value` replaces what a reading has; else it is added
  std::vector<std::size_t> readings{}; ///< ascending; empty: all
};

/// Changes made together to all points.
struct Variation {
  std::vector<Change> changes;
};

/// Results of a model at points under variations. Rows are [reading][indication] or [reading][measurand]; for a joint
/// evaluation [measurand].
struct Responses {
  std::size_t rows = 0;
  std::vector<double> values; ///< [variation][row], SI; meaningless where the status is not ok
  std::vector<Status> status; ///< [variation]: ok, or why the model has no value at one of the readings
  bool ok() const {
    for (const Status s : status)
      if (s != Status::ok) return false;
    return true;
  }
  double at(std::size_t variation, std::size_t row) const { return values[variation * rows + row]; }
};

/// A derivative by one quantity, with the step for a difference, from `down` to `up`, if the model has no exact
/// derivatives.
struct Partial {
  std::size_t quantity = 0;
  double up = 0, down = 0;             ///< SI
  bool absolute = false;               ///< values of the quantity; else shifts of it
  std::vector<std::size_t> readings{}; ///< ascending: readings at which the quantity acts; empty: all. Elsewhere 0.
};

/// Indications and their derivatives.
struct Linearisation {
  std::size_t rows = 0;            ///< [reading][indication]
  std::vector<double> values;      ///< [row], SI
  std::vector<double> derivatives; ///< [partial][row], SI; 0 where none exists
  Status status = Status::ok;      ///< why the first reading without a value has none
  std::size_t failed_reading = 0;  ///< that reading; 0 if the model does not report it
  std::vector<Status> by_partial;  ///< [partial]: why a difference could not be taken
  bool kink = false;               ///< some reading has values but no derivatives here
};

/// Points of some readings as columns over samples, arranged as kernels need them: a Monte Carlo block, a table or a
/// stencil. Columns refer to values owned by the caller; stride 0: one value for all samples. clear() keeps the
/// memory.
struct Block {
  std::size_t samples = 0;                                                         ///< a multiple of 8
  std::vector<std::size_t> readings;                                               ///< [place]: reading of the model
  std::vector<models::Column> quantities, effects, indications, sizes, conditions; ///< [place][...]
  std::vector<std::size_t> solved_as; ///< [place]: earlier place with the same columns for the solve, or itself
  std::uint64_t first_sample = models::unnumbered;
  std::deque<std::vector<double>> moved; ///< columns of quantities to which stated effects add
  void clear(std::size_t samples_wanted);
};

/// Results of a model for a block. Rows are [place][indication] and [place][measurand]; for a joint evaluation
/// [measurand].
struct BlockValues {
  std::vector<double> indications;  ///< [row][sample], SI; only from a simulation
  std::vector<double> measurands;   ///< [row][sample], SI; from a simulation the true ones
  std::vector<std::uint8_t> status; ///< [sample]: code of a Status
};

/// Number of samples that hold `count` points: kernels work in groups of eight.
constexpr std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

} // namespace gumshoe::propagation
