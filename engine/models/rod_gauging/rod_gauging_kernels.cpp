/// Block loops of the rod model, compiled once per instruction set.
#include "models/rod_gauging/rod_gauging.h"

namespace gumshoe::models {
namespace {

constexpr std::size_t width = Lanes::size;

Lanes load(const Column& c, std::size_t i) {
  return c.stride == 0 ? Lanes(c.data[0]) : Lanes::load_unaligned(c.data + i);
}

/// Lanes whose values no rod or beam can have, or that the fast solve cannot take.
template <class V> auto needs_general_solve(const rod_gauging::Rod<V>& r, const laser_setter::Beam<V>& b, const V& failed) {
  const V zero(0.0);
  auto fine = (r.radius > zero) && (r.fillet_radius >= zero) && (r.fillet_radius <= r.radius) &&
              (r.bottom_elevation > zero) && (r.bottom_elevation < V(std::numbers::pi)) && (b.radius > zero) &&
              (b.fraction > zero) && (b.fraction < V(1.0)) && (num::abs(b.pitch) < V(0.5 * std::numbers::pi)) &&
              (failed < V(0.5));
  return !fine;
}

void solve_group(const Lanes* q, const chain::ProbingEvent<Lanes>& event, double* height, std::uint8_t* status) {
  const rod_gauging::Rod<Lanes> rod = rod_gauging::rod(q, event);
  const laser_setter::Beam<Lanes> beam = rod_gauging::beam(q);
  const auto chord = rod_gauging::solve_chord<Lanes>(rod_gauging::shadow_edge(rod, beam), beam.radius, beam.fraction);
  const Lanes fast = rod_gauging::bottom_height_of(chord.k, rod, beam);
  fast.store_unaligned(height);
  const auto general = needs_general_solve(rod, beam, chord.failed);
  if (!num::any(general)) return;
  for (std::size_t l = 0; l < width; ++l) {
    if (!general.get(l)) continue;
    const auto solved =
        rod_gauging::general_height({rod.radius.get(l), rod.fillet_radius.get(l), rod.bottom_elevation.get(l),
                               rod.bottom_azimuth.get(l), rod.axis_x.get(l), rod.axis_y.get(l)},
                              {beam.yaw.get(l), beam.pitch.get(l), beam.radius.get(l), beam.fraction.get(l)});
    height[l] = solved.value;
    if (solved.status != Status::ok) status[l] = code(solved.status);
  }
}

template <class Finish> void for_each_group(const BlockCall& call, bool with_solve, const Finish& finish) {
  Lanes q[rod_gauging::count], condition[rod_gauging::conditions];
  std::vector<Lanes> e(call.effect_quantities + 1);
  for (std::size_t r = 0; r < call.readings; ++r) {
    const Column* columns = call.quantities + r * rod_gauging::count;
    const Column* effect_columns = call.effects + r * call.effect_quantities;
    double* height_row = call.measurands[r * rod_gauging::measurands + rod_gauging::bottom_height_row];
    const std::size_t twin = call.solved_as[r];
    for (std::size_t i = 0; i < call.samples; i += width) {
      for (std::size_t j = 0; j < rod_gauging::count; ++j) q[j] = load(columns[j], i);
      for (std::size_t j = 0; j < call.effect_quantities; ++j) e[j] = load(effect_columns[j], i);
      for (std::size_t j = 0; j < rod_gauging::conditions; ++j)
        condition[j] = load(call.conditions[r * rod_gauging::conditions + j], i);
      const auto event = rod_gauging::probing_event<Lanes>(q, condition, e.data(), call.active);
      if (!with_solve)
        Lanes(0.0).store_unaligned(height_row + i);
      else if (twin == r)
        solve_group(q, event, height_row + i, call.status + i);
      else
        Lanes::load_unaligned(call.measurands[twin * rod_gauging::measurands] + i).store_unaligned(height_row + i);
      finish(r, i, q, event, Lanes::load_unaligned(height_row + i));
    }
  }
}

void simulate(const BlockCall& call) {
  for_each_group(call, true, [&](std::size_t r, std::size_t i, const Lanes* q, const auto& event, const Lanes& height) {
    rod_gauging::simulate(q, height, event).store_unaligned(call.simulated[r] + i);
    q[rod_gauging::laser_z].store_unaligned(call.measurands[r * rod_gauging::measurands + rod_gauging::laser_z_row] + i);
  });
}

void evaluate(const BlockCall& call) {
  for_each_group(call, call.evaluation == rod_gauging::full,
                 [&](std::size_t r, std::size_t i, const Lanes* q, const auto& event, const Lanes& height) {
                   const Lanes z = rod_gauging::evaluate(load(call.indications[r], i), q, height, event);
                   z.store_unaligned(call.measurands[r * rod_gauging::measurands + rod_gauging::laser_z_row] + i);
                 });
}

} // namespace
} // namespace gumshoe::models

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_rod_gauging_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_rod_gauging_){&gumshoe::models::simulate,
                                                                    &gumshoe::models::evaluate};
}
