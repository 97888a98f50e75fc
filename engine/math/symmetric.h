#pragma once
/// Small symmetric matrices in double or lanes. With lanes, each lane holds a matrix of its own and its result does not
/// depend on the neighbouring lanes. Only the lower triangles are read.
#include "math/scalar.h"

namespace gumshoe {

/// Row-major N x N; at[i][j] with i >= j is read.
template <class T, int N> struct Symmetric { T at[N][N]; };

/// Solves M x = b by Cholesky decomposition of the leading n x n block.
///
/// @param m positive definite; scale it to a unit diagonal for a meaningful pivot
/// @param x b on entry, the solution on return; n values
/// @return  the smallest pivot. With a unit diagonal it lies below the smallest eigenvalue by a factor of about N at
///          most. Pivots below 1e-30 are replaced by 1e-30, so the caller has to compare the result with its own limit
///          before it uses x.
/// Source: Golub and Van Loan, Matrix Computations, section 4.2.
template <class T, int N> T solve_cholesky(Symmetric<T, N> m, T* x, int n = N) {
  T smallest(1e300);
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) m.at[j][j] = m.at[j][j] - m.at[j][k] * m.at[j][k];
    smallest = num::select(m.at[j][j] < smallest, m.at[j][j], smallest);
    const T positive = num::select(m.at[j][j] > T(1e-30), m.at[j][j], T(1e-30));
    const T inverse = 1.0 / num::sqrt(positive);
    m.at[j][j] = inverse;
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) m.at[i][j] = m.at[i][j] - m.at[i][k] * m.at[j][k];
      m.at[i][j] = m.at[i][j] * inverse;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) x[i] = x[i] - m.at[i][k] * x[k];
    x[i] = x[i] * m.at[i][i];
  }
  for (int i = n; i-- > 0;) {
    for (int k = i + 1; k < n; ++k) x[i] = x[i] - m.at[k][i] * x[k];
    x[i] = x[i] * m.at[i][i];
  }
  return smallest;
}

/// Eigenvalues and the eigenvector of each.
template <class T, int N> struct EigenSystem {
  T value[N];     ///< in no order
  T vector[N][N]; ///< [which][component], of length one
};

/// Eigenvalues and eigenvectors of the leading n x n block by cyclic Jacobi rotations.
///
/// Iterates until every off-diagonal element is below 1e-18 times the sum of the absolute diagonal, at most 60 sweeps;
/// convergence is quadratic, about 10 sweeps for N = 11. The error of an eigenvalue is a few roundings of the largest
/// one. A lane whose matrix is diagonal is not changed by the rotations of its neighbours.
/// Source: Golub and Van Loan, Matrix Computations, section 8.5.
template <class T, int N> EigenSystem<T, N> eigen_system(Symmetric<T, N> m, int n = N) {
  EigenSystem<T, N> out;
  T size(0.0);
  for (int i = 0; i < n; ++i) {
    size = size + num::abs(m.at[i][i]);
    for (int j = 0; j < n; ++j) {
      out.vector[i][j] = T(i == j ? 1.0 : 0.0);
      if (j > i) m.at[i][j] = m.at[j][i];
    }
  }
  const T zero = size * T(1e-18);
  bool turning = true;
  for (int sweep = 0; turning && sweep < 60; ++sweep) { // each squares what is left
    turning = false;
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        const auto turns = num::abs(m.at[p][q]) > zero;
        if (!num::any(turns)) continue;
        turning = true;
        const T d = m.at[q][q] - m.at[p][p], twice = m.at[p][q] + m.at[p][q];
        const T root = num::abs(d) + num::sqrt(d * d + twice * twice);
        const T t =
            num::select(turns, num::select(d < T(0.0), -twice, twice) / num::select(turns, root, T(1.0)), T(0.0));
        const T c = 1.0 / num::sqrt(t * t + T(1.0)), s = t * c, moved = t * m.at[p][q];
        m.at[p][p] = m.at[p][p] - moved;
        m.at[q][q] = m.at[q][q] + moved;
        m.at[p][q] = m.at[q][p] = num::select(turns, T(0.0), m.at[p][q]);
        const auto turn = [&](T& a, T& b) {
          const T was = a;
          a = c * was - s * b;
          b = s * was + c * b;
        };
        for (int k = 0; k < n; ++k) {
          turn(out.vector[p][k], out.vector[q][k]);
          if (k == p || k == q) continue;
          turn(m.at[p][k], m.at[q][k]);
          m.at[k][p] = m.at[p][k];
          m.at[k][q] = m.at[q][k];
        }
      }
  }
  for (int i = 0; i < n; ++i) out.value[i] = m.at[i][i];
  return out;
}

} // namespace gumshoe
