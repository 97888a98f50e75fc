#pragma once
/// Where a result file may be put: nothing that is not ours is overwritten. Private to this folder.
#include <cstdint>
#include <string>

namespace gumshoe::store {

/// Follows links and refuses what cannot become a result file: a directory, a device, a missing or
/// unwritable folder. Returns the path to write; throws OutputError.
std::string destination(const std::string& path);

/// A name beside `path` under which a new file is built before it takes its place.
std::string temporary_name(const std::string& path);

/// Removes what processes that were killed left under such names of theirs.
void remove_leftovers(const std::string& path);

/// Whether another process holds the file locked, as HDF5 does with what it has open.
bool held_by_another(const std::string& path);

/// Throws OutputError unless the disk of `path` has that many bytes free.
void require_space(const std::string& path, double bytes);

/// Claims disk space for the file as it stands plus `reserve` bytes to come, so that a full disk
/// shows before the run and not after it. Throws OutputError.
void claim_space(const std::string& path, std::uint64_t reserve);

/// Makes a file-size limit (ulimit -f) an error like a full disk; by default its signal kills us.
void survive_size_limit();

} // namespace gumshoe::store
