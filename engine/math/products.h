#pragma once
/// Matrix products, compiled once per instruction set. Every sum has one order, which depends neither on the
/// instruction set nor on what else is multiplied: all give the same bits.
#include <Eigen/Core>

namespace gumshoe {

/// a'b. The columns of `a` lie one after the other.
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::MatrixXd& b);

} // namespace gumshoe
