#pragma once
/// The section [plan]: which of the allowed further readings reach its goals at least cost?
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "quantities/input_quantity.h"

namespace gumshoe::scenario {

/// A reading that may be taken, again and again.
struct AllowedReading {
  quantities::Labels labels;
  std::vector<double> conditions; ///< SI, by position in the model's card
  std::vector<double> columns;    ///< SI, by position in TraceOptions::columns
  double cost = 1;
};

/// A column of the table in which planned readings are written, to be filled in at the machine.
struct PlanColumn {
  enum class Holds { label, condition, nothing };
  std::string header;
  Holds holds = Holds::nothing; ///< nothing: what is read or recorded
  std::string label = {};
  std::size_t condition = 0; ///< by position in the model's card
  std::string unit = "1", si_unit = "1";
  std::vector<std::pair<std::string, double>> words = {}; ///< words that stand for values, SI
};

struct Plan {
  std::vector<AllowedReading> readings;                      ///< at least one
  std::vector<std::pair<std::string, double>> setup_costs;   ///< by label: cost of a value that no reading has yet
  int most = 20;                                             ///< further readings
  std::optional<double> budget;                              ///< of all costs
  double cost = 1;                                           ///< of a reading that states none
  double power = 0.9;                                        ///< probability of a split or a detection
  double alpha = 0.001;                                      ///< false-alarm rate of one test
  std::vector<std::string> split;                            ///< effects to be distinguished, each from every other
  std::vector<std::string> detect;                           ///< effects to be detected
  std::vector<std::pair<std::string, double>> sizes;         ///< by effect: assumed size, SI
  std::vector<std::pair<std::string, double>> uncertainties; ///< by quantity: target standard uncertainty, SI
  std::vector<PlanColumn> columns;                           ///< as in the data file, if there is one
  /// Without a goal of these, the plan is D-optimal for the free unknowns.
  bool d_optimal() const { return split.empty() && detect.empty() && uncertainties.empty(); }
};

} // namespace gumshoe::scenario
