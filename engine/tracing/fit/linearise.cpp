/// The model linearised at a fit's point: what the fit absorbs, what is declared, the readings' own noise.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include "quantities/cells.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

void Fitter::find_responses() {
  responses_.assign(needed_.size(), {});
  offset_ = Vector::Zero(static_cast<Index>(simulator_.rows()));
  for (std::size_t i = 0; i < needed_.size(); ++i) {
    if (!experiment_.layout().effects.contains(needed_[i])) continue;
    double u = 0;
    // A table holds where each draw is by itself all that moves its readings by the quantity.
    bool alone = true;
    std::vector<int> moved(observations_.readings, 0);
    for (std::size_t v = 0; v < draws_.size(); ++v) {
      const Draw& d = draws_[v];
      if (d.moves.empty() || d.moves.front().second != needed_[i]) continue;
      alone = alone && !d.local && (u == 0 || d.u == u);
      for (const auto& group : experiment_.plan().copulas)
        alone = alone && std::find(group.variates.begin(), group.variates.end(), v) == group.variates.end();
      for (const auto& [r, q] : d.moves) alone = alone && ++moved[r] == 1;
      u = std::max(u, d.u);
    }
    if (!(u > 0)) continue;
    responses_[i] = declared_response(simulator_, simulator_.estimates(), needed_[i], u, alone);
    if (!responses_[i].straight()) offset_ += responses_[i].offset;
  }
}

/// Noise of each reading by itself: its own draws.
void Fitter::local_noise(const Matrix& derivative, JointFit& fit) const {
  const auto& e = experiment_;
  const auto& o = observations_;
  const auto k = static_cast<Index>(o.indications);
  const propagation::Range noise = e.layout().indications;
  std::vector<Matrix> covariance(o.readings, Matrix::Zero(k, k));
  const auto effect_of = [&](std::size_t reading, std::size_t quantity) {
    Vector g = Vector::Zero(k);
    if (noise.contains(quantity)) {
      g[static_cast<Index>(quantity - noise.begin)] = 1;
      return g;
    }
    const auto at = std::lower_bound(needed_.begin(), needed_.end(), quantity) - needed_.begin();
    g = derivative.col(at).segment(static_cast<Index>(reading) * k, k);
    return g;
  };
  for (const Draw& d : draws_) {
    if (!d.local || d.moves.empty()) continue;
    Vector g = Vector::Zero(k);
    for (const auto& [r, q] : d.moves) g += effect_of(r, q) * d.u;
    covariance[d.moves.front().first] += g * g.transpose();
  }
  Vector mean = Vector::Zero(k);
  auto without = covariance;
  for (const std::size_t r : o.sequence) {
    if (!noise_declared_) covariance[r] = Matrix::Identity(k, k) / e.scenario().readings[r].repeats;
    const double unit = noise_declared_ ? 1 : fit.noise * fit.noise;
    without[r] = covariance[r];
    for (const DeclaredResponse& response : responses_) {
      if (response.straight()) continue;
      const Vector bends = response.variance.segment(static_cast<Index>(r) * k, k) / unit;
      covariance[r].diagonal() += bends;
      if (response.table.size() == 0) without[r].diagonal() += bends;
    }
    mean += covariance[r].diagonal() / static_cast<double>(o.readings);
  }
  fit.design.reference.assign(static_cast<std::size_t>(k), 0);
  for (Index i = 0; i < k; ++i) fit.design.reference[static_cast<std::size_t>(i)] = fit.noise * std::sqrt(mean[i]);
  // An indication that declares nothing of its own here: a small share keeps it from being exact.
  const auto factors = [&](std::vector<Matrix>& of) {
    std::vector<Matrix> out;
    for (const std::size_t r : o.sequence) {
      for (Index i = 0; i < k; ++i) of[r](i, i) += 1e-8 * mean[i] + 1e-30;
      out.push_back(fit.noise * Matrix(of[r].llt().matrixL()));
    }
    return out;
  };
  fit.design.local = factors(covariance);
  fit.design.straight.clear();
  if (std::any_of(responses_.begin(), responses_.end(), [](const auto& r) { return r.table.size() > 0; }))
    fit.design.straight = factors(without);
}

bool Fitter::linearise(JointFit& fit) const {
  const auto& o = observations_;
  const auto& plan = experiment_.plan();
  const auto k = static_cast<Index>(o.indications), n = static_cast<Index>(o.readings) * k;
  // Each once: a quantity that is declared and found to be off is asked for twice.
  auto wanted = needed_;
  const auto column_of = [&](std::size_t quantity) {
    const auto known = std::find(wanted.begin(), wanted.end(), quantity);
    if (known == wanted.end()) wanted.push_back(quantity);
    return static_cast<Index>(std::find(wanted.begin(), wanted.end(), quantity) - wanted.begin());
  };
  for (const Term& t : fit.terms)
    for (const Amplitude& a : t.alternative.amplitudes)
      if (a.quantity != Amplitude::npos) column_of(a.quantity);
  Vector f;
  Matrix derivative;
  if (!simulator_.derivatives(fit.at, wanted, f, derivative, &fit.kink)) return false;
  // Of declared draws: over the steps that they take.
  Matrix drawn = derivative;
  for (std::size_t i = 0; i < responses_.size(); ++i)
    if (responses_[i].slope.size() > 0) drawn.col(static_cast<Index>(i)) = responses_[i].slope;
  Vector measured(n);
  for (Index i = 0; i < n; ++i) measured[i] = o.measured[static_cast<std::size_t>(i)];
  fit.residual = in_sequence(o, measured - f - offset_);
  Design& d = fit.design;
  d.indications = o.indications;
  d.reading.clear();
  for (const std::size_t r : o.sequence)
    for (Index i = 0; i < k; ++i) d.reading.push_back(r);
  d.scatter = o.redone;
  const auto at = [&](std::size_t q) {
    return static_cast<Index>(std::lower_bound(needed_.begin(), needed_.end(), q) - needed_.begin());
  };
  // Free unknowns, then terms.
  Matrix fixed = Matrix::Zero(n, static_cast<Index>(unknowns_.size()));
  d.fixed_names.clear();
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    for (std::size_t r = 0; r < o.readings; ++r)
      if (unknowns_[u].holds[r])
        fixed.col(static_cast<Index>(u)).segment(static_cast<Index>(r) * k, k) =
            derivative.col(at(unknowns_[u].quantity)).segment(static_cast<Index>(r) * k, k);
    d.fixed_names.push_back(unknowns_[u].name);
  }
  d.fixed = in_sequence(o, fixed);
  for (Term& t : fit.terms) {
    for (std::size_t j = 0; j < t.alternative.amplitudes.size(); ++j) {
      const Amplitude& a = t.alternative.amplitudes[j];
      Vector signature = t.alternative.columns.col(static_cast<Index>(j));
      if (a.quantity != Amplitude::npos) {
        Matrix moved = derivative.col(column_of(a.quantity));
        for (std::size_t r = 0; r < o.readings; ++r)
          if (!quantities::holds_for(a.labels, experiment_.scenario().readings[r].labels))
            moved.col(0).segment(static_cast<Index>(r) * k, k).setZero();
        signature = in_sequence(o, moved);
      } else {
        fit.residual -= signature * t.size[static_cast<Index>(j)];
      }
      d.fixed.conservativeResize(Eigen::NoChange, d.fixed.cols() + 1);
      d.fixed.rightCols(1) = signature;
      d.fixed_names.push_back(t.alternative.name);
      t.alternative.columns.col(static_cast<Index>(j)) = signature;
    }
  }
  local_noise(drawn, fit);
  // Draws shared by readings, tied ones through the factor of their copula's matrix.
  Matrix shared = Matrix::Zero(n, static_cast<Index>(draws_.size()));
  std::vector<bool> used(draws_.size(), false);
  const propagation::Range noise = experiment_.layout().indications;
  // What is declared of a quantity that is found to be off binds it no more.
  const auto released = [&](const Draw& draw) {
    return std::any_of(fit.terms.begin(), fit.terms.end(), [&](const Term& t) {
      if (t.alternative.family != Family::declared) return false;
      const Amplitude& a = t.alternative.amplitudes[0];
      return std::all_of(draw.moves.begin(), draw.moves.end(), [&](const auto& m) {
        return m.second == a.quantity &&
               quantities::holds_for(a.labels, experiment_.scenario().readings[m.first].labels);
      });
    });
  };
  for (std::size_t v = 0; v < draws_.size(); ++v) {
    if (draws_[v].local || released(draws_[v])) continue;
    for (const auto& [r, q] : draws_[v].moves) {
      const auto rows = Eigen::seqN(static_cast<Index>(r) * k, k);
      if (noise.contains(q))
        shared(static_cast<Index>(r) * k + static_cast<Index>(q - noise.begin), static_cast<Index>(v)) += draws_[v].u;
      else
        shared(rows, static_cast<Index>(v)) += drawn(rows, at(q)) * draws_[v].u;
    }
    used[v] = true;
  }
  for (const auto& group : plan.copulas) {
    const std::size_t m = group.variates.size();
    Matrix old(n, static_cast<Index>(m));
    for (std::size_t i = 0; i < m; ++i)
      old.col(static_cast<Index>(i)) = shared.col(static_cast<Index>(group.variates[i]));
    for (std::size_t j = 0; j < m; ++j) {
      Vector sum = Vector::Zero(n);
      for (std::size_t i = j; i < m; ++i) sum += old.col(static_cast<Index>(i)) * group.cholesky[i * m + j];
      shared.col(static_cast<Index>(group.variates[j])) = sum;
    }
  }
  d.random.resize(n, 0);
  d.random_names.clear();
  d.bent.clear();
  d.bends.clear();
  std::vector<int> table_of(responses_.size(), -1);
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    if (responses_[i].table.size() == 0) continue;
    table_of[i] = static_cast<int>(d.bends.size());
    d.bends.push_back(in_sequence(o, responses_[i].table));
  }
  // By name: draws are numbered as rows of the file ask for them.
  std::vector<std::size_t> by_name(draws_.size());
  std::iota(by_name.begin(), by_name.end(), 0);
  std::stable_sort(by_name.begin(), by_name.end(),
                   [&](std::size_t a, std::size_t b) { return draws_[a].name < draws_[b].name; });
  for (const std::size_t v : by_name) {
    const Vector one = in_sequence(o, shared.col(static_cast<Index>(v)));
    if (!used[v] || !(one.norm() > 1e-6 * d.reference[0])) continue;
    d.random.conservativeResize(n, d.random.cols() + 1);
    d.random.rightCols(1) = one;
    d.random_names.push_back(draws_[v].name);
    const std::size_t moved = draws_[v].moves.front().second;
    const bool may_bend = std::binary_search(needed_.begin(), needed_.end(), moved);
    d.bent.push_back(may_bend ? table_of[static_cast<std::size_t>(at(moved))] : -1);
  }
  return fit.residual.allFinite() && d.fixed.allFinite() && d.random.allFinite();
}

} // namespace gumshoe::tracing
