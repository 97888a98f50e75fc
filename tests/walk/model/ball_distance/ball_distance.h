#pragma once
/// Distance between the centres of two balls, probed on a machine with three slides.
///
/// The bar that holds the balls points from ball 1 to where ball 2 was commanded, and has grown with its temperature:
///     centre 2 - centre 1 = distance (1 + expansion temperature_difference) direction
/// The evaluation takes the length of the difference of both centres and divides by the growth.
#include "models/cards.h"
#include "models/model.h"
#include "models/reading.h"

namespace gumshoe::models::ball_distance {

using si::minute, si::mm;

inline constexpr QuantityCard quantity_cards[] = {
    in_mm({.name = "distance", .default_value = 300 * mm, .limits = positive, .symbol = "L",
           .meaning = "between the balls' centres at 20 degC; only simulation reads it"}),
    {.name = "expansion", .unit = "um/m/K", .si_unit = "1/K", .default_value = 11.5e-6, .limits = {-1e-4, 1e-4},
     .symbol = "alpha", .meaning = "coefficient of linear thermal expansion of the bar"},
    {.name = "temperature_difference", .unit = "K", .si_unit = "K", .limits = {-200, 200}, .symbol = "dT",
     .meaning = "temperature of the bar minus 20 degC"},
};
constexpr VariableCard command(std::string_view name, double at) {
  return shown_in_mm({.name = name, .default_value = at, .meaning = "command at a ball's centre"});
}
inline constexpr VariableCard condition_cards[] = {
    command("x_1", 100 * mm), command("y_1", 50 * mm), command("z_1", -200 * mm),
    command("x_2", 300 * mm), command("y_2", 250 * mm), command("z_2", -100 * mm),
    {.name = "feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 30 * mm / minute, .meaning = "of every slide"},
    shown_pure({.name = "direction", .default_value = -1, .meaning = "from which every slide came: 1 or -1"}),
    shown_in_s({.name = "time", .meaning = "since the start of the work"}),
};
inline constexpr VariableCard indication_cards[] = {command("X_1", 0), command("Y_1", 0), command("Z_1", 0),
                                                    command("X_2", 0), command("Y_2", 0), command("Z_2", 0)};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_mm({.name = "distance", .meaning = "between the balls' centres at 20 degC"})};
inline constexpr EquationCard equations[] = {
    {"distance = norm(centre_2 - centre_1) / (1 + expansion * temperature_difference)"}};
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "full", .meaning = "length of the difference", .equations = equations}};
inline constexpr Stage stages[] = {Stage::motion, Stage::slides, Stage::slide_directions, Stage::trigger};

struct Rows {
  GUMSHOE_NAMED(Quantities, distance, expansion, temperature_difference);
  GUMSHOE_NAMED(Conditions, x_1, y_1, z_1, x_2, y_2, z_2, feed, direction, time);
  GUMSHOE_NAMED(Indications, X_1, Y_1, Z_1, X_2, Y_2, Z_2);
  GUMSHOE_NAMED(Measurands, distance);
};
template <class T> using At = Reading<Rows, T>;

template <class T> Vector3<T> first(const At<T>& at) { return {at.c.x_1, at.c.y_1, at.c.z_1}; }
template <class T> Vector3<T> second(const At<T>& at) { return {at.c.x_2, at.c.y_2, at.c.z_2}; }
template <class T> T length(const Vector3<T>& v) { return num::sqrt(dot(v, v)); }
template <class T> T growth(const At<T>& at) { return 1.0 + at.q.expansion * at.q.temperature_difference; }

/// A ball probed where `commanded` is, with all freed effects applied.
template <class T> chain::ProbingEvent<T> touch(const At<T>& at, const Vector3<T>& commanded) {
  chain::ProbingEvent<T> event;
  event.x = {.position = commanded.x, .direction = at.c.direction, .feed = at.c.feed};
  event.y = {.position = commanded.y, .direction = at.c.direction, .feed = at.c.feed};
  event.z = {.position = commanded.z, .direction = at.c.direction, .feed = at.c.feed};
  event.time = at.c.time;
  at.freed.act(event);
  return event;
}

struct BallDistance {
  using Rows = ball_distance::Rows;
  static constexpr ModelCard card{
      .name = "ball_distance",
      .title = "Distance between two balls on a machine with three slides",
      .summary = "Two balls on a bar are probed one after the other; the distance of their centres follows.",
      .source = "an example",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages};

  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>&) {
    const Vector3<T> a = first(at), along = second(at) - a;
    const Vector3<T> b = a + at.q.distance * growth(at) / length(along) * along;
    const auto read_a = chain::reading_of(a, touch(at, a)), read_b = chain::reading_of(b, touch(at, second(at)));
    return {{read_a.x, read_a.y, read_a.z, read_b.x, read_b.y, read_b.z}, {at.q.distance}};
  }

  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>&) {
    const Vector3<T> a = chain::actual_of(Vector3<T>{read.X_1, read.Y_1, read.Z_1}, touch(at, first(at)));
    const Vector3<T> b = chain::actual_of(Vector3<T>{read.X_2, read.Y_2, read.Z_2}, touch(at, second(at)));
    return {length<T>(b - a) / growth(at)};
  }
};

} // namespace gumshoe::models::ball_distance
