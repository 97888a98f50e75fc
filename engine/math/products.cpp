#include "math/products.h"

#include "base/kernel_choice.h"
#include "math/products_kernels.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::ProductKernels, products)

namespace gumshoe {

const ProductKernels& product_kernels() { return *GUMSHOE_BEST_KERNELS(products); }

Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b) {
  eigen_assert(a.cols() <= 1 || a.outerStride() == a.rows());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  const auto size = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  product_kernels().transposed(size(a.rows()), size(a.cols()), size(b.cols()), a.data(), b.data(), out.data());
  return out;
}

} // namespace gumshoe
