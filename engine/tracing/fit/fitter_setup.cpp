/// What a fit needs to know of the scenario: its free unknowns, its declared draws, and how readings respond to those.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "effects/effect.h"
#include "quantities/cells.h"
#include "quantities/effect_of.h"
#include "tracing/criteria.h"
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

Fitter::Fitter(const propagation::Experiment& experiment, const Simulator& simulator, const Observations& observations,
               std::vector<Index> rows, int threads)
    : experiment_(experiment), simulator_(simulator), observations_(observations), rows_(std::move(rows)),
      replicates_(find_replicates(observations)), threads_(threads) {
  find_unknowns();
  find_draws();
  earlier_ = Vector::Zero(index(draws_.size()));
  find_fitted();
  std::set<std::size_t> needed;
  for (const FreeUnknown& u : unknowns_) needed.insert(u.quantity);
  for (const Draw& d : draws_)
    for (const auto& [r, q] : d.moves)
      if (!experiment.layout().indications.contains(q)) needed.insert(q);
  noise_declared_ = declares_noise();
  if (noise_declared_) need_independent_noise();
  needed_.assign(needed.begin(), needed.end());
  spread_ = Vector::Ones(index(observations.indications));
  find_responses();
  find_spread();
  find_coarse();
  find_growth();
  find_covariance_models();
}

Index Fitter::needed(std::size_t quantity) const {
  return std::ranges::lower_bound(needed_, quantity) - needed_.begin();
}

namespace {

/// Whether this is the name of an effect's quantity that is no shape.
bool is_size(const std::string& name) {
  const EffectCard* effect = effects::find(quantities::effect_of(name));
  return effect && std::ranges::any_of(effect->quantities, [&](const QuantityCard& q) {
           return q.name == name.substr(effect->name.size() + 1) && q.role != Role::shape;
         });
}

} // namespace

void Fitter::find_unknowns() {
  const auto& s = experiment_.scenario();
  const auto jump = [&](const std::string& name) {
    const auto found = std::ranges::find(s.trace.jumping, name, &std::pair<std::string, double>::first);
    return found == s.trace.jumping.end() ? 0 : found->second;
  };
  for (std::size_t q = 0; q < s.quantities.size(); ++q) {
    if (!s.quantities[q].estimated) continue;
    for (std::size_t i = 0; i < s.quantities[q].entries.size(); ++i) {
      const auto& entry = s.quantities[q].entries[i];
      if (!entry.components.empty()) continue; // has a prior: a declared draw
      FreeUnknown u{s.quantities[q].name + (entry.labels.empty() ? "" : "[" + quantities::text_of(entry.labels) + "]"),
                    q,
                    i,
                    {},
                    is_size(s.quantities[q].name),
                    entry.labels.empty() ? jump(s.quantities[q].name) : 0};
      for (const auto& reading : s.readings) u.holds.push_back(quantities::holds_for(entry.labels, reading.labels));
      if (std::ranges::find(u.holds, true) != u.holds.end()) unknowns_.push_back(std::move(u));
    }
  }
}

void Fitter::find_draws() {
  const auto& plan = experiment_.plan();
  for (const auto& v : plan.variates) draws_.push_back({v.name, v.distribution.standard_uncertainty(), {}, false});
  for (std::size_t r = 0; r < observations_.readings; ++r)
    for (std::size_t q = 0; q < plan.gather[r].size(); ++q)
      for (const std::size_t v : plan.columns[plan.gather[r][q]].variates) draws_[v].moves.push_back({r, q});
  for (Draw& d : draws_)
    d.local = std::ranges::all_of(d.moves, [&](const auto& m) { return m.first == d.moves.front().first; });
}

/// Where readings jump or have a kink with a quantity, the tangent leads nowhere, and its draws stay as declared.
void Fitter::find_fitted() {
  std::map<std::size_t, double> largest; // by quantity
  for (Draw& d : draws_) {
    d.fitted = !d.local && !d.moves.empty() && std::ranges::all_of(d.moves, [&](const auto& m) {
      return experiment_.layout().model.contains(m.second);
    });
    if (!d.fitted) continue;
    for (const auto& [r, q] : d.moves) largest[q] = std::max(largest[q], d.u);
  }
  const std::set<std::size_t> jumping = not_smooth(largest);
  for (Draw& d : draws_)
    d.fitted = d.fitted && std::ranges::none_of(d.moves, [&](const auto& m) { return jumping.contains(m.second); });
  // Tied draws move together or not at all.
  for (const auto& group : experiment_.plan().copulas) {
    const bool all = std::ranges::all_of(group.variates, [&](std::size_t v) { return draws_[v].fitted; });
    for (const std::size_t v : group.variates) draws_[v].fitted = all;
  }
}

std::set<std::size_t> Fitter::not_smooth(const std::map<std::size_t, double>& steps) const {
  std::set<std::size_t> out;
  std::vector<std::size_t> quantities;
  std::vector<Variation> variations;
  for (const auto& [q, u] : steps) {
    quantities.push_back(q);
    for (const double share : {1.0, -1.0, 0.5, -0.5}) variations.push_back({{{q, share * u, false}}});
  }
  if (quantities.empty()) return out;
  const Points at = simulator_.estimates();
  Vector here;
  Matrix slope, f;
  std::vector<bool> valid;
  if (!simulator_.derivatives(at, quantities, here, slope)) return {quantities.begin(), quantities.end()};
  simulator_.vary(at, variations, f, valid);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto first = index(4 * i);
    if (!(valid[4 * i] && valid[4 * i + 1] && valid[4 * i + 2] && valid[4 * i + 3])) continue;
    const Vector line = slope.col(index(i)) * steps.at(quantities[i]);
    const auto off = [&](Index column, double share) { return (f.col(first + column) - here - share * line).norm(); };
    const double whole = off(0, 1) + off(1, -1), half = off(2, 0.5) + off(3, -0.5);
    if (whole > criteria.straight * line.norm() && half > criteria.curved * whole) out.insert(quantities[i]);
  }
  return out;
}

void Fitter::find_responses() {
  responses_.assign(needed_.size(), {});
  offset_ = Vector::Zero(index(simulator_.rows()));
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
        alone = alone && std::ranges::find(group.variates, v) == group.variates.end();
      for (const auto& [r, q] : d.moves) alone = alone && ++moved[r] == 1;
      u = std::max(u, d.u);
    }
    if (!(u > 0)) continue;
    responses_[i] = declared_response(simulator_, simulator_.estimates(), needed_[i], u, alone);
    if (!responses_[i].straight()) offset_ += responses_[i].offset;
  }
}

Fitter Fitter::without_scatter() const {
  Fitter out = *this;
  out.groups_scatter_ = false;
  out.covariance_models_.clear();
  out.find_covariance_models();
  return out;
}

Fitter Fitter::without_rows(const std::vector<Index>& rows) const {
  Fitter out = *this;
  std::erase_if(out.rows_, [&](Index row) { return std::ranges::binary_search(rows, row); });
  out.covariance_models_.clear();
  out.find_covariance_models();
  return out;
}

} // namespace gumshoe::tracing
