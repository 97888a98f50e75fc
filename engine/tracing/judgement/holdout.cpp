#include "tracing/judgement/holdout.h"

#include <algorithm>
#include <map>

#include <Eigen/Cholesky>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// The block's offsets: columns to which no training row is sensitive.
std::vector<Index> offsets_of(const Design& d, const std::vector<Index>& train, const std::vector<Index>& test) {
  std::vector<Index> out;
  std::ranges::set_difference(insensitive(d, train), insensitive(d, test), std::back_inserter(out));
  return out;
}

/// A factor of a covariance, which need not be definite.
Matrix factor(const Matrix& covariance) {
  const Eigen::LDLT<Matrix> ldlt(covariance);
  const Matrix lower = ldlt.matrixL();
  return ldlt.transpositionsP().transpose() * Matrix(lower * ldlt.vectorD().cwiseMax(0).cwiseSqrt().asDiagonal());
}

} // namespace

HeldOut hold_out(const Design& d, const Matrix& residual, const std::vector<Index>& train,
                 const std::vector<Index>& test, const CovarianceModel& model, const CovarianceModel& units) {
  HeldOut out;
  out.rows = test;
  const auto use = independent(d, train);
  const Whitened w(d, train, use, model);
  const Matrix x = w.coefficients(w.take(residual));
  const auto p = index(use.size()), q = d.random.cols();
  Matrix as_declared = residual(test, Eigen::all);
  as_declared -= d.fixed(test, use) * x.topRows(p);
  out.residual = as_declared - d.random(test, Eigen::all) * x.bottomRows(q);
  Design own = d;
  own.fixed = Matrix(d.fixed(Eigen::all, offsets_of(d, train, test)));
  const auto seen = independent(own, test);
  out.count = static_cast<double>(test.size() - seen.size());
  out.whitened = Vector::Zero(residual.cols());
  // With declared draws and scatter, as they are expected of readings not seen.
  const Whitened declared(own, test, seen, {0, units.scatter, units.ratio, units.indication});
  own.random.resize(own.random.rows(), 0);
  const Whitened local(own, test, seen, {});
  for (Matrix* of : {&out.residual, &as_declared}) {
    if (seen.empty()) break;
    const Matrix offset = local.coefficients(*of);
    for (Index i = 0; i < of->rows(); ++i)
      for (std::size_t j = 0; j < seen.size(); ++j)
        of->row(i) -= own.fixed(test[index(i)], seen[j]) * offset.row(index(j));
  }
  if (out.count <= 0) return out;
  // Squares of what the offsets leave: those may be millions of times the noise, and differences would lose digits.
  out.whitened = declared.squares(as_declared);
  out.declared = declared.in_units(as_declared.col(0));
  out.weighted = declared.weighted_units(out.declared);
  return out;
}

double minus_log_density(const Design& d, const Matrix& residual, const std::vector<Index>& train,
                         const std::vector<Index>& test, const CovarianceModel& model) {
  const auto use = independent(d, train);
  const Whitened w(d, train, use, model);
  Matrix known;
  const Matrix x = w.coefficients(w.take(residual), &known);
  Matrix columns(d.fixed.rows(), x.rows());
  columns << d.fixed(Eigen::all, use), d.random;
  Design own = d;
  own.fixed = Matrix(d.fixed(Eigen::all, offsets_of(d, train, test)));
  own.random = columns * factor(known);
  const auto seen = independent(own, test);
  if (test.size() <= seen.size()) return 0;
  const Whitened given(own, test, seen, {0, model.scatter, model.ratio, model.indication});
  return given.squares(given.take(residual - columns * x))[0] + given.log_determinant();
}

Matrix winsorised_in(const Design& d, const std::vector<Index>& rows, Matrix residual) {
  const Whitened plain(d, rows, independent(d, rows), {});
  residual(rows, Eigen::all) = plain.winsorised(plain.take(residual));
  return residual;
}

std::vector<Index> rows_where(const Observations& o, const std::vector<bool>& chosen) {
  std::vector<Index> out;
  for (std::size_t i = 0; i < o.sequence.size(); ++i)
    if (chosen[o.sequence[i]])
      for (std::size_t k = 0; k < o.indications; ++k) out.push_back(index(i * o.indications + k));
  return out;
}

std::vector<std::vector<Index>> folds(const Observations& o, const std::vector<Index>& rows) {
  const auto reading = [&](Index row) { return o.sequence[index(row) / o.indications]; };
  std::map<std::size_t, std::vector<Index>> by_block;
  if (!o.blocks.groups.empty())
    for (const Index row : rows) by_block[o.blocks.group[reading(row)]].push_back(row);
  std::vector<std::vector<Index>> out;
  if (by_block.size() >= criteria.blocks_for_folds) {
    for (auto& [block, list] : by_block) out.push_back(std::move(list));
    return out;
  }
  const std::size_t readings = rows.size() / o.indications, parts = std::min(criteria.stretches, readings);
  out.resize(parts);
  for (std::size_t i = 0; i < rows.size(); ++i) out[i / o.indications * parts / readings].push_back(rows[i]);
  return out;
}

double cross_validated(const Observations& o, const std::vector<Index>& rows, const JointFit& fit,
                       const CovarianceModel& model, Judged judged) {
  double sum = 0;
  const Matrix clean = winsorised_in(fit.design, rows, fit.residual);
  for (const auto& fold : folds(o, rows)) {
    std::vector<Index> train;
    std::set_difference(rows.begin(), rows.end(), fold.begin(), fold.end(), std::back_inserter(train));
    // Terms are fixed columns of the design: their sizes are fitted again without the fold.
    if (judged == Judged::given_the_others) {
      sum += minus_log_density(fit.design, clean, train, fold, model);
      continue;
    }
    const HeldOut held = hold_out(fit.design, clean, train, fold, model, model);
    if (held.count > 0) sum += held.whitened[0];
  }
  return sum;
}

} // namespace gumshoe::tracing
