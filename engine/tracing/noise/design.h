#pragma once
/// The linearised fit: which columns it estimates, which are declared, and how the readings scatter.
#include <string>
#include <vector>

#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

/// Rows are [place in the sequence][indication]: always in the order of measurement. SI units.
struct Design {
  std::size_t indications = 1;
  std::vector<std::size_t> reading; ///< by row
  Matrix fixed;                     ///< J, rows x free unknowns
  std::vector<std::string> fixed_names;
  Matrix random; ///< U, rows x declared draws shared by readings, each of unit variance
  std::vector<std::string> random_names;
  /// By reading of the sequence: lower Cholesky factor of its own noise, indications x indications. What declared draws
  /// do beyond U, such as jumps, is part of it.
  std::vector<Matrix> local;
  std::vector<Matrix> straight;  ///< the same without what `bends` draw; empty: they draw nothing
  std::vector<Matrix> bends;     ///< rows x nodes: what a draw of bend_node(j) does beyond U
  std::vector<int> bent;         ///< by column of U: its table of `bends`, or -1
  std::vector<double> reference; ///< by indication: typical standard uncertainty of its noise
  std::vector<Grouping> scatter; ///< what may scatter; group by reading of the scenario
};

/// Columns of Design::fixed that the chosen rows can distinguish, in the order in which they are declared: a column
/// that earlier ones explain is left out.
std::vector<Index> independent(const Design& design, const std::vector<Index>& rows);

/// Covariance of the noise in addition to what is declared: serial correlation and one variance component.
struct CovarianceModel {
  double correlation = 0; ///< from one reading to the next
  int scatter = -1;       ///< of Design::scatter; -1: none
  double ratio = 0;       ///< standard deviation of the component over that of the noise
  int indication = -1;    ///< the only one that the component moves; -1: each by itself
};

/// All models that are tried: correlations alone, and with each variance component at each ratio (criteria.h).
std::vector<CovarianceModel> covariance_models(const Design& design, std::size_t rows);

} // namespace gumshoe::tracing
