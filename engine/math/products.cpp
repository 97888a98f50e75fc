#include "math/products.h"

#include "base/instruction_set.h"
#include "math/products_kernels.h"

extern "C" {
extern const gumshoe::ProductKernels gumshoe_products_sse2, gumshoe_products_avx2, gumshoe_products_avx512;
}

namespace gumshoe {

const ProductKernels& product_kernels() {
#ifdef GUMSHOE_HAS_AVX2
  switch (best_instruction_set()) {
  case InstructionSet::avx512:
    return gumshoe_products_avx512;
  case InstructionSet::avx2:
    return gumshoe_products_avx2;
  default:
    break;
  }
#endif
  return gumshoe_products_sse2;
}

Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b) {
  eigen_assert(a.cols() <= 1 || a.outerStride() == a.rows());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  const auto size = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  product_kernels().transposed(size(a.rows()), size(a.cols()), size(b.cols()), a.data(), b.data(), out.data());
  return out;
}

} // namespace gumshoe
