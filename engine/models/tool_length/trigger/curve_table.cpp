#include "models/tool_length/trigger/curve_table.h"

#include "base/instruction_set.h"

extern "C" {
extern const gumshoe::models::tool_length::CurveTableKernels gumshoe_curve_table_sse2, gumshoe_curve_table_avx2,
    gumshoe_curve_table_avx512;
}

namespace gumshoe::models::tool_length {

const CurveTableKernels& curve_table_kernels() {
#ifdef GUMSHOE_HAS_AVX2
  switch (best_instruction_set()) {
  case InstructionSet::avx512:
    return gumshoe_curve_table_avx512;
  case InstructionSet::avx2:
    return gumshoe_curve_table_avx2;
  default:
    break;
  }
#endif
  return gumshoe_curve_table_sse2;
}

} // namespace gumshoe::models::tool_length
