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
/// +1 and -1 are exact; as a Pearson coefficient they need distributions of one shape (mirrored for -1).
/// Throws InputError if no copula reaches it, or if the kind does not exist for the distributions;
/// `pair` names the two variates in the message.
double copula_coefficient(Correlation::Kind kind, double r, const Distribution& a, const Distribution& b,
                          const std::string& pair);

/// The reverse: Pearson's coefficient of two variates tied by a Gaussian copula, as the law of propagation of
/// uncertainty takes it (JCGM 100, 5.2.2). Where a t has no variance, the framework takes its scale for u (4.2.3), and
/// the copula's coefficient stands. NaN where any other variance is infinite.
double pearson_coefficient(double copula, const Distribution& a, const Distribution& b);

/// A correlation matrix as the product of a lower triangle with its transpose.
struct CorrelationFactor {
  std::vector<std::size_t> order; ///< rows of the matrix, in the order of the factor's rows
  std::vector<double> lower;      ///< row-major n x n; trailing columns are zero where the matrix is singular
};

/// Cholesky factor of a row-major n x n matrix. Positive definite: in the matrix' own order. Singular (a coefficient of
/// +-1, or quantities that determine another), which is to say that its smallest eigenvalue is not above n 9e-16: with
/// pivoting, so that it reproduces the matrix to that, or to n times an eigenvalue below zero. Throws InputError naming
/// the smallest eigenvalue if that is below -n 1e-12; `group` names the matrix, and `stated` is the matrix that it was
/// computed from.
CorrelationFactor correlation_factor(const std::vector<double>& matrix, const std::vector<double>& stated,
                                     std::size_t n, const std::string& group);

} // namespace gumshoe::quantities
