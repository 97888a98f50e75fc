#pragma once
/// Reads [volume]: ranges of the axes, commands of the others, the tool's point.
#include "scenario/reader.h"
#include "scenario/scenario.h"
#include "scenario/volume_options.h"

namespace gumshoe::scenario {

Shape volume_shape();

/// @param top the whole scenario, whose [machine] is the one
/// Problems: no [machine], a name that is no axis, no range or more than three, a range without length.
Volume read_volume(Table table, Table& top, Problems& problems);

/// [volume] of a scenario that was read: only `gumshoe volume` needs it, so it is read again from the text. Empty if there
/// is none.
std::optional<Volume> stated_volume(const Scenario& scenario);
/// The same; throws InputError if there is none.
Volume volume_of(const Scenario& scenario);

} // namespace gumshoe::scenario
