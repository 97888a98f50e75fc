#pragma once
/// The root attributes of a result file: what it is, and what fixes its numbers.
#include <mutex>
#include <string>

#include "base/error.h"
#include "store/hdf5.h"
#include "store/record.h"

namespace gumshoe::store {

/// HDF5 is one library for all threads; every door into it holds this.
using Lock = std::lock_guard<std::recursive_mutex>;

/// Whether two runs give the same samples: everything but the scenario's file name is equal, and the room
/// that an adaptive run has.
bool same_numbers(const Identity& a, const Identity& b);

/// Also makes the progress marker `samples_done`, 0. Returns the record so far.
Record write_identity(hid_t file, const Identity& identity, bool complete);

/// Whether what cannot be read as a result was written as one, for the scenario at `place`: our root attributes stand in
/// its head.
bool was_ours(const std::string& path, const std::string& place);

/// Opens, or with H5F_ACC_TRUNC creates.
hdf5::Handle open_file(const std::string& path, unsigned flags);
/// With everything written to it; throws OutputError.
void close_file(hdf5::Handle& file);

} // namespace gumshoe::store
