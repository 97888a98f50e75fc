#pragma once
/// Flute heights and phase of a characteristic curve from readings at several start angles, by least squares.
///
/// In the frame of the spindle, flute k is a curve F_k (trigger/trigger_curve.h) at its height H_k; reading i descends
/// on a line that is known except for the phase, which all readings share, and shows the flute that triggers first:
///     height_i = max over k of H_k + F_k(line_ik + phase - H_k).
/// README.md has the mathematics.
#include <array>
#include <vector>

#include "models/tool_length/trigger/insert_trigger.h"
#include "models/tool_length/trigger/trigger_curve.h"

namespace gumshoe::models::tool_length {

/// What the fit reads; the curves must outlive it.
struct CurveReadings {
  std::size_t readings = 0, flutes = 0;
  double drop = 0;                         ///< m per rad; of all readings, about
  std::vector<const TriggerCurve*> curves; ///< [reading][flute]
  std::vector<double> lines;               ///< [reading][flute], m
  std::vector<double> heights;             ///< [reading], m
  bool alike = false; ///< flutes differ in nothing but height, evenly spread: a phase of a flute's pitch renumbers them
};

struct CurveFit {
  bool converged = false;
  double phase = 0;                                  ///< m, from 0 to one turn's descent
  std::array<double, chain::most_inserts> heights{}; ///< H_k, m; of a hidden flute the greatest that readings allow
  std::array<bool, chain::most_inserts> seen{};      ///< needed to explain the readings
  double squares = 0;                                ///< sum of squared residuals, m^2
};

/// The phase and the heights of least squares, from the best of a scan of the phase over one turn. Flutes that the
/// readings do not need (README.md) are hidden. Not converged: the descent still gained when its steps were used up.
CurveFit fit_curve(const CurveReadings& data);

} // namespace gumshoe::models::tool_length
