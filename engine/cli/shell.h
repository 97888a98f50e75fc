#pragma once
/// Words of the commands that are printed for a user to copy.
#include <string>

namespace gumshoe::cli {

/// A word as a shell takes it: in quotes where it needs them.
std::string shell_word(const std::string& word);
/// The same of a file's name. One that begins with - would be taken for an option: "./-x.toml".
std::string shell_file(const std::string& name);

} // namespace gumshoe::cli
