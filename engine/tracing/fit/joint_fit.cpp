#include "tracing/fit/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/special_values.h"
#include "quantities/cells.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

} // namespace

Index first_column(const JointFit& fit, std::size_t term) {
  Index at = fit.design.fixed.cols();
  for (std::size_t t = fit.terms.size(); t-- > term;) at -= fit.terms[t].size.size();
  return at;
}

Vector uncertainties(const JointFit& fit, std::size_t term) {
  return fit.covariance.diagonal().segment(first_column(fit, term), fit.terms[term].size.size()).cwiseSqrt();
}

Vector Fitter::sizes(const std::vector<Term>& terms) const {
  Vector out = Vector::Zero(index(unknowns_.size()));
  for (const Term& t : terms) {
    out.conservativeResize(out.size() + t.size.size());
    out.tail(t.size.size()) = t.size;
  }
  return out;
}

void Fitter::apply(JointFit& fit, const Vector& change, double share) const {
  Index j = 0;
  for (const FreeUnknown& u : unknowns_) {
    const double step = share * change[j++];
    if (step == 0) continue;
    for (std::size_t r = 0; r < observations_.readings; ++r)
      if (u.holds[r]) fit.at[r][u.quantity] += step;
  }
  for (Term& t : fit.terms)
    for (std::size_t i = 0; i < t.candidate.amplitudes.size(); ++i) {
      const Amplitude& a = t.candidate.amplitudes[i];
      double& size = t.size[index(i)];
      const double before = size;
      size = std::clamp(size + share * change[j++], a.low, a.high);
      if (a.quantity == Amplitude::npos) continue;
      for (std::size_t r = 0; r < observations_.readings; ++r)
        if (quantities::holds_for(a.labels, experiment_.scenario().readings[r].labels))
          fit.at[r][a.quantity] += size - before;
    }
}

void Fitter::move_draws(JointFit& fit, const Vector& change) const {
  fit.drawn += change;
  Vector moved = change;
  for (const auto& group : experiment_.plan().copulas) {
    const std::size_t m = group.variates.size();
    for (std::size_t i = 0; i < m; ++i) {
      double& own = moved[index(group.variates[i])] = 0;
      for (std::size_t j = 0; j <= i; ++j) own += group.cholesky[i * m + j] * change[index(group.variates[j])];
    }
  }
  for (std::size_t v = 0; v < draws_.size(); ++v)
    if (const double by = draws_[v].u * moved[index(v)]; by != 0)
      for (const auto& [r, q] : draws_[v].moves) fit.at[r][q] += by;
}

Points Fitter::without_draws(JointFit fit) const {
  move_draws(fit, -fit.drawn);
  return std::move(fit.at);
}

Vector Fitter::released_draws(const JointFit& fit) const {
  Vector out = Vector::Zero(fit.drawn.size());
  for (std::size_t v = 0; v < draws_.size(); ++v)
    if (fit.drawn[index(v)] != 0 && released(draws_[v], fit)) out[index(v)] = -fit.drawn[index(v)];
  return out;
}

/// Squares of the residuals at the point itself, winsorised as in the step, so that an outlier cannot stop the fit, and
/// of the fitted draws. What is shared but not fitted is left out by the linearised model.
double Fitter::objective(const JointFit& fit, const CovarianceModel& model, const Scan& scan) const {
  Design others = fit.design;
  Index kept = 0;
  double squares = 0;
  for (std::size_t j = 0; j < fit.draw_of.size(); ++j) {
    const std::size_t v = fit.draw_of[j];
    squares += fit.drawn[index(v)] * fit.drawn[index(v)];
    if (draws_[v].fitted) continue;
    others.random.col(kept++) = fit.design.random.col(index(j));
  }
  others.random.conservativeResize(Eigen::NoChange, kept);
  const Whitened here(others, rows_, {}, model);
  const Matrix chosen = scan.winsorised(here.take(fit.residual)) - here.take(drawn_part(fit));
  return here.squares(chosen)[0] + squares;
}

JointFit Fitter::linearised(double noise) const {
  JointFit fit;
  fit.at = simulator_.estimates();
  fit.drawn = Vector::Zero(index(draws_.size()));
  fit.noise = noise;
  fit.valid = linearise(fit);
  return fit;
}

/// Where a fit stands but for its terms: their sizes are in its point.
Points Fitter::without_terms(JointFit fit) const {
  for (Term& t : fit.terms)
    for (Amplitude& a : t.candidate.amplitudes) a.low = -1e300, a.high = 1e300;
  apply(fit, -sizes(fit.terms), 1);
  return fit.at;
}

namespace {

/// Columns of terms at the sizes from which they are fitted, where readings jump.
std::vector<Index> start_columns(const JointFit& fit) {
  std::vector<Index> out;
  for (std::size_t t = 0; t < fit.terms.size(); ++t) {
    const auto& [candidate, size] = fit.terms[t];
    if (candidate.start.empty() || !std::ranges::equal(candidate.start, size)) continue;
    for (Index j = 0; j < size.size(); ++j) out.push_back(first_column(fit, t) + j);
  }
  return out;
}

/// The step of all other columns. On a mill whose lowest insert triggers every reading, the tangent of its height is
/// that of the tool's length: a step of both together leads anywhere, and is for the better while the length is off.
Vector without_moving(const std::vector<Index>& held, const JointFit& fit, const std::vector<Index>& rows) {
  std::vector<Index> others;
  for (Index j = 0; j < fit.design.fixed.cols(); ++j)
    if (std::ranges::find(held, j) == held.end()) others.push_back(j);
  Design rest = fit.design;
  rest.fixed = Matrix(fit.design.fixed(Eigen::all, others));
  const auto use = independent(rest, rows);
  const Whitened plain(rest, rows, use, {});
  const Vector x = plain.coefficients(plain.winsorised(plain.take(fit.residual)));
  Vector out = Vector::Zero(fit.design.fixed.cols());
  for (std::size_t i = 0; i < use.size(); ++i) out[others[index(use[i])]] = x[index(i)];
  return out;
}

} // namespace

std::vector<Index> Fitter::jumping_unknowns() const {
  std::vector<Index> out;
  for (std::size_t u = 0; u < unknowns_.size(); ++u)
    if (unknowns_[u].jump > 0) out.push_back(index(u));
  return out;
}

JointFit Fitter::fit(const std::vector<Term>& terms, double noise, const JointFit* start) const {
  JointFit fit;
  fit.at = start ? without_terms(*start) : simulator_.estimates();
  fit.drawn = start ? start->drawn : Vector::Zero(index(draws_.size()));
  if (!start) move_draws(fit, earlier_);
  fit.terms = terms;
  move_draws(fit, released_draws(fit));
  // The scale of a declared noise is sought from the declared one on, as when the traced scenario is traced: from a
  // larger one, what an outlier is and what declared draws explain may settle elsewhere.
  fit.noise = noise > 0 ? noise : start && !noise_declared_ ? start->noise : 1;
  for (Term& t : fit.terms) {
    for (const auto& [q, value] : t.candidate.held)
      for (auto& p : fit.at) p[q] = value;
    t.size.setZero();
  }
  apply(fit, sizes(terms), 1);
  fit.valid = fit.converged = linearise(fit);
  if (!fit.valid) return fit;
  if (!noise_declared_ && noise == 0 && !start) {
    // No scale is known yet: take that of the plain residuals about the free unknowns.
    const Scan scan(fit.design, rows_, {}, threads_);
    fit.noise *= scan.run(scan.whitened(scan.plain()).take(fit.residual)).scale[0];
    linearise(fit);
  }
  auto held = start_columns(fit);
  if (!start) std::ranges::copy(jumping_unknowns(), std::back_inserter(held));
  if (!held.empty()) {
    apply(fit, without_moving(held, fit, rows_), 1);
    if (!linearise(fit)) fit.valid = fit.converged = false;
    if (!fit.valid) return fit;
  }
  converge(fit, noise);
  for (int lesser = 0; lesser < criteria.most_optima && fit.valid && explore(fit); ++lesser) converge(fit, noise);
  if (!fit.valid) return fit;
  cross_jumps(fit, noise, jump_reach(terms, start));
  return fit;
}

JointFit Fitter::with_noise(const JointFit& found, const std::vector<MoreNoise>& more) const {
  Fitter with = *this;
  const propagation::Range noise = experiment_.layout().indications;
  for (const MoreNoise& one : more) {
    std::map<std::size_t, Draw> draws;
    for (std::size_t r = 0; r < observations_.readings; ++r) {
      Draw& d = draws[one.group ? one.group->group[r] : r];
      if (one.group) d.name = one.group->groups[one.group->group[r]];
      d.u = one.u;
      d.moves.emplace_back(r, noise[one.indication]);
      d.local = d.moves.size() == 1;
    }
    for (auto& [of, d] : draws) with.draws_.push_back(std::move(d));
  }
  JointFit start = found;
  start.drawn.conservativeResizeLike(Vector::Zero(index(with.draws_.size())));
  with.earlier_.conservativeResizeLike(start.drawn);
  return with.fit(found.terms, 0, &start);
}

void Fitter::converge(JointFit& fit, double noise) const {
  fit.converged = false;
  bool draws_move = true; // false where readings jump, and their tangent leads nowhere
  int scales = 0;
  for (fit.iterations = 1; fit.iterations <= criteria.most_iterations; ++fit.iterations) {
    const Scan scan(fit.design, rows_, {}, threads_);
    const Whitened& plain = scan.whitened(scan.plain());
    const Matrix chosen = plain.take(fit.residual);
    const Statistics now = scan.run(chosen);
    fit.covariance_model = scan.covariance_models()[now.cautious[0]];
    fit.variance = now.variance_cautious[0];
    if (scan.degrees_of_freedom() > 0 && !std::isfinite(fit.variance)) { // of as many readings as unknowns it is none
      fit.valid = false;
      return;
    }
    const Whitened& w = scan.whitened(now.cautious[0]);
    fit.criterion = static_cast<double>(scan.degrees_of_freedom()) * std::log(fit.variance) + w.log_determinant();
    Matrix covariance;
    const Vector x = w.coefficients(scan.winsorised(chosen), &covariance);
    const auto p = index(scan.used().size());
    Vector change = Vector::Zero(fit.design.fixed.cols());
    fit.covariance = Matrix::Constant(change.size(), change.size(), nan);
    double largest = 0;
    for (Index i = 0; i < p; ++i) {
      const Index column = scan.used()[index(i)];
      change[column] = x[i];
      const double u = std::sqrt(std::max(0.0, fit.variance * covariance(i, i)));
      if (u > 0) largest = std::max(largest, std::fabs(x[i]) / u);
      for (Index j = 0; j < p; ++j) fit.covariance(column, scan.used()[index(j)]) = fit.variance * covariance(i, j);
    }
    Vector drawn = Vector::Zero(fit.drawn.size());
    for (std::size_t j = 0; j < fit.draw_of.size() && draws_move; ++j) {
      const std::size_t v = fit.draw_of[j];
      if (!draws_[v].fitted) continue;
      const Index i = p + index(j);
      drawn[index(v)] = x[i] - fit.drawn[index(v)];
      largest = std::max(largest, std::fabs(drawn[index(v)]) / std::sqrt(fit.variance * covariance(i, i)));
    }
    fit.converged = largest < criteria.converged;
    // The noise's scale once the fit stands, as far as the readings know it.
    const auto rescaled = [&] {
      if (noise > 0) return false;
      const auto freedom = static_cast<double>(scan.degrees_of_freedom());
      const double prior = noise_declared_ ? criteria.noise_prior : 0;
      double factor = (freedom * fit.variance + prior / (fit.noise * fit.noise)) / (freedom + prior);
      // Far from it, the squares are those of fitted draws: of these the noise takes nothing.
      if (!noise_declared_ && factor < criteria.noise_far) {
        double squares = objective(fit, fit.covariance_model, scan), left = freedom;
        for (std::size_t j = 0; j < fit.draw_of.size(); ++j) {
          const std::size_t v = fit.draw_of[j];
          if (!draws_[v].fitted) continue;
          squares -= fit.drawn[index(v)] * fit.drawn[index(v)];
          left -= 1 - covariance(p + index(j), p + index(j));
        }
        if (squares > 0 && left >= 1) factor = std::min(factor, std::max(squares / left, w.least_variance()));
      }
      if (std::fabs(std::log(factor)) < criteria.noise_settled || ++scales > criteria.most_scales) return false;
      fit.noise *= std::sqrt(factor);
      fit.converged = false;
      fit.iterations = 0;
      return linearise(fit);
    };
    if (fit.converged || fit.iterations == criteria.most_iterations) {
      if (rescaled()) continue;
      break;
    }
    const double before = objective(fit, fit.covariance_model, scan);
    bool better = false;
    const auto improve = [&](const Vector& by, const Vector& draws) {
      for (double share = 1; share > 0.05 && !better; share /= 2) {
        JointFit next = fit;
        apply(next, by, share);
        move_draws(next, share * draws);
        if (!linearise(next)) continue;
        better = objective(next, next.covariance_model, scan) <= before * (1 + 1e-9);
        if (better) fit = std::move(next);
      }
    };
    improve(change, drawn);
    const std::vector<Index> held = jumping_unknowns();
    if (!better && !held.empty()) { // their tangents lead nowhere, nor does a step of others that goes with them
      change = without_moving(held, fit, rows_);
      largest = 0;
      for (Index j = 0; j < change.size(); ++j)
        if (const double u = std::sqrt(fit.covariance(j, j)); u > 0)
          largest = std::max(largest, std::fabs(change[j]) / u);
      if (largest > criteria.stalled) improve(change, Vector::Zero(drawn.size()));
    }
    if (better) {
      draws_move = true; // from elsewhere it may lead somewhere: the fit ends where neither step does
    } else if (drawn.norm() > 0) {
      draws_move = false;
      --fit.iterations; // the same point is tried without
    } else {            // at the floor of what steps can do
      if (rescaled()) continue;
      fit.converged = largest < criteria.stalled;
      break;
    }
  }
}

Fitter::Settled Fitter::settled_columns(const JointFit& fit) const {
  Settled out;
  const Matrix& fixed = fit.design.fixed;
  out.columns = insensitive(fit.design, rows_);
  std::erase_if(out.columns, [&](Index j) { return j >= index(unknowns_.size()); });
  for (Index r = 0; r < fixed.rows(); ++r)
    if (std::ranges::any_of(out.columns, [&](Index j) { return fixed(r, j) != 0; })) out.rows.push_back(r);
  return out;
}

void Fitter::settle(JointFit& fit) const {
  const auto [open, rows] = settled_columns(fit);
  std::vector<Index> known;
  for (Index j = 0; j < fit.design.fixed.cols(); ++j)
    if (std::isfinite(fit.covariance(j, j))) known.push_back(j);
  if (rows.empty()) return;
  for (int iteration = 0; iteration < criteria.most_offset_iterations; ++iteration) {
    Design own = fit.design;
    own.fixed = Matrix(fit.design.fixed(Eigen::all, open));
    const auto use = independent(own, rows);
    const auto m = index(use.size());
    const Whitened plain(own, rows, use, {});
    const Whitened w(own, rows, use, fit.covariance_model);
    Matrix covariance;
    const Vector x = w.coefficients(plain.winsorised(plain.take(fit.residual)), &covariance);
    const Matrix own_covariance = fit.variance * covariance.topLeftCorner(m, m);
    Vector change = Vector::Zero(fit.design.fixed.cols());
    double largest = 0;
    for (Index i = 0; i < m; ++i) {
      change[open[index(use[index(i)])]] = x[i];
      largest = std::max(largest, std::fabs(x[i]) / std::sqrt(own_covariance(i, i)));
    }
    if (largest < criteria.converged) {
      // They follow what was fitted: x = ... - S (known - estimate).
      const Matrix s = w.coefficients(w.take(fit.design.fixed(Eigen::all, known))).topRows(m);
      const Matrix v = fit.covariance(known, known), cross = -s * v, total = own_covariance + s * v * s.transpose();
      for (Index i = 0; i < m; ++i) {
        const Index a = open[index(use[index(i)])];
        for (Index j = 0; j < m; ++j) fit.covariance(a, open[index(use[index(j)])]) = total(i, j);
        for (std::size_t j = 0; j < known.size(); ++j)
          fit.covariance(a, known[j]) = fit.covariance(known[j], a) = cross(i, index(j));
      }
      return;
    }
    JointFit next = fit;
    apply(next, change, 1);
    if (!linearise(next)) return;
    fit = std::move(next);
  }
}

} // namespace gumshoe::tracing
