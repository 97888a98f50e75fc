#pragma once
/// The loops of matrix products, compiled once per instruction set.
#include <cstddef>

namespace gumshoe {

/// c += a'b for matrices by columns, each `rows` long: a has m columns, b and c have n.
struct ProductKernels {
  void (*transposed)(std::size_t rows, std::size_t m, std::size_t n, const double* a, const double* b, double* c);
};

/// For the best instruction set of this processor.
const ProductKernels& product_kernels();

} // namespace gumshoe
