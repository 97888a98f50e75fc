#pragma once
/// The fitted model linearised: residuals, what the fit absorbs, what is declared of the rest, and structures of noise.
#include <optional>
#include <string>
#include <vector>

#include "tracing/noise/declared_response.h"
#include "tracing/noise/innovations.h"
#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

/// Rows are [place in the sequence][indication]: always in the order of measurement.
struct Design {
  std::size_t indications = 1;
  std::vector<std::size_t> reading; ///< by row
  Matrix fixed;                     ///< J, rows x free unknowns
  std::vector<std::string> fixed_names;
  Matrix random; ///< U, rows x declared draws shared by readings, each of unit variance
  std::vector<std::string> random_names;
  /// By reading of the sequence: lower Cholesky factor of its own noise, indications x indications. What declared draws
  /// do beyond U, as jumps, is in it as if it were noise.
  std::vector<Matrix> local;
  std::vector<Matrix> straight;  ///< the same without what `bends` draw; empty: they draw nothing
  std::vector<Matrix> bends;     ///< rows x nodes: what a draw of bend_node(j) does beyond U
  std::vector<int> bent;         ///< by column of U: its table of `bends`, or -1
  std::vector<double> reference; ///< by indication: typical standard uncertainty of its noise
  std::vector<Grouping> scatter; ///< what may scatter; group by reading of the scenario
};

/// What lies beyond so many robust standard deviations is far out.
inline constexpr double far_out = 3.5;

/// Noise beside what is declared: serial correlation along the sequence, and a variance component.
struct Structure {
  double correlation = 0;
  int scatter = -1;    ///< of Design::scatter; -1: none
  double ratio = 0;    ///< u of the component over the noise's
  int indication = -1; ///< the only one that the component moves; -1: each by itself
};

/// rho over a grid, alone and with each variance component over a grid of ratios.
std::vector<Structure> structures(const Design& design, std::size_t rows);

/// How the noise of draws departs from normal numbers.
struct Departures {
  double share = 0;          ///< of readings far out
  std::vector<double> sizes; ///< of those, in standard deviations of the others
  /// Rows x nodes: what a draw bend_node(j) of the variance component does to each reading, in the readings' units at
  /// scale 1; empty: what Z says.
  Matrix scatter;

  /// Standard deviation of what is not far out over that of all, drawn in as data are.
  double core() const;
};

/// Some rows of a design (whole readings, in order) under one structure: whitening and projection.
class Whitened {
public:
  /// @param rows   chosen rows, rising; @param use columns of Design::fixed that take part
  Whitened(const Design& design, std::vector<Index> rows, const std::vector<Index>& use, const Structure& structure);

  /// Chosen rows of a matrix over all rows.
  Matrix take(const Matrix& all) const;
  /// Rows in units of the noise, without serial correlation.
  Matrix whiten(Matrix chosen) const;
  /// What is left beside fixed and random parts: x - Q Q'x, of whitened x.
  Matrix project(const Matrix& whitened) const { return whitened - basis_ * (basis_.transpose() * whitened); }
  /// Residuals (not whitened) with what lies beyond 3.5 robust standard deviations drawn in; `scale` of those to the
  /// design's, `weight` 1 where a residual was left alone. Of a structure without correlation or component.
  Matrix winsorised(const Matrix& residuals, Vector* scale = nullptr, Matrix* weight = nullptr) const;
  /// Squares left of each whitened column, with what the random parts cost.
  Vector left(const Matrix& whitened) const;
  /// Q, the data's part.
  const Matrix& basis() const { return basis_; }
  /// Minus two ln of the density's factor that does not depend on the data.
  double log_determinant() const { return log_determinant_; }
  /// Best fixed and random coefficients and those of `extra` for a whitened column: x = (fixed, random, extra).
  Vector solve(const Matrix& whitened_extra, const Vector& whitened, Matrix* covariance = nullptr) const {
    return solve_all(whitened_extra, whitened, covariance);
  }
  /// The same for many columns.
  Matrix solve_all(const Matrix& whitened_extra, const Matrix& whitened, Matrix* covariance = nullptr) const;
  /// n draws of the noise, declared draws included, in the chosen rows' own units. `seed` keys the stream.
  Matrix draw(std::size_t n, std::uint64_t seed, const Departures& departures = {}) const;
  const std::vector<Index>& rows() const { return rows_; }
  std::size_t degrees_of_freedom() const { return rows_.size() - fixed_; }

private:
  /// Of the variance component: by chosen row the group that moves it, or -1.
  std::vector<int> scattered() const;
  double scatter_unit(std::size_t row) const; ///< u of the component in a chosen row
  void filter_scatter(const std::vector<int>& group);
  void add_bends(const Matrix& z, Matrix& out) const;

  const Design& design_;
  std::vector<Index> rows_, use_;
  Structure structure_;
  std::size_t fixed_ = 0, random_ = 0;
  std::optional<Innovations> scatter_;
  Matrix stacked_; ///< whitened fixed and random columns, over the unit rows of the latter
  Matrix basis_;
  double log_determinant_ = 0;
};

/// Columns of Design::fixed that the chosen rows can tell apart.
std::vector<Index> independent(const Design& design, const std::vector<Index>& rows);

/// Independent standard normal numbers: column i of stream (seed, row).
Matrix normals(std::size_t rows, std::size_t columns, std::uint64_t seed, std::uint16_t purpose);

} // namespace gumshoe::tracing
