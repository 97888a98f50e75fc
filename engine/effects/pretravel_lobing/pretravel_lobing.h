#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct PretravelLobing {
  static constexpr QuantityCard quantities[] = {
      {.name = "cosine", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .symbol = "a_3",
       .meaning = "lobe for an approach along the probe's X", .role = Role::pair, .typical = {1e-6, 10e-6}},
      {.name = "sine", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .symbol = "a_3",
       .meaning = "lobe for an approach 30 deg from X towards Y", .role = Role::pair, .typical = {1e-6, 10e-6}},
  };
  static constexpr EffectCard card{
      .name = "pretravel_lobing",
      .title = "Lobing of the probe's pretravel",
      .stage = Stage::contact,
      .meaning = "The three supports of a kinematic seat give pretravel three lobes over the approach's azimuth phi "
                 "in the probe's frame, which turns with B and C: sin^3(theta) (cosine cos 3 phi + sine sin 3 phi), "
                 "with theta from the stylus. The sines keep it smooth for an approach along the stylus: at the top "
                 "of a sphere it acts only if B has turned the probe.",
      .adds = "pretravel += sin^3 theta (cosine cos 3 phi + sine sin 3 phi) (phi: azimuth of the approach)",
      .confused_with = "harmonics of C, form of the sphere; pretravel_bending while C stands still",
      .source = "Estler et al. 1996, Precision Engineering (three lobes of a kinematic seat); the smooth shape: "
                "engineering knowledge",
      .quantities = quantities};
  /// Lobes of an approach along u, in the probe's frame.
  template <class T> static T lobes(const T* q, const Vector3<T>& u) {
    const T c = u.x * u.x, s = u.y * u.y;
    return q[0] * (u.x * (c - 3.0 * s)) + q[1] * (u.y * (3.0 * c - s));
  }
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.pretravel = event.pretravel + lobes(q, event.approach_in_probe);
  }
};

/// Centre of two touches from opposite sides along X: (x_1 + x_2) / 2, of which each is a pretravel f(u) too far along
/// its approach u. Lobes are odd, f(-u) = -f(u), so the centre lies f(u) too far; what is even cancels.
struct CentreLobing {
  static constexpr EffectCard card{
      .name = "centre_lobing",
      .title = "Lobing of centres found from four touches",
      .stage = Stage::contact,
      .meaning = "X and Y of a centre are the middles of two touches from opposite sides. The three lobes of a "
                 "kinematic seat do not cancel: at B = 0, X reads too far by cosine cos 3C - sine sin 3C and Y by "
                 "-(cosine sin 3C + sine cos 3C).",
      .adds = "x.error -= lobes of an approach along X; y.error -= lobes of one along Y",
      .confused_with = "third harmonics of C; c_radial_motion and squareness over few angles",
      .source = "Estler et al. 1996, Precision Engineering (three lobes of a kinematic seat); the middles: derived",
      .quantities = PretravelLobing::quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const T B = event.rotary->B.angle, C = event.rotary->C.angle;
    const T cB = num::cos(B), sB = num::sin(B), cC = num::cos(C), sC = num::sin(C);
    // Rz(-C) Ry(-B) of the machine's X and Y.
    event.x.error = event.x.error - PretravelLobing::lobes(q, Vector3<T>{cB * cC, -(cB * sC), sB});
    event.y.error = event.y.error - PretravelLobing::lobes(q, Vector3<T>{sC, cC, T(0.0)});
  }
};

} // namespace gumshoe::effects
