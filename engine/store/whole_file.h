#pragma once
/// A result that is written in one go, without samples: of a choice, of a trace. Private to this folder.
#include <functional>
#include <string>

#include "store/hdf5.h"
#include "store/result_file.h"

namespace gumshoe::store {

/// Adds a file to the draft: root attributes, with the seed and the number of samples that the results are of, a marker
/// of no samples, then `contents`. Throws OutputError naming path and reason.
void write_whole(Draft& draft, const Claim& claim, Identity identity, const scenario::Scenario& scenario,
                 const std::function<void(hid_t file)>& contents);

} // namespace gumshoe::store
