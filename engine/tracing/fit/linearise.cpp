/// The model linearised at a fit's point: what the fit estimates, what is declared, the readings' own noise.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include "quantities/cells.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

bool Fitter::linearise(JointFit& fit) const {
  const auto& o = observations_;
  // Each once: a quantity that is declared and found to be off is asked for twice.
  auto wanted = needed_;
  for (const Term& t : fit.terms)
    for (const Amplitude& a : t.candidate.amplitudes)
      if (a.quantity != Amplitude::npos && std::ranges::find(wanted, a.quantity) == wanted.end())
        wanted.push_back(a.quantity);
  Vector f;
  Matrix derivative;
  if (!simulator_.derivatives(fit.at, wanted, f, derivative, &fit.kink)) return false;
  fit.residual = in_sequence(o, Eigen::Map<const Vector>(o.measured.data(), f.size()) - f - offset_);
  Design& d = fit.design;
  d.indications = o.indications;
  d.scatter = groups_scatter_ ? o.replicate_groups : std::vector<Grouping>{};
  d.step = o.step;
  d.coarse = coarse_;
  d.covariance_models = covariance_models_;
  d.order_known = observations_.order_known;
  d.reading.clear();
  d.readouts.clear();
  for (const std::size_t r : o.sequence) {
    d.reading.insert(d.reading.end(), o.indications, r);
    d.readouts.push_back(o.readouts[r]);
  }
  set_fixed(derivative, wanted, fit);
  // Declared draws: over the steps that they take.
  for (std::size_t i = 0; i < responses_.size(); ++i)
    if (responses_[i].slope.size() > 0) derivative.col(index(i)) = responses_[i].slope;
  set_local_noise(derivative, fit);
  set_declared(derivative, fit);
  fit.residual += drawn_part(fit);
  return fit.residual.allFinite() && d.fixed.allFinite() && d.random.allFinite();
}

/// Free unknowns, then terms.
void Fitter::set_fixed(const Matrix& derivative, const std::vector<std::size_t>& wanted, JointFit& fit) const {
  const auto& o = observations_;
  const auto k = index(o.indications);
  Design& d = fit.design;
  Matrix fixed = Matrix::Zero(derivative.rows(), index(unknowns_.size()));
  d.fixed_names.clear();
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    for (std::size_t r = 0; r < o.readings; ++r)
      if (unknowns_[u].holds[r])
        fixed.col(index(u)).segment(index(r) * k, k) =
            derivative.col(needed(unknowns_[u].quantity)).segment(index(r) * k, k);
    d.fixed_names.push_back(unknowns_[u].name);
  }
  Index sizes = 0, next = fixed.cols();
  for (const Term& t : fit.terms) sizes += t.size.size();
  fixed.conservativeResize(Eigen::NoChange, next + sizes);
  fixed.rightCols(sizes).setZero();
  d.fixed = in_sequence(o, fixed);
  for (Term& t : fit.terms)
    for (Index j = 0; j < t.size.size(); ++j) {
      const Amplitude& a = t.candidate.amplitudes[index(j)];
      if (a.quantity != Amplitude::npos) {
        Matrix moved = derivative.col(std::ranges::find(wanted, a.quantity) - wanted.begin());
        for (std::size_t r = 0; r < o.readings; ++r)
          if (!quantities::holds_for(a.labels, experiment_.scenario().readings[r].labels))
            moved.col(0).segment(index(r) * k, k).setZero();
        t.candidate.columns.col(j) = in_sequence(o, moved);
      } else {
        fit.residual -= t.candidate.columns.col(j) * t.size[j];
      }
      d.fixed.col(next++) = t.candidate.columns.col(j);
      d.fixed_names.push_back(t.candidate.name);
    }
}

/// Noise of each reading by itself: its own draws.
void Fitter::set_local_noise(const Matrix& derivative, JointFit& fit) const {
  const auto& o = observations_;
  const auto k = index(o.indications);
  const propagation::Range noise = experiment_.layout().indications;
  std::vector<Matrix> covariance(o.readings, Matrix::Zero(k, k));
  for (const Draw& d : draws_) {
    if (!d.local || d.moves.empty()) continue;
    Vector g = Vector::Zero(k);
    for (const auto& [r, q] : d.moves)
      g += (noise.contains(q) ? Vector(Vector::Unit(k, index(q - noise.begin)))
                              : Vector(derivative.col(needed(q)).segment(index(r) * k, k))) *
           d.u;
    covariance[d.moves.front().first] += g * g.transpose();
  }
  Vector mean = Vector::Zero(k);
  auto without = covariance;
  for (const std::size_t r : o.sequence) {
    if (!noise_declared_)
      covariance[r] = spread_.cwiseAbs2().cwiseProduct(relative_variance(r)).asDiagonal().toDenseMatrix() /
                      experiment_.scenario().readings[r].repeats;
    const double unit = noise_declared_ ? 1 : fit.noise * fit.noise;
    without[r] = covariance[r];
    for (const DeclaredResponse& response : responses_) {
      if (response.straight()) continue;
      const Vector bends = response.variance.segment(index(r) * k, k) / unit;
      covariance[r].diagonal() += bends;
      if (response.table.size() == 0) without[r].diagonal() += bends;
    }
    mean += covariance[r].diagonal() / static_cast<double>(o.readings);
  }
  fit.design.reference.assign(index(k), 0);
  for (Index i = 0; i < k; ++i) fit.design.reference[index(i)] = fit.noise * std::sqrt(mean[i]);
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
  if (std::ranges::any_of(responses_, [](const auto& r) { return r.table.size() > 0; }))
    fit.design.straight = factors(without);
}

bool Fitter::released(const Draw& draw, const JointFit& fit) const {
  return std::ranges::any_of(fit.terms, [&](const Term& t) {
    const Amplitude& a = t.candidate.amplitudes[0];
    const auto moved = [&](const auto& r) { return quantities::holds_for(a.labels, r.labels); };
    const auto& readings = experiment_.scenario().readings;
    // The draw of just these readings: those of single labels within them stay as declared.
    return t.candidate.family == Family::declared &&
           draw.moves.size() == index(std::ranges::count_if(readings, moved)) &&
           std::ranges::all_of(draw.moves,
                               [&](const auto& m) { return m.second == a.quantity && moved(readings[m.first]); });
  });
}

/// Draws shared by readings, tied ones through the factor of their copula's matrix.
void Fitter::set_declared(const Matrix& derivative, JointFit& fit) const {
  const auto& o = observations_;
  const auto k = index(o.indications), n = derivative.rows();
  const propagation::Range noise = experiment_.layout().indications;
  Design& d = fit.design;
  Matrix shared = Matrix::Zero(n, index(draws_.size()));
  std::vector<std::size_t> used;
  for (std::size_t v = 0; v < draws_.size(); ++v) {
    if (draws_[v].local || released(draws_[v], fit)) continue;
    for (const auto& [r, q] : draws_[v].moves) {
      const auto rows = Eigen::seqN(index(r) * k, k);
      if (noise.contains(q))
        shared(index(r) * k + index(q - noise.begin), index(v)) += draws_[v].u;
      else
        shared(rows, index(v)) += derivative(rows, needed(q)) * draws_[v].u;
    }
    used.push_back(v);
  }
  for (const auto& group : experiment_.plan().copulas) {
    const std::size_t m = group.variates.size();
    Matrix old(n, index(m));
    for (std::size_t i = 0; i < m; ++i) old.col(index(i)) = shared.col(index(group.variates[i]));
    for (std::size_t j = 0; j < m; ++j) {
      Vector sum = Vector::Zero(n);
      for (std::size_t i = j; i < m; ++i) sum += old.col(index(i)) * group.cholesky[i * m + j];
      shared.col(index(group.variates[j])) = sum;
    }
  }
  d.random.resize(n, index(used.size()));
  d.random_names.clear();
  fit.draw_of.clear();
  d.bent.clear();
  d.bends.clear();
  std::vector<int> table_of(responses_.size(), -1);
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    if (responses_[i].table.size() == 0) continue;
    table_of[i] = static_cast<int>(d.bends.size());
    d.bends.push_back(in_sequence(o, responses_[i].table));
  }
  Index kept = 0;
  // By name: the numbers of draws depend on the order of rows in the file.
  std::ranges::stable_sort(used, [&](std::size_t a, std::size_t b) { return draws_[a].name < draws_[b].name; });
  for (const std::size_t v : used) {
    const Vector one = in_sequence(o, shared.col(index(v)));
    if (!(one.norm() > 1e-6 * d.reference[0]) && fit.drawn[index(v)] == 0) continue;
    d.random.col(kept++) = one;
    d.random_names.push_back(draws_[v].name);
    fit.draw_of.push_back(v);
    const std::size_t moved = draws_[v].moves.front().second;
    const bool may_bend = std::binary_search(needed_.begin(), needed_.end(), moved);
    d.bent.push_back(may_bend ? table_of[index(needed(moved))] : -1);
  }
  d.random.conservativeResize(Eigen::NoChange, kept);
}

Vector Fitter::drawn_part(const JointFit& fit) const {
  Vector out = Vector::Zero(fit.design.random.rows());
  for (std::size_t j = 0; j < fit.draw_of.size(); ++j)
    out += fit.design.random.col(index(j)) * fit.drawn[index(fit.draw_of[j])];
  return out;
}

} // namespace gumshoe::tracing
