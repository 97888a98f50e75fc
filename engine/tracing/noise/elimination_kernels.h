#pragma once
/// The loops of an elimination, compiled once per instruction set. Every number of a column is computed by itself, so
/// all sets give the same bits.
#include <cstddef>
#include <cstdint>

namespace gumshoe::tracing {

/// By row up to `*_end[row]`: slots that open, rotations with the slot that each turns the row with, slots that close.
struct EliminationPlan {
  std::size_t rows = 0, slots = 0;
  std::size_t lag = 1;    ///< rows are correlated with those so far before them ...
  double correlation = 0; ///< ... by so much
  const std::uint32_t *opened, *opened_end, *slot, *rotation_end, *closed, *closed_end;
  const double *cosine, *sine;
};

/// Columns that are treated together: t is [row][lane], state is [slot, then lag][lane].
inline constexpr std::size_t elimination_lanes = 32, few_elimination_lanes = 8;

struct EliminationKernels {
  /// Rows are made uncorrelated and rotated into the open slots; what is left of them stays in t. `kept` [close][lane]:
  /// what a slot holds when it closes; or null.
  void (*reduce)(const EliminationPlan& plan, std::size_t lanes, double* t, double* state, double* kept);
  /// The transpose of what `reduce` does to rows: rotates back, with nothing in the slots, and correlates.
  void (*restore)(const EliminationPlan& plan, std::size_t lanes, double* t, double* state);
};

/// For the best instruction set of this processor.
const EliminationKernels& elimination_kernels();

} // namespace gumshoe::tracing
