#pragma once
/// Reads a whole text file and refuses files that cannot be text.
#include <cstddef>
#include <string>

namespace gumshoe {

/// What an error says of a file that is there and whose bytes cannot be read: a broken disk, and not a fault of its text.
inline constexpr const char* unreadable_file = "the file cannot be read";

/// The file's bytes. Throws InputError: missing, a directory, unreadable, larger than `limit` bytes,
/// or binary (it contains a NUL byte).
std::string read_text_file(const std::string& path, std::size_t limit);
/// The same of data that a control or a spreadsheet wrote, in UTF-8 (as_utf8).
std::string read_data_file(const std::string& path, std::size_t limit);

} // namespace gumshoe
