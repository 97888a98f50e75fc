#include "scenario/loading_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "scenario/series.h"

namespace gumshoe::scenario {
namespace {

/// Values are one level if they differ by rounding only: by this share of the range, or of the value.
constexpr double same_level = 1e-9;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

} // namespace

LoadingTable::LoadingTable(std::vector<std::size_t> inputs, std::vector<std::vector<double>> levels,
                           std::vector<double> loading)
    : inputs_(std::move(inputs)), range_(inputs_.size(), 0) {
  std::vector<std::size_t> order(loading.size());
  std::iota(order.begin(), order.end(), 0);
  if (inputs_.size() == 1)
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return levels[0][a] < levels[0][b]; });
  for (const std::size_t row : order) {
    loading_.push_back(loading[row]);
    levels_.emplace_back();
    for (const auto& level : levels) levels_.back().push_back(level[row]);
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const auto [low, high] = std::ranges::minmax(levels[i]);
    range_[i] = std::max({high - low, std::fabs(low), std::fabs(high)});
  }
}

double LoadingTable::between(double x) const {
  const auto reaches = [&](const std::vector<double>& row) { return row[0] >= x - same_level * range_[0]; };
  const auto above = std::ranges::find_if(levels_, reaches);
  if (above == levels_.end()) return unknown;
  const auto i = static_cast<std::size_t>(above - levels_.begin());
  if (std::fabs((*above)[0] - x) <= same_level * range_[0]) return loading_[i];
  if (i == 0) return unknown;
  const double low = levels_[i - 1][0], share = (x - low) / ((*above)[0] - low);
  return loading_[i - 1] + share * (loading_[i] - loading_[i - 1]);
}

double LoadingTable::at(const std::vector<double>& known) const {
  if (inputs_.size() == 1) return between(known[inputs_[0]]);
  for (std::size_t row = 0; row < levels_.size(); ++row) {
    bool here = true;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      here = here && std::fabs(levels_[row][i] - known[inputs_[i]]) <= same_level * range_[i];
    if (here) return loading_[row];
  }
  return unknown;
}

Shape loading_table_shape() {
  return shape::table(
      {{"loading", shape::list(shape::number()), "change of the indication by a size of 1, by row", true}}, "",
      shape::reference("series"));
}

std::optional<LoadingTable> read_loading_table(Table& effect, const StatedScope& scope, Context& context) {
  const std::size_t before = context.problems.size();
  auto table = effect.table("table");
  if (!table) return std::nullopt;
  std::vector<std::size_t> inputs;
  std::vector<std::vector<double>> levels;
  std::size_t place = 0;
  const auto read = [&](const auto& card) {
    const std::string name(card.name);
    if (table->has(name))
      if (auto values = read_series(*table, name, {std::string(card.si_unit)}, context)) {
        inputs.push_back(place);
        levels.push_back(std::move(*values));
      }
    ++place;
  };
  for (const VariableCard& c : scope.model.conditions) read(c);
  for (const TraceColumn& c : scope.columns) read(c);
  table->require("loading", "loading = [0, 1]");
  const auto loading = read_series(*table, "loading", {"1"}, context);
  table->refuse_unknown();
  if (context.problems.size() > before || !loading) return std::nullopt;
  if (inputs.empty())
    table->refuse("it names no condition and no column", "the loading is a value at each of their levels",
                  "position = [\"0 mm\", \"50 mm\"]");
  for (const auto& level : levels)
    if (level.size() != loading->size() || level.size() < 2) {
      table->refuse(fmt::format("a column has {} rows and loading has {}", level.size(), loading->size()),
                    "every row is a level with its loading", "state two rows or more, and as many in every column");
      break;
    }
  if (context.problems.size() > before) return std::nullopt;
  for (std::size_t a = 0; a < loading->size(); ++a)
    for (std::size_t b = a + 1; b < loading->size(); ++b)
      if (std::ranges::all_of(levels, [&](const auto& level) { return level[a] == level[b]; })) {
        table->refuse(fmt::format("rows {} and {} state the same level", a + 1, b + 1), "", "remove one of them");
        return std::nullopt;
      }
  return LoadingTable(std::move(inputs), std::move(levels), *loading);
}

} // namespace gumshoe::scenario
