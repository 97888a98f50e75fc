#pragma once
/// Every signature against many data sets at once: likelihood ratios without and with the signature, each time under
/// the covariance model of the noise that fits best.
#include <limits>
#include <vector>

#include "tracing/candidates/candidates.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

/// For one data set or many (columns). "Model" is a covariance model, by its place in Scan::covariance_models().
struct Statistics {
  Matrix ratio;                              ///< [signature][set]: 2 ln of the likelihood ratio, at least 0
  Matrix scatter;                            ///< [variance component][set]: the same for it
  Vector scale;                              ///< [set]: of the noise, robust, relative to the design's
  std::vector<std::size_t> covariance_model; ///< [set]: the best without a signature
  std::vector<std::size_t> cautious;         ///< [set]: serial correlation only where the data insist on it
  std::vector<std::size_t> without_scatter;  ///< [set]: the best of those without a variance component
  Vector criterion;                          ///< [set]: minus 2 ln likelihood under the best, but for a constant
  Vector variance;                           ///< [set]: s^2 under `covariance_model`
  Vector variance_cautious;                  ///< [set]: the same under `cautious`
  Vector variance_without_scatter;           ///< [set]: and under `without_scatter`
};

/// Writes the statistics of some sets into those of all, from set `first` on. @param all  empty, or of `sets` sets
void put(const Statistics& some, Index first, Index sets, Statistics& all);

/// One candidate in one data set.
struct Fit {
  Vector size, u;                   ///< by column of the candidate, SI
  double ratio = 0;                 ///< 2 ln of the likelihood ratio
  std::size_t covariance_model = 0; ///< the best with the signature
};

/// Minus 2 ln likelihood of one data set under each covariance model, but for a constant.
/// @param rows       chosen rows of the design
/// @param residuals  of these, SI. Winsorised here.
Vector criteria_of(const Design& design, const std::vector<Index>& rows, const Vector& residuals, int threads);

/// Keeps references to the design and the candidates.
class Scan {
public:
  /// @param rows  chosen rows of the design. A candidate that is absorbed keeps its place and has no statistic.
  Scan(const Design& design, const std::vector<Index>& rows, const std::vector<const Candidate*>& candidates,
       int threads);

  /// @param residuals  chosen rows x sets, SI. Winsorised here.
  /// @param reach      covariance models whose criterion is further above the best one's are not tried with a
  ///                   signature: for noise alone, where no signature makes up for so much
  Statistics run(const Matrix& residuals, double reach = std::numeric_limits<double>::infinity()) const;
  Fit fit(std::size_t candidate, const Vector& residuals) const;
  /// Two candidates together, under a given covariance model: 2 ln of the likelihood ratio against neither.
  double pair_ratio(std::size_t a, std::size_t b, const Vector& residuals, std::size_t model) const;
  /// Minus 2 ln likelihood of the first of some candidates with all of them, in pairs, comparable with
  /// Statistics::criterion: [a][b] by their places in `some`.
  Matrix pair_criteria(const std::vector<std::size_t>& some, std::size_t first, const Vector& residuals,
                       std::size_t model) const;
  /// The same of several data sets: [set].
  std::vector<Matrix> pair_criteria(const std::vector<std::size_t>& some, std::size_t first, const Matrix& residuals,
                                    std::size_t model) const;

  /// As Whitened::winsorised, under the plain model.
  Matrix winsorised(const Matrix& residuals, Vector* scale = nullptr, Matrix* weight = nullptr) const {
    return whitened_[plain_].winsorised(residuals, scale, weight);
  }
  /// How the noise of one data set differs from normal numbers: by the readings that are winsorised.
  NoiseShape noise_shape(const Vector& residuals) const;
  /// Share of a signature that fixed and declared columns leave, under the plain model: g'WMg / g'N^-1 g.
  double identifiable(std::size_t candidate) const { return share_[candidate]; }
  /// The fixed or declared column that takes most of it away: index into fixed, then random columns; -1: none does.
  int absorbed_by(std::size_t candidate) const { return absorbed_[candidate]; }
  /// Cosine of two projected signatures (largest canonical correlation) under a covariance model.
  double correlation(std::size_t a, std::size_t b, std::size_t model) const;
  /// g'WMg of one column of a candidate under a covariance model, per SI unit squared, with its noise at scale 1.
  double information(std::size_t candidate, Index column, std::size_t model) const;

  const std::vector<CovarianceModel>& covariance_models() const { return models_; }
  const Whitened& whitened(std::size_t model) const { return whitened_[model]; }
  std::size_t degrees_of_freedom() const { return freedom_; }
  std::size_t plain() const { return plain_; }            ///< model without correlation or scatter
  const std::vector<Index>& used() const { return use_; } ///< independent fixed columns

private:
  template <class Body> void by_blocks(const Body& body) const;
  Matrix units(std::size_t first, std::size_t last) const;        ///< columns of these candidates
  Matrix reduced(std::size_t candidate, std::size_t model) const; ///< Whitened::reduce of a signature
  /// Of these candidates, reduced and orthonormal within each.
  Matrix signatures(std::size_t first, std::size_t last, std::size_t model) const;
  void prepare(std::size_t model);
  void find_absorbed(std::size_t candidate, const Matrix& white, double left);
  double criterion(double left, std::size_t model) const;
  double squares_of(double criterion, std::size_t model) const; ///< its inverse
  /// Smallest criterion of each candidate in each set, over all models.
  /// @param data     chosen rows in units of the noise of readings
  /// @param without  criteria [model][set]
  Matrix with_signatures(const Matrix& data, const Matrix& without, double reach) const;
  void choose_models(const Matrix& without, Index set, Statistics& out) const;

  const Design& design_;
  std::vector<Index> rows_, use_;
  std::vector<const Candidate*> candidates_;
  int threads_;
  std::vector<CovarianceModel> models_;
  std::vector<Whitened> whitened_;
  Matrix units_; ///< candidates' columns, chosen rows in units of the noise of readings
  std::vector<Index> first_column_;
  std::vector<std::vector<Matrix>> orthonormal_; ///< [model][candidate]: factor of its reduced columns
  std::vector<double> share_;
  std::vector<int> absorbed_;
  std::size_t freedom_ = 0, plain_ = 0;
};

} // namespace gumshoe::tracing
