#pragma once
/// A document back to TOML text.
#include "scenario/document.h"

namespace gumshoe::scenario {

/// The text between quotes, as TOML takes it.
std::string toml_string(const std::string& text);

/// Tables of the document become sections, tables deeper than two levels and in arrays stand inline. Comments are not
/// part of a document. parse_document(to_toml(d)) equals d but for places.
std::string to_toml(const Node& document);

} // namespace gumshoe::scenario
