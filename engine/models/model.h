#pragma once
/// What every model of the catalogue offers: a card and functions over a closed list of scalars
/// (templates cannot be virtual). Physics lives in the model's own header, once.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/card.h"
#include "effects/catalogue.h"
#include "math/dual.h"

namespace gumshoe::models {

/// Values of one variable over the samples of a block; stride 0: one value for all.
struct Column {
  const double* data = nullptr;
  std::size_t stride = 0;
};

/// A block of samples for all readings. Rows of pointers are [reading][variable].
struct BlockCall {
  std::size_t samples = 0; ///< multiple of 8; the last block is padded by the caller
  std::size_t readings = 0;
  const Column* quantities = nullptr;
  const Column* effects = nullptr; ///< quantities of the active effects
  std::size_t effect_quantities = 0;
  std::span<const effects::Active> active;
  const Column* conditions = nullptr;
  Column* indications = nullptr;          ///< evaluate: read
  double* const* simulated = nullptr;     ///< simulate: [reading][indication] -> samples
  double* const* measurands = nullptr;    ///< [reading][measurand] -> samples (simulate: the true values)
  const std::size_t* solved_as = nullptr; ///< [reading]: earlier reading with the same columns for the solve, or itself
  std::uint8_t* status = nullptr;         ///< [sample], propagation::Status; 0 on entry
  int evaluation = 0;
};

/// One block of one instruction set.
struct Kernels {
  void (*simulate)(const BlockCall&);
  void (*evaluate)(const BlockCall&);
};

/// One reading at one point, for derivatives and replay.
template <class T> struct PointCall {
  const T* quantities = nullptr;
  const T* effects = nullptr;
  std::span<const effects::Active> active;
  const double* conditions = nullptr;
  const T* indications = nullptr;
  T* measurands = nullptr;
  int evaluation = 0;
};
struct PointOutcome {
  std::uint8_t status = 0;
  bool kink = false; ///< values are right, derivatives do not exist here
};

using Gradient = Dual<double, 8>;
using Curvature = Dual<Dual<double, 8>, 8>;

struct Intermediate {
  std::string name, unit;
  double value; ///< in `unit`
};

struct Model {
  const ModelCard* card;
  const Kernels* (*kernels)(); ///< of the best instruction set here
  PointOutcome (*evaluate_gradient)(const PointCall<Gradient>&);
  PointOutcome (*evaluate_curvature)(const PointCall<Curvature>&);
  /// Every intermediate value of one evaluation, in the order of computation.
  std::vector<Intermediate> (*explain)(const PointCall<double>&);
  /// What is impossible about a set of values, beyond each quantity's own limits; empty if nothing.
  std::string (*check)(const double* quantities);
  /// True if the solve reads this quantity; readings that agree in these share one solve.
  bool (*solve_reads)(std::size_t quantity);
};

std::span<const Model* const> catalogue();
const Model* find(std::string_view name);

} // namespace gumshoe::models
