/// Declared draws with which readings jump: no tangent leads to their most likely values.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/special_values.h"
#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {
namespace {

/// A fit's design without one declared draw; the readings about the point where that stands.
struct WithoutDraw {
  Design design;
  Vector residual;

  WithoutDraw(const JointFit& fit, std::size_t draw) : design(fit.design), residual(fit.residual) {
    std::vector<Index> others;
    for (std::size_t j = 0; j < fit.draw_of.size(); ++j)
      if (fit.draw_of[j] == draw)
        residual -= fit.design.random.col(index(j)) * fit.drawn[index(draw)];
      else
        others.push_back(index(j));
    design.random = Matrix(fit.design.random(Eigen::all, others));
    design.bent.clear();
    for (const Index j : others) design.bent.push_back(fit.design.bent[index(j)]);
  }
};

} // namespace

Matrix Fitter::moved_by(const Draw& draw, const Points& at, const Vector& steps, std::vector<bool>& valid) const {
  std::set<std::size_t> quantities;
  std::vector<bool> moves(observations_.readings, false);
  for (const auto& [r, q] : draw.moves) quantities.insert(q), moves[r] = true;
  std::vector<Variation> variations(index(steps.size()) + 1); // the last one changes nothing
  for (Index k = 0; k < steps.size(); ++k)
    for (const std::size_t q : quantities) variations[index(k)].changes.push_back({q, draw.u * steps[k], false});
  Matrix f;
  simulator_.vary(at, variations, f, valid);
  Matrix out = f.leftCols(steps.size()).colwise() - f.col(steps.size()).eval();
  const auto k = index(observations_.indications);
  for (std::size_t r = 0; r < observations_.readings; ++r)
    if (!moves[r]) out.middleRows(index(r) * k, k).setZero();
  return in_sequence(observations_, out);
}

bool Fitter::cross_draws(JointFit& fit) const {
  double best = criteria.decisive;
  Vector change;
  for (std::size_t v = 0; v < draws_.size() && fit.valid; ++v) {
    if (!draws_[v].jumps || released(draws_[v], fit)) continue;
    const double here = fit.drawn[index(v)];
    const Vector steps =
        Vector::LinSpaced(criteria.draw_steps, -criteria.draw_reach, criteria.draw_reach).array() - here;
    std::vector<bool> valid;
    const Matrix moved = moved_by(draws_[v], fit.at, steps, valid);
    const WithoutDraw rest(fit, v);
    const auto use = independent(rest.design, rows_);
    const Whitened plain(rest.design, rows_, use, {}), model(rest.design, rows_, use, fit.covariance_model);
    Matrix residuals(moved.rows(), moved.cols() + 1);
    residuals << ((-moved).colwise() + rest.residual), rest.residual;
    const Vector squares = model.squares(plain.winsorised(plain.take(residuals)));
    const double before = squares[steps.size()] + here * here,
                 freedom = static_cast<double>(model.degrees_of_freedom());
    for (Index k = 0; k < steps.size(); ++k) {
      if (!valid[index(k)]) continue;
      const double gain = freedom * std::log(before / (squares[k] + std::pow(here + steps[k], 2)));
      if (!(gain > best)) continue;
      best = gain;
      change = Vector::Zero(fit.drawn.size());
      change[index(v)] = steps[k];
    }
  }
  if (change.size() == 0) return false;
  JointFit next = fit;
  move_draws(next, change);
  if (!linearise(next)) return false;
  fit = std::move(next);
  return true;
}

} // namespace gumshoe::tracing
