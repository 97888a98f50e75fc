#pragma once
/// Where an output file may be put, and whether the disk has room for it.
#include <cstdint>
#include <string>

#include "base/error.h"

namespace gumshoe::store {

/// Follows links and refuses what cannot become a result file: a directory, a device, a missing or
/// unwritable folder. Returns the path to write; throws OutputError.
std::string destination(const std::string& path);

/// Throws OutputError unless the disk of `path` has that many bytes free.
void require_space(const std::string& path, double bytes);

/// Claims disk space for the file as it stands plus `reserve` bytes to come, so that a full disk
/// shows before the run and not after it. Throws OutputError.
void claim_space(const std::string& path, std::uint64_t reserve);

/// Makes a file-size limit (ulimit -f) an error like a full disk; by default its signal kills us.
void survive_size_limit();

/// Runs `action` and puts the path into whatever OutputError it throws.
template <class Action> auto naming(const std::string& path, Action action) {
  try {
    return action();
  } catch (const OutputError& error) {
    const Problem& p = error.problems().front();
    if (p.what.find(path) != std::string::npos) throw;
    throw OutputError("'" + path + "': " + p.what, p.why, p.remedy);
  }
}

} // namespace gumshoe::store
