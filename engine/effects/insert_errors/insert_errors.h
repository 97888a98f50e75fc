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
      .symbol = "dR_k", .meaning = "excess of this insert's cutting-edge radius over insert_radius",
      .role = Role::amplitude, .typical = {12e-6, 75e-6, "ISO 1832, classes G and M"}};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_radius_error",
      .title = "Radius error of each insert",
      .stage = Stage::insert,
      .meaning = "The radius of an insert's cutting edge differs from insert_radius. Its virtual cutting point stays "
                 "in place: "
                 "the edge still touches tool_radius outside and the tool's end below, as with insert_radius itself. "
                 "For an insert that protrudes from its pocket, also use insert_seat_error and a negative wear.",
      .adds = "insert k: radius += radius_k",
      .confused_with = "insert_radius, exactly, if all are equal; hardly visible in the height while the lowest point "
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
      .symbol = "dr_k", .meaning = "additional distance of this insert from the tool's axis",
      .role = Role::amplitude, .typical = {5e-6, 20e-6}};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_seat_error",
      .title = "Radial seat error of each insert",
      .stage = Stage::insert,
      .meaning = "An insert is farther from the tool's axis than tool_radius (radial run-out of one insert). "
                 "Its axial position is given by its wear.",
      .adds = "insert k: tool_radius += radius_k",
      .confused_with = "tool_radius, exactly, if all are equal; tool_runout (one cosine over all inserts); "
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
      .symbol = "dpsi_k", .meaning = "angle of this insert's seat ahead of even spacing, counter-clockwise",
      .role = Role::amplitude, .typical = {0.02 * degree, 0.2 * degree, "degrees in differential-pitch cutters"}};
#define GUMSHOE_ROW(k) named("azimuth_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_pitch_error",
      .title = "Angular seat error of each insert",
      .stage = Stage::insert,
      .meaning = "The seats of the inserts are not evenly spaced: the azimuth is larger by this angle. Also describes "
                 "the spacing of "
                 "a cutter with differential pitch.",
      .adds = "insert k: azimuth += azimuth_k",
      .confused_with = "holder_angle, exactly, if all are equal; the start of the feed",
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
      .symbol = "dtheta_rk", .meaning = "excess of this insert's radial angle over insert_radial_angle",
      .role = Role::amplitude, .typical = {0.05 * degree, 0.5 * degree}};
#define GUMSHOE_ROW(k) named("angle_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_radial_angle_error",
      .title = "Radial angle error of each insert",
      .stage = Stage::insert,
      .meaning = "The radial angle of an insert's rake face, turned about its virtual cutting point, differs from "
                 "insert_radial_angle.",
      .adds = "insert k: radial_angle += angle_k",
      .confused_with = "insert_radial_angle, exactly, if all are equal",
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
      .symbol = "dtheta_ak", .meaning = "excess of this insert's axial angle over insert_axial_angle",
      .role = Role::amplitude, .typical = {0.05 * degree, 0.5 * degree}};
#define GUMSHOE_ROW(k) named("angle_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      .name = "insert_axial_angle_error",
      .title = "Axial angle error of each insert",
      .stage = Stage::insert,
      .meaning = "The axial angle of an insert's rake face, turned about its virtual cutting point, differs from "
                 "insert_axial_angle.",
      .adds = "insert k: axial_angle += angle_k",
      .confused_with = "insert_axial_angle, exactly, if all are equal",
      .source = insert_source,
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::axial_angle);
  }
};

} // namespace gumshoe::effects
