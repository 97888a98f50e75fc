#include "tracing/fit/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "quantities/cells.h"

namespace gumshoe::tracing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// A smooth model takes three or four; one that jumps from tooth to tooth gains nothing by more.
constexpr int most_iterations = 14;
/// Optima that are left for a better one, where readings jump.
constexpr int most_optima = 4;

} // namespace

Index first_column(const JointFit& fit, std::size_t term) {
  Index at = fit.design.fixed.cols();
  for (std::size_t t = fit.terms.size(); t-- > term;) at -= fit.terms[t].size.size();
  return at;
}

Fitter::Fitter(const propagation::Experiment& e, const Simulator& simulator, const Observations& o,
               std::vector<Index> rows, int threads)
    : experiment_(e), simulator_(simulator), observations_(o), rows_(std::move(rows)), threads_(threads) {
  const auto& s = e.scenario();
  const auto& plan = e.plan();
  std::set<std::size_t> needed;
  for (std::size_t q = 0; q < s.quantities.size(); ++q) {
    if (!s.quantities[q].estimated) continue;
    for (std::size_t i = 0; i < s.quantities[q].entries.size(); ++i) {
      const auto& entry = s.quantities[q].entries[i];
      if (!entry.components.empty()) continue; // has a prior: a declared draw
      FreeUnknown u;
      u.quantity = q;
      u.entry = i;
      u.name = s.quantities[q].name + (entry.labels.empty() ? "" : "[" + quantities::text_of(entry.labels) + "]");
      for (const auto& reading : s.readings) u.holds.push_back(quantities::holds_for(entry.labels, reading.labels));
      if (std::find(u.holds.begin(), u.holds.end(), true) == u.holds.end()) continue;
      unknowns_.push_back(std::move(u));
      needed.insert(q);
    }
  }
  for (const auto& v : plan.variates) {
    const double variance = v.distribution.variance();
    draws_.push_back(
        {v.name, std::isfinite(variance) ? std::sqrt(variance) : std::fabs(v.distribution.parameters[1]), {}, false});
  }
  for (std::size_t r = 0; r < s.readings.size(); ++r)
    for (std::size_t q = 0; q < plan.gather[r].size(); ++q)
      for (const std::size_t v : plan.columns[plan.gather[r][q]].variates) {
        draws_[v].moves.push_back({r, q});
        if (e.layout().indications.contains(q))
          noise_declared_ = true;
        else
          needed.insert(q);
      }
  for (Draw& d : draws_)
    d.local =
        std::all_of(d.moves.begin(), d.moves.end(), [&](const auto& m) { return m.first == d.moves.front().first; });
  needed_.assign(needed.begin(), needed.end());
  find_responses();
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
    for (std::size_t i = 0; i < t.alternative.amplitudes.size(); ++i) {
      const Amplitude& a = t.alternative.amplitudes[i];
      double& size = t.size[static_cast<Index>(i)];
      const double before = size;
      size = std::clamp(size + share * change[j++], a.low, a.high);
      if (a.quantity == Amplitude::npos) continue;
      for (std::size_t r = 0; r < observations_.readings; ++r)
        if (quantities::holds_for(a.labels, experiment_.scenario().readings[r].labels))
          fit.at[r][a.quantity] += size - before;
    }
}

/// Of the residuals as the step saw them, drawn in: an outlier must not hold the fit back.
double Fitter::objective(const JointFit& fit, const Whitened& prior, const Scan& scan) const {
  return prior.left(prior.whiten(scan.winsorised(prior.take(fit.residual))))[0];
}

JointFit Fitter::linearised(double noise) const {
  JointFit fit;
  fit.at = simulator_.estimates();
  fit.noise = noise;
  fit.valid = linearise(fit);
  return fit;
}

JointFit Fitter::fit(const std::vector<Term>& terms, double noise, const JointFit* start) const {
  JointFit fit;
  fit.at = start ? start->at : simulator_.estimates();
  if (start) { // its terms' sizes are in its point
    JointFit bare = *start;
    Vector back = Vector::Zero(static_cast<Index>(unknowns_.size()));
    for (const Term& t : start->terms) {
      back.conservativeResize(back.size() + t.size.size());
      back.tail(t.size.size()) = -t.size;
    }
    for (Term& t : bare.terms)
      for (Amplitude& a : t.alternative.amplitudes) a.low = -1e300, a.high = 1e300;
    apply(bare, back, 1);
    fit.at = bare.at;
  }
  fit.terms = terms;
  fit.noise = noise > 0 ? noise : start ? start->noise : 1;
  for (const Term& t : terms)
    for (const auto& [q, value] : t.alternative.held)
      for (auto& p : fit.at) p[q] = value;
  Vector sizes = Vector::Zero(static_cast<Index>(unknowns_.size()));
  for (Term& t : fit.terms) {
    sizes.conservativeResize(sizes.size() + t.size.size());
    sizes.tail(t.size.size()) = t.size;
    t.size.setZero();
  }
  apply(fit, sizes, 1);
  fit.valid = fit.converged = linearise(fit);
  if (!fit.valid) return fit;
  if (!noise_declared_ && noise == 0 && !start) {
    // No scale at all yet: that of the plain residuals about the free unknowns.
    const Scan scan(fit.design, rows_, {}, threads_);
    fit.noise *= scan.run(scan.whitened(scan.plain()).take(fit.residual)).scale[0];
    linearise(fit);
  }
  converge(fit, noise);
  for (int lesser = 0; lesser < most_optima && explore(fit); ++lesser) converge(fit, noise);
  return fit;
}

void Fitter::converge(JointFit& fit, double noise) const {
  fit.converged = false;
  for (fit.iterations = 1; fit.iterations <= most_iterations; ++fit.iterations) {
    const Scan scan(fit.design, rows_, {}, threads_);
    const Whitened& plain = scan.whitened(scan.plain());
    const Matrix chosen = plain.take(fit.residual);
    const Statistics now = scan.run(chosen);
    fit.structure = scan.all_structures()[now.cautious[0]];
    fit.variance = now.variance_cautious[0];
    const Whitened& w = scan.whitened(now.cautious[0]);
    fit.criterion = static_cast<double>(scan.degrees_of_freedom()) * std::log(fit.variance) + w.log_determinant();
    const Vector white = w.whiten(scan.winsorised(chosen));
    Matrix covariance;
    const Vector x = w.solve(Matrix(white.size(), 0), white, &covariance);
    const auto p = static_cast<Index>(scan.used().size());
    Vector change = Vector::Zero(fit.design.fixed.cols());
    fit.covariance = Matrix::Constant(change.size(), change.size(), nan);
    double largest = 0;
    for (Index i = 0; i < p; ++i) {
      const Index column = scan.used()[static_cast<std::size_t>(i)];
      change[column] = x[i];
      const double u = std::sqrt(std::max(0.0, fit.variance * covariance(i, i)));
      if (u > 0) largest = std::max(largest, std::fabs(x[i]) / u);
      for (Index j = 0; j < p; ++j)
        fit.covariance(column, scan.used()[static_cast<std::size_t>(j)]) = fit.variance * covariance(i, j);
    }
    fit.converged = largest < 1e-3;
    // The noise's scale once the fit stands, as far as the readings know it.
    if (fit.converged || fit.iterations == most_iterations) {
      if (noise > 0) break;
      const auto freedom = static_cast<double>(scan.degrees_of_freedom());
      const double prior = noise_declared_ ? 4 : 0,
                   factor = (freedom * fit.variance + prior / (fit.noise * fit.noise)) / (freedom + prior);
      if (std::fabs(std::log(factor)) < 0.02 || fit.iterations > most_iterations - 4) break;
      fit.noise *= std::sqrt(factor);
      fit.converged = false;
      linearise(fit);
      continue;
    }
    const Whitened prior(fit.design, rows_, {}, fit.structure);
    const double before = objective(fit, prior, scan);
    bool better = false;
    for (double share = 1; share > 0.05 && !better; share /= 2) {
      JointFit next = fit;
      apply(next, change, share);
      if (!linearise(next)) continue;
      better = objective(next, prior, scan) <= before * (1 + 1e-9);
      if (better) fit = std::move(next);
    }
    if (!better) { // at the floor of what steps can do
      fit.converged = largest < 0.1;
      if (noise > 0 || !fit.converged) break;
      noise = fit.noise;
      break;
    }
  }
}

void Fitter::settle(JointFit& fit) const {
  const Index n = fit.design.fixed.rows();
  std::vector<Index> open, known, rows;
  for (Index j = 0; j < fit.design.fixed.cols(); ++j) {
    const bool felt = std::any_of(rows_.begin(), rows_.end(), [&](Index r) { return fit.design.fixed(r, j) != 0; });
    if (std::isfinite(fit.covariance(j, j)))
      known.push_back(j);
    else if (!felt && j < static_cast<Index>(unknowns_.size()))
      open.push_back(j);
  }
  for (Index r = 0; r < n; ++r)
    if (std::any_of(open.begin(), open.end(), [&](Index j) { return fit.design.fixed(r, j) != 0; })) rows.push_back(r);
  if (rows.empty()) return;
  for (int iteration = 0; iteration < 20; ++iteration) {
    Design own = fit.design;
    own.fixed = Matrix(fit.design.fixed(Eigen::all, open));
    const auto use = independent(own, rows);
    const auto m = static_cast<Index>(use.size());
    const Whitened plain(own, rows, use, {});
    const Whitened w(own, rows, use, fit.structure);
    const Vector white = w.whiten(plain.winsorised(plain.take(fit.residual)));
    const Matrix nothing(white.size(), 0);
    Matrix covariance;
    const Vector x = w.solve(nothing, white, &covariance);
    const Matrix own_covariance = fit.variance * covariance.topLeftCorner(m, m);
    Vector change = Vector::Zero(fit.design.fixed.cols());
    double largest = 0;
    for (Index i = 0; i < m; ++i) {
      change[open[static_cast<std::size_t>(use[static_cast<std::size_t>(i)])]] = x[i];
      largest = std::max(largest, std::fabs(x[i]) / std::sqrt(own_covariance(i, i)));
    }
    if (largest < 1e-3) {
      // They follow what was fitted: x = ... - S (known - estimate).
      const Matrix s = w.solve_all(nothing, w.whiten(w.take(fit.design.fixed(Eigen::all, known)))).topRows(m);
      const Matrix v = fit.covariance(known, known), cross = -s * v, total = own_covariance + s * v * s.transpose();
      for (Index i = 0; i < m; ++i) {
        const Index a = open[static_cast<std::size_t>(use[static_cast<std::size_t>(i)])];
        for (Index j = 0; j < m; ++j)
          fit.covariance(a, open[static_cast<std::size_t>(use[static_cast<std::size_t>(j)])]) = total(i, j);
        for (std::size_t j = 0; j < known.size(); ++j)
          fit.covariance(a, known[j]) = fit.covariance(known[j], a) = cross(i, static_cast<Index>(j));
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
