#pragma once
/// A result that is written in one go, without samples: of a choice, of a trace. Private to this folder.
#include <functional>
#include <string>

#include "store/hdf5.h"
#include "store/result_file.h"

namespace gumshoe::store {

/// Root attributes, a marker of no samples, then `contents`; takes its place at `path` when complete. Throws
/// OutputError naming path and reason.
void write_whole(const std::string& path, const Identity& identity, const std::string& title,
                 double coverage_probability, const std::function<void(hid_t file)>& contents);

} // namespace gumshoe::store
