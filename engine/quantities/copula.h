#pragma once
/// Gaussian copulas: from a stated correlation coefficient to the copula's.
#include <string>
#include <vector>

#include "quantities/distribution.h"
#include "quantities/input_quantity.h"

namespace gumshoe::quantities {

/// The coefficient of the Gaussian copula for which the stated coefficient of the two variates is r.
///   copula, multivariate t: r itself. Spearman: 2 sin(pi r / 6), any continuous distributions.
///   Pearson: r for two normals, 2 sin(pi r / 6) for two rectangulars, else the root of the series
///   r(rho) = sum_k a_k b_k rho^k over the Hermite coefficients of the two (Mehler 1866).
/// Throws InputError if no copula reaches it, or if the kind does not exist for the distributions;
/// `pair` names the two variates in the message.
double copula_coefficient(Correlation::Kind kind, double r, const Distribution& a, const Distribution& b,
                          const std::string& pair);

/// The reverse: Pearson's coefficient of two variates tied by a Gaussian copula, as the law of propagation of
/// uncertainty takes it (JCGM 100, 5.2.2). NaN where a variance is infinite.
double pearson_coefficient(double copula, const Distribution& a, const Distribution& b);

/// Lower Cholesky factor, row-major n x n. Throws InputError naming the smallest eigenvalue if the
/// matrix is not positive definite; `group` names it in the message.
std::vector<double> cholesky_factor(const std::vector<double>& matrix, std::size_t n, const std::string& group);

} // namespace gumshoe::quantities
