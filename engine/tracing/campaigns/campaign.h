#pragma once
/// What one campaign (one trace of one set of readings) says of each effect, in numbers that add up over campaigns.
#include <string>
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

/// A size that a score is about.
struct ScoredSize {
  std::string name, unit, si_unit; ///< name in a scenario: "z_reversal.backlash"
};

/// How one signature g agrees with the residuals r. W is the inverse of their covariance, from which every fitted column
/// is projected, so that g'Wr = 0 for a column of J.
struct Score {
  std::string candidate; ///< "z_reversal"
  int variant = 0;       ///< by the shape parameter that is held (a time constant), in the order tried
  std::vector<ScoredSize> sizes;
  Vector score;       ///< g'Wr, by size
  Matrix information; ///< g'Wg
};

struct Campaign {
  std::string id; ///< hash of the readings, whatever the scenario makes of them
  std::string title, date;
  int readings = 0;
  double squares = 0; ///< r'Wr, without any effect
  double freedom = 0; ///< readings less unknowns
  std::vector<Score> scores;
  std::string model = {}, model_title = {}; ///< by name; empty in histories of older versions
  /// What distinguishes models of one name that scenarios describe, one in a line: title, equations and axes. Empty for a
  /// model of the catalogue, and in histories of older versions.
  std::string model_equations = {};
  std::vector<double> rows = {}; ///< digest of each reading, in the order given; empty in histories of older versions
};

} // namespace gumshoe::tracing
