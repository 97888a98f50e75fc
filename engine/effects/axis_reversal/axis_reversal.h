#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Reversal error of a rotary axis. It lags half the reversal value behind its command on either side.
struct AxisReversal {
  static constexpr QuantityCard quantities[] = {
      {"backlash", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "B", "reversal value", Role::amplitude, "1-10 arcsec"},
  };
  static constexpr EffectCard card(std::string_view name, std::string_view title, int rank, std::string_view symbol,
                                   std::string_view confused_with) {
    return {name,
            title,
            "rotary",
            rank,
            symbol,
            "The axis lags half the reversal value behind its command: actual minus commanded is -direction backlash / "
            "2, by the direction from which the angle was reached.",
            confused_with,
            "engineering knowledge; ISO 230-2 for the reversal value",
            quantities};
  }
  template <class T> static void add(const T* q, const T& direction, T& error) {
    error = error - direction * (0.5 * q[0]);
  }
};

struct BAxisReversal {
  static constexpr EffectCard card = AxisReversal::card(
      "b_axis_reversal", "Reversal error of the B axis", 30, "E_BB",
      "E_BB where every angle was reached from one side; time, if the sides were measured one after the other");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    AxisReversal::add(q, r.B_direction, r.B_error[chain::E_B]);
  }
};

struct CAxisReversal {
  static constexpr EffectCard card =
      AxisReversal::card("c_axis_reversal", "Reversal error of the C axis", 31, "E_CC",
                         "any constant turn of the probe where every angle was reached from one side; time, if the "
                         "sides were measured one after the other");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    AxisReversal::add(q, r.C_direction, r.C_error[chain::E_C]);
  }
};

} // namespace gumshoe::effects
