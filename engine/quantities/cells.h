#pragma once
/// Cells: the combinations of label values that draws are for.
#include <cstddef>
#include <cstdint>
#include <string>

#include "quantities/input_quantity.h"

namespace gumshoe::quantities {

/// The label that every reading has by itself; its value is the reading's number from 1.
inline constexpr const char* reading_label = "reading";

/// Value of a label of a reading, or null.
const std::string* label_value(const Labels& labels, const std::string& name);

/// Whether the entry holds for a reading with these labels.
bool holds_for(const Labels& entry, const Labels& reading);

/// Labels of the entry and of the scope, with the reading's values, sorted by name. Throws
/// InputError if the reading lacks a label of the scope; `what` names the quantity.
Labels cell_of(const Labels& entry, const std::vector<std::string>& scope, const Labels& reading, std::size_t index,
               const std::string& what);

/// "rod 2, setup 1"; empty for no labels.
std::string text_of(const Labels& cell);

/// 0 for a cell shared by readings, else the reading's number: the word of the random counter.
std::uint32_t reading_of(const Labels& cell);

/// Key of the random stream of (seed, quantity, component, cell); the reading is left out, because
/// it has a word of its own in the counter.
std::uint64_t stream_key(std::uint64_t seed, const std::string& quantity, const std::string& component,
                         const Labels& cell);

} // namespace gumshoe::quantities
