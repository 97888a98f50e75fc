#pragma once
/// The walk through the windows for several tools at once, compiled once per instruction set.
#include "models/tool_length/trigger/insert_descent.h"
#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::models::tool_length {

/// What a walk found, as an answer.
inline InsertTrigger trigger_of(const DescentTrigger<double>& found, const InsertMotion& m) {
  InsertTrigger result;
  result.insert = static_cast<int>(found.insert);
  result.slope = found.slope;
  if (found.inside) {
    result.status = Status::already_covered;
    return result;
  }
  result.turned = found.turned;
  result.height = m.start_height - m.drop * found.turned;
  return result;
}

struct WalkKernels {
  /// Answers as TriggerSolver::walk gives them at its first try; `found` is false where it has to try on.
  void (*walk)(const TriggerQuestion* questions, std::size_t n, InsertTrigger* answers, bool* found);
};

/// For the best instruction set of this processor; all give the same bits.
const WalkKernels& walk_kernels();

} // namespace gumshoe::models::tool_length
