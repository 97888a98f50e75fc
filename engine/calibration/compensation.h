#pragma once
/// What a control can take back: errors of a fitted scenario that come back with the position and the direction of one
/// axis.
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::calibration {

struct CompensationRequest {
  std::string indication;           ///< the deviation, actual minus commanded; empty: the only one
  std::string position, direction;  ///< conditions; empty: found, direction by its name
  std::vector<std::string> with;    ///< quantities of the model whose estimates count, too, such as a gain
  std::vector<std::string> without; ///< effects to leave out
  std::vector<std::string> only;    ///< the effects and quantities that count, each direction apart; empty: all
};

/// Error at a position, approached upwards (+1), downwards (-1) or from either side (0).
struct CompensationRow {
  double position = 0; ///< m or rad
  int direction = 0;
  double error = 0, u = 0; ///< actual minus commanded, of the indication; SI
  double u_of_sizes = 0;   ///< without the declared quantities that the values of the sizes depend on
};

struct Compensation {
  std::string position, direction, indication; ///< names; direction is empty where it makes no difference
  std::string position_si_unit, indication_si_unit;
  std::vector<CompensationRow> rows; ///< by position; where there are directions, up before down
  /// The same errors at positions without readings, where the model knows them; filled by the caller (errors_at).
  std::vector<CompensationRow> between;
  std::vector<std::string> holds;    ///< effects and quantities that are in it
  struct LeftOut {
    std::string name, why; ///< "also depends on ..."
  };
  std::vector<LeftOut> left_out;
  std::vector<std::string> set_up; ///< quantities of the model that are taken for the set-up's: left out, and no error
  /// A declared quantity on which the errors depend, directly or because the fit of their sizes held it.
  struct Declared {
    std::string name;
    double most = 0;       ///< its contribution to u at the position where that is largest, SI
    bool contained = true; ///< else it is not in u: the readings of the fit, or their noise, are not in the scenario
  };
  std::vector<Declared> declared; ///< the largest first
  /// What a reading deviates by: what effects and the quantities asked for explain, or nothing does; what the model
  /// takes for the set-up's is none of it. SI.
  struct Deviation {
    double position = 0;
    int direction = 0;
    double as_read = 0;
    double unexplained = 0; ///< of that
    double repeats = 1;
  };
  struct Group {
    std::string which; ///< "these readings", "held-out readings (cycle 5)"
    std::vector<Deviation> readings;
  };
  std::vector<Group> groups; ///< all readings, and those of [trace] final; none is empty
  /// Whether the errors change so much from one position to the next that a control, which interpolates, may make them
  /// worse in between: neighbours tell little of the error between them.
  bool coarse = false;
};

/// "shape_1" of its part "shape_1_18"; any other name as it is.
std::string whole_of(const std::string& name);

/// Errors of the effects with a size, at the positions of the scenario's readings: what the simulated indication loses
/// when the sizes are at null; u by the law of propagation from the sizes' uncertainties and correlations, and from
/// those of the declared quantities that the errors depend on. An effect that also depends on anything else (time, a
/// temperature, a label) is left out. Throws InputError if nothing remains, or the conditions are not clear.
Compensation compensation(const propagation::Experiment& experiment, const CompensationRequest& request);

} // namespace gumshoe::calibration
