#pragma once
/// Folders that the program needs at run time.
#include <string>

namespace gumshoe::cli {

/// share/gumshoe/NAME next to the program where it is installed, else `built`: the folder of the source.
std::string data_folder(const std::string& name, const std::string& built);

} // namespace gumshoe::cli
