#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The same row under another name.
constexpr QuantityCard named(std::string_view name, QuantityCard row) {
  row.name = name;
  return row;
}

template <class T> void add_to_inserts(const T* q, chain::ProbingEvent<T>& event, T chain::InsertDeviation<T>::*field) {
  for (auto& insert : event.turning->insert) insert.*field = insert.*field + *q++;
}

inline constexpr std::string_view insert_source = "engineering knowledge; Fang 2022, chapter 3 for the measurement";

struct InsertRadiusError {
  static constexpr QuantityCard each{
      .name = "", .unit = "um", .si_unit = "m", .limits = {-5e-2, 5e-2},
      .symbol = "dR_k", .meaning = "this insert's cutting edge has a radius larger by this",
      .role = Role::amplitude, .typical = {12e-6, 75e-6, "ISO 1832, classes G and M"}};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_radius_error",
      .title = "Radius of each insert",
      .stage = Stage::insert,
      .meaning = "An insert's cutting edge has another radius than insert_radius. Its virtual cutting point stays: "
                 "the edge still touches tool_radius outside and the tool's end below, as with insert_radius itself. "
                 "An insert that stands out of its pocket has insert_seat_error and a negative wear as well.",
      .adds = "insert k: radius += radius_k",
      .confused_with = "insert_radius, exactly, where all are equal; hardly seen in the height while the lowest point "
                       "triggers",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::radius);
  }
};

struct InsertSeatError {
  static constexpr QuantityCard each{
      .name = "", .unit = "um", .si_unit = "m", .limits = {-5e-2, 5e-2},
      .symbol = "dr_k", .meaning = "this insert sits farther from the tool's axis by this",
      .role = Role::amplitude, .typical = {5e-6, 20e-6}};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_seat_error",
      .title = "Radial seat of each insert",
      .stage = Stage::insert,
      .meaning = "An insert sits farther from the tool's axis than tool_radius says (radial run-out of one insert). "
                 "Its axial seat is its wear.",
      .adds = "insert k: tool_radius += radius_k",
      .confused_with = "tool_radius, exactly, where all are equal; tool_runout (one cosine over all inserts); "
                       "insert_radius_error",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::tool_radius);
  }
};

struct InsertPitchError {
  static constexpr QuantityCard each{
      .name = "", .unit = "deg", .si_unit = "rad", .limits = {-3.2, 3.2},
      .symbol = "dpsi_k", .meaning = "this insert's seat is ahead of its even spacing by this, counter-clockwise",
      .role = Role::amplitude, .typical = {0.02 * degree, 0.2 * degree, "degrees in differential-pitch cutters"}};
#define GUMSHOE_ROW(k) named("azimuth_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_pitch_error",
      .title = "Angular seat of each insert",
      .stage = Stage::insert,
      .meaning = "An insert's seat is not evenly spaced: its azimuth is larger by this. It also states the spacing of "
                 "a cutter with differential pitch.",
      .adds = "insert k: azimuth += azimuth_k",
      .confused_with = "holder_angle, exactly, where all are equal; the start of the feed",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::azimuth);
  }
};

struct InsertRadialAngleError {
  static constexpr QuantityCard each{
      .name = "", .unit = "deg", .si_unit = "rad", .limits = {-1.5, 1.5},
      .symbol = "dtheta_rk", .meaning = "this insert's radial angle is larger by this",
      .role = Role::amplitude, .typical = {0.05 * degree, 0.5 * degree}};
#define GUMSHOE_ROW(k) named("angle_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_radial_angle_error",
      .title = "Radial angle of each insert",
      .stage = Stage::insert,
      .meaning = "An insert's rake face has another radial angle than insert_radial_angle, turned about its virtual "
                 "cutting point.",
      .adds = "insert k: radial_angle += angle_k",
      .confused_with = "insert_radial_angle, exactly, where all are equal",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::radial_angle);
  }
};

struct InsertAxialAngleError {
  static constexpr QuantityCard each{
      .name = "", .unit = "deg", .si_unit = "rad", .limits = {-1.5, 1.5},
      .symbol = "dtheta_ak", .meaning = "this insert's axial angle is larger by this",
      .role = Role::amplitude, .typical = {0.05 * degree, 0.5 * degree}};
#define GUMSHOE_ROW(k) named("angle_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_axial_angle_error",
      .title = "Axial angle of each insert",
      .stage = Stage::insert,
      .meaning = "An insert's rake face has another axial angle than insert_axial_angle, turned about its virtual "
                 "cutting point.",
      .adds = "insert k: axial_angle += angle_k",
      .confused_with = "insert_axial_angle, exactly, where all are equal",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::axial_angle);
  }
};

} // namespace gumshoe::effects
