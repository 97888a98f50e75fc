#pragma once
/// The closed forms of Fang 2022, corrected, for the reproduction study only: the commands at the sphere's top to first
/// order in the location errors. Pattern I: B = 0, eqs 4.23 to 4.25. Pattern II: C = 90 deg, eqs 4.30 to 4.38.
#include "models/sphere_calibration/probe.h"

namespace gumshoe::models::sphere_calibration {

/// eq 4.38 as corrected, or as printed: without probe_z E_A0B.
enum class Equation438 { corrected, printed };

/// The probe from the commanded origin at B = 0; eqs 4.17 to 4.21. @param C rad
template <class T> Vector3<T> closed_form_I(const T* length, const Orientation<T>& e, const T& C) {
  const T &x = length[length_probe_x], &y = length[length_probe_y], &z = length[length_probe_z];
  const T &cx = length[length_C_x], &cy = length[length_C_y];
  const T q1 = x - cx + e.B0C * z, q2 = cy + y + e.A0C * z;
  const T q3 = e.B0C * (cx - x) - e.A0C * (y + cy), q4 = e.A0C * (x - cx) - e.B0C * (cy + y);
  const T c = num::cos(C), s = num::sin(C);
  return {q1 * c + q2 * s + cx - e.B0C * z, q1 * s - q2 * c + cy + e.A0C * z,
          q3 * c + q4 * s - z + e.A0C * (y + cy) - e.B0C * (cx - x)};
}

/// The same at C = 90 deg; eqs 4.30 to 4.38. @param B rad
template <class T>
Vector3<T> closed_form_II(const T* length, const Orientation<T>& e, const T& B,
                          Equation438 equation = Equation438::corrected) {
  const T &x = length[length_probe_x], &y = length[length_probe_y], &z = length[length_probe_z];
  const T &bx = length[length_B_x], &bz = length[length_B_z], &cx = length[length_C_x], &cy = length[length_C_y];
  const T q5 = cy - cx + x, reach = bx - cx - cy - y;
  const T q6 = reach + (e.B0C - e.A0C) * z - e.C0B * q5;
  const T q7 = z - bz + e.A0B * q5 - e.A0C * (q5 + y) + e.B0C * (cx + cy - x + y);
  const T q8 = e.A0B * (bz - z) + e.C0B * reach, q9 = e.C0B * (z - bz) + e.A0B * reach;
  const T lost = equation == Equation438::corrected ? z : T(0.0);
  const T q10 = (lost - bz) * e.A0B - z * (e.A0C + e.B0C) - reach * e.C0B - q5;
  const T c = num::cos(B), s = num::sin(B);
  return {bx - q6 * c - q7 * s - e.C0B * q5, -(q8 * c + q9 * s + q10), q6 * s - q7 * c - bz + e.A0B * q5};
}

} // namespace gumshoe::models::sphere_calibration
