/// Picks the copy of the kernels that the processor can run.
#include <atomic>

#include "base/kernel_choice.h"
#include "quantities/quantile_kernels.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::quantities::Kernels, quantity_kernels)

namespace gumshoe::quantities {

const Kernels& kernels(InstructionSet set) { return *GUMSHOE_KERNELS(quantity_kernels, set); }

namespace {
std::atomic<const Kernels*>& selected() {
  static std::atomic<const Kernels*> table = &kernels(best_instruction_set());
  return table;
}
} // namespace

const Kernels& kernels() { return *selected().load(std::memory_order_relaxed); }

void select_kernels(InstructionSet set) { selected() = &kernels(set); }

} // namespace gumshoe::quantities
