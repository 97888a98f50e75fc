#pragma once
/// Every signature against many data sets at once: likelihood ratios, with the structure of the noise fitted anew each
/// time, beside the model without and with the signature.
#include <limits>
#include <memory>
#include <vector>

#include "tracing/candidates/candidates.h"
#include "tracing/noise/design.h"

namespace gumshoe::tracing {

/// Below this share of a signature nothing is said of it: what is left is of the size of what a linearised model
/// neglects.
inline constexpr double absorbed_share = 1e-5;

/// By how much no signature's gain on pure noise differs between two structures of it.
inline constexpr double beyond_chance = 20;

/// Of one data set or many (columns).
struct Statistics {
  Matrix ratio;                             ///< [signature][set]: 2 ln of the likelihood ratio, at least 0
  Matrix scatter;                           ///< [variance component][set]: the same for it
  Vector scale;                             ///< [set]: of the noise, robust, relative to the design's
  std::vector<std::size_t> structure;       ///< [set]: best without a signature
  std::vector<std::size_t> cautious;        ///< [set]: serial correlation only where the data insist on it
  std::vector<std::size_t> without_scatter; ///< [set]: the best of those without a variance component
  Vector criterion;                         ///< [set]: minus 2 ln likelihood under `structure`, but for a constant
  Vector variance;                          ///< [set]: s^2 under `structure`
  Vector variance_cautious;                 ///< [set]: the same under `cautious`
  Vector variance_without_scatter;          ///< [set]: and under `without_scatter`
};

struct Fit {
  Vector size, u;            ///< of each column, SI
  double ratio = 0;          ///< 2 ln of the likelihood ratio
  std::size_t structure = 0; ///< best with the signature
};

class Scan {
public:
  /// @param rows readings that take part. Alternatives keep their order; those that are absorbed have no statistic.
  Scan(const Design& design, const std::vector<Index>& rows, const std::vector<const Alternative*>& alternatives,
       int threads);

  /// @param residuals over the chosen rows, SI, a column per data set. Winsorised here.
  /// @param reach     structures whose criterion is further above the best one's are not tried with a signature: for
  ///                  noise alone, where none makes up for so much. Without it all are.
  Statistics run(const Matrix& residuals, double reach = std::numeric_limits<double>::infinity()) const;
  /// Sizes of one alternative in one data set.
  Fit fit(std::size_t alternative, const Vector& residuals) const;
  /// Two alternatives together, under a given structure: 2 ln of the likelihood ratio against neither.
  double pair_ratio(std::size_t a, std::size_t b, const Vector& residuals, std::size_t structure) const;

  /// Residuals with what lies beyond 3.5 robust standard deviations drawn in; `weight` 1 where it was left alone.
  Matrix winsorised(const Matrix& residuals, Vector* scale = nullptr, Matrix* weight = nullptr) const {
    return whitened_[plain_].winsorised(residuals, scale, weight);
  }
  /// How one data set's noise departs from normal numbers: the readings that are drawn in.
  Departures departures(const Vector& residuals) const;
  /// Share of the signature that fixed and declared parts leave, under the plainest structure.
  double identifiable(std::size_t alternative) const { return share_[alternative]; }
  /// The declared or estimated part that takes most of it away: index into fixed, then random columns.
  int absorbed_by(std::size_t alternative) const { return absorbed_[alternative]; }
  /// Cosine of two projected signatures (largest canonical correlation) under a structure.
  double correlation(std::size_t a, std::size_t b, std::size_t structure) const;
  /// g'WMg of one column of an alternative under a structure, per SI unit squared, with its noise at scale 1.
  double information(std::size_t alternative, Index column, std::size_t structure) const;

  std::size_t alternatives() const { return alternatives_.size(); }
  const std::vector<Structure>& all_structures() const { return structures_; }
  const Whitened& whitened(std::size_t structure) const { return whitened_[structure]; }
  std::size_t degrees_of_freedom() const { return freedom_; }
  std::size_t plain() const { return plain_; } ///< structure without correlation or scatter
  const std::vector<Index>& used() const { return use_; }

private:
  struct Block {
    Index first = 0, count = 0; ///< columns of `signatures`
  };
  struct Prepared {
    Matrix signatures; ///< orthonormal within each alternative, projected
    std::vector<Block> blocks;
  };
  double criterion(double left, std::size_t structure) const;

  const Design& design_;
  std::vector<Index> rows_, use_;
  std::vector<const Alternative*> alternatives_;
  int threads_;
  std::vector<Structure> structures_;
  std::vector<Whitened> whitened_;
  std::vector<Prepared> prepared_;
  std::vector<double> share_;
  std::vector<int> absorbed_;
  std::size_t freedom_ = 0, plain_ = 0;
};

} // namespace gumshoe::tracing
