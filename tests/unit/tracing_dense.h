#pragma once
/// Generalised least squares with dense covariance matrices, written independently of engine/tracing, and random
/// designs.
#include <random>

#include "tracing/fit/scan.h"

namespace tracing_dense {

using namespace gumshoe::tracing;

/// Independent standard normal numbers.
Matrix normal_matrix(Index rows, Index columns, std::mt19937_64& chance);
/// `readings` readings of k indications in SI units of micrometres: p fixed and q random columns, own noise of unequal
/// size (correlated between indications), and a label of `groups` values that may scatter.
Design random_design(std::size_t readings, std::size_t k, Index p, Index q, std::size_t groups, std::uint64_t seed);
std::vector<Index> all_rows(const Design& d);
/// The rows with these numbers.
Matrix chosen(const Matrix& all, const std::vector<Index>& rows);
/// Own noise of the chosen rows, block by block.
Matrix local_factor(const Design& d, const std::vector<Index>& rows);
/// V: serial correlation along the chosen readings, declared draws, variance component.
Matrix covariance(const Design& d, const std::vector<Index>& rows, const CovarianceModel& s);

/// Generalised least squares of y on x.
struct Gls {
  Vector size;
  Matrix covariance;
  double squares = 0; ///< (y - x b)' V^-1 (y - x b)
};
Gls gls(const Matrix& v, const Matrix& x, const Vector& y);
/// ln det m of a positive definite matrix.
double ln_determinant(const Matrix& m);
/// Columns of a, then of b.
Matrix joined(const Matrix& a, const Matrix& b);
/// A candidate with these columns.
Candidate candidate(const Matrix& columns);
/// y less its projection on the columns.
Vector outside(const Matrix& columns, const Vector& y);
/// The same of columns of any rank, all of about one length, and of several y at once.
Matrix left_by(const Matrix& columns, const Matrix& y);
Index rank(const Matrix& m);
/// v^-1 f of a positive definite matrix v.
Matrix solved(const Matrix& v, const Matrix& f);

} // namespace tracing_dense
