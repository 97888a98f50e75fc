/// Pure error and lack of fit against dense matrices: two-way layouts of cells and passes, written independently of
/// engine/tracing/noise.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tracing/criteria.h"
#include "tracing/noise/pure_error.h"
#include "unit/tracing_dense.h"

using namespace tracing_dense;
using Approx = Catch::Detail::Approx;

namespace {

/// Set-ups with an offset and a declared column each; most of the cells are measured in each of them.
struct Setups {
  Design design;
  Replicates replicates;
  std::vector<Index> rows;

  Setups(std::size_t k, std::size_t setups, std::size_t cells, std::uint64_t seed) {
    std::mt19937_64 chance(seed);
    for (std::size_t s = 0; s < setups; ++s)
      for (std::size_t c = 0; c < cells; ++c) {
        if (chance() % 8 == 0) continue; // not in this set-up
        replicates.cell.push_back((c + s) % cells);
        replicates.pass.push_back(s);
      }
    replicates.passes_are_blocks = true;
    const std::size_t n = replicates.cell.size();
    design = random_design(n, k, 2, 3, 0, seed);
    const auto own = [&](Matrix& to, double size) {
      const Index first = to.cols();
      to.conservativeResize(Eigen::NoChange, first + index(setups));
      to.rightCols(index(setups)).setZero();
      for (std::size_t i = 0; i < n * k; ++i) to(index(i), first + index(replicates.pass[i / k])) = size;
    };
    own(design.fixed, 1.0);
    own(design.random, 2e-6);
    for (std::size_t i = 0; i < n * k; ++i)
      if (i / k % 9 != 4) rows.push_back(index(i)); // whole readings are left out
  }

  /// A column for each group and indication: ones, or the number of the reading. Dense, over the chosen rows, in SI.
  Matrix by_group(const std::vector<std::size_t>& group, bool line, std::size_t least = 0) const {
    const std::size_t k = design.indications, groups = *std::ranges::max_element(group) + 1;
    std::vector<std::size_t> count(groups, 0);
    for (const Index row : rows) ++count[group[index(row) / k]];
    Matrix out = Matrix::Zero(index(rows.size()), index(groups * k));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t g = group[index(rows[i]) / k];
      if (count[g] >= least * k)
        out(index(i), index(g * k + index(rows[i]) % k)) = line ? static_cast<double>(index(rows[i]) / k) : 1.0;
    }
    return out;
  }
  Matrix white(const Matrix& columns) const {
    return local_factor(design, rows).triangularView<Eigen::Lower>().solve(columns);
  }
  Matrix unit(const Matrix& columns) const {
    Matrix out = white(columns);
    for (Index j = 0; j < out.cols(); ++j) out.col(j).normalize(); // zero stays zero
    return out;
  }
  Matrix model() const { return unit(joined(chosen(design.fixed, rows), chosen(design.random, rows))); }
  Matrix nuisance() const { return joined(model(), unit(by_group(replicates.pass, false))); }
  Matrix with_cells() const { return joined(nuisance(), unit(by_group(replicates.cell, false))); }
  Matrix with_lines() const {
    return joined(with_cells(), unit(joined(by_group(replicates.pass, true),
                                            by_group(replicates.cell, true, criteria.repeats_for_line))));
  }
  /// Noise of all chosen rows, none of which is outlying.
  Matrix noise(Index sets, std::uint64_t seed) const {
    std::mt19937_64 chance(seed);
    return local_factor(design, rows) * normal_matrix(index(rows.size()), sets, chance).cwiseMax(-1.8).cwiseMin(1.8);
  }
};

double squares_outside(const Matrix& columns, const Vector& y) { return left_by(columns, y).squaredNorm(); }

} // namespace

TEST_CASE("pure error is what dense columns of model, cells, passes and their lines leave", "[tracing]") {
  struct Layout {
    std::size_t k, setups, cells;
  };
  // More cells than set-ups and fewer: rows are eliminated cell by cell, and as measured.
  for (const auto& [k, setups, cells] : {Layout{1, 6, 40}, Layout{1, 30, 6}, Layout{3, 7, 12}}) {
    const Setups s(k, setups, cells, 11 * setups + k);
    const PureError pure(s.design, s.rows, s.replicates, 1);
    const Matrix columns = s.with_lines(), y = s.noise(9, 5), clean = s.white(y);
    const auto n = static_cast<double>(s.rows.size());
    REQUIRE(pure.freedom() == n - static_cast<double>(rank(columns)));
    CHECK(pure.cells() == cells);
    const Vector scale = pure.scale(y), lack = pure.lack_of_fit(y);
    const Matrix about = pure.about_cells(y);
    const double without = n - static_cast<double>(rank(s.nuisance()));
    for (Index j = 0; j < y.cols(); ++j) {
      CHECK(scale[j] == Approx(std::sqrt(squares_outside(columns, clean.col(j)) / pure.freedom())).epsilon(1e-9));
      CHECK((about.col(j) - left_by(s.with_cells(), clean.col(j))).norm() < 1e-9 * clean.col(j).norm());
      const double ratio = squares_outside(s.nuisance(), clean.col(j)) / squares_outside(s.with_cells(), clean.col(j));
      CHECK(lack[j] == Approx(without * std::log(ratio)).epsilon(1e-8));
    }
  }
}

TEST_CASE("outlying readings are left out of the pure error, each with its degree of freedom", "[tracing]") {
  const Setups s(1, 12, 9, 4);
  const PureError pure(s.design, s.rows, s.replicates, 1);
  Matrix y = s.noise(1, 8);
  const Matrix local = local_factor(s.design, s.rows);
  Matrix columns = s.with_lines();
  for (const Index row : {3, 40, 41}) {
    y(row, 0) += 60 * local(row, row);
    columns = joined(columns, Vector::Unit(columns.rows(), row));
  }
  // What replaces a reading settles within 1 % of the scale, and squares by less than its square.
  const double scale = std::sqrt(squares_outside(columns, s.white(y)) / (pure.freedom() - 3));
  CHECK(pure.scale(y)[0] == Approx(scale).epsilon(1e-3));
}

TEST_CASE("of the readings of a cell the bad one is left out, and not that with the largest residual", "[tracing]") {
  // Four or five readings of a cell with a straight line: the others take up most of what is wrong with the first.
  const Setups s(1, 5, 40, 21);
  const PureError pure(s.design, s.rows, s.replicates, 1);
  const Matrix columns = s.with_lines(), local = local_factor(s.design, s.rows);
  const Matrix left = left_by(columns, Matrix::Identity(columns.rows(), columns.rows()));
  int masked = 0;
  std::size_t others = 0, readings = 0;
  for (Index row = 0; row < index(s.rows.size()); ++row) {
    if (left(row, row) < 0.1) continue; // nothing but this reading itself says what it should be
    bool twin = false;                  // nothing tells it from another
    for (Index other = 0; other < left.rows(); ++other)
      twin |= other != row && std::fabs(left(other, row)) > 0.9 * std::sqrt(left(row, row) * left(other, other));
    if (twin) continue;
    masked += left.col(row).cwiseAbs().maxCoeff() > std::fabs(left(row, row));
    Vector y = s.noise(1, 7 + static_cast<std::uint64_t>(row));
    y[row] += 200 * local(row, row);
    const auto found = pure.outlying(y);
    CHECK(std::ranges::count(found, row) == 1);
    others += found.size() - 1;
    readings += s.rows.size();
  }
  CHECK(masked > 0);
  // One normal reading in 2,150 is beyond the limit by chance.
  CHECK(others <= readings / 2150);
}

TEST_CASE("pure error has the same bits on any number of threads and among any data sets", "[tracing]") {
  const Setups s(1, 20, 9, 6);
  Matrix y = s.noise(150, 3);
  for (Index j = 0; j < y.cols(); j += 3) y(j % y.rows(), j) *= 30;
  const PureError one(s.design, s.rows, s.replicates, 1), many(s.design, s.rows, s.replicates, 5);
  const Vector scale = one.scale(y), lack = one.lack_of_fit(y);
  CHECK(many.scale(y) == scale);
  CHECK(many.lack_of_fit(y) == lack);
  CHECK(many.about_cells(y) == one.about_cells(y));
  for (const Index j : {0, 1, 63, 99, 149}) {
    CHECK(one.scale(y.col(j))[0] == scale[j]);
    CHECK(one.lack_of_fit(y.col(j))[0] == lack[j]);
  }
}

TEST_CASE("a column that earlier ones explain is left out, as orthogonalisation one after the other has it",
          "[tracing]") {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    std::mt19937_64 chance(seed);
    constexpr Index rows = 60, blocks = 12;
    // Offsets of blocks, their sums, columns of all rows, and copies in other units, in any order.
    Matrix all = Matrix::Zero(rows, 0);
    const auto add = [&](const Vector& column) { all = joined(all, column); };
    for (Index b = 0; b < blocks; ++b) {
      Vector one = Vector::Zero(rows);
      one.segment(b * 5, 5).setOnes();
      add(one);
      if (b % 3 == 0) add(1e6 * one);
      if (b % 4 == 1) add(all.rightCols(1) + 3 * all.col(0));
    }
    const Matrix free = normal_matrix(rows, 4, chance);
    for (Index j = 0; j < 4; ++j) add(free.col(j));
    add(Vector::Ones(rows));
    add(free * Vector::Ones(4) + all.col(3));
    add(Vector::Zero(rows));
    std::vector<Index> order(index(all.cols()));
    for (Index j = 0; j < all.cols(); ++j) order[index(j)] = j;
    std::ranges::shuffle(order, chance);
    Design d = random_design(index(rows), 1, 0, 0, 0, seed);
    d.fixed = Matrix(all(Eigen::all, order));
    std::vector<Index> expected;
    Matrix before(rows, 0);
    for (Index j = 0; j < d.fixed.cols(); ++j) {
      const Vector x = d.fixed.col(j).normalized();
      if (!(d.fixed.col(j).norm() > 0) || left_by(before, x).norm() < 1e-7) continue;
      before = joined(before, x);
      expected.push_back(j);
    }
    CHECK(independent(d, all_rows(d)) == expected);
  }
}

TEST_CASE("draws are the same whatever else is drawn with them", "[tracing]") {
  Design d = random_design(40, 2, 2, 3, 8, 9);
  const CovarianceModel model{0.4, 0, 2.0};
  const Whitened w(d, all_rows(d), {0, 1}, model);
  const NoiseShape shape{0.1, {5.0, 9.0, 20.0}, {}};
  for (const std::size_t of : {50, 51}) {
    const Matrix together = w.draw(of, 7, shape);
    for (const std::size_t first : {0, 16, 48}) {
      const std::size_t count = std::min<std::size_t>(of - first, 16);
      CHECK(w.draw(Draws{first, count, of}, 7, shape) == Matrix(together.middleCols(index(first), index(count))));
    }
  }
}
