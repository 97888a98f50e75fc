#include "models/tool_length/trigger/curve_table.h"

#include "base/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::models::tool_length::CurveTableKernels, curve_table)

namespace gumshoe::models::tool_length {

const CurveTableKernels& curve_table_kernels() { return *GUMSHOE_BEST_KERNELS(curve_table); }

} // namespace gumshoe::models::tool_length
