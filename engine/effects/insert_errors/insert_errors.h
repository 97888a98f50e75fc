#pragma once
#include "chain/turning_tool.h"
#include "effects/part.h"

namespace gumshoe::effects {

/// An error that each insert has of its own, added to the member of its deviation that `of` picks.
template <auto of> struct OnEachInsert {
  static constexpr QuantityCard named(std::string_view name, QuantityCard row) {
    row.name = name;
    return row;
  }
  static constexpr QuantityCard length(std::string_view symbol, std::string_view meaning, Typical typical) {
    return {.name = "", .unit = "um", .si_unit = "m", .limits = {-5e-2, 5e-2}, .symbol = symbol, .meaning = meaning,
            .role = Role::amplitude, .typical = typical};
  }
  static constexpr QuantityCard angle(std::string_view symbol, double limit, std::string_view meaning, Typical typical) {
    return {.name = "", .unit = "deg", .si_unit = "rad", .limits = {-limit, limit}, .symbol = symbol,
            .meaning = meaning, .role = Role::amplitude, .typical = typical};
  }
  static constexpr EffectCard card_of(const Part& part, std::string_view meaning,
                                      std::span<const QuantityCard> quantities) {
    EffectCard card = on(part, {.stage = Stage::insert,
                                .meaning = meaning,
                                .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
                                .quantities = quantities});
    card.follows_derivative = true;
    return card;
  }
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    for (auto& insert : event.turning->insert) of(insert) = of(insert) + *q++;
  }
};
inline constexpr auto radius_of = [](auto& insert) -> auto& { return insert.radius; };
inline constexpr auto tool_radius_of = [](auto& insert) -> auto& { return insert.tool_radius; };
inline constexpr auto azimuth_of = [](auto& insert) -> auto& { return insert.azimuth; };
inline constexpr auto radial_angle_of = [](auto& insert) -> auto& { return insert.radial_angle; };
inline constexpr auto axial_angle_of = [](auto& insert) -> auto& { return insert.axial_angle; };

#define GUMSHOE_RADIUS(k) named("radius_" #k, each)
#define GUMSHOE_AZIMUTH(k) named("azimuth_" #k, each)
#define GUMSHOE_ANGLE(k) named("angle_" #k, each)

struct InsertRadiusError : OnEachInsert<radius_of> {
  static constexpr QuantityCard each = length("dR_k", "excess of this insert's cutting-edge radius over insert_radius",
                                              {12e-6, 75e-6, "ISO 1832, classes G and M"});
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_RADIUS)};
  static constexpr EffectCard card =
      card_of({.name = "insert_radius_error", .title = "Radius error of each insert",
               .adds = "insert k: radius += radius_k",
               .confused_with = "insert_radius, exactly, if all are equal; hardly visible in the height while the "
                                "lowest point triggers"},
              "The radius of an insert's cutting edge differs from insert_radius. Its virtual cutting point stays in "
              "place: the edge still touches tool_radius outside and the tool's end below, as with insert_radius "
              "itself. For an insert that protrudes from its pocket, also use insert_seat_error and a negative wear.",
              quantities);
};

struct InsertSeatError : OnEachInsert<tool_radius_of> {
  static constexpr QuantityCard each =
      length("dr_k", "additional distance of this insert from the tool's axis", {5e-6, 20e-6});
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_RADIUS)};
  static constexpr EffectCard card =
      card_of({.name = "insert_seat_error", .title = "Radial seat error of each insert",
               .adds = "insert k: tool_radius += radius_k",
               .confused_with = "tool_radius, exactly, if all are equal; tool_runout (one cosine over all inserts); "
                                "insert_radius_error"},
              "An insert is farther from the tool's axis than tool_radius (radial run-out of one insert). Its axial "
              "position is given by its wear.",
              quantities);
};

struct InsertPitchError : OnEachInsert<azimuth_of> {
  static constexpr QuantityCard each =
      angle("dpsi_k", 3.2, "angle of this insert's seat ahead of even spacing, counter-clockwise",
            {0.02 * degree, 0.2 * degree, "degrees in differential-pitch cutters"});
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_AZIMUTH)};
  static constexpr EffectCard card =
      card_of({.name = "insert_pitch_error", .title = "Angular seat error of each insert",
               .adds = "insert k: azimuth += azimuth_k",
               .confused_with = "holder_angle, exactly, if all are equal; the start of the feed"},
              "The seats of the inserts are not evenly spaced: the azimuth is larger by this angle. Also describes "
              "the spacing of a cutter with differential pitch.",
              quantities);
};

struct InsertRadialAngleError : OnEachInsert<radial_angle_of> {
  static constexpr QuantityCard each = angle(
      "dtheta_rk", 1.5, "excess of this insert's radial angle over insert_radial_angle", {0.05 * degree, 0.5 * degree});
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ANGLE)};
  static constexpr EffectCard card =
      card_of({.name = "insert_radial_angle_error", .title = "Radial angle error of each insert",
               .adds = "insert k: radial_angle += angle_k",
               .confused_with = "insert_radial_angle, exactly, if all are equal"},
              "The radial angle of an insert's rake face, turned about its virtual cutting point, differs from "
              "insert_radial_angle.",
              quantities);
};

struct InsertAxialAngleError : OnEachInsert<axial_angle_of> {
  static constexpr QuantityCard each = angle(
      "dtheta_ak", 1.5, "excess of this insert's axial angle over insert_axial_angle", {0.05 * degree, 0.5 * degree});
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ANGLE)};
  static constexpr EffectCard card =
      card_of({.name = "insert_axial_angle_error", .title = "Axial angle error of each insert",
               .adds = "insert k: axial_angle += angle_k",
               .confused_with = "insert_axial_angle, exactly, if all are equal"},
              "The axial angle of an insert's rake face, turned about its virtual cutting point, differs from "
              "insert_axial_angle.",
              quantities);
};

#undef GUMSHOE_RADIUS
#undef GUMSHOE_AZIMUTH
#undef GUMSHOE_ANGLE

} // namespace gumshoe::effects
