#include "tracing/fit/scan.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "propagation/parallel.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Orthonormal columns that span the projected signature; empty if next to nothing is left.
Matrix orthonormal(const Matrix& whitened, const Matrix& projected) {
  // In the metric with the random parts <g, g> = g~' P g~ of the projected columns.
  const Matrix gram = whitened.transpose() * projected;
  Vector length = whitened.colwise().norm();
  Matrix scaled = gram;
  for (Index i = 0; i < gram.rows(); ++i)
    for (Index j = 0; j < gram.cols(); ++j)
      scaled(i, j) = length[i] > 0 && length[j] > 0 ? gram(i, j) / (length[i] * length[j]) : 0;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen((scaled + scaled.transpose()) / 2);
  std::vector<Index> kept;
  for (Index j = 0; j < scaled.rows(); ++j)
    if (eigen.eigenvalues()[j] > criteria.absorbed_share) kept.push_back(j);
  Matrix out(projected.rows(), index(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    Vector direction = eigen.eigenvectors().col(kept[i]);
    for (Index j = 0; j < direction.size(); ++j) direction[j] = length[j] > 0 ? direction[j] / length[j] : 0;
    out.col(index(i)) = projected * direction / std::sqrt(eigen.eigenvalues()[kept[i]]);
  }
  return out;
}

} // namespace

Scan::Scan(const Design& design, const std::vector<Index>& rows, const std::vector<const Candidate*>& candidates,
           int threads)
    : design_(design), rows_(rows), use_(independent(design, rows)), candidates_(candidates), threads_(threads),
      models_(tracing::covariance_models(design, rows.size())), prepared_(models_.size()), share_(candidates.size(), 0),
      absorbed_(candidates.size(), -1), freedom_(rows.size() - use_.size()) {
  for (std::size_t k = 0; k < models_.size(); ++k)
    if (models_[k].correlation == 0 && models_[k].scatter < 0) plain_ = k;
  Index total = 0;
  for (const Candidate* a : candidates_) total += a->columns.cols();
  Matrix chosen(index(rows.size()), total);
  Index at = 0;
  for (const Candidate* a : candidates_) {
    chosen.middleCols(at, a->columns.cols()) = a->columns(rows_, Eigen::all);
    at += a->columns.cols();
  }
  std::vector<std::unique_ptr<Whitened>> made(models_.size());
  propagation::parallel_for(models_.size(), threads_, [&](std::size_t k) {
    made[k] = std::make_unique<Whitened>(design_, rows_, use_, models_[k]);
  });
  for (auto& m : made) whitened_.push_back(std::move(*m));
  propagation::parallel_for(models_.size(), threads_, [&](std::size_t k) { prepare(k, chosen); });
  for (std::size_t a = 0; a < candidates_.size(); ++a)
    if (share_[a] <= criteria.absorbed_share)
      for (Prepared& p : prepared_) p.blocks[a].count = 0;
}

void Scan::prepare(std::size_t k, const Matrix& chosen) {
  const Matrix white = whitened_[k].whiten(chosen), left = whitened_[k].project(white);
  Prepared& p = prepared_[k];
  p.signatures.resize(white.rows(), white.cols());
  Index used = 0, from = 0;
  for (std::size_t a = 0; a < candidates_.size(); ++a) {
    const Index cols = candidates_[a]->columns.cols();
    const Matrix w = white.middleCols(from, cols), l = left.middleCols(from, cols);
    const Matrix basis = orthonormal(w, l);
    p.blocks.push_back({used, basis.cols()});
    p.signatures.middleCols(used, basis.cols()) = basis;
    used += basis.cols();
    from += cols;
    if (k == plain_) find_absorbed(a, w, l);
  }
  p.signatures.conservativeResize(Eigen::NoChange, used);
}

void Scan::find_absorbed(std::size_t a, const Matrix& white, const Matrix& left) {
  const double whole = white.squaredNorm();
  share_[a] = whole > 0 ? white.cwiseProduct(left).sum() / whole : 0;
  if (share_[a] >= 0.5 || !(whole > 0)) return;
  double best = 0;
  const auto compare = [&](const Vector& column, Index place) {
    const Vector one = whitened_[plain_].whiten_rows(column);
    const double cosine = one.norm() > 0 ? (one.transpose() * white).norm() / (one.norm() * std::sqrt(whole)) : 0;
    if (cosine > best) best = cosine, absorbed_[a] = static_cast<int>(place);
  };
  for (const Index c : use_) compare(design_.fixed.col(c), c);
  for (Index c = 0; c < design_.random.cols(); ++c) compare(design_.random.col(c), design_.fixed.cols() + c);
}

Matrix Scan::signature(std::size_t a, std::size_t k) const { return whitened_[k].whiten_rows(candidates_[a]->columns); }

double Scan::criterion(double left, std::size_t k) const {
  return static_cast<double>(freedom_) * std::log(std::max(left, 1e-300)) + whitened_[k].log_determinant();
}

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
      std::vector<Index> chosen;
      for (Index j = 0; j < sets; ++j)
        if (without(index(k), j) - least[j] <= reach) chosen.push_back(j);
      if (chosen.empty()) continue;
      const Matrix white = whitened_[k].whiten(data(Eigen::all, chosen));
      const Matrix explained = (prepared_[k].signatures.transpose() * white).array().square();
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Index j = chosen[i];
        const double n = static_cast<double>(freedom_), shift = whitened_[k].log_determinant(),
                     left = std::exp((without(index(k), j) - shift) / n);
        for (Index a = 0; a < candidates; ++a) {
          const Block& b = prepared_[k].blocks[index(a)];
          if (b.count == 0) continue;
          const double rest = left - explained.col(index(i)).segment(b.first, b.count).sum();
          best[part](a, j) = std::min(best[part](a, j), n * std::log(std::max(rest, 1e-12 * left)) + shift);
        }
      }
    }
  });
  Matrix out = Matrix::Constant(candidates, sets, infinite);
  for (const Matrix& b : best) out = out.cwiseMin(b);
  return out;
}

Vector Scan::criteria_of(const Vector& residuals) const {
  const Matrix data = winsorised(residuals);
  Vector out(index(models_.size()));
  for (std::size_t k = 0; k < models_.size(); ++k)
    out[index(k)] = criterion(whitened_[k].left(whitened_[k].whiten(data))[0], k);
  return out;
}

Statistics Scan::run(const Matrix& residuals, double reach) const {
  Statistics out;
  const Matrix data = winsorised(residuals, &out.scale);
  const Index sets = data.cols();
  Matrix without(index(models_.size()), sets);
  propagation::parallel_for(models_.size(), threads_, [&](std::size_t k) {
    const Vector left = whitened_[k].left(whitened_[k].whiten(data));
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
    const auto n = static_cast<double>(freedom_);
    return std::exp((without(index(i), j) - whitened_[i].log_determinant()) / n) / n;
  };
  out.covariance_model[index(j)] = k;
  out.without_scatter[index(j)] = single;
  out.cautious[index(j)] = cautious;
  out.criterion[j] = base;
  out.variance[j] = variance(k);
  out.variance_cautious[j] = variance(cautious);
  out.variance_without_scatter[j] = variance(single);
}

double Scan::left_with(std::size_t a, std::size_t k, const Vector& white, double left) const {
  const Block& b = prepared_[k].blocks[a];
  return left - (prepared_[k].signatures.middleCols(b.first, b.count).transpose() * white).squaredNorm();
}

Fit Scan::fit(std::size_t a, const Vector& residuals) const {
  const Matrix data = winsorised(residuals);
  Fit out;
  double best = infinite, base = best;
  for (std::size_t k = 0; k < models_.size(); ++k) {
    const Vector white = whitened_[k].whiten(data);
    const double left = whitened_[k].left(white)[0];
    base = std::min(base, criterion(left, k));
    const double c = criterion(std::max(left_with(a, k, white, left), 1e-12 * left), k);
    if (c < best - criteria.as_good) best = c, out.covariance_model = k;
  }
  out.ratio = std::max(0.0, base - best);
  const Whitened& w = whitened_[out.covariance_model];
  const Vector white = w.whiten(data);
  Matrix covariance;
  const Vector x = w.solve(white, &covariance, signature(a, out.covariance_model));
  const Index d = candidates_[a]->columns.cols();
  out.size = x.tail(d);
  const double rest = left_with(a, out.covariance_model, white, w.left(white)[0]);
  const double s2 = rest / std::max(1.0, static_cast<double>(freedom_) - static_cast<double>(d));
  out.u = (s2 * covariance.diagonal().tail(d)).cwiseMax(0).cwiseSqrt();
  return out;
}

double Scan::pair_ratio(std::size_t a, std::size_t b, const Vector& residuals, std::size_t k) const {
  const Whitened& w = whitened_[k];
  const Vector white = w.whiten(winsorised(residuals));
  Matrix both(white.size(), candidates_[a]->columns.cols() + candidates_[b]->columns.cols());
  both << signature(a, k), signature(b, k);
  for (Index j = 0; j < both.cols(); ++j) {
    const double length = both.col(j).norm();
    if (length > 0) both.col(j) /= length;
  }
  const Matrix basis = orthonormal(both, w.project(both));
  const double left = w.left(white)[0], in = (basis.transpose() * white).squaredNorm();
  return static_cast<double>(freedom_) * std::log(left / std::max(left - in, 1e-12 * left));
}

double Scan::correlation(std::size_t a, std::size_t b, std::size_t k) const {
  const Matrix x = signature(a, k), y = signature(b, k);
  const Matrix xp = whitened_[k].project(x), yp = whitened_[k].project(y);
  const Eigen::LLT<Matrix> xx(Matrix(x.transpose() * xp)), yy(Matrix(y.transpose() * yp));
  if (xx.info() != Eigen::Success || yy.info() != Eigen::Success) return 0;
  const Matrix cross = xx.matrixL().solve(Matrix(x.transpose() * yp));
  const Matrix canonical = yy.matrixL().solve(Matrix(cross.transpose()));
  const Eigen::JacobiSVD<Matrix> svd(canonical);
  // Between spaces of unequal size: how well the smaller lies in the larger.
  return std::min(1.0, svd.singularValues()[std::min(x.cols(), y.cols()) - 1]);
}

double Scan::information(std::size_t a, Index column, std::size_t k) const {
  const Matrix w = whitened_[k].whiten_rows(candidates_[a]->columns.col(column));
  return std::max(0.0, w.cwiseProduct(whitened_[k].project(w)).sum());
}

} // namespace gumshoe::tracing
