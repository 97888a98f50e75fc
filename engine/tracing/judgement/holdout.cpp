#include "tracing/judgement/holdout.h"

#include <algorithm>
#include <map>

namespace gumshoe::tracing {

HeldOut hold_out(const Design& d, const Matrix& residual, const Matrix& extra, const std::vector<Index>& train,
                 const std::vector<Index>& test, const Structure& structure) {
  HeldOut out;
  out.rows = test;
  const auto use = independent(d, train);
  const Whitened w(d, train, use, structure);
  const auto p = static_cast<Index>(use.size()), n = static_cast<Index>(test.size());
  const Matrix data = w.whiten(w.take(residual)), signature = w.whiten(w.take(extra));
  Matrix predicted = Matrix::Zero(n, residual.cols());
  const Matrix x = w.solve_all(signature, data);
  for (Index i = 0; i < n; ++i) {
    const Index row = test[static_cast<std::size_t>(i)];
    for (Index j = 0; j < p; ++j) predicted.row(i) += d.fixed(row, use[static_cast<std::size_t>(j)]) * x.row(j);
    if (extra.cols() > 0) predicted.row(i) += extra.row(row) * x.bottomRows(extra.cols());
  }
  out.residual.resize(n, residual.cols());
  for (Index i = 0; i < n; ++i)
    out.residual.row(i) = residual.row(test[static_cast<std::size_t>(i)]) - predicted.row(i);
  // The block's own constants.
  std::vector<Index> constants;
  const auto felt = [&](const std::vector<Index>& rows, Index j) {
    return std::any_of(rows.begin(), rows.end(), [&](Index row) { return d.fixed(row, j) != 0; });
  };
  for (Index j = 0; j < d.fixed.cols(); ++j)
    if (!felt(train, j) && felt(test, j)) constants.push_back(j);
  Design own = d;
  own.fixed = Matrix(d.fixed(Eigen::all, constants));
  const auto seen = independent(own, test);
  out.count = static_cast<double>(test.size() - seen.size());
  out.squares = out.whitened = Vector::Zero(residual.cols());
  // Beside declared draws and scatter, as they are expected of readings not seen.
  const Whitened declared(own, test, seen, {0, structure.scatter, structure.ratio, structure.indication});
  own.random.resize(own.random.rows(), 0);
  const Whitened local(own, test, seen, Structure{});
  const Matrix white = local.whiten(out.residual);
  if (!seen.empty()) {
    const Matrix constant = local.solve_all(Matrix(white.rows(), 0), white);
    for (Index i = 0; i < n; ++i)
      for (std::size_t j = 0; j < seen.size(); ++j)
        out.residual.row(i) -=
            own.fixed(test[static_cast<std::size_t>(i)], seen[j]) * constant.row(static_cast<Index>(j));
  }
  if (out.count <= 0) return out;
  // Of what the constants leave, which may be millions of times the noise: no difference of large squares.
  out.squares = local.left(local.whiten(out.residual));
  out.whitened = declared.left(declared.whiten(out.residual));
  return out;
}

std::vector<Index> rows_where(const Observations& o, const std::vector<bool>& chosen) {
  std::vector<Index> out;
  for (std::size_t i = 0; i < o.sequence.size(); ++i)
    if (chosen[o.sequence[i]])
      for (std::size_t k = 0; k < o.indications; ++k) out.push_back(static_cast<Index>(i * o.indications + k));
  return out;
}

std::vector<std::vector<Index>> folds(const Observations& o, const std::vector<Index>& rows) {
  const auto reading = [&](Index row) { return o.sequence[static_cast<std::size_t>(row) / o.indications]; };
  std::map<std::size_t, std::vector<Index>> by_block;
  if (!o.blocks.groups.empty())
    for (const Index row : rows) by_block[o.blocks.group[reading(row)]].push_back(row);
  std::vector<std::vector<Index>> out;
  if (by_block.size() >= 3) {
    for (auto& [block, list] : by_block) out.push_back(std::move(list));
    return out;
  }
  const std::size_t readings = rows.size() / o.indications, parts = std::min<std::size_t>(5, readings);
  out.resize(parts);
  for (std::size_t i = 0; i < rows.size(); ++i) out[i / o.indications * parts / readings].push_back(rows[i]);
  return out;
}

} // namespace gumshoe::tracing
