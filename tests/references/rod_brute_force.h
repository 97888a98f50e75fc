#pragma once
/// Brute-force twin of the rod-gauging solve: shares no formula with the engine.
///
/// The rod's surface is sampled in space, projected along the beam, and its hull is a polygon; the
/// covered area is the exact intersection of that polygon with the beam's disc; the height is found by
/// bisection. An inscribed polygon covers too little, so heights come out too low, by at most `error`.

namespace gumshoe::references {

/// How the rounded rod is sampled; the two agree because the fillet is swept by a rolling ball.
enum class Construction {
  rolling_ball,   ///< centres of the ball along C_in (Fang 2022, eq. 2.9), then a disc at every centre
  fillet_surface, ///< points of the swept fillet itself (eqs 2.12 to 2.17); n^2 points, for coarse checks
};

/// Lengths in m, angles in rad, `fraction` in (0, 1).
struct RodCase {
  double rod_radius, fillet_radius, bottom_elevation, bottom_azimuth, holder_angle;
  double beam_yaw, beam_pitch, beam_radius, fraction;
};

struct BruteForceHeight {
  double height; ///< Z'_d in m; not a number where the rod cannot cover that much
  double error;  ///< bound on |height - true height| in m, from the spacing of the samples: O(samples^-2)
};

/// @param samples points round the rod and round the ball; the error falls as samples^-2
BruteForceHeight brute_force_bottom_height(const RodCase& rod, int samples,
                                           Construction construction = Construction::rolling_ball);

} // namespace gumshoe::references
