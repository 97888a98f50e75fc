#pragma once
/// Response of readings to a scattering quantity over its values, not by its derivative alone: while a turning mill
/// stays on one tooth, its derivative is nearly zero.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tracing/simulator.h"

namespace gumshoe::tracing {

/// Rows of the simulator.
struct DeclaredResponse {
  Vector slope;    ///< straight line through the readings, per unit of the quantity; empty: the derivative serves
  Vector variance; ///< variance about that line
  Vector offset;   ///< mean of the readings over the draws minus the readings at the point itself
  Matrix table;    ///< rows x nodes: effect of bend_node(j) standard deviations that line and mean leave out; empty: no
                   ///< bend, or not requested
  bool straight() const { return variance.size() == 0; }
};

/// Response over equally likely values of a normal draw of standard deviation `u` (SI) about `at`.
/// @param tabled  also tabulates the deviation from the line
DeclaredResponse declared_response(const Simulator& simulator, const Points& at, std::size_t quantity, double u,
                                   bool tabled);

/// Rows x nodes, SI: response of the readings to bend_node(j), if a draw of one changes the typical reading by `u`
/// along the straight line. Empty if the response is straight.
Matrix bent_response(const Simulator& simulator, const Points& at, std::size_t quantity, double u);

/// Draws at which bends are tabulated, in standard deviations.
inline constexpr Index bend_middle = 50, bend_nodes = 2 * bend_middle + 1;
inline double bend_node(Index j) { return 0.1 * static_cast<double>(j - bend_middle); }
inline Index nearest_bend_node(double z) {
  return std::clamp<Index>(std::lround((z - bend_node(0)) / 0.1), 0, bend_nodes - 1);
}

/// Quantity of the effect that scatters between clampings, where the model has one and the scenario leaves it at null.
std::optional<std::size_t> seat_at_null(const propagation::Experiment& experiment);

} // namespace gumshoe::tracing
