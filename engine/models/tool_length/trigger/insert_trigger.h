#pragma once
/// The trigger of a turning mill that is fed into the beam: the first moment at which any flute covers the trigger's
/// share. The tool's centre comes down from `start_height` by `drop` per radian of spindle angle; flute k stands at
/// start_angle + azimuth_k + turned and raise_k higher than an unworn one:
///     first turned >= not_before with start_height + raise_k - drop turned <= Zc_k(start_angle + azimuth_k + turned).
/// No time steps: revolutions above the highest Zc are passed at once, then humps of Zc + drop angle are isolated.
#include <array>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "chain/turning_tool.h"
#include "models/tool_length/trigger/insert_height.h"
#include "models/tool_length/trigger/insert_pass.h"
#include "models/tool_length/trigger/lag.h"

namespace gumshoe::models::tool_length {

using chain::most_inserts;

/// One insert in its seat. Flutes of one tool may differ in everything.
template <class T> struct Flute {
  Insert<T> insert;
  T azimuth; ///< of the seat, from that of the first, rad
  T raise;   ///< the flute is shorter by this: W_k, m
};

struct InsertMotion {
  double start_angle = 0;  ///< of the first seat, holder angle included, rad
  double start_height = 0; ///< of the tool's centre above the laser reference point, m
  double drop = 0;         ///< m per rad, positive
  double not_before = 0;   ///< spindle angle turned until a trigger counts, rad
};

struct InsertTrigger {
  Status status = Status::ok;
  int insert = 0;    ///< from 0
  double turned = 0; ///< spindle angle from the start to the trigger, rad
  double height = 0; ///< of the tool's centre at the trigger
  double slope = 0;  ///< dZc / d(angle) of that flute there: d(height) / d(start_height) = slope / (slope + drop)
};

/// One trigger that is wanted.
struct TriggerQuestion {
  std::span<const Flute<double>> flutes;
  Beam<double> beam;
  InsertMotion motion;
};

/// Solves triggers, and remembers what depends on the geometry alone: calls with equal inserts and beam share it. What
/// is remembered changes no bit.
class TriggerSolver {
public:
  /// `already_covered`: a flute covers the share before anything moves. Absolute error of the height below 1e-12 m.
  InsertTrigger solve(std::span<const Flute<double>> flutes, const Beam<double>& beam, const InsertMotion& motion);
  /// The same for several tools at once, in SIMD lanes: as many answers as questions, the same bits.
  void solve(std::span<const TriggerQuestion> questions, InsertTrigger* answers);
  /// The same by the general search alone, for every insert and beam.
  InsertTrigger search(std::span<const Flute<double>> flutes, const Beam<double>& beam, const InsertMotion& motion);
  /// The same by the walk through the windows alone (insert_pass.h); nothing where it has no proof.
  std::optional<InsertTrigger> walk(std::span<const Flute<double>> flutes, const Beam<double>& beam,
                                    const InsertMotion& motion);
  /// The trigger of one flute alone when the tool's centre comes down the whole line height = level - drop turned, from
  /// far above; `turned` may be negative. It depends on the line's phase only: a level higher by 2 pi drop gives an
  /// equal height one turn later. A tool that starts above all flutes triggers at the highest of its flutes' heights,
  /// so this is what a fit of a characteristic curve needs. About a microsecond while insert, beam and drop stay the
  /// same. d(height) / d(level) = slope / (slope + drop), d(height) / d(raise) = -drop / (slope + drop).
  InsertTrigger alone(const Flute<double>& flute, const Beam<double>& beam, double level, double drop);
  /// How deep below the highest a walk tries windows, in turns' descents: as deep as one flute alone may wait, but less
  /// serves when others come between.
  static std::array<double, 3> shares(std::size_t flutes) { return {1.0 / static_cast<double>(flutes), 1.0, 2.0}; }
  /// Zc of one insert; valid until the next call.
  const InsertHeight& heights(const Insert<double>& insert, const Beam<double>& beam);

private:
  struct Remembered {
    Insert<double> insert;
    Beam<double> beam;
    InsertHeight heights;
  };
  std::list<Remembered> remembered_; ///< the last used first
  /// search(), with its answers to whole questions remembered: it takes a hundred times the walk's time.
  InsertTrigger searched(std::span<const Flute<double>> flutes, const Beam<double>& beam, const InsertMotion& motion);
  static constexpr std::size_t most_answers = 4096;
  std::map<std::vector<double>, InsertTrigger> answers_;
  struct Pass {
    Insert<double> insert;
    Beam<double> beam;
    std::optional<InsertPass> pass;
    double below = -1, whole = 0; ///< of the last open(), and what came of it
    bool open = false;
  };
  Pass& pass(std::size_t flute, const Insert<double>& insert, const Beam<double>& beam);
  std::array<Pass, most_inserts> passes_;
  static constexpr std::size_t most_questions = 64;
};

/// Motion for derivatives. The axis may lag behind its command (lagging_feed.h).
template <class T> struct InsertMotionOf {
  T angle;  ///< start_angle, rad
  T height; ///< start_height, m
  T drop;
  T lag = T(0.0); ///< rad of spindle angle
  T height_at(const T& turned) const { return height - drop * (turned - behind(turned, lag)); }
};

/// The spindle angle turned until the trigger with its derivatives: Newton steps in T at the trigger found, for the
/// flute that triggers.
template <class T>
T differentiable_turned(const Flute<T>& flute, const Beam<T>& beam, const InsertMotionOf<T>& m,
                        const InsertTrigger& solved) {
  const InsertBody<T> body = insert_body(flute.insert, beam);
  const T target = beam.fraction * (pi * (beam.radius * beam.radius));
  T turned(solved.turned);
  for (int level = 0; level < num::derivative_levels<T>; ++level) {
    const T angle = m.angle + flute.azimuth + turned, k = body.cos_pitch * (m.height_at(turned) + flute.raise);
    const InsertShadow<T> shadow = insert_shadow(body, angle);
    const InsertShadow<double> plain = converted<double>(shadow);
    const InsertParts parts = insert_parts(plain, joints(plain), num::value(k), num::value(beam.radius));
    const auto moving = Dual<double, 1>::variable(num::value(turned), 0);
    const auto turning = insert_shadow(converted<Dual<double, 1>>(body), num::value(m.angle + flute.azimuth) + moving);
    const double s = num::value(turned), lag = num::value(m.lag);
    const double fall = num::value(body.cos_pitch * m.drop) * (1 - falling_behind(s, lag));
    const double slope = insert_cover(turning, joints(turning), num::value(k) - fall * (moving - num::value(turned)),
                                      Dual<double, 1>(num::value(beam.radius)), parts)
                             .area.d[0];
    const auto cover = insert_cover(shadow, joints(shadow), k, beam.radius, parts);
    turned = turned - (cover.area - target) / slope;
  }
  return turned;
}

} // namespace gumshoe::models::tool_length
