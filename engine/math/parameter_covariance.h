#pragma once
/// What a Jacobian says of its parameters: covariance, rank, and directions that the residuals cannot see.
#include <cstddef>
#include <vector>

namespace gumshoe::least_squares {

/// A change of parameters that leaves all residuals unchanged.
struct Direction {
  std::vector<double> change; ///< [p], by x; its largest effect on the residuals has length 1
  std::vector<double> share;  ///< [p], effect of each parameter's part alone, largest 1
};

struct ParameterCovariance {
  std::size_t rank = 0;
  double condition = 0; ///< largest over smallest singular value, columns scaled to length one; infinity if rank < p
  std::vector<double> matrix;    ///< [p][p]: (J'J)^-1; on the seen subspace only where rank < p
  std::vector<bool> determined;  ///< [p]: false if a direction without effect moves this parameter
  std::vector<Direction> unseen; ///< p - rank of them, each with few members
  Direction weakest;             ///< of the smallest singular value kept
};

/// jacobian[n][p], rows whitened. A column counts as zero if a change of its parameter by `magnitude` is negligible
/// compared with the other columns; singular values below tolerance x the largest count as zero. Uses QR and SVD
/// (Golub and Van Loan, chapter 5), never J'J.
ParameterCovariance parameter_covariance(const std::vector<double>& jacobian, std::size_t n, std::size_t p,
                                         const std::vector<double>& magnitude, double tolerance = 1e-11);

} // namespace gumshoe::least_squares
