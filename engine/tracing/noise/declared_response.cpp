#include "tracing/noise/declared_response.h"

#include <boost/math/special_functions/erf.hpp>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr Index likely = criteria.response_nodes; // equally likely values

/// Readings under shifts of one quantity; false if the model has no value somewhere.
bool shifted(const Simulator& simulator, const Points& at, std::size_t quantity, const Vector& shifts, Matrix& f) {
  std::vector<Variation> variations;
  for (const double shift : shifts) variations.push_back({{{quantity, shift, false}}});
  std::vector<bool> valid;
  simulator.vary(at, variations, f, valid);
  return std::ranges::find(valid, false) == valid.end();
}

} // namespace

DeclaredResponse declared_response(const Simulator& simulator, const Points& at, std::size_t quantity, double u,
                                   bool tabled) {
  DeclaredResponse out;
  Vector z(likely), here;
  for (Index j = 0; j < likely; ++j)
    z[j] = -std::sqrt(2.0) * boost::math::erfc_inv((2.0 * static_cast<double>(j) + 1) / likely);
  Matrix f;
  if (!shifted(simulator, at, quantity, u * z, f) || !simulator.simulate(at, here)) return out;
  const Vector mean = f.rowwise().mean(), slope = f * z / z.squaredNorm();
  const Matrix line = slope * z.transpose(), off = (f - line).colwise() - (f - line).rowwise().mean();
  out.slope = slope / u;
  if (off.norm() < criteria.straight * line.norm()) return out;
  out.variance = off.array().square().matrix().rowwise().sum() / static_cast<double>(likely - 2);
  out.offset = mean - here;
  if (!tabled) return out;
  Vector nodes(bend_nodes);
  for (Index j = 0; j < bend_nodes; ++j) nodes[j] = bend_node(j);
  if (Matrix table; shifted(simulator, at, quantity, u * nodes, table))
    out.table = (table - slope * nodes.transpose()).colwise() - mean;
  return out;
}

Matrix bent_response(const Simulator& simulator, const Points& at, std::size_t quantity, double u) {
  const Vector slope = declared_response(simulator, at, quantity, u, false).slope;
  if (!(slope.norm() > 0)) return {};
  const double unit = u / (slope.norm() / std::sqrt(static_cast<double>(slope.size())));
  const DeclaredResponse response = declared_response(simulator, at, quantity, unit, true);
  if (response.table.size() == 0) return {};
  Matrix out = response.table.colwise() + response.offset;
  for (Index j = 0; j < bend_nodes; ++j) out.col(j) += response.slope * (unit * bend_node(j));
  return out;
}

std::optional<std::size_t> seat_at_null(const propagation::Experiment& experiment) {
  const auto& all = experiment.scenario().quantities;
  for (const effects::Active& active : experiment.forward().active()) {
    const std::size_t q = experiment.layout().effects[active.first];
    if (effects::cards()[active.effect]->scatters_between_clampings && !all[q].estimated &&
        all[q].entries.size() == 1 && all[q].entries[0].components.empty() && all[q].entries[0].value == 0)
      return q;
  }
  return std::nullopt;
}

} // namespace gumshoe::tracing
