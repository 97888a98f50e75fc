#pragma once
/// Texts of controls and spreadsheets in UTF-8.
#include <string>

namespace gumshoe {

/// UTF-8 as it stands; UTF-16 with a byte order mark, and otherwise Windows-1252 (with Latin-1 a part of it),
/// converted: bytes that are no UTF-8 are next to never anything else. Line ends and columns in characters stay as they
/// are.
std::string as_utf8(std::string bytes);

} // namespace gumshoe
