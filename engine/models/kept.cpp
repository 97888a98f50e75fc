#include "models/kept.h"

#include "models/expression/expression.h"

namespace gumshoe::models {

const KeepingKernels* keeping_kernels(const Model& model) { return expression::keeping_kernels(model); }

} // namespace gumshoe::models
