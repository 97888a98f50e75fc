#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The brake turns a rotary axis as it closes.
struct BrakeShift {
  static constexpr QuantityCard quantities[] = {
      {"angle",
       "arcsec",
       "rad",
       0.0,
       {-1e-2, 1e-2},
       "",
       "turn of the axis when its brake holds",
       Role::amplitude,
       "1-5 arcsec"},
  };
  static constexpr EffectCard card(std::string_view name, std::string_view title, int rank, std::string_view symbol,
                                   std::string_view confused_with) {
    return {name,          title,
            "rotary",      rank,
            symbol,        "The axis is turned by an angle where its brake holds (condition clamped = 1).",
            confused_with, "engineering knowledge",
            quantities};
  }
  template <class T> static void add(const T* q, const T& clamped, T& error) { error = error + clamped * q[0]; }
};

struct BBrakeShift {
  static constexpr EffectCard card =
      BrakeShift::card("b_brake_shift", "Shift of the B axis by its brake", 40, "E_BB",
                       "b_axis_reversal; what differs between the patterns if the brake closes in one of them");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    BrakeShift::add(q, r.B_clamped, r.B_error[chain::E_B]);
  }
};

struct CBrakeShift {
  static constexpr EffectCard card =
      BrakeShift::card("c_brake_shift", "Shift of the C axis by its brake", 41, "E_CC",
                       "c_axis_reversal; what differs between the patterns if the brake closes in one of them");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    BrakeShift::add(q, r.C_clamped, r.C_error[chain::E_C]);
  }
};

} // namespace gumshoe::effects
