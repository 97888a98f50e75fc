#pragma once
/// The root attributes of a result file: what it is, and what fixes its numbers.
#include <mutex>
#include <string>

#include "store/hdf5.h"
#include "store/result_file.h"

namespace gumshoe::store {

/// HDF5 is one library for all threads; every door into it holds this.
using Lock = std::lock_guard<std::recursive_mutex>;

/// Whether two runs give the same samples: everything but the scenario's file name is equal, and the room
/// that an adaptive run has.
bool same_numbers(const Identity& a, const Identity& b);

void write_identity(hid_t file, const Identity& identity);
/// Throws OutputError saying why the open file is no result of ours.
Stored read_stored(hid_t file);

bool is_hdf5(const std::string& path);
/// Opens, or with H5F_ACC_TRUNC creates.
hdf5::Handle open_file(const std::string& path, unsigned flags);

} // namespace gumshoe::store
