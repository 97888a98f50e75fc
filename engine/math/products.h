#pragma once
/// Matrix products, compiled once per instruction set. Every sum has one order, which depends neither on the
/// instruction set nor on what else is multiplied: all give the same bits.
#include <Eigen/Core>

namespace gumshoe {

/// a'b.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

} // namespace gumshoe
