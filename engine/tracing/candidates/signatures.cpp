#include "tracing/candidates/signatures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

Index column(std::size_t i) { return index(i); }

/// Steps of both signs, of the amplitudes of effects. What does not move the indications at all by its derivative takes
/// its typical size.
std::vector<double> steps(const propagation::Experiment& e, const Points& at, double step, const Matrix& tangents) {
  std::vector<double> sizes(2 * index(tangents.cols()), 0);
  for (const effects::Active& a : e.forward().active()) {
    const EffectCard& effect = *effects::cards()[a.effect];
    for (std::size_t k = 0; k < effect.quantities.size(); ++k) {
      const QuantityCard& card = effect.quantities[k];
      const std::size_t q = e.layout().effects[a.first + k];
      if (card.role == Role::shape || e.scenario().quantities[q].estimated) continue;
      const double slope = tangents.col(column(q)).norm() / std::sqrt(static_cast<double>(tangents.rows()));
      if (effect.follows_derivative && slope > 0) continue;
      const double typical = card.typical.high;
      double size = slope > 0 ? step / slope : typical;
      if (slope > 0 && typical > 0) size = std::min(size, criteria.secant_step * typical);
      for (const std::size_t i : {0, 1}) {
        const double signed_size = i == 0 ? size : -size;
        if (size > 0 && std::ranges::all_of(at, [&](const auto& p) { return card.limits.contain(p[q] + signed_size); }))
          sizes[2 * q + i] = signed_size;
      }
    }
  }
  return sizes;
}

/// Most of what has no derivative (inserts that the tool does not have) moves nothing by any size: of each sign one
/// trial together tells.
void drop_still(const Simulator& simulator, const Points& at, Signatures& s) {
  std::vector<Variation> together(3); // upwards, downwards, neither
  for (std::size_t k = 0; k < s.sizes.size(); ++k)
    if (s.sizes[k] != 0 && s.tangents.col(column(k / 2)).norm() == 0)
      together[k % 2].changes.push_back({k / 2, s.sizes[k], false});
  Matrix f;
  std::vector<bool> valid;
  simulator.vary(at, together, f, valid);
  for (const std::size_t i : {0, 1})
    if (valid[i] && (f.col(column(i)) - f.col(2)).norm() == 0)
      for (const auto& c : together[i].changes) s.sizes[2 * c.quantity + i] = 0;
}

void take_secants(const Simulator& simulator, const Points& at, Signatures& s) {
  std::vector<Variation> variations;
  std::vector<std::size_t> owner;
  for (std::size_t k = 0; k < s.sizes.size(); ++k) {
    if (s.sizes[k] == 0) continue;
    variations.push_back({{{k / 2, s.sizes[k], false}}});
    owner.push_back(k);
  }
  variations.push_back({});
  Matrix f;
  std::vector<bool> valid;
  simulator.vary(at, variations, f, valid);
  s.secants = Matrix::Zero(f.rows(), column(s.sizes.size()));
  for (std::size_t v = 0; v < owner.size(); ++v)
    if (valid[v])
      s.secants.col(column(owner[v])) = (f.col(column(v)) - f.col(f.cols() - 1)) / s.sizes[owner[v]];
    else
      s.sizes[owner[v]] = 0;
}

} // namespace

Signatures signatures(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                      double step) {
  std::vector<std::size_t> all(experiment.layout().effects.end);
  std::iota(all.begin(), all.end(), std::size_t{0});
  Signatures out;
  Vector f;
  simulator.derivatives(at, all, f, out.tangents);
  out.sizes = steps(experiment, at, step, out.tangents);
  drop_still(simulator, at, out);
  take_secants(simulator, at, out);
  out.changes_with = simulator.changes_with(at, all);
  return out;
}

} // namespace gumshoe::tracing
