#include "cli/effects_markdown.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"

namespace gumshoe::cli {
namespace {

std::string in_unit(const QuantityCard& q, double x) {
  return fmt::format("{:g}", units::from_si(x, std::string(q.unit), std::string(q.si_unit), units::Kind::difference));
}

/// Whether two quantities may share a cell of the table.
bool alike(const QuantityCard& a, const QuantityCard& b) { return a.unit == b.unit && a.role == b.role; }

/// "`x`, `y`" or "`radius_1` ... `radius_12`".
std::string names(std::span<const QuantityCard> group) {
  if (group.size() > 4) return fmt::format("`{}` ... `{}`", group.front().name, group.back().name);
  std::vector<std::string> out;
  for (const QuantityCard& q : group) out.push_back(fmt::format("`{}`", q.name));
  return fmt::format("{}", fmt::join(out, ", "));
}

std::string row(const EffectCard& card) {
  std::vector<std::string> quantities, typical;
  for (std::size_t i = 0, end = 0; i < card.quantities.size(); i = end) {
    const QuantityCard& q = card.quantities[i];
    while (end < card.quantities.size() && alike(card.quantities[end], q)) ++end;
    const std::string shape = q.role == Role::shape ? fmt::format("; shape, default {}", in_unit(q, q.default_value)) : "";
    quantities.push_back(fmt::format("{} ({}{})", names(card.quantities.subspan(i, end - i)), q.unit, shape));
    for (const QuantityCard& one : card.quantities.subspan(i, end - i))
      if (const std::string text = typical_text(one);
          one.role != Role::shape && std::find(typical.begin(), typical.end(), text) == typical.end())
        typical.push_back(text);
  }
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", card.name, name(card.stage), fmt::join(quantities, ", "),
                     fmt::join(typical, ", "), card.adds, card.confused_with);
}

} // namespace

std::string typical_text(const QuantityCard& q) {
  const auto& [low, high, note, positive] = q.typical;
  if (high == 0) return {};
  return (low == high ? "" : in_unit(q, low) + "-") + in_unit(q, high) + units::suffix(q.unit) +
         (positive ? ", positive" : "");
}

std::string effects_markdown(std::span<const ModelCard* const> models, std::span<const EffectCard* const> effects) {
  std::string out = "| stage | what effects change there | models |\n|---|---|---|\n";
  for (const StageRow& stage : stage_table) {
    std::vector<std::string> having;
    for (const ModelCard* model : models)
      if (std::ranges::find(model->stages, stage.stage) != model->stages.end())
        having.push_back(fmt::format("`{}`", model->name));
    out += fmt::format("| `{}` | {} | {} |\n", stage.name, stage.meaning, fmt::join(having, ", "));
  }
  out += "\n| effect | stage | quantities (unit) | typical | adds to the event | confused with |\n|---|---|---|---|---|---|\n";
  for (const EffectCard* effect : effects) out += row(*effect);
  return out;
}

} // namespace gumshoe::cli
