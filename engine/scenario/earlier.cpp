#include "scenario/earlier.h"

#include <cstdint>
#include <filesystem>

#include <fmt/format.h>

#include "base/hash.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

std::optional<quantities::Earlier> EarlierResults::locate(const std::string& text) const {
  // Labels in brackets may hold a colon.
  const std::size_t colon = text.rfind(':', text.find('['));
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) return std::nullopt;
  return quantities::Earlier{
      (std::filesystem::path(folder_) / text.substr(0, colon)).string(), text.substr(colon + 1), {}};
}

const EarlierOutput* EarlierResults::open(const Node& node, const std::string& path, Problems& problems) {
  const auto text = read_text(node, path, problems);
  if (!text) return nullptr;
  const auto where = locate(*text);
  if (!where || !read_) {
    problems.add(node,
                 where ? fmt::format("{}: results cannot be read here", path)
                       : fmt::format("{}: '{}' names no output of a result", path, *text),
                 "", "write \"FILE.h5:OUTPUT\", such as \"calibration.h5:laser_z\"");
    return nullptr;
  }
  const auto [it, fresh] = outputs_.try_emplace({where->file, where->output});
  if (!fresh) return it->second.get();
  try {
    it->second = std::make_unique<const EarlierOutput>(read_(where->file, where->output));
  } catch (const InputError& error) {
    outputs_.erase(it); // told to whoever asks again
    problems.add(node, path, error);
    return nullptr;
  }
  return it->second.get();
}

void EarlierResults::state_units(Node& document, Problems& problems) {
  for (Member& section : document.members) {
    if (section.key != "quantities") continue;
    for (Member& q : section.value.members) {
      const Node* from = find_member(q.value, "from");
      if (!from || find_member(q.value, "unit")) continue;
      // What cannot be read is told here: without its unit, formulas would seem to be wrong.
      const EarlierOutput* output = open(*from, "quantities." + q.key + ".from", problems);
      if (!output) continue;
      Node unit;
      unit.kind = Node::Kind::text;
      unit.line = from->line, unit.column = from->column;
      unit.text = output->unit;
      q.value.members.push_back({"unit", from->line, from->column, std::move(unit)});
    }
  }
}

std::uint64_t EarlierResults::hash(std::uint64_t hash) const {
  for (const auto& [name, output] : outputs_) {
    hash = hash64(fmt::format("{} {} {} {} {}", name.second, output->si_unit, output->estimate,
                              output->standard_uncertainty, output->degrees_of_freedom),
                  hash);
    for (const EarlierOutput::Share& s : output->shares)
      hash = hash64(fmt::format("{} {}", s.component, s.contribution), hash);
    hash =
        hash64({reinterpret_cast<const char*>(output->samples.data()), output->samples.size() * sizeof(double)}, hash);
  }
  return hash;
}

} // namespace gumshoe::scenario
