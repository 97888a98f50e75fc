#pragma once
/// Texts of first scenarios, commented, for a user to go on from: `gumshoe new`.
#include <string>
#include <utility>
#include <vector>

#include "base/card.h"
#include "scenario/recognise.h"

namespace gumshoe::scenario {

/// The data that a first scenario is about.
struct StarterData {
  const RecognisedData& found;
  std::string file; ///< relative to the scenario
};

/// A budget: a formula, its input quantities, and repeated readings.
std::string starter_budget();

/// What an axis, or anything else with readings at positions, does that a straight line and a reversal do not explain.
std::string starter_axis(const StarterData& data, const std::string& scenario);

/// Commanded and read coordinates of the same name: cmd_x and act_x, X_nom and X_meas.
using TargetColumns = std::vector<std::pair<const RecognisedColumn*, const RecognisedColumn*>>;
TargetColumns target_columns(const RecognisedData& data);

/// What a robot or a machine, read in several coordinates at its targets, does that an affine map does not explain:
/// offsets, scales and turned axes. @param columns two or more
std::string starter_targets(const StarterData& data, const TargetColumns& columns, const std::string& scenario);

/// What readings without a position depend on: time, temperatures, and whatever else was recorded with them.
std::string starter_series(const StarterData& data, const std::string& scenario);

/// A linear model of a reading: a constant, and a coefficient for each term, fitted to the data.
/// @param terms products of columns, "load" or "load*machine"; a column of words is a factor, whose first word is the
/// reference. None: every column of numbers that is no time, and a direction
/// Throws InputError if a term names no column, or a factor has too many words.
std::string starter_linear(const StarterData& data, const std::vector<std::string>& terms, const std::string& scenario);

/// A scenario of the model: its example, with what the card says of every quantity. With data, its columns take the
/// place of the example's readings and conditions; an indication without a column gets "?".
std::string starter_model(const ModelCard& card, const std::string& example, const StarterData* data);

/// A sphere on a machine, its readings in the data: location errors of the rotary axes and the sphere's place are
/// fitted; what only the user knows is "?".
/// @param machine "B,C/X,Y,Z": axes to the workpiece / axes to the tool, from the bed outwards; or a name that
/// chain::find_machine knows. Empty: the axes that the columns name, their sides left to fill in
/// Throws InputError if the machine is wrong, or the columns name no rotary axis.
std::string starter_probing(const StarterData& data, const std::string& machine);

} // namespace gumshoe::scenario
