#pragma once
/// The linearised fit: its estimated columns, its declared columns, and the noise of the readings.
#include <string>
#include <vector>

#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

/// Covariance of the noise in addition to what is declared: serial correlation and one variance component.
struct CovarianceModel {
  double correlation = 0; ///< correlation of successive readings
  int scatter = -1;       ///< index into Design::scatter; -1: none
  double ratio = 0;       ///< standard deviation of the component over that of the noise
  int indication = -1;    ///< the only one that the component moves; -1: each by itself
};

/// Rows are [place in the sequence][indication]: always in the order of measurement. SI units.
struct Design {
  std::size_t indications = 1;
  std::vector<std::size_t> reading; ///< by row
  Matrix fixed;                     ///< J, rows x free unknowns
  std::vector<std::string> fixed_names;
  Matrix random; ///< U, rows x declared draws shared by readings, each of unit variance
  std::vector<std::string> random_names;
  /// Lower Cholesky factor of the noise of each reading of the sequence, indications x indications. It includes the
  /// response to declared draws beyond U, such as jumps.
  std::vector<Matrix> local;
  std::vector<Matrix> straight;  ///< the same without the part that `bends` draw; empty: they draw nothing
  std::vector<Matrix> bends;     ///< rows x nodes: response to a draw of bend_node(j) in addition to U
  std::vector<int> bent;         ///< by column of U: its table of `bends`, or -1
  std::vector<double> reference; ///< by indication: typical standard uncertainty of its noise
  std::vector<double> step;      ///< by indication: in which its readouts were recorded; empty: not known
  std::vector<int> readouts;     ///< by place in the sequence, the number of which it is the mean; empty: one
  /// By indication, whether its readings scatter so little that rounding to these steps comes back; empty: none does.
  std::vector<bool> coarse;
  std::vector<Grouping> scatter; ///< possible variance components; group by reading of the scenario
  std::vector<CovarianceModel> covariance_models; ///< those that are tried; empty: all
  bool order_known = true;                        ///< of measurement: else no reading resembles the one before
};

/// Standard uncertainty of the noise of a row, SI.
double noise_of_row(const Design& design, Index row);
/// The number of readouts of which a row is the mean.
double readouts_of_row(const Design& design, Index row);

/// What the steps in which readings were recorded give at least as the standard deviation of the chosen rows, in units
/// of their noise: their root mean square. No robust scale may be less, or most residuals could be equal and the others
/// outliers.
double least_scale(const Design& design, const std::vector<Index>& rows);

/// Sum of squares of the chosen rows, in units of the noise, that coarse steps may hide: a reading is not known better
/// than to q / sqrt(12), however well it comes back (JCGM 100, F.2.2.1). Of indications whose steps are not coarse,
/// none.
double hidden_squares(const Design& design, const std::vector<Index>& rows);

/// Columns of Design::fixed that the chosen rows can distinguish, in the order in which they are declared: a column
/// that earlier ones explain is left out.
std::vector<Index> independent(const Design& design, const std::vector<Index>& rows);

/// Columns of Design::fixed to which none of the chosen rows is sensitive.
std::vector<Index> insensitive(const Design& design, const std::vector<Index>& rows);

/// The models that are tried; all are correlations alone, and with each variance component at each ratio (criteria.h).
std::vector<CovarianceModel> covariance_models(const Design& design, std::size_t rows);

/// Adds columns over the chosen rows to the fixed ones.
void add_fixed(Design& design, const std::vector<Index>& rows, const Matrix& columns);

/// The design with no variance component to be tried.
Design without_components(Design design);

} // namespace gumshoe::tracing
