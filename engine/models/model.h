#pragma once
/// What every model offers: a card and functions over a closed list of scalars (templates cannot be
/// virtual). Physics lives in the model's own header, once.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/card.h"
#include "base/status.h"
#include "effects/effect.h"
#include "math/dual.h"

namespace gumshoe::chain {
struct MachineDescription;
}

namespace gumshoe::models {

/// Values of one variable over the samples of a block; stride 0: one value for all.
struct Column {
  const double* data = nullptr;
  std::size_t stride = 0;
};

/// What is declared of the data, for evaluations that weight them: draws, each with its standard uncertainty and all
/// that it moves, and which of them are correlated.
struct Declared {
  struct Moved {
    std::size_t reading, column; ///< of the model's quantities, then of the indications
    double by = 1;               ///< times the draw
  };
  struct Draw {
    double u; ///< SI
    std::vector<Moved> moves;
  };
  struct Tie {
    std::size_t a, b;   ///< two different draws
    double correlation; ///< Pearson's coefficient
  };
  std::vector<double> estimates; ///< [reading][quantity of the model]
  std::vector<Draw> draws;
  std::vector<Tie> ties;
};

/// BlockCall::first_sample of points that are not samples of the run (the estimates, an analysis).
inline constexpr std::uint64_t unnumbered = ~std::uint64_t{0};

/// A block of samples for all readings. Rows of pointers are [reading][variable].
struct BlockCall {
  std::size_t samples = 0; ///< multiple of 8; the last block is padded by the caller
  std::size_t readings = 0;
  const Column* quantities = nullptr;
  const Column* effects = nullptr; ///< quantities of the active effects
  std::size_t effect_quantities = 0;
  std::span<const effects::Active> active;
  const Column* conditions = nullptr;
  const Column* indications = nullptr; ///< evaluate: read
  double* const* simulated = nullptr;  ///< simulate: [reading][indication] -> samples
  /// [reading][measurand] -> samples, of a joint evaluation [measurand] -> samples (simulate: the true values).
  double* const* measurands = nullptr;
  const std::size_t* solved_as = nullptr; ///< [reading]: earlier reading with the same columns for the solve, or itself
  std::uint8_t* status = nullptr;         ///< [sample], Status; 0 on entry
  int evaluation = 0;
  const void* context = nullptr;           ///< Model::context
  const Declared* declared = nullptr;      ///< of a joint evaluation in a scenario
  std::uint64_t first_sample = unnumbered; ///< of the run, for messages only
};

/// One block of one instruction set. `simulate` is null if the model only evaluates. What a user wrote (a plugin, a
/// command) may throw an InputError: the run stops there and keeps the blocks before.
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
  T* simulated = nullptr; ///< simulate only: indications, for the true values among the quantities
  int evaluation = 0;
  const void* context = nullptr; ///< Model::context
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

struct Model;
/// A model made from a scenario (an expression, a plugin, a command): the pointer owns card and context.
using MadeModel = std::shared_ptr<const Model>;

struct Model {
  const ModelCard* card;
  const Kernels* (*kernels)(); ///< for the best instruction set of this processor
  /// Exact derivatives of one reading's measurands; null for a model that has none (a plugin, a command). There, and
  /// for joint evaluations, the engine takes differences.
  PointOutcome (*evaluate_gradient)(const PointCall<Gradient>&);
  PointOutcome (*evaluate_curvature)(const PointCall<Curvature>&);
  /// Indications of one reading and their exact derivatives; null if the model only evaluates.
  PointOutcome (*simulate_gradient)(const PointCall<Gradient>&);
  /// Every intermediate value of one evaluation, in the order of computation.
  std::vector<Intermediate> (*explain)(const PointCall<double>&);
  /// Message if the estimates are impossible although each is within its limits; empty otherwise. May throw an
  /// InputError that names the place (a character of a formula).
  std::string (*check)(const PointCall<double>&);
  /// True if the solve reads this quantity; readings that agree in these share one solve.
  bool (*solve_reads)(std::size_t quantity);
  /// Data of a model made at run time, passed in every call. Null for models of the catalogue.
  const void* context = nullptr;
  std::size_t block = 0; ///< preferred smallest number of samples per call; 0: none. Results do not depend on it.
  /// Number of measurands (the first ones) that a joint evaluation defines at these estimates, such as one per flute.
  /// Null: all.
  std::size_t (*measurands_in_use)(int evaluation, const double* quantities) = nullptr;
  /// Message if all readings together, one sample at the estimates, are impossible; empty otherwise. May be null.
  std::string (*check_readings)(const BlockCall&) = nullptr;
  /// Remarks on all readings together, one sample at the estimates, such as directions that they do not determine.
  std::vector<std::string> (*remarks)(const BlockCall&) = nullptr;
  /// The model on another machine than the card's, as `[machine]` describes it without errors of the description; null
  /// where it does not fit, and `why` says what it lacks. Null: the model's machine is fixed.
  MadeModel (*on_machine)(const chain::MachineDescription& machine, std::string& why) = nullptr;
  /// The evaluation whose machine a virtual experiment simulates, of one that is not joint. Null: the first.
  int (*machine_of)(int evaluation) = nullptr;
};

/// The models of the catalogue; those that a scenario makes are not among them.
std::span<const Model* const> catalogue();
/// Null if the catalogue has no model of this name.
const Model* find(std::string_view name);

} // namespace gumshoe::models
