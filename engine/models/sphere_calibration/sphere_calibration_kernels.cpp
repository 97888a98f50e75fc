/// Block loops of the sphere model, compiled once per instruction set.
#include "models/sphere_calibration/procedures.h"

namespace gumshoe::models {
namespace {

constexpr std::size_t width = Lanes::size;

Lanes load(const Column& c, std::size_t i) {
  return c.stride == 0 ? Lanes(c.data[0]) : Lanes::load_unaligned(c.data + i);
}
bool all_zero(const Column& c) { return c.stride == 0 && c.data[0] == 0; }
bool equal(const Column& a, const Column& b) { return a.data == b.data && a.stride == b.stride; }

/// What Links are made of is the same in this reading and the one before.
bool same_links(const Column* columns, std::size_t r) {
  const Column *here = columns + r * sphere_calibration::count, *before = here - sphere_calibration::count;
  for (std::size_t j = 0; j <= sphere_calibration::link_C_y; ++j)
    if (!equal(here[j], before[j])) return false;
  return true;
}

void load_effects(const BlockCall& call, std::size_t r, std::size_t i, std::vector<Lanes>& e) {
  for (std::size_t j = 0; j < e.size(); ++j) e[j] = load(call.effects[r * e.size() + j], i);
}

/// Samples whose reading is of neither pattern fail.
void mark_without_closed_form(const BlockCall& call, std::size_t i, const Lanes* condition) {
  const auto fine = sphere_calibration::has_closed_form(condition);
  for (std::size_t l = 0; l < width; ++l)
    if (!fine.get(l)) call.status[i + l] = code(Status::out_of_domain);
}

template <class Finish> void for_each_group(const BlockCall& call, const Finish& finish) {
  // A joint evaluation stands on the exact chain.
  const int variant = call.evaluation < sphere_calibration::variants ? call.evaluation : static_cast<int>(sphere_calibration::exact);
  std::vector<char> square(call.readings), new_links(call.readings);
  for (std::size_t r = 0; r < call.readings; ++r) {
    const Column* columns = call.quantities + r * sphere_calibration::count;
    square[r] = all_zero(columns[sphere_calibration::S_XY]) && all_zero(columns[sphere_calibration::S_XZ]) && all_zero(columns[sphere_calibration::S_YZ]);
    new_links[r] = r == 0 || !same_links(call.quantities, r);
  }
  Lanes q[sphere_calibration::count], condition[sphere_calibration::conditions];
  std::vector<Lanes> e(call.effect_quantities);
  sphere_calibration::Links<Lanes> links;
  for (std::size_t i = 0; i < call.samples; i += width)
    for (std::size_t r = 0; r < call.readings; ++r) {
      const Column* columns = call.quantities + r * sphere_calibration::count;
      for (std::size_t j = 0; j < sphere_calibration::count; ++j) q[j] = load(columns[j], i);
      for (std::size_t j = 0; j < sphere_calibration::conditions; ++j)
        condition[j] = load(call.conditions[r * sphere_calibration::conditions + j], i);
      load_effects(call, r, i, e);
      if (new_links[r]) links = sphere_calibration::links(q);
      const auto at = sphere_calibration::contact(variant, q, links, condition, sphere_calibration::is_pattern_II(condition), square[r] == 0,
                                      {call.active, e.data()});
      if (variant == sphere_calibration::closed_form) mark_without_closed_form(call, i, condition);
      finish(r, i, at);
    }
}

void store(const Vector3<Lanes>& value, double* const* rows, std::size_t i) {
  value.x.store_unaligned(rows[0] + i);
  value.y.store_unaligned(rows[1] + i);
  value.z.store_unaligned(rows[2] + i);
}

/// The machine that a joint evaluation should find; readings agree in it.
void store_truth(const BlockCall& call) {
  for (std::size_t i = 0; i < call.samples; i += width) {
    for (std::size_t j = 0; j < sphere_calibration::unknowns; ++j)
      load(call.quantities[j], i).store_unaligned(call.measurands[sphere_calibration::row_of[j]] + i);
    Lanes(0.0).store_unaligned(call.measurands[sphere_calibration::residual_row] + i);
    Lanes(0.0).store_unaligned(call.measurands[sphere_calibration::rank_row] + i);
    Lanes(0.0).store_unaligned(call.measurands[sphere_calibration::condition_row] + i);
  }
}

void simulate(const BlockCall& call) {
  if (sphere_calibration::is_joint(call.evaluation)) store_truth(call);
  for_each_group(call, [&](std::size_t r, std::size_t i, const auto& at) {
    store(sphere_calibration::simulate(at), call.simulated + r * sphere_calibration::indications, i);
    // Of a joint evaluation the true values are not these.
    if (call.evaluation < sphere_calibration::variants) store(at.tip, call.measurands + r * sphere_calibration::measurands, i);
  });
}

void load_pose(const BlockCall& call, std::size_t r, std::size_t i, sphere_calibration::Pose<Lanes>& pose) {
  const Column* columns = call.quantities + r * sphere_calibration::count;
  const Column* read = call.indications + r * sphere_calibration::indications;
  const Column* condition = call.conditions + r * sphere_calibration::conditions;
  Lanes q[sphere_calibration::count];
  for (std::size_t j = 0; j < sphere_calibration::count; ++j) q[j] = load(columns[j], i);
  for (std::size_t j = 0; j < 4; ++j) pose.link[j] = q[sphere_calibration::link_B_x + j];
  for (std::size_t j = 0; j < 3; ++j) pose.square[j] = q[sphere_calibration::S_XY + j];
  pose.squareness =
      !(all_zero(columns[sphere_calibration::S_XY]) && all_zero(columns[sphere_calibration::S_XZ]) && all_zero(columns[sphere_calibration::S_YZ]));
  const Lanes A = load(condition[sphere_calibration::A], i), zero(0.0);
  pose.B = load(condition[sphere_calibration::B], i), pose.C = load(condition[sphere_calibration::C], i);
  pose.at_B = pose.B + q[sphere_calibration::E_BB], pose.at_C = pose.C + q[sphere_calibration::E_CC];
  pose.tip = sphere_calibration::tip_at_top(q, A);
  const Vector3<Lanes> recorded{load(read[0], i), load(read[1], i), load(read[2], i)};
  // Squareness follows the nominal commands, which are the machine's that is sought.
  q[sphere_calibration::S_XY] = q[sphere_calibration::S_XZ] = q[sphere_calibration::S_YZ] = zero;
  const auto top = sphere_calibration::tip_at_top(q, A + q[sphere_calibration::E_AA]), added = sphere_calibration::linear_errors(q, zero, zero);
  pose.measured = top + added - recorded;
  if (call.active.empty()) return;
  auto& freed = pose.freed;
  freed.active = call.active;
  freed.quantities.resize(call.effect_quantities);
  load_effects(call, r, i, freed.quantities);
  for (std::size_t j = 0; j < sphere_calibration::conditions; ++j) freed.condition[j] = load(condition[j], i);
  freed.top = top, freed.recorded = recorded - added;
}

void identify(const BlockCall& call) {
  std::vector<double> values(call.readings * sphere_calibration::conditions);
  std::vector<const double*> condition;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = *call.conditions[i].data;
  for (std::size_t r = 0; r < call.readings; ++r) condition.push_back(&values[r * sphere_calibration::conditions]);
  const auto patterns = sphere_calibration::patterns(condition);
  std::string problem;
  const auto whitening = call.evaluation == sphere_calibration::joint_weighted && call.declared ? sphere_calibration::whitening(call, problem)
                                                                                    : sphere_calibration::Whitening{};
  sphere_calibration::Identification<Lanes> identification(call.readings, patterns, whitening);
  for (std::size_t i = 0; i < call.samples; i += width) {
    for (std::size_t r = 0; r < call.readings; ++r) load_pose(call, r, i, identification.poses[r]);
    Lanes declared[sphere_calibration::unknowns];
    for (std::size_t j = 0; j < sphere_calibration::unknowns; ++j) declared[j] = load(call.quantities[j], i);
    const auto found =
        call.evaluation == sphere_calibration::sequential ? identification.sequential(declared) : identification.joint(declared);
    for (std::size_t j = 0; j < sphere_calibration::unknowns; ++j)
      found.theta[j].store_unaligned(call.measurands[sphere_calibration::row_of[j]] + i);
    found.residual_rms.store_unaligned(call.measurands[sphere_calibration::residual_row] + i);
    found.rank.store_unaligned(call.measurands[sphere_calibration::rank_row] + i);
    found.condition.store_unaligned(call.measurands[sphere_calibration::condition_row] + i);
    for (std::size_t l = 0; l < width; ++l) {
      std::uint8_t& status = call.status[i + l];
      if (status != 0) continue;
      const auto failed = !found.finite.get(l)      ? Status::out_of_domain
                          : !found.converged.get(l) ? Status::not_converged
                                                    : Status::ok;
      status = static_cast<std::uint8_t>(failed);
    }
  }
}

void evaluate(const BlockCall& call) {
  if (sphere_calibration::is_joint(call.evaluation)) return identify(call);
  for_each_group(call, [&](std::size_t r, std::size_t i, const auto& at) {
    const Column* read = call.indications + r * sphere_calibration::indications;
    store(sphere_calibration::evaluate({load(read[0], i), load(read[1], i), load(read[2], i)}, at),
          call.measurands + r * sphere_calibration::measurands, i);
  });
}

} // namespace
} // namespace gumshoe::models

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_sphere_calibration_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_sphere_calibration_){&gumshoe::models::simulate,
                                                                           &gumshoe::models::evaluate};
}
