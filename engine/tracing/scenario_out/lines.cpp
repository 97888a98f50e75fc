#include "tracing/scenario_out/lines.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::tracing {

double covariance_of(const Matrix& of_columns, const MadeOf& a, const MadeOf& b) {
  double out = 0;
  for (const auto& [i, x] : a)
    for (const auto& [j, y] : b) out += x * y * (of_columns(i, j) + of_columns(j, i)) / 2;
  return out;
}

void of_shares(const JointFit& fit, std::size_t term, const Vector& share, Line& line) {
  line.value = share.dot(fit.terms[term].size);
  for (Index j = 0; j < share.size(); ++j)
    if (share[j] != 0) line.made_of.emplace_back(first_column(fit, term) + j, share[j]);
}

std::size_t of_a_group_not_measured(const JointFit& fit, std::size_t term, const std::vector<Matrix>& shares,
                                    Line& line) {
  const Vector& size = fit.terms[term].size;
  std::vector<Vector> measured;
  for (const Matrix& of_effect : shares)
    for (Index g = 0; g < of_effect.rows(); ++g)
      if (!of_effect.row(g).hasNaN()) measured.emplace_back(of_effect.row(g));
  const auto n = static_cast<double>(measured.size());
  Vector mean = Vector::Zero(size.size());
  for (const Vector& one : measured) mean += one / n;
  of_shares(fit, term, mean, line);
  double square = 0;
  for (const Vector& one : measured) square += std::pow((one - mean).dot(size), 2);
  line.spread = std::sqrt(square / std::max(1.0, n - 1) * (1 + 1 / n));
  line.taken.source += "; not measured: what the others have, give or take their spread";
  return measured.size();
}

} // namespace gumshoe::tracing
