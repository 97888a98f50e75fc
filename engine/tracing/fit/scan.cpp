#include "tracing/fit/scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "propagation/propagate.h"

namespace gumshoe::tracing {
namespace {

/// In twice the log likelihood: rounding of large determinants is far less, what tells structures apart far more.
constexpr double as_good = 1e-6;

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
    if (eigen.eigenvalues()[j] > absorbed_share) kept.push_back(j);
  Matrix out(projected.rows(), static_cast<Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    Vector direction = eigen.eigenvectors().col(kept[i]);
    for (Index j = 0; j < direction.size(); ++j) direction[j] = length[j] > 0 ? direction[j] / length[j] : 0;
    out.col(static_cast<Index>(i)) = projected * direction / std::sqrt(eigen.eigenvalues()[kept[i]]);
  }
  return out;
}

} // namespace

Scan::Scan(const Design& design, const std::vector<Index>& rows, const std::vector<const Alternative*>& alternatives,
           int threads)
    : design_(design), rows_(rows), use_(independent(design, rows)), alternatives_(alternatives), threads_(threads),
      structures_(structures(design, rows.size())) {
  freedom_ = rows.size() - use_.size();
  for (std::size_t k = 0; k < structures_.size(); ++k)
    if (structures_[k].correlation == 0 && structures_[k].scatter < 0) plain_ = k;
  std::vector<std::unique_ptr<Whitened>> made(structures_.size());
  prepared_.resize(structures_.size());
  Index total = 0;
  for (const Alternative* a : alternatives_) total += a->columns.cols();
  Matrix chosen(static_cast<Index>(rows.size()), total);
  Index at = 0;
  for (const Alternative* a : alternatives_) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      chosen.row(static_cast<Index>(i)).segment(at, a->columns.cols()) = a->columns.row(rows[i]);
    at += a->columns.cols();
  }
  share_.assign(alternatives_.size(), 0);
  absorbed_.assign(alternatives_.size(), -1);
  propagation::parallel_for(structures_.size(), threads_, [&](std::size_t k) {
    made[k] = std::make_unique<Whitened>(design_, rows_, use_, structures_[k]);
    const Matrix white = made[k]->whiten(chosen), left = made[k]->project(white);
    Prepared& p = prepared_[k];
    p.signatures.resize(white.rows(), total);
    Index used = 0, from = 0;
    for (std::size_t a = 0; a < alternatives_.size(); ++a) {
      const Index cols = alternatives_[a]->columns.cols();
      const Matrix w = white.middleCols(from, cols), l = left.middleCols(from, cols);
      const Matrix basis = orthonormal(w, l);
      p.blocks.push_back({used, basis.cols()});
      p.signatures.middleCols(used, basis.cols()) = basis;
      used += basis.cols();
      from += cols;
      if (k != plain_) continue;
      const double whole = w.squaredNorm();
      share_[a] = whole > 0 ? w.cwiseProduct(l).sum() / whole : 0;
      if (share_[a] < 0.5 && whole > 0) {
        // Which column of the fit looks most like it?
        double best = 0;
        Index j = 0;
        for (const Index c : use_) {
          const Vector fixed = made[k]->whiten(made[k]->take(design_.fixed.col(c)));
          const double cosine =
              fixed.norm() > 0 ? (fixed.transpose() * w).norm() / (fixed.norm() * std::sqrt(whole)) : 0;
          if (cosine > best) best = cosine, absorbed_[a] = static_cast<int>(c);
          ++j;
        }
        for (Index c = 0; c < design_.random.cols(); ++c) {
          const Vector random = made[k]->whiten(made[k]->take(design_.random.col(c)));
          const double cosine =
              random.norm() > 0 ? (random.transpose() * w).norm() / (random.norm() * std::sqrt(whole)) : 0;
          if (cosine > best) best = cosine, absorbed_[a] = static_cast<int>(design_.fixed.cols() + c);
        }
      }
    }
    p.signatures.conservativeResize(Eigen::NoChange, used);
  });
  for (auto& m : made) whitened_.push_back(std::move(*m));
  for (std::size_t a = 0; a < alternatives_.size(); ++a)
    if (share_[a] <= absorbed_share)
      for (Prepared& p : prepared_) p.blocks[a].count = 0;
}

double Scan::criterion(double left, std::size_t k) const {
  return static_cast<double>(freedom_) * std::log(std::max(left, 1e-300)) + whitened_[k].log_determinant();
}

Departures Scan::departures(const Vector& residuals) const {
  // Of normal numbers so many would be far out.
  const double chance = std::erfc(far_out / std::sqrt(2.0)), n = static_cast<double>(residuals.size());
  Departures out;
  Matrix weight;
  winsorised(residuals, nullptr, &weight);
  // Least squares hide of each residual what they fit to it.
  for (Index i = 0; i < weight.rows(); ++i)
    if (weight(i, 0) < 1) out.sizes.push_back(far_out / weight(i, 0) * n / static_cast<double>(freedom_));
  out.share = std::max(0.0, static_cast<double>(out.sizes.size()) / n - chance);
  return out;
}

Statistics Scan::run(const Matrix& residuals, double reach) const {
  Statistics out;
  const Matrix data = winsorised(residuals, &out.scale);
  const Index sets = data.cols();
  const auto candidates = static_cast<Index>(alternatives_.size());
  const std::size_t count = structures_.size();
  Matrix without(static_cast<Index>(count), sets);
  constexpr double none = std::numeric_limits<double>::infinity();
  propagation::parallel_for(count, threads_, [&](std::size_t k) {
    const Vector left = whitened_[k].left(whitened_[k].whiten(data));
    for (Index j = 0; j < sets; ++j) without(static_cast<Index>(k), j) = criterion(left[j], k);
  });
  const Vector least = without.colwise().minCoeff();
  // In parts by structure, each thread with its own best; minima do not depend on the order.
  const std::size_t parts = candidates > 0 ? std::min<std::size_t>(count, 8) : 0;
  std::vector<Matrix> best(parts);
  propagation::parallel_for(parts, threads_, [&](std::size_t part) {
    best[part] = Matrix::Constant(candidates, sets, none);
    for (std::size_t k = part; k < count; k += parts) {
      std::vector<Index> chosen;
      for (Index j = 0; j < sets; ++j)
        if (without(static_cast<Index>(k), j) - least[j] <= reach) chosen.push_back(j);
      if (chosen.empty()) continue;
      const Matrix white = whitened_[k].whiten(data(Eigen::all, chosen));
      const Matrix explained = (prepared_[k].signatures.transpose() * white).array().square();
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Index j = chosen[i];
        const double n = static_cast<double>(freedom_), shift = whitened_[k].log_determinant(),
                     left = std::exp((without(static_cast<Index>(k), j) - shift) / n);
        for (Index a = 0; a < candidates; ++a) {
          const Block& b = prepared_[k].blocks[static_cast<std::size_t>(a)];
          if (b.count == 0) continue;
          const double rest = left - explained.col(static_cast<Index>(i)).segment(b.first, b.count).sum();
          const double c = n * std::log(std::max(rest, 1e-12 * left)) + shift;
          if (c < best[part](a, j)) best[part](a, j) = c;
        }
      }
    }
  });
  out.ratio = Matrix::Zero(candidates, sets);
  out.scatter = Matrix::Zero(static_cast<Index>(design_.scatter.size()), sets);
  out.structure.resize(static_cast<std::size_t>(sets));
  out.without_scatter.resize(static_cast<std::size_t>(sets));
  out.cautious.resize(static_cast<std::size_t>(sets));
  out.variance_cautious.resize(sets);
  out.criterion.resize(sets);
  out.variance.resize(sets);
  out.variance_without_scatter.resize(sets);
  for (Index j = 0; j < sets; ++j) {
    // The first, hence simplest, of those that are as good: where each group has a constant, its scatter changes
    // nothing.
    const auto best_of = [&](const std::function<bool(const Structure&)>& wanted) {
      std::size_t found = count;
      for (std::size_t i = 0; i < count; ++i)
        if (wanted(structures_[i]) &&
            (found == count || without(static_cast<Index>(i), j) < without(static_cast<Index>(found), j) - as_good))
          found = i;
      return found;
    };
    const std::size_t k = best_of([](const Structure&) { return true; }),
                      uncorrelated = best_of([](const Structure&s) { return s.correlation == 0; }),
                      single = best_of([](const Structure&s) { return s.scatter < 0; });
    const double base = without.col(j).minCoeff(), white = without(static_cast<Index>(uncorrelated), j),
                 plain = without(static_cast<Index>(single), j);
    out.structure[static_cast<std::size_t>(j)] = k;
    out.without_scatter[static_cast<std::size_t>(j)] = single;
    out.criterion[j] = base;
    Vector component = Vector::Constant(out.scatter.rows(), none);
    for (std::size_t i = 0; i < count; ++i)
      if (structures_[i].scatter >= 0)
        component[structures_[i].scatter] =
            std::min(component[structures_[i].scatter], without(static_cast<Index>(i), j));
    for (Index c = 0; c < out.scatter.rows(); ++c) out.scatter(c, j) = std::max(0.0, plain - component[c]);
    const auto variance = [&](std::size_t i) {
      return std::exp((without(static_cast<Index>(i), j) - whitened_[i].log_determinant()) /
                      static_cast<double>(freedom_)) /
             static_cast<double>(freedom_);
    };
    // A correlation that chance gives would make u of alternating signatures too small.
    out.cautious[static_cast<std::size_t>(j)] = white - base < 3.84 ? uncorrelated : k;
    out.variance_cautious[j] = variance(out.cautious[static_cast<std::size_t>(j)]);
    out.variance[j] = variance(k);
    out.variance_without_scatter[j] = variance(out.without_scatter[static_cast<std::size_t>(j)]);
    for (Index a = 0; a < candidates; ++a) {
      double with = none;
      for (const Matrix& b : best) with = std::min(with, b(a, j));
      if (std::isfinite(with)) out.ratio(a, j) = std::max(0.0, base - with);
    }
  }
  return out;
}

Fit Scan::fit(std::size_t a, const Vector& residuals) const {
  const Matrix data = winsorised(residuals);
  Fit out;
  double best = std::numeric_limits<double>::infinity(), base = best;
  for (std::size_t k = 0; k < structures_.size(); ++k) {
    const Vector white = whitened_[k].whiten(data);
    const double left = whitened_[k].left(white)[0];
    base = std::min(base, criterion(left, k));
    const Block& b = prepared_[k].blocks[a];
    const double rest = left - (prepared_[k].signatures.middleCols(b.first, b.count).transpose() * white).squaredNorm();
    const double c = criterion(std::max(rest, 1e-12 * left), k);
    if (c < best - as_good) best = c, out.structure = k;
  }
  out.ratio = std::max(0.0, base - best);
  const Whitened& w = whitened_[out.structure];
  const Matrix signature = w.whiten(w.take(alternatives_[a]->columns));
  const Vector white = w.whiten(data);
  Matrix covariance;
  const Vector x = w.solve(signature, white, &covariance);
  const Index d = signature.cols();
  out.size = x.tail(d);
  const double left = w.left(white)[0];
  const Block& b = prepared_[out.structure].blocks[a];
  const double rest =
      left - (prepared_[out.structure].signatures.middleCols(b.first, b.count).transpose() * white).squaredNorm();
  const double s2 = rest / std::max(1.0, static_cast<double>(freedom_) - static_cast<double>(d));
  out.u = (s2 * covariance.diagonal().tail(d)).cwiseMax(0).cwiseSqrt();
  return out;
}

double Scan::pair_ratio(std::size_t a, std::size_t b, const Vector& residuals, std::size_t k) const {
  const Whitened& w = whitened_[k];
  const Vector white = w.whiten(winsorised(residuals));
  const Index d = alternatives_[a]->columns.cols();
  Matrix both(white.size(), d + alternatives_[b]->columns.cols());
  both << w.whiten(w.take(alternatives_[a]->columns)), w.whiten(w.take(alternatives_[b]->columns));
  for (Index j = 0; j < both.cols(); ++j) {
    const double length = both.col(j).norm();
    if (length > 0) both.col(j) /= length;
  }
  const Matrix basis = orthonormal(both, w.project(both));
  const double left = w.left(white)[0], in = (basis.transpose() * white).squaredNorm();
  return static_cast<double>(freedom_) * std::log(left / std::max(left - in, 1e-12 * left));
}

double Scan::correlation(std::size_t a, std::size_t b, std::size_t k) const {
  const Matrix x = whitened_[k].whiten(whitened_[k].take(alternatives_[a]->columns)),
               y = whitened_[k].whiten(whitened_[k].take(alternatives_[b]->columns));
  const Matrix xp = whitened_[k].project(x), yp = whitened_[k].project(y);
  const Eigen::LLT<Matrix> xx(Matrix(x.transpose() * xp)), yy(Matrix(y.transpose() * yp));
  if (xx.info() != Eigen::Success || yy.info() != Eigen::Success) return 0;
  const Matrix cross = xx.matrixL().solve(Matrix(x.transpose() * yp));
  const Matrix canonical = yy.matrixL().solve(Matrix(cross.transpose()));
  const Eigen::JacobiSVD<Matrix> svd(canonical);
  // Of spaces of unequal size: how well the smaller lies in the larger.
  return std::min(1.0, svd.singularValues()[std::min(x.cols(), y.cols()) - 1]);
}

double Scan::information(std::size_t a, Index column, std::size_t k) const {
  const Matrix w = whitened_[k].whiten(whitened_[k].take(alternatives_[a]->columns.col(column)));
  return std::max(0.0, w.cwiseProduct(whitened_[k].project(w)).sum());
}

} // namespace gumshoe::tracing
