#pragma once
/// Sizes of a fit with which readings jump, as jump_search.cpp and jump_region.cpp vary them.
#include <algorithm>
#include <optional>

#include <Eigen/LU>

#include "base/special_values.h"
#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

/// Normal numbers about zero, every other column three times as far. `batch` keys the numbers.
inline Matrix around(Index rows, int batch) {
  Matrix out = normals(index(rows), index(criteria.jump_tries), static_cast<std::uint64_t>(batch), 11);
  for (Index k = 1; k < out.cols(); k += 2) out.col(k) *= 3;
  return out;
}

/// Sizes of a fit with which readings jump, and the likelihood over them by the exact model, all else fitted.
class Fitter::JumpingSizes {
public:
  /// @param earlier  whether those that an earlier trace found are among them
  JumpingSizes(const Fitter& fitter, const JointFit& fit, bool earlier = true)
      : fitter_(fitter), fit_(fit), rest_(fit.design) {
    std::vector<Index> others;
    const auto add = [&](Size size, double found) {
      own_.push_back(size.column);
      sizes_.push_back(std::move(size));
      scale_.push_back(0.5 * found);
    };
    for (std::size_t u = 0; earlier && u < fitter.unknowns_.size(); ++u)
      if (const double jump = fitter.unknowns_[u].jump; jump > 0) add(fitter.size_of(fit, u), jump);
    for (std::size_t t = 0; t < fit.terms.size(); ++t) {
      const Term& term = fit.terms[t];
      if (term.candidate.start.empty()) continue;
      jumping_.push_back({&term, index(own_.size())});
      for (Index j = 0; j < term.size.size(); ++j) add(fitter.size_of(fit, t, j), found_size(term));
    }
    for (Index j = 0; j < fit.design.fixed.cols(); ++j)
      if (std::ranges::find(own_, j) == own_.end()) others.push_back(j);
    rest_.fixed = Matrix(fit.design.fixed(Eigen::all, others));
    const auto use = independent(rest_, fitter.rows_);
    plain_.emplace(rest_, fitter.rows_, use, CovarianceModel{});
    model_.emplace(rest_, fitter.rows_, use, fit.covariance_model);
    for (const Index j : use) columns_.push_back(others[index(j)]);
  }

  Index count() const { return index(own_.size()); }
  const std::vector<Index>& own() const { return own_; }
  std::size_t terms() const { return jumping_.size(); }
  /// Changes that give one term each of the sizes from which it was started, and leave the others changed by `change`.
  Matrix restarts(std::size_t term, const Vector& change) const {
    const auto& [of, first] = jumping_[term];
    const Matrix& tried = of->candidate.tried;
    Matrix out = change.replicate(1, tried.cols());
    if (tried.cols() > 0) out.middleRows(first, of->size.size()) = tried.colwise() - of->size;
    return out;
  }
  /// Half of the sizes from which they are sought.
  Vector scale() const { return Eigen::Map<const Vector>(scale_.data(), count()); }
  double freedom() const { return static_cast<double>(model_->degrees_of_freedom()); }

  /// Squares that are left under changes of the sizes (columns); infinite where there is no value.
  Vector left(const Matrix& changes) const {
    std::vector<bool> valid;
    const Matrix clean = residuals(changes, valid);
    Vector out = model_->squares(clean);
    for (Index k = 0; k < out.size(); ++k)
      if (!valid[index(k)]) out[k] = infinity;
    return out;
  }

  /// What is left under changes of the sizes, such that its squares are those of left(); invalid where there is no
  /// value.
  Matrix reduced(const Matrix& changes, std::vector<bool>& valid) const {
    return model_->reduce(residuals(changes, valid));
  }

  /// Standard uncertainties by the straight line through the readings over these changes.
  Vector by_line(const Matrix& changes) const {
    std::vector<bool> valid;
    const Matrix moved = (-residuals(changes, valid)).colwise() + residuals(Matrix::Zero(count(), 1), valid).col(0);
    const Matrix products = changes * changes.transpose();
    const Matrix line = model_->reduce(moved * changes.transpose() * products.inverse());
    return (fit_.variance * Matrix(line.transpose() * line).inverse().diagonal()).cwiseSqrt();
  }

  /// Change of all fixed columns that goes with a change of the sizes.
  Vector with_others(const Vector& change) const {
    std::vector<bool> valid;
    const Vector x = model_->coefficients(residuals(change, valid));
    Vector out = Vector::Zero(fit_.design.fixed.cols());
    for (std::size_t j = 0; j < columns_.size(); ++j) out[columns_[j]] = x[index(j)];
    for (std::size_t i = 0; i < own_.size(); ++i) out[own_[i]] = change[index(i)];
    return out;
  }

  /// Changes of the predictions of all readings by these changes of the sizes, at which the model has a value.
  Matrix predicted(const Matrix& changes) const {
    Matrix with_none(count(), changes.cols() + 1);
    with_none << changes, Vector::Zero(count());
    std::vector<bool> valid;
    Matrix left = residuals_of_all(with_none, valid);
    const Matrix x = model_->coefficients(plain_->winsorised(plain_->take(left)));
    const auto p = index(columns_.size());
    left -= fit_.design.fixed(Eigen::all, columns_) * x.topRows(p) + rest_.random * x.bottomRows(x.rows() - p);
    return (-left.leftCols(changes.cols())).colwise() + left.col(changes.cols());
  }

private:
  Matrix residuals(const Matrix& changes, std::vector<bool>& valid) const {
    return plain_->winsorised(plain_->take(residuals_of_all(changes, valid)));
  }

  /// All readings, not winsorised. Those of the fit where the model has no value.
  Matrix residuals_of_all(const Matrix& changes, std::vector<bool>& valid) const {
    std::vector<Variation> variations;
    std::vector<bool> within;
    for (Index k = 0; k < changes.cols(); ++k) {
      Variation v;
      within.push_back(true);
      for (std::size_t i = 0; i < own_.size(); ++i) {
        const double by = changes(index(i), k), to = sizes_[i].at + by;
        within.back() = within.back() && to >= sizes_[i].low && to <= sizes_[i].high;
        v.changes.push_back({sizes_[i].quantity, by, false});
      }
      if (!within.back()) v.changes.clear();
      variations.push_back(std::move(v));
    }
    variations.push_back({});
    Matrix f;
    fitter_.simulator_.vary(fit_.at, variations, f, valid);
    for (std::size_t k = 0; k < within.size(); ++k) valid[k] = valid[k] && within[k];
    const Matrix moved = f.leftCols(changes.cols()).colwise() - f.col(changes.cols()).eval();
    Matrix all = (-in_sequence(fitter_.observations_, moved)).colwise() + fit_.residual;
    for (Index k = 0; k < all.cols(); ++k)
      if (!valid[index(k)]) all.col(k) = fit_.residual;
    return all;
  }

  const Fitter& fitter_;
  const JointFit& fit_;
  Design rest_; ///< without the columns of these sizes
  std::optional<Whitened> plain_, model_;
  std::vector<Index> own_, columns_;
  std::vector<Size> sizes_;
  std::vector<double> scale_;
  std::vector<std::pair<const Term*, Index>> jumping_; ///< terms, and the place of their first size
};

} // namespace gumshoe::tracing
