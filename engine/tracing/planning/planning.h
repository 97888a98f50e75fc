#pragma once
/// Which further readings would distinguish effects, detect one, or determine quantities, at least cost? The answer to
/// [plan] of a scenario. Method: README.md of tracing, "Planning".
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "scenario/plan_options.h"
#include "scenario/scenario.h"

namespace gumshoe::tracing {

/// Readings of one kind that are to be taken.
struct PlannedReading {
  std::size_t allowed = 0; ///< by position in scenario::Plan::readings
  int count = 0;
  double cost = 0;     ///< of all of them, set-ups left out
  std::string setting; ///< what differs between the allowed readings: "feed 8 mm/min, setup 4"
};

/// One goal before and after.
struct GoalReached {
  enum class Kind { split, detect, uncertainty, unknown };
  Kind kind = Kind::detect;
  std::string of, against; ///< effect, or quantity; of a split the effect that must not explain it
  std::string unit, si_unit;
  double size = 0;              ///< of the effect as assumed, SI
  double wanted = 0;            ///< power, or standard uncertainty in SI; 0: none
  double before = 0, after = 0; ///< power, or standard uncertainty in SI: infinite where it is not determined
  bool met = false;
  bool possible = true;    ///< false: no number of allowed readings does it
  std::string remark = {}; ///< why not
};
/// "split", "detect", "uncertainty", "unknown"
const char* name(GoalReached::Kind kind);

/// Share of simulated data sets in which `gumshoe trace` finds what it should.
struct Verified {
  std::string of, against; ///< as in GoalReached
  int sets = 0, found = 0;
};

struct Planned {
  std::vector<PlannedReading> readings; ///< cheapest set-ups first, as allowed
  std::vector<GoalReached> goals;
  std::vector<std::string> opened; ///< new set-ups: "setup 4"
  double cost = 0;                 ///< all, set-ups included
  int count = 0;
  bool met = false; ///< every goal; a D-optimal plan: true
  bool d_optimal = false;
  /// Readings are planned that count only where something tells them from others of equal labels and conditions.
  bool repeats = false;
  std::size_t allowed = 0; ///< readings compared
  double gain = 0;         ///< of a D-optimal plan: ln of the determinant of the information, after less before
  /// How the noise of a reading is known: as declared, or from residuals. Unknown: uncertainties are in units of it.
  enum class Noise : unsigned char { unknown, estimated, declared };
  Noise noise = Noise::declared;
  std::vector<Verified> verified;
  std::vector<std::string> notes;
};

struct PlanSettings {
  int threads = 0;
  int verify = 0; ///< simulated data sets of each goal that `gumshoe trace` is tried on
  std::function<void(const std::string& what)> progress = {};
};

/// "unknown", "estimated", "declared"
const char* name(Planned::Noise noise);

/// Plans further readings as [plan] of the scenario asks, which must have one. Throws InputError: an effect that moves
/// no reading, goals that need a noise that nothing tells.
Planned plan(const scenario::Scenario& scenario, const PlanSettings& settings);

} // namespace gumshoe::tracing
