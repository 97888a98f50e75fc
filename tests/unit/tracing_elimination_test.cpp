#include <random>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "tracing/noise/elimination.h"

using Approx = Catch::Detail::Approx;
using namespace gumshoe::tracing;

namespace {

/// Offsets of blocks that overlap, two columns of all rows, and a declared column of every second block.
struct Blocks {
  static constexpr std::size_t rows = 60, of_block = 7, blocks = 9, free = blocks + 2;
  static constexpr std::size_t columns = free + 5;
  std::vector<SparseRow> sparse{rows};
  Matrix dense = Matrix::Zero(rows, columns);
  explicit Blocks(unsigned seed) {
    std::mt19937_64 chance(seed);
    std::normal_distribution<double> normal;
    const auto put = [&](std::size_t row, std::size_t column) {
      sparse[row].push_back({column, dense(index(row), index(column)) = normal(chance)});
    };
    for (std::size_t i = 0; i < rows; ++i) {
      put(i, i / of_block);
      if (i % of_block == 0 && i > 0) put(i, i / of_block - 1); // as serial correlation leaves them
      put(i, blocks);
      put(i, blocks + 1);
      if (i / of_block % 2 == 0) put(i, free + i / of_block / 2);
    }
  }
  /// P by the normal equations, the declared columns with their unit rows.
  Matrix normal_matrix() const {
    Matrix out = dense.transpose() * dense;
    for (Index j = free; j < index(columns); ++j) out(j, j) += 1;
    return out;
  }
};

Matrix numbers(Index rows, Index columns) {
  std::mt19937_64 chance(7);
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(chance); });
}

} // namespace

TEST_CASE("elimination agrees with the normal equations", "[tracing]") {
  const Blocks b(3);
  const Elimination e(b.sparse, Blocks::columns, Blocks::free);
  const Matrix normal = b.normal_matrix(), inverse = normal.inverse(), y = numbers(Blocks::rows, 41);
  const Matrix left = y - b.dense * inverse * b.dense.transpose() * y, products = y.transpose() * left;
  CHECK((e.projected(y) - left).norm() < 1e-12 * left.norm());
  const Matrix r = e.reduced(y);
  CHECK((r.transpose() * r - products).norm() < 1e-12 * products.norm());
  CHECK((e.squares(y) - products.diagonal()).norm() < 1e-12 * products.diagonal().norm());
  CHECK((e.solved(y) - inverse * b.dense.transpose() * y).norm() < 1e-10 * y.norm());
  CHECK((e.covariance(Blocks::free) - inverse.topLeftCorner(Blocks::free, Blocks::free)).norm() <
        1e-10 * inverse.norm());
  double pivots = 0;
  for (std::size_t j = 0; j < Blocks::columns; ++j) pivots += 2 * e.log_pivot(j);
  CHECK(pivots == Approx(std::log(normal.determinant())).epsilon(1e-12));
}

TEST_CASE("a column is eliminated to the same bits alone and among others", "[tracing]") {
  const Blocks b(4);
  const Elimination e(b.sparse, Blocks::columns, Blocks::free);
  const Matrix y = numbers(Blocks::rows, 45), together = e.reduced(y), solved = e.solved(y);
  const Vector squares = e.squares(y);
  for (Index j = 0; j < y.cols(); ++j) {
    CHECK(e.reduced(y.col(j)) == Matrix(together.col(j)));
    CHECK(e.solved(y.col(j)) == Matrix(solved.col(j)));
    CHECK(e.squares(y.col(j))[0] == squares[j]);
  }
}

TEST_CASE("a column that no row moves stays at its declared value", "[tracing]") {
  const std::vector<SparseRow> rows{{{0, 2.0}}, {{0, 1.0}}};
  const Elimination e(rows, 2, 1);
  const Matrix y = Matrix::Ones(2, 1);
  CHECK(e.solved(y)(0, 0) == Approx(3.0 / 5));
  CHECK(e.solved(y)(1, 0) == 0);
  CHECK(e.covariance(2)(1, 1) == 1);
  CHECK(e.squares(y)[0] == Approx(1.0 / 5));
}

TEST_CASE("an entry whose square is no number counts for nothing", "[tracing]") {
  // Rotations by angles of rounding leave such entries.
  for (const double nothing : {1e-165, 1e-200, 1e-320}) {
    const std::vector<SparseRow> rows{{{0, 1.0}, {1, nothing}}, {{1, nothing}}, {{0, 1.0}, {1, 2.0}}, {{1, 1.0}}};
    const Elimination e(rows, 2, 2);
    const Matrix y = (Matrix(4, 1) << 3, 5, 7, 1).finished();
    // Rows 1, 3 and 4: (1 0), (1 2), (0 1) x = (3, 7, 1); the second is left alone.
    const Matrix a = (Matrix(3, 2) << 1, 0, 1, 2, 0, 1).finished();
    const Vector b = (Vector(3) << 3, 7, 1).finished(), x = (a.transpose() * a).inverse() * a.transpose() * b;
    CHECK((e.solved(y) - x).norm() < 1e-12);
    CHECK(e.squares(y)[0] == Approx(25 + (b - a * x).squaredNorm()));
  }
}
