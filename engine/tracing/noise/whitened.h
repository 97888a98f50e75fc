#pragma once
/// Some rows of a design under one covariance model: whitening, elimination of its columns, draws of the noise.
#include <memory>
#include <optional>
#include <vector>

#include "tracing/noise/design.h"
#include "tracing/noise/elimination.h"
#include "tracing/noise/innovations.h"

namespace gumshoe::tracing {

/// Deviation of the noise of draws from a normal distribution.
struct NoiseShape {
  double share = 0;          ///< share of outlying readings
  std::vector<double> sizes; ///< their sizes, in standard deviations of the others
  /// Rows x nodes: response of each reading to a draw bend_node(j) of the variance component, in SI at scale 1; empty:
  /// as in the covariance model.
  Matrix scatter = {};
  std::vector<double> own = {}; ///< by indication, factor of the noise of readings that are not outlying; empty: 1

  /// Ratio of the standard deviation of the readings that are not outlying to that of all, winsorised like data.
  double core() const;
};

/// Some draws, by number, of all `of`: the same whatever else is drawn with them. `first` is even.
struct Draws {
  std::size_t first = 0, count = 0, of = 0;
};

/// "Chosen rows" are those given to the constructor: whole readings, in order. Keeps a reference to the design.
class Whitened {
public:
  /// @param rows  chosen rows, ascending
  /// @param use   columns of Design::fixed that are used
  Whitened(const Design& design, std::vector<Index> rows, std::vector<Index> use, const CovarianceModel& model);
  /// The same rows under another covariance model.
  Whitened(const Whitened& other, const CovarianceModel& model);

  /// Chosen rows of a matrix over all rows.
  Matrix take(const Matrix& all) const { return all(rows_, Eigen::all); }
  /// Chosen rows in units of the noise, without serial correlation and component.
  Matrix whiten(Matrix chosen) const { return whiten_units(in_units(std::move(chosen))); }
  /// What is left of products when the fixed and random columns are eliminated, too: reduce(a)' reduce(b) = a'WMb.
  Matrix reduce(Matrix chosen) const { return reduce_units(in_units(std::move(chosen))); }
  /// a'WMa of each column of chosen rows: the squares left, with the cost of the random columns.
  Vector squares(const Matrix& chosen) const { return squares_units(in_units(chosen)); }
  /// Chosen rows in units of the noise of readings, which is the same under every model; then as above.
  Matrix in_units(Matrix chosen) const;
  Matrix whiten_units(Matrix units) const;
  Matrix reduce_units(Matrix units) const { return elimination_->reduced(std::move(units)); }
  Vector squares_units(const Matrix& units) const { return elimination_->squares(units); }
  /// WMb of chosen rows b in these units, so that a'WMb needs no a reduced under each model.
  Matrix weighted_units(Matrix units) const { return elimination_->projected(std::move(units)); }
  /// Residuals of the chosen rows (not whitened), winsorised at criteria.winsor_limit robust standard deviations.
  /// For a covariance model without correlation or component.
  /// @param scale   robust standard deviation by column, in units of the design's
  /// @param weight  1 where a residual was not changed, below 1 where it was winsorised
  Matrix winsorised(const Matrix& residuals, Vector* scale = nullptr, Matrix* weight = nullptr) const;
  /// Whitened part of chosen rows that the fixed and random columns and the component leave. For models without
  /// correlation.
  Matrix left_over(Matrix chosen) const { return elimination_->projected(in_units(std::move(chosen))); }
  /// Minus twice the logarithm of the density's factor that does not depend on the data.
  double log_determinant() const { return log_determinant_; }
  /// Best coefficients (fixed, random) by column of chosen rows. `covariance` of the coefficients, at scale 1.
  Matrix coefficients(const Matrix& chosen, Matrix* covariance = nullptr) const;
  /// Squared length of each fixed and random column, and their products with others, by the noise of readings alone.
  Matrix overlap(const Matrix& whitened, Vector& squares) const;
  /// n draws of the noise (columns), declared draws included, in SI. `seed` keys the stream.
  Matrix draw(std::size_t n, std::uint64_t seed, const NoiseShape& shape = {}) const {
    return draw(Draws{0, n, n}, seed, shape);
  }
  Matrix draw(const Draws& draws, std::uint64_t seed, const NoiseShape& shape = {}) const;
  const std::vector<Index>& rows() const { return rows_; }
  std::size_t degrees_of_freedom() const { return rows_.size() - use_.size(); }
  /// As hidden_squares() of the design, whitened.
  double hidden_squares() const { return hidden_squares_; }
  double least_variance() const { return hidden_squares_ / static_cast<double>(rows_.size()); } ///< of a reading

private:
  /// Fixed, then random columns, in units of the noise of readings.
  struct Columns {
    std::vector<SparseRow> rows;
    double log_squares = 0; ///< sum over the fixed ones of ln of their squared length in units of the reference
  };
  /// Group of the variance component that moves each chosen row, or -1; empty without a component.
  std::vector<int> scattered() const;
  double scatter_unit(std::size_t row) const; ///< standard deviation of the component in a chosen row
  Serial serial() const;
  Columns columns_in_units() const;
  std::vector<SparseRow> scatter_in_units(const std::vector<int>& group) const;
  void eliminate();
  void add_declared(const Draws& draws, std::uint64_t seed, Matrix& out) const;
  void add_scatter(const Draws& draws, std::uint64_t seed, const NoiseShape& shape, Matrix& out) const;

  const Design& design_;
  std::vector<Index> rows_, use_;
  CovarianceModel model_;
  std::shared_ptr<const Columns> columns_;
  std::optional<Innovations> scatter_;
  std::shared_ptr<const Elimination> elimination_; ///< of the columns and the component
  double log_determinant_ = 0, hidden_squares_ = 0;
};

/// Robust standard deviation by absolute residuals, which it sorts in part: by their median, unless more than a tenth
/// of them (three, of few) would then be outliers. So many are the noise's own shape, as indications in coarse steps
/// have it, and the tenth largest tells the scale.
double robust_scale(std::vector<double>& sizes);

/// Independent standard normal numbers: row i is stream (seed, i, purpose).
Matrix normals(std::size_t rows, const Draws& draws, std::uint64_t seed, std::uint16_t purpose);
inline Matrix normals(std::size_t rows, std::size_t columns, std::uint64_t seed, std::uint16_t purpose) {
  return normals(rows, Draws{0, columns, columns}, seed, purpose);
}

} // namespace gumshoe::tracing
