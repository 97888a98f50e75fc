/// Picks the copy of the kernels that the processor can run.
#include <atomic>

#include "quantities/quantile_kernels.h"

extern "C" {
#define GUMSHOE_DECLARE(isa) extern const gumshoe::quantities::Kernels gumshoe_quantity_kernels_##isa;
GUMSHOE_DECLARE(sse2)
#ifdef GUMSHOE_HAS_AVX2
GUMSHOE_DECLARE(avx2)
#endif
#ifdef GUMSHOE_HAS_AVX512
GUMSHOE_DECLARE(avx512)
#endif
}

namespace gumshoe::quantities {

const Kernels& kernels(InstructionSet set) {
  switch (set) {
#ifdef GUMSHOE_HAS_AVX512
  case InstructionSet::avx512:
    return gumshoe_quantity_kernels_avx512;
#endif
#ifdef GUMSHOE_HAS_AVX2
  case InstructionSet::avx2:
    return gumshoe_quantity_kernels_avx2;
#endif
  default:
    return gumshoe_quantity_kernels_sse2;
  }
}

namespace {
std::atomic<const Kernels*>& selected() {
  static std::atomic<const Kernels*> table = &kernels(best_instruction_set());
  return table;
}
} // namespace

const Kernels& kernels() { return *selected().load(std::memory_order_relaxed); }

void select_kernels(InstructionSet set) { selected() = &kernels(set); }

} // namespace gumshoe::quantities
