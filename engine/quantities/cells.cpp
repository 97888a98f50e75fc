#include "quantities/cells.h"

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"

namespace gumshoe::quantities {

const std::string* label_value(const Labels& labels, const std::string& name) {
  for (const auto& [label, value] : labels)
    if (label == name) return &value;
  return nullptr;
}

bool holds_for(const Labels& entry, const Labels& reading) {
  return std::all_of(entry.begin(), entry.end(), [&](const auto& label) {
    const std::string* value = label_value(reading, label.first);
    return value && *value == label.second;
  });
}

Labels cell_of(const Labels& entry, const std::vector<std::string>& scope, const Labels& reading, std::size_t index,
               const std::string& what) {
  Labels cell = entry;
  for (const std::string& label : scope) {
    if (label_value(cell, label)) continue;
    if (label == reading_label) {
      cell.emplace_back(label, std::to_string(index + 1));
    } else if (const std::string* value = label_value(reading, label)) {
      cell.emplace_back(label, *value);
    } else {
      throw InputError(what + ": per = '" + label + "', but reading " + std::to_string(index + 1) +
                           " does not have this label",
                       "", "use a label of the readings, or 'reading'");
    }
  }
  std::sort(cell.begin(), cell.end());
  return cell;
}

std::string text_of(const Labels& cell) {
  std::string text;
  for (const auto& [label, value] : cell) {
    if (!text.empty()) text += ", ";
    // "rod 2" for rod = "2" as well as for rod = "rod 2"
    text += value.starts_with(label) ? value : label + " " + value;
  }
  return text;
}

std::uint32_t reading_of(const Labels& cell) {
  const std::string* number = label_value(cell, reading_label);
  return number ? static_cast<std::uint32_t>(std::stoul(*number)) : 0;
}

std::uint64_t stream_key(std::uint64_t seed, const std::string& quantity, const std::string& component,
                         const Labels& cell) {
  // Each text starts from the hash of those before it, so that texts cannot run into each other.
  std::uint64_t key = hash64(component, hash64(quantity, seed));
  for (const auto& [label, value] : cell)
    if (label != reading_label) key = hash64(value, hash64(label, key));
  return key;
}

} // namespace gumshoe::quantities
