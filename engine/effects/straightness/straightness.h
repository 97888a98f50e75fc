#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A bowed guideway: its slide strays across by the square of its position.
struct Straightness {
  static constexpr QuantityCard along(std::string_view symbol, std::string_view meaning) {
    return {symbol, "um/m2", "1/m", 0.0, {-1e-1, 1e-1}, symbol, meaning, Role::amplitude, "20-200 um/m2"};
  }
  static constexpr QuantityCard x(std::string_view symbol) {
    return along(symbol, "along X, per square of the position");
  }
  static constexpr QuantityCard y(std::string_view symbol) {
    return along(symbol, "along Y, per square of the position");
  }
  static constexpr QuantityCard z(std::string_view symbol) {
    return along(symbol, "along Z, per square of the position");
  }
  static constexpr EffectCard card(std::string_view name, std::string_view title, int rank, std::string_view symbols,
                                   std::span<const QuantityCard> quantities) {
    return {name,
            title,
            "slides",
            rank,
            symbols,
            "The guideway is bowed: actual minus commanded position across it grows with the square of the commanded "
            "position along it. 80 um/m2 are 5 um over 0.5 m. What is linear is squareness.",
            "second harmonics of C, as a square is one on a circle; squareness and offsets over a short travel",
            "engineering knowledge; ISO 230-1",
            quantities};
  }
};

struct XStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::y("E_YX"), Straightness::z("E_ZX")};
  static constexpr EffectCard card =
      Straightness::card("x_straightness", "Straightness of X", 30, "E_YX, E_ZX", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T square = r.position.x * r.position.x;
    r.Y.error = r.Y.error + q[0] * square;
    event.axis_error = event.axis_error + q[1] * square;
  }
};

struct YStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::x("E_XY"), Straightness::z("E_ZY")};
  static constexpr EffectCard card =
      Straightness::card("y_straightness", "Straightness of Y", 31, "E_XY, E_ZY", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T square = r.position.y * r.position.y;
    r.X.error = r.X.error + q[0] * square;
    event.axis_error = event.axis_error + q[1] * square;
  }
};

struct ZStraightness {
  static constexpr QuantityCard quantities[] = {Straightness::x("E_XZ"), Straightness::y("E_YZ")};
  static constexpr EffectCard card =
      Straightness::card("z_straightness", "Straightness of Z", 32, "E_XZ, E_YZ", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T square = r.position.z * r.position.z;
    r.X.error = r.X.error + q[0] * square;
    r.Y.error = r.Y.error + q[1] * square;
  }
};

} // namespace gumshoe::effects
