/// The data's covariance matrix by what is declared, as rows that whiten.
#include <cmath>

#include <Eigen/Dense>

#include "models/sphere_calibration/procedures.h"

namespace gumshoe::models::sphere_calibration {

Vector3<double> derivative(const Poses<double>& poses, std::size_t reading, std::size_t quantity) {
  constexpr std::size_t count = rows_of<Quantities>;
  const At<double>& at = poses.at[reading];
  // The estimates of a scenario, or the values that a table states.
  const double* estimates = poses.declared ? &poses.declared->estimates[reading * count] : array_of(at.q);
  At<Gradient> moved;
  for (std::size_t j = 0; j < count; ++j) array_of(moved.q)[j] = Gradient(estimates[j]);
  for (std::size_t j = 0; j < rows_of<Conditions>; ++j) array_of(moved.c)[j] = Gradient(array_of(at.c)[j]);
  array_of(moved.q)[quantity].d[0] = 1;
  const auto x = simulate(contact(moved));
  return {x.x.d[0], x.y.d[0], x.z.d[0]};
}

namespace {

/// Moves the commands as some unknowns do: no weight depends on it.
bool as_unknowns_do(const Declared::Draw& draw, std::size_t readings) {
  const std::size_t q = draw.moves.front().column;
  return q < Q::link_B_x || (q <= Q::sphere_distance && draw.moves.size() == readings);
}

/// What a draw of one standard uncertainty does to all commands; empty if no weight depends on it.
using Effect = std::vector<std::pair<Eigen::Index, double>>;

Effect effect_of(const Declared::Draw& draw, const Poses<double>& poses) {
  Effect out;
  if (draw.moves.empty() || as_unknowns_do(draw, poses.size())) return out;
  for (const auto& [reading, column, by] : draw.moves) {
    const auto first = static_cast<Eigen::Index>(3 * reading);
    if (column >= rows_of<Quantities>) {
      out.emplace_back(first + static_cast<Eigen::Index>(column - rows_of<Quantities>), draw.u * by);
      continue;
    }
    const auto d = derivative(poses, reading, column);
    out.emplace_back(first, draw.u * d.x);
    out.emplace_back(first + 1, draw.u * d.y);
    out.emplace_back(first + 2, draw.u * d.z);
  }
  return out;
}

/// Adds r a b'.
void add(const Effect& a, const Effect& b, double r, Eigen::MatrixXd& V) {
  for (const auto& [i, x] : a)
    for (const auto& [j, y] : b) V(i, j) += r * x * y;
}

Eigen::MatrixXd covariance(const Poses<double>& poses) {
  const auto n = static_cast<Eigen::Index>(3 * poses.size());
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(n, n);
  std::vector<Effect> effects;
  for (const auto& draw : poses.declared->draws) {
    effects.push_back(effect_of(draw, poses));
    add(effects.back(), effects.back(), 1, V);
  }
  for (const auto& [a, b, correlation] : poses.declared->ties) {
    add(effects[a], effects[b], correlation, V);
    add(effects[b], effects[a], correlation, V);
  }
  return V;
}

} // namespace

Whitening whitening(const Poses<double>& poses, std::string& problem) {
  const Eigen::MatrixXd V = covariance(poses);
  const Eigen::Index n = V.rows();
  Whitening out;
  const Eigen::LLT<Eigen::MatrixXd> factor(V);
  const Eigen::MatrixXd L = factor.matrixL();
  for (Eigen::Index i = 0; i < n; ++i)
    if (factor.info() != Eigen::Success || !(L(i, i) > 1e-6 * std::sqrt(V(i, i)))) {
      constexpr const char* names[] = {"X", "Y", "Z"};
      problem = std::string("the declaration leaves ") + names[i % 3] + " of reading " + std::to_string(i / 3 + 1) +
                " without independent noise, so that there are no weights (declare linear errors or noise of the "
                "indications per reading)";
      return out;
    }
  const Eigen::MatrixXd W = L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n));
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index first = 0;
    while (W(i, first) == 0) ++first;
    out.first.push_back(static_cast<std::size_t>(first));
    out.rows.emplace_back();
    for (Eigen::Index j = first; j <= i; ++j) out.rows.back().push_back(W(i, j));
  }
  out.size = W.norm() / std::sqrt(static_cast<double>(n));
  return out;
}

} // namespace gumshoe::models::sphere_calibration
