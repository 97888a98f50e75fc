#pragma once
/// A result that is written in one go, without samples: of a choice, of a trace. Private to this folder.
#include <functional>
#include <string>

#include "store/hdf5.h"
#include "store/result_file.h"

namespace gumshoe::store {

/// Root attributes, with the seed and the number of samples that the results are of, a marker of no samples, then
/// `contents`; takes its place at `path` when complete. Throws OutputError naming path and reason.
void write_whole(const std::string& path, const scenario::Scenario& scenario, std::uint64_t seed, std::uint64_t samples,
                 const std::function<void(hid_t file)>& contents);

} // namespace gumshoe::store
