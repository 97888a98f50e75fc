#pragma once
#include "effects/part.h"

namespace gumshoe::effects {

/// Rows of the errors across a slide, and what its guideway adds to the two others.
struct Straightness {
  static constexpr QuantityCard row(std::string_view symbol, std::string_view meaning) {
    return {.name = symbol, .unit = "um/m2", .si_unit = "1/m", .limits = {-1e-1, 1e-1}, .symbol = symbol,
            .meaning = meaning, .role = Role::amplitude, .typical = {2e-5, 2e-4}};
  }
  static constexpr QuantityCard x(std::string_view symbol) { return row(symbol, "along X, per position squared"); }
  static constexpr QuantityCard y(std::string_view symbol) { return row(symbol, "along Y, per position squared"); }
  static constexpr QuantityCard z(std::string_view symbol) { return row(symbol, "along Z, per position squared"); }
  static constexpr EffectCard card(std::string_view name, std::string_view title, std::string_view symbols,
                                   std::string_view adds, std::span<const QuantityCard> quantities) {
    return {.name = name,
            .title = title,
            .stage = Stage::slides,
            .iso230 = symbols,
            .meaning = "The guideway is bowed: actual minus commanded position across it grows with the square of the "
                       "commanded position along it. 80 um/m2 give 5 um over 0.5 m. The linear part is squareness.",
            .adds = adds,
            .confused_with = "second harmonics of C, as a square is one on a circle; squareness and offsets over a "
                             "short travel",
            .source = "engineering knowledge; ISO 230-1",
            .quantities = quantities};
  }
  template <class T>
  static void add(const T* q, const chain::Slide<T>& along, chain::Slide<T>& first, chain::Slide<T>& second) {
    const T square = along.position * along.position;
    first.error = first.error + q[0] * square;
    second.error = second.error + q[1] * square;
  }
};

struct XStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::y("E_YX"), Straightness::z("E_ZX")};
  static constexpr EffectCard card = Straightness::card(
      "x_straightness", "Straightness of X", "E_YX, E_ZX", "y.error += E_YX x^2; z.error += E_ZX x^2", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& e) { Straightness::add(q, e.x, e.y, e.z); }
};

struct YStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::x("E_XY"), Straightness::z("E_ZY")};
  static constexpr EffectCard card = Straightness::card(
      "y_straightness", "Straightness of Y", "E_XY, E_ZY", "x.error += E_XY y^2; z.error += E_ZY y^2", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& e) { Straightness::add(q, e.y, e.x, e.z); }
};

struct ZStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::x("E_XZ"), Straightness::y("E_YZ")};
  static constexpr EffectCard card = Straightness::card(
      "z_straightness", "Straightness of Z", "E_XZ, E_YZ", "x.error += E_XZ z^2; y.error += E_YZ z^2", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& e) { Straightness::add(q, e.z, e.x, e.y); }
};

} // namespace gumshoe::effects
