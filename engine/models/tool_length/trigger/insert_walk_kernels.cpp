/// Compiled once per instruction set: tools side by side, a lane each, of as many flutes, with equal inserts in the
/// same places.
#include <algorithm>
#include <array>
#include <optional>

#include "models/tool_length/trigger/insert_pass.h"
#include "models/tool_length/trigger/insert_walk_kernels.h"

namespace gumshoe::models::tool_length {
namespace {

constexpr std::size_t width = Lanes::size;

/// A number of each question.
template <class F> Lanes each(const TriggerQuestion* const* questions, const F& number) {
  double x[width];
  for (std::size_t l = 0; l < width; ++l) x[l] = number(*questions[l]);
  return Lanes::load_unaligned(x);
}

/// For each flute the first with an equal insert.
struct Likeness {
  std::size_t flutes = 0;
  std::array<std::size_t, most_inserts> first{};
  bool operator==(const Likeness&) const = default;
};

Likeness likeness(const TriggerQuestion& q) {
  Likeness out{q.flutes.size(), {}};
  for (std::size_t k = 0; k < q.flutes.size(); ++k)
    while (!(q.flutes[out.first[k]].insert == q.flutes[k].insert)) ++out.first[k];
  return out;
}

/// One question per lane, all of one likeness.
void walk_lanes(const TriggerQuestion* const* questions, const Likeness& like, InsertTrigger* answers, bool* found) {
  const std::size_t n = like.flutes;
  const auto of_beam = [&](auto member) { return each(questions, [&](const auto& q) { return q.beam.*member; }); };
  const auto of_motion = [&](auto member) { return each(questions, [&](const auto& q) { return q.motion.*member; }); };
  using I = Insert<double>;
  using B = Beam<double>;
  using M = InsertMotion;
  const Beam<Lanes> beam{of_beam(&B::yaw), of_beam(&B::pitch), of_beam(&B::radius), of_beam(&B::fraction)};
  using Pass = InsertPassOf<Lanes>;
  const DiscShareOf<Lanes> disc(beam.radius, beam.fraction);
  DescentFlute<Lanes> flutes[most_inserts];
  std::optional<Pass> passes[most_inserts];
  for (std::size_t k = 0; k < n; ++k) {
    flutes[k].pass = like.first[k];
    flutes[k].azimuth = each(questions, [&](const auto& q) { return q.flutes[k].azimuth; });
    flutes[k].raise = each(questions, [&](const auto& q) { return q.flutes[k].raise; });
    if (like.first[k] != k) continue;
    const auto of_insert = [&](auto member) {
      return each(questions, [&](const TriggerQuestion& q) { return q.flutes[k].insert.*member; });
    };
    const Insert<Lanes> insert{of_insert(&I::tool_radius), of_insert(&I::radius),       of_insert(&I::thickness),
                               of_insert(&I::clearance),   of_insert(&I::radial_angle), of_insert(&I::axial_angle),
                               of_insert(&I::axis_x),      of_insert(&I::axis_y),       of_insert(&I::seat)};
    passes[k].emplace(insert_body(insert, beam), disc);
  }
  InsertDescent<Lanes, Pass> descent(
      {flutes, n}, num::cos(beam.pitch),
      {of_motion(&M::start_angle), of_motion(&M::start_height), of_motion(&M::drop), of_motion(&M::not_before)},
      [&](std::size_t k) -> const Pass& { return *passes[k]; });
  DescentTrigger<Lanes> t;
  auto wanted = everywhere<Lanes>(true);
  for (const double share : TriggerSolver::shares(n)) {
    for (std::size_t k = 0; k < n; ++k) {
      if (like.first[k] != k) continue;
      wanted = wanted && passes[k]->open(descent.below(k, share));
      passes[k]->sharpen(wanted, share * descent.whole(), descent.whole());
    }
    wanted = wanted && descent.begin();
    if (!num::any(wanted)) break;
    t = select<Lanes>(wanted, descent.down(wanted), t);
    wanted = wanted && !t.found && !t.unproved;
  }
  double turned[width], slope[width], flute[width];
  t.turned.store_unaligned(turned), t.slope.store_unaligned(slope), t.insert.store_unaligned(flute);
  for (std::size_t l = 0; l < width; ++l) {
    found[l] = t.found.get(l) && !t.unproved.get(l);
    if (found[l])
      answers[l] = trigger_of({true, false, t.inside.get(l), flute[l], turned[l], slope[l]}, questions[l]->motion);
  }
}

bool has_lanes(const TriggerQuestion& q) { return !q.flutes.empty() && q.flutes.size() <= most_inserts; }

void walk(const TriggerQuestion* questions, std::size_t n, InsertTrigger* answers, bool* found) {
  std::fill_n(found, n, false);
  for (std::size_t i = 0; i < n;) {
    // The questions that follow, of one likeness; the last one fills lanes that are left.
    const TriggerQuestion* lanes[width];
    std::size_t at[width], count = 0;
    Likeness like;
    for (; i < n && count < width; ++i) {
      if (!has_lanes(questions[i])) continue;
      const Likeness of_this = likeness(questions[i]);
      if (count > 0 && !(of_this == like)) break;
      like = of_this;
      lanes[count] = &questions[i];
      at[count++] = i;
    }
    if (count == 0) continue;
    std::fill(lanes + count, lanes + width, lanes[count - 1]);
    InsertTrigger answer[width];
    bool good[width];
    walk_lanes(lanes, like, answer, good);
    for (std::size_t l = 0; l < count; ++l)
      if (good[l]) answers[at[l]] = answer[l], found[at[l]] = true;
  }
}

} // namespace
} // namespace gumshoe::models::tool_length

extern "C" const gumshoe::models::tool_length::WalkKernels GUMSHOE_KERNEL(gumshoe_insert_walk_);
const gumshoe::models::tool_length::WalkKernels GUMSHOE_KERNEL(gumshoe_insert_walk_) = {
    gumshoe::models::tool_length::walk};
