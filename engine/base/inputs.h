#pragma once
/// The files that this process reads: no output may replace one of them. Process-wide and thread-safe.
#include <string>

namespace gumshoe::inputs {

/// To be called by whoever opens a file for reading; paths that lead nowhere are harmless.
void note(const std::string& path);

/// The noted file that `path` leads to, by whatever name or link; empty: none. The files are compared as they are now.
std::string same_file(const std::string& path);

} // namespace gumshoe::inputs
