#pragma once
/// The root attributes of a result file: what it is, and what fixes its numbers.
#include <mutex>
#include <string>

#include "base/error.h"
#include "store/hdf5.h"
#include "store/result_file.h"

namespace gumshoe::store {

/// HDF5 is one library for all threads; every door into it holds this.
using Lock = std::lock_guard<std::recursive_mutex>;

/// Whether two runs give the same samples: everything but the scenario's file name is equal, and the room
/// that an adaptive run has.
bool same_numbers(const Identity& a, const Identity& b);

/// Readable, and no result of ours.
struct NoResult : OutputError {
  using OutputError::OutputError;
};

/// Also makes the progress marker `samples_done`, 0.
void write_identity(hid_t file, const Identity& identity);
/// Throws OutputError saying why the open file is no result of ours: NoResult, or that it cannot be read.
Stored read_stored(hid_t file);

/// Whether what cannot be read as a result was written as one of this format: our root attributes stand in its head.
bool was_ours(const std::string& path);

bool is_hdf5(const std::string& path);
/// Opens, or with H5F_ACC_TRUNC creates.
hdf5::Handle open_file(const std::string& path, unsigned flags);

} // namespace gumshoe::store
