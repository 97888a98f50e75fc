#include "tracing/fit/scan.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "math/products.h"
#include "propagation/parallel.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Factor that makes reduced columns orthonormal; without columns where next to nothing is left of them.
/// @param products  of the reduced columns
/// @param length    of the columns before they were reduced
Matrix orthonormal(const Matrix& products, const Vector& length) {
  Matrix scaled = products;
  for (Index i = 0; i < scaled.rows(); ++i)
    for (Index j = 0; j < scaled.cols(); ++j)
      scaled(i, j) = length[i] > 0 && length[j] > 0 ? scaled(i, j) / (length[i] * length[j]) : 0;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen((scaled + scaled.transpose()) / 2);
  Matrix out(scaled.rows(), scaled.cols());
  Index kept = 0;
  for (Index j = 0; j < scaled.rows(); ++j) {
    if (!(eigen.eigenvalues()[j] > criteria.absorbed_share)) continue;
    for (Index i = 0; i < out.rows(); ++i)
      out(i, kept) = length[i] > 0 ? eigen.eigenvectors()(i, j) / (length[i] * std::sqrt(eigen.eigenvalues()[j])) : 0;
    ++kept;
  }
  return out.leftCols(kept);
}

double criterion(double left, const Whitened& w) {
  return static_cast<double>(w.degrees_of_freedom()) * std::log(std::max(left + w.hidden_squares(), 1e-300)) +
         w.log_determinant();
}

} // namespace

Vector criteria_of(const Design& design, const std::vector<Index>& rows, const Vector& residuals, int threads) {
  const auto models = covariance_models(design, rows.size());
  const Whitened plain(design, rows, independent(design, rows), {});
  const Matrix data = plain.in_units(plain.winsorised(residuals));
  Vector out(index(models.size()));
  // Each is dropped at once: with cells and lines among the columns, their rotations would take much memory.
  propagation::parallel_for(models.size(), threads, [&](std::size_t k) {
    const Whitened w(plain, models[k]);
    out[index(k)] = criterion(w.squares_units(data)[0], w);
  });
  return out;
}

void put(const Statistics& some, Index first, Index sets, Statistics& all) {
  for (Matrix Statistics::*of : {&Statistics::ratio, &Statistics::scatter}) {
    (all.*of).conservativeResize((some.*of).rows(), sets);
    (all.*of).middleCols(first, (some.*of).cols()) = some.*of;
  }
  for (Vector Statistics::*of : {&Statistics::scale, &Statistics::criterion, &Statistics::variance,
                                 &Statistics::variance_cautious, &Statistics::variance_without_scatter}) {
    (all.*of).conservativeResize(sets);
    (all.*of).segment(first, (some.*of).size()) = some.*of;
  }
  for (std::vector<std::size_t> Statistics::*of :
       {&Statistics::covariance_model, &Statistics::cautious, &Statistics::without_scatter}) {
    (all.*of).resize(index(sets));
    std::ranges::copy(some.*of, (all.*of).begin() + first);
  }
}

Scan::Scan(const Design& design, const std::vector<Index>& rows, const std::vector<const Candidate*>& candidates,
           int threads)
    : design_(design), rows_(rows), use_(independent(design, rows)), candidates_(candidates), threads_(threads),
      models_(tracing::covariance_models(design, rows.size())), orthonormal_(models_.size()),
      share_(candidates.size(), 0), absorbed_(candidates.size(), -1), freedom_(rows.size() - use_.size()) {
  for (std::size_t k = 0; k < models_.size(); ++k)
    if (models_[k].correlation == 0 && models_[k].scatter < 0) plain_ = k;
  const Whitened first(design_, rows_, use_, models_[0]);
  first_column_.push_back(0);
  for (const Candidate* a : candidates_) first_column_.push_back(first_column_.back() + a->columns.cols());
  units_.resize(index(rows_.size()), first_column_.back());
  for (std::size_t a = 0; a < candidates_.size(); ++a)
    units_.middleCols(first_column_[a], candidates_[a]->columns.cols()) =
        first.in_units(first.take(candidates_[a]->columns));
  std::vector<std::unique_ptr<Whitened>> made(models_.size());
  propagation::parallel_for(models_.size(), threads_,
                            [&](std::size_t k) { made[k] = std::make_unique<Whitened>(first, models_[k]); });
  for (auto& m : made) whitened_.push_back(std::move(*m));
  propagation::parallel_for(models_.size(), threads_, [&](std::size_t k) { prepare(k); });
  for (std::size_t a = 0; a < candidates_.size(); ++a)
    if (share_[a] <= criteria.absorbed_share)
      for (auto& p : orthonormal_) p[a].resize(p[a].rows(), 0);
}

/// Calls body(first, last) for candidates of not too many columns together.
template <class Body> void Scan::by_blocks(const Body& body) const {
  constexpr Index together = 128;
  for (std::size_t first = 0, last = 0; first < candidates_.size(); first = last) {
    Index columns = 0;
    do columns += candidates_[last++]->columns.cols();
    while (last < candidates_.size() && columns + candidates_[last]->columns.cols() <= together);
    body(first, last);
  }
}

Matrix Scan::units(std::size_t first, std::size_t last) const {
  const auto from = first_column_[first];
  return units_.middleCols(from, first_column_[last] - from);
}

void Scan::prepare(std::size_t k) {
  by_blocks([&](std::size_t first, std::size_t last) {
    const Matrix block = units(first, last), white = whitened_[k].whiten_units(block),
                 left = whitened_[k].reduce_units(block);
    Index from = 0;
    for (std::size_t a = first; a < last; ++a) {
      const Index cols = candidates_[a]->columns.cols();
      const Matrix w = white.middleCols(from, cols), l = left.middleCols(from, cols);
      orthonormal_[k].push_back(orthonormal(l.transpose() * l, w.colwise().norm()));
      if (k == plain_) find_absorbed(a, w, l.squaredNorm());
      from += cols;
    }
  });
}

void Scan::find_absorbed(std::size_t a, const Matrix& white, double left) {
  const double whole = white.squaredNorm();
  share_[a] = whole > 0 ? left / whole : 0;
  if (share_[a] >= 0.5 || !(whole > 0)) return;
  Vector squares;
  const Matrix overlap = whitened_[plain_].overlap(white, squares);
  double best = 0;
  for (Index j = 0; j < overlap.rows(); ++j) {
    const double cosine = squares[j] > 0 ? overlap.row(j).norm() / std::sqrt(squares[j] * whole) : 0;
    const Index used = index(use_.size());
    const Index place = j < used ? use_[index(j)] : design_.fixed.cols() + j - used;
    if (cosine > best) best = cosine, absorbed_[a] = static_cast<int>(place);
  }
}

Matrix Scan::reduced(std::size_t a, std::size_t k) const { return whitened_[k].reduce_units(units(a, a + 1)); }

Matrix Scan::signatures(std::size_t first, std::size_t last, std::size_t k) const {
  const Matrix block = whitened_[k].reduce_units(units(first, last));
  Index from = 0, used = 0;
  for (std::size_t a = first; a < last; ++a) used += orthonormal_[k][a].cols();
  Matrix out(block.rows(), used);
  used = 0;
  for (std::size_t a = first; a < last; ++a) {
    const Matrix& factor = orthonormal_[k][a];
    out.middleCols(used, factor.cols()) = block.middleCols(from, factor.rows()) * factor;
    from += factor.rows();
    used += factor.cols();
  }
  return out;
}

double Scan::squares_of(double criterion, std::size_t k) const {
  const Whitened& w = whitened_[k];
  return std::max(0.0,
                  std::exp((criterion - w.log_determinant()) / static_cast<double>(freedom_)) - w.hidden_squares());
}

double Scan::criterion(double left, std::size_t k) const { return tracing::criterion(left, whitened_[k]); }

NoiseShape Scan::noise_shape(const Vector& residuals) const {
  // Share of normal numbers that would be winsorised.
  const double chance = std::erfc(criteria.winsor_limit / std::sqrt(2.0)), n = static_cast<double>(residuals.size());
  NoiseShape out;
  Matrix weight;
  winsorised(residuals, nullptr, &weight);
  // Least squares hide the part of each residual that they fit to it.
  for (Index i = 0; i < weight.rows(); ++i)
    if (weight(i, 0) < 1) out.sizes.push_back(criteria.winsor_limit / weight(i, 0) * n / static_cast<double>(freedom_));
  out.share = std::max(0.0, static_cast<double>(out.sizes.size()) / n - chance);
  return out;
}

Matrix Scan::with_signatures(const Matrix& data, const Matrix& without, double reach) const {
  const Index sets = data.cols(), candidates = index(candidates_.size());
  const Vector least = without.colwise().minCoeff();
  // In parts by model, each thread with its own best; minima do not depend on the order.
  const std::size_t count = models_.size(), parts = candidates > 0 ? std::min<std::size_t>(count, 8) : 0;
  std::vector<Matrix> best(parts);
  propagation::parallel_for(parts, threads_, [&](std::size_t part) {
    best[part] = Matrix::Constant(candidates, sets, infinite);
    for (std::size_t k = part; k < count; k += parts) {
      std::vector<Index> near;
      for (Index j = 0; j < sets; ++j)
        if (without(index(k), j) - least[j] <= reach) near.push_back(j);
      if (near.empty()) continue;
      const Matrix weighted = whitened_[k].weighted_units(data(Eigen::all, near));
      by_blocks([&](std::size_t first, std::size_t last) {
        const auto from = first_column_[first];
        const Matrix products = transposed_product(units_.middleCols(from, first_column_[last] - from), weighted);
        for (std::size_t a = first; a < last; ++a) {
          const Matrix& factor = orthonormal_[k][a];
          if (factor.cols() == 0) continue;
          const Matrix own = products.middleRows(first_column_[a] - from, factor.rows()),
                       explained = transposed_product(factor, own);
          for (std::size_t i = 0; i < near.size(); ++i) {
            double& least_so_far = best[part](index(a), near[i]);
            const double squares = squares_of(without(index(k), near[i]), k);
            double gone = 0;
            for (Index j = 0; j < explained.rows(); ++j) gone += explained(j, index(i)) * explained(j, index(i));
            least_so_far = std::min(least_so_far, criterion(std::max(squares - gone, 1e-12 * squares), k));
          }
        }
      });
    }
  });
  Matrix out = Matrix::Constant(candidates, sets, infinite);
  for (const Matrix& b : best) out = out.cwiseMin(b);
  return out;
}

Statistics Scan::run(const Matrix& residuals, double reach) const {
  Statistics out;
  const Matrix data = whitened_[plain_].in_units(winsorised(residuals, &out.scale));
  const Index sets = data.cols();
  Matrix without(index(models_.size()), sets);
  propagation::parallel_for(models_.size(), threads_, [&](std::size_t k) {
    const Vector left = whitened_[k].squares_units(data);
    for (Index j = 0; j < sets; ++j) without(index(k), j) = criterion(left[j], k);
  });
  const Matrix with = with_signatures(data, without, reach);
  out.ratio = Matrix::Zero(with.rows(), sets);
  out.scatter = Matrix::Zero(index(design_.scatter.size()), sets);
  for (auto* models : {&out.covariance_model, &out.without_scatter, &out.cautious}) models->resize(index(sets));
  for (Vector* numbers : {&out.criterion, &out.variance, &out.variance_cautious, &out.variance_without_scatter})
    numbers->resize(sets);
  for (Index j = 0; j < sets; ++j) {
    choose_models(without, j, out);
    for (Index a = 0; a < with.rows(); ++a)
      if (std::isfinite(with(a, j))) out.ratio(a, j) = std::max(0.0, out.criterion[j] - with(a, j));
  }
  return out;
}

void Scan::choose_models(const Matrix& without, Index j, Statistics& out) const {
  const std::size_t count = models_.size();
  // The first, hence simplest, of those that are as good: where each group has a constant, its scatter changes nothing.
  const auto best_of = [&](const std::function<bool(const CovarianceModel&)>& wanted) {
    std::size_t found = count;
    for (std::size_t i = 0; i < count; ++i)
      if (wanted(models_[i]) && (found == count || without(index(i), j) < without(index(found), j) - criteria.as_good))
        found = i;
    return found;
  };
  const std::size_t k = best_of([](const CovarianceModel&) { return true; }),
                    uncorrelated = best_of([](const CovarianceModel&s) { return s.correlation == 0; }),
                    single = best_of([](const CovarianceModel&s) { return s.scatter < 0; });
  const double base = without.col(j).minCoeff();
  // A correlation that chance gives would make u of alternating signatures too small.
  const std::size_t cautious = without(index(uncorrelated), j) - base < criteria.decisive ? uncorrelated : k;
  Vector component = Vector::Constant(out.scatter.rows(), infinite);
  for (std::size_t i = 0; i < count; ++i)
    if (const int c = models_[i].scatter; c >= 0) component[c] = std::min(component[c], without(index(i), j));
  for (Index c = 0; c < out.scatter.rows(); ++c)
    out.scatter(c, j) = std::max(0.0, without(index(single), j) - component[c]);
  const auto variance = [&](std::size_t i) {
    return std::max(squares_of(without(index(i), j), i) / static_cast<double>(freedom_), whitened_[i].least_variance());
  };
  out.covariance_model[index(j)] = k;
  out.without_scatter[index(j)] = single;
  out.cautious[index(j)] = cautious;
  out.criterion[j] = base;
  out.variance[j] = variance(k);
  out.variance_cautious[j] = variance(cautious);
  out.variance_without_scatter[j] = variance(single);
}

Fit Scan::fit(std::size_t a, const Vector& residuals) const {
  const Matrix data = whitened_[plain_].in_units(winsorised(residuals));
  Fit out;
  double best = infinite, base = best, rest = 0;
  for (std::size_t k = 0; k < models_.size(); ++k) {
    const Vector white = whitened_[k].reduce_units(data);
    const double left = white.squaredNorm(), with = left - (signatures(a, a + 1, k).transpose() * white).squaredNorm();
    base = std::min(base, criterion(left, k));
    const double c = criterion(std::max(with, 1e-12 * left), k);
    if (c < best - criteria.as_good) best = c, rest = with, out.covariance_model = k;
  }
  out.ratio = std::max(0.0, base - best);
  const Whitened& w = whitened_[out.covariance_model];
  const Index d = candidates_[a]->columns.cols();
  // Columns of length one, of which what is absorbed is not fitted.
  const Vector length = w.whiten_units(units(a, a + 1)).colwise().norm();
  Vector scale = Vector::Zero(d);
  for (Index j = 0; j < d; ++j)
    if (length[j] > 0) scale[j] = 1 / length[j];
  Eigen::CompleteOrthogonalDecomposition<Matrix> columns;
  columns.setThreshold(1e-10);
  columns.compute(reduced(a, out.covariance_model) * scale.asDiagonal());
  out.size = scale.asDiagonal() * columns.solve(w.reduce_units(data));
  const Matrix inverse = columns.pseudoInverse();
  const Vector variance = scale.array().square() * inverse.rowwise().squaredNorm().array();
  const double s2 = rest / std::max(1.0, static_cast<double>(freedom_) - static_cast<double>(d));
  out.u = (s2 * variance).cwiseMax(0).cwiseSqrt();
  return out;
}

std::vector<Matrix> Scan::pair_criteria(const std::vector<std::size_t>& some, std::size_t first,
                                        const Matrix& residuals, std::size_t k) const {
  const Matrix data = whitened_[k].reduce(winsorised(residuals));
  std::vector<Index> from{0};
  for (const std::size_t a : some) from.push_back(from.back() + candidates_[a]->columns.cols());
  Matrix all(rows_.size(), from.back());
  for (std::size_t i = 0; i < some.size(); ++i)
    all.middleCols(from[i], from[i + 1] - from[i]) = units(some[i], some[i] + 1);
  const Vector length = whitened_[k].whiten_units(all).colwise().norm();
  all = whitened_[k].reduce_units(all);
  const Matrix products = transposed_product(all, all), along = transposed_product(all, data);
  const Vector left = data.colwise().squaredNorm();
  std::vector<Matrix> out(index(data.cols()), Matrix(index(first), index(some.size())));
  propagation::parallel_for(first, threads_, [&](std::size_t row) {
    const Index a = index(row);
    for (Index b = a; b < index(some.size()); ++b) {
      std::vector<Index> columns;
      for (const Index one : {a, b})
        for (Index j = from[index(one)]; j < from[index(one) + 1]; ++j) columns.push_back(j);
      const Matrix factor = orthonormal(products(columns, columns), length(columns));
      for (Index set = 0; set < data.cols(); ++set) {
        const double explained = (factor.transpose() * Vector(along(columns, set))).squaredNorm();
        out[index(set)](a, b) = criterion(std::max(left[set] - explained, 1e-12 * left[set]), k);
      }
    }
  });
  for (Matrix& one : out)
    for (Index a = 0; a < one.rows(); ++a)
      for (Index b = 0; b < a; ++b) one(a, b) = one(b, a);
  return out;
}

Matrix Scan::pair_criteria(const std::vector<std::size_t>& some, std::size_t first, const Vector& residuals,
                           std::size_t k) const {
  return pair_criteria(some, first, Matrix(residuals), k)[0];
}

double Scan::pair_ratio(std::size_t a, std::size_t b, const Vector& residuals, std::size_t k) const {
  const double left = whitened_[k].reduce(winsorised(residuals)).squaredNorm();
  return criterion(left, k) - pair_criteria({a, b}, 1, residuals, k)(0, 1);
}

namespace {

/// An orthonormal basis of the columns; the declared model may have taken some of them.
Matrix span_of(const Matrix& columns) {
  Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  qr.setThreshold(1e-8);
  return qr.householderQ() * Matrix::Identity(columns.rows(), qr.rank());
}

double correlation_of_spans(const Matrix& x, const Matrix& y) {
  const Matrix a = span_of(x), b = span_of(y);
  const Index smaller = std::min(a.cols(), b.cols());
  if (smaller == 0) return 0;
  return std::min(1.0, Eigen::JacobiSVD<Matrix>(a.transpose() * b).singularValues()[smaller - 1]);
}

} // namespace

double Scan::correlation(std::size_t a, std::size_t b, std::size_t k) const {
  const Matrix x = reduced(a, k), y = reduced(b, k);
  const Eigen::LLT<Matrix> xx(Matrix(x.transpose() * x)), yy(Matrix(y.transpose() * y));
  if (xx.info() != Eigen::Success || yy.info() != Eigen::Success) return correlation_of_spans(x, y);
  const Matrix cross = xx.matrixL().solve(Matrix(x.transpose() * y));
  const Matrix canonical = yy.matrixL().solve(Matrix(cross.transpose()));
  const Eigen::JacobiSVD<Matrix> svd(canonical);
  // Between spaces of unequal size: how well the smaller lies in the larger.
  return std::min(1.0, svd.singularValues()[std::min(x.cols(), y.cols()) - 1]);
}

double Scan::information(std::size_t a, Index column, std::size_t k) const {
  return whitened_[k].squares_units(units_.col(first_column_[a] + column))[0];
}

} // namespace gumshoe::tracing
