#pragma once
/// Writes what a choice found as the group `choice` of README.md, and the notes. Private to this folder.
#include "choice/results.h"
#include "store/hdf5.h"

namespace gumshoe::store {

void write_choice_group(hid_t file, const choice::Result& result);

} // namespace gumshoe::store
