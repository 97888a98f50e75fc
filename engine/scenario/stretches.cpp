#include "scenario/stretches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most_blocks = 10'000;
constexpr double rounding = 1e-9; ///< of a stretch: 0.3 s / 0.1 s is 2.9999999999999996

std::vector<Key> keys() {
  return {
      {"every", shape::reference("width"), "length of a stretch, counted from the first reading"},
      {"count", shape::whole(2, most_blocks), "number of stretches with equally many rows"},
      {"interleaved", shape::flag(),
       "with count: rows are dealt to the blocks in turn, each round from the next block on, where a stretch would be "
       "an end of what they sweep through"},
      {"of", shape::text(), "condition or column by which they go, such as the time; default: the order of [trace]"}};
}

/// The condition or column of [trace] that is named; nothing if there is none, with a problem if `of` names it.
std::optional<StretchAxis> read_axis(Table& blocks, const Node& trace_node, const StretchedData& data) {
  Problems unheard(blocks.problems().file()); // [trace] reports them itself
  Table trace(trace_node, "trace", unheard);
  const auto name = blocks.has("of") ? blocks.text("of") : trace.text("order");
  if (!name) return std::nullopt;
  if (const auto known = data.conditions.find(*name); known != data.conditions.end()) return known->second;
  std::vector<std::string> names;
  for (const auto& [condition, axis] : data.conditions) names.push_back(condition);
  if (auto columns = trace.table("columns")) {
    for (const Member& m : columns->node().members) names.push_back(m.key);
    if (const auto column = NumberColumn::read(*columns, *name, data.file)) {
      StretchAxis out{{}, column->si_unit()};
      for (const auto& value : column->values(data.rows, unheard)) out.values.push_back(value.value_or(0));
      return out;
    }
  }
  if (blocks.has("of") && std::ranges::find(names, *name) == names.end())
    blocks.refuse_key("of", fmt::format("'{}' is neither a condition nor a column of the data", *name), "",
                      did_you_mean(*name, names));
  return std::nullopt;
}

/// Equally many rows in each stretch, by the order of the axis or of the rows; or, interleaved, dealt in turn. Each
/// round of dealing begins one block later: rows whose labels come back with its length would be in one block alone.
std::vector<double> counted(Table& blocks, const std::optional<StretchAxis>& axis, std::size_t n) {
  std::vector<double> out(n);
  const auto count = blocks.integer("count", 2, most_blocks);
  if (!count) return out;
  if (static_cast<std::size_t>(*count) > n)
    blocks.refuse_key("count", fmt::format("there are only {} rows", n), "", "ask for fewer blocks");
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (axis) std::ranges::stable_sort(order, {}, [&](std::size_t i) { return axis->values[i]; });
  const auto blocks_wanted = static_cast<std::size_t>(*count);
  const bool interleaved = blocks.boolean("interleaved").value_or(false);
  for (std::size_t rank = 0; rank < n; ++rank)
    out[order[rank]] =
        static_cast<double>(interleaved ? (rank + rank / blocks_wanted) % blocks_wanted : rank * blocks_wanted / n);
  return out;
}

/// Stretches of one length, from the first reading on.
std::vector<double> measured(Table& blocks, const StretchAxis& axis) {
  std::vector<double> out(axis.values.size());
  const auto every = blocks.width("every", axis.si_unit);
  const double first = axis.values.empty() ? 0 : *std::ranges::min_element(axis.values);
  for (std::size_t i = 0; i < out.size() && every; ++i)
    out[i] = std::floor((axis.values[i] - first) / *every + rounding);
  return out;
}

/// Numbers from 1, in the order of the values, without gaps.
std::vector<std::string> named(const std::vector<double>& stretch) {
  std::vector<double> sorted = stretch;
  std::ranges::sort(sorted);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<std::string> out;
  for (const double s : stretch)
    out.push_back(fmt::format("{}", std::ranges::lower_bound(sorted, s) - sorted.begin() + 1));
  return out;
}

} // namespace

Shape stretches_shape() { return shape::table(keys()); }

bool has_stretches(const Node* trace) {
  if (!trace) return false;
  const auto blocks = std::ranges::find(trace->members, "blocks", &Member::key);
  return blocks != trace->members.end() && blocks->value.kind == Node::Kind::table;
}

std::vector<std::string> stretches(const Node& trace, const StretchedData& data, Problems& problems) {
  const auto node = std::ranges::find(trace.members, "blocks", &Member::key);
  Table blocks(node->value, "trace.blocks", problems);
  blocks.declare(keys());
  const std::size_t before = problems.size();
  const auto axis = read_axis(blocks, trace, data);
  std::vector<double> out;
  if (blocks.has("every") == blocks.has("count"))
    blocks.refuse("either every or count is expected", "", "blocks = { every = \"30 min\" }, or { count = 6 }");
  else if (blocks.has("count"))
    out = counted(blocks, axis, data.rows.size());
  else if (axis)
    out = measured(blocks, *axis);
  else if (problems.size() == before)
    blocks.refuse("nothing tells how far the readings are apart", "", "name a condition or column: of = \"time\"");
  blocks.refuse_unknown();
  return problems.size() == before ? named(out) : std::vector<std::string>{};
}

} // namespace gumshoe::scenario
