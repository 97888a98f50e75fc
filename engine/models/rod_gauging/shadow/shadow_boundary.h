#pragma once
/// The general trigger solve: any rod and beam, thin pins, ball ends and sharp corners included.
///
/// The boundary of the rod's shadow is followed from the left wall over the edge to the right wall.
/// Its crossings with the beam's circle are isolated between the stationary points of the distance to
/// the beam's axis (roots of a trigonometric polynomial of degree two, found with rigorous bounds),
/// and the covered area follows from Green's theorem in closed form but for one arc length.
#include <vector>

#include "models/rod_gauging/shadow/shadow.h"

namespace gumshoe::models::rod_gauging {

/// In the order of travel; interior (metal) to the left. A fan is a corner of the shrunk body, where
/// only the normal turns; a quarter is one half of the half-ellipse.
enum class Piece { left_wall, left_fan, left_quarter, right_quarter, right_fan, right_wall };

/// Where the boundary meets the circle. The parameter is z on a wall, the normal's angle nu on a fan,
/// and pi/2 - |w| on a quarter, so that the corners of flat bottoms are resolved to full precision.
struct Crossing {
  Piece piece;
  double t;
};

struct BoundarySolve {
  double k = 0;
  std::vector<Crossing> crossings; ///< entering and leaving in turn; empty if the beam is never covered that much
  Status status = Status::ok;
};

/// The trigger of any edge: the height k, m, at which the shadow covers `fraction` of the disc of radius `beam_radius`
/// (m), and the crossings there. `never_covered` where no height does.
BoundarySolve solve_boundary(const ShadowEdge<double>& edge, double beam_radius, double fraction);

/// Covered area of the beam's disc, m^2, and its slope -d(area)/dk, for given crossings.
template <class T> struct Covered {
  T area;
  T chord;
};

/// Carries derivatives to the root: repeats one Newton step in T for crossings and height, as often
/// as T has levels of derivatives. For plain numbers it returns k as it is.
template <class T>
T refine_height(const ShadowEdge<T>& edge, const T& beam_radius, const T& fraction, const BoundarySolve& solved);

} // namespace gumshoe::models::rod_gauging
