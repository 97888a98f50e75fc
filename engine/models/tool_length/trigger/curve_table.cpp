#include "models/tool_length/trigger/curve_table.h"

#include "models/kernel_choice.h"

extern "C" {
extern const gumshoe::models::tool_length::CurveTableKernels gumshoe_curve_table_sse2, gumshoe_curve_table_avx2,
    gumshoe_curve_table_avx512;
}

namespace gumshoe::models::tool_length {

const CurveTableKernels& curve_table_kernels() { return *GUMSHOE_BEST_KERNELS(curve_table); }

} // namespace gumshoe::models::tool_length
