#pragma once
/// Evaluations that keep their intermediate values, so that one in which few columns differ goes on from them.
#include "models/model.h"

namespace gumshoe::models {

/// What a complete evaluation of a block keeps; of one thread.
struct Kept {
  std::size_t samples = 0, readings = 0; ///< of that evaluation; no samples: it kept nothing
  std::vector<Column> inputs;            ///< [reading][step]: the column that the step reads
  std::vector<double> values;            ///< [reading][operation][sample]
};

struct KeepingKernels {
  /// As Kernels::evaluate, and fills `kept`; where the values of a block take too much memory it keeps nothing.
  void (*keep)(const BlockCall& call, Kept& kept);
  /// As Kernels::evaluate, of a call that differs from the one that filled `kept` in its indications and in columns of
  /// quantities and conditions that lie elsewhere. Computes what depends on those alone. The same bits.
  void (*go_on)(const BlockCall& call, const Kept& kept);
};

/// Null for a model that keeps nothing.
const KeepingKernels* keeping_kernels(const Model& model);

} // namespace gumshoe::models
