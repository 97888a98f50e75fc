#pragma once
/// Reading a text file whole, refusing what cannot be one.
#include <cstddef>
#include <string>

namespace gumshoe {

/// The file's bytes. Throws InputError: missing, a directory, unreadable, larger than `limit` bytes,
/// or binary (it contains a NUL byte).
std::string read_text_file(const std::string& path, std::size_t limit);

} // namespace gumshoe
