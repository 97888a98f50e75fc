#include "scenario/loading_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/special_values.h"
#include "scenario/series.h"

namespace gumshoe::scenario {
namespace {

/// Values are one level if they differ by rounding only: by this share of the range, or of the value.
constexpr double same_level = 1e-9;
constexpr double most_margin = 0.1; ///< farther than that, nothing was measured near it

} // namespace

LoadingTable::LoadingTable(std::vector<std::size_t> inputs, std::vector<std::vector<double>> levels,
                           std::vector<double> loading, double margin, std::optional<double> beyond)
    : inputs_(std::move(inputs)), margin_(margin), beyond_(beyond) {
  for (std::size_t row = 0; row < loading.size(); ++row) {
    rows_.push_back({{}, loading[row]});
    for (const auto& level : levels) rows_.back().level.push_back(level[row]);
  }
  for (const auto& level : levels) {
    const auto [low, high] = std::ranges::minmax(level);
    low_.push_back(low), high_.push_back(high);
    rounding_.push_back(same_level * std::max({high - low, std::fabs(low), std::fabs(high)}));
  }
}

bool LoadingTable::is_level(std::size_t input, double level, double x) const {
  return std::fabs(level - x) <= rounding_[input];
}

std::vector<std::pair<double, double>> LoadingTable::line(std::size_t input, const std::vector<double>& known) const {
  std::vector<std::pair<double, double>> out;
  for (const Row& row : rows_) {
    bool here = true;
    for (std::size_t i = 0; i < inputs_.size() && here; ++i)
      here = i == input || is_level(i, row.level[i], known[inputs_[i]]);
    if (here) out.emplace_back(row.level[input], row.loading);
  }
  std::ranges::sort(out);
  return out;
}

double LoadingTable::along(const std::vector<std::pair<double, double>>& line, std::size_t input, double x) const {
  const auto through = [x](const auto& a, const auto& b) {
    return a.second + (x - a.first) / (b.first - a.first) * (b.second - a.second);
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (is_level(input, line[i].first, x)) return line[i].second;
    if (i > 0 && line[i - 1].first < x && x < line[i].first) return through(line[i - 1], line[i]);
  }
  if (line.size() < 2) return nan;
  const bool above = x > line.back().first;
  const auto& end = above ? line.back() : line.front();
  const double far = reach(input);
  if (std::fabs(x - end.first) > far + rounding_[input]) return nan;
  // A chord that is shorter than the margin would enlarge what differs between neighbours by chance.
  const auto inside = [&](const auto& level) { return std::fabs(level.first - end.first) >= far; };
  if (above) {
    const auto from = std::find_if(line.rbegin(), line.rend(), inside);
    return from == line.rend() ? nan : through(*from, end);
  }
  const auto from = std::ranges::find_if(line, inside);
  return from == line.end() ? nan : through(end, *from);
}

double LoadingTable::at(const std::vector<double>& known) const {
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (const double x = along(line(i, known), i, known[inputs_[i]]); !std::isnan(x)) return x;
  for (std::size_t i = 0; i < inputs_.size() && beyond_; ++i)
    if (const double x = known[inputs_[i]]; x < low_[i] || x > high_[i]) return *beyond_;
  return nan;
}

std::optional<LoadingTable::Limits> LoadingTable::beyond(const std::vector<double>& known) const {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const double x = known[inputs_[i]];
    // Where the others are as they are here, and else anywhere.
    const auto here = line(i, known);
    const double low = (here.empty() ? low_[i] : here.front().first) - reach(i),
                 high = (here.empty() ? high_[i] : here.back().first) + reach(i);
    if (x < low - rounding_[i] || x > high + rounding_[i]) return Limits{inputs_[i], low, high};
  }
  return std::nullopt;
}

Shape loading_table_shape() {
  return shape::table(
      {{"loading", shape::list(shape::number()), "change of the indication by a size of 1, by row", true},
       {"margin", shape::number(),
        "share of the range of a condition by which the table is continued in a straight line beyond its ends, up to "
        "0.1; default: 0"},
       {"beyond", shape::number(),
        "change farther out, such as 0 of what came and went; default: nothing is known there"}},
      "", shape::reference("series"));
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
  const double margin = table->number("margin").value_or(0);
  if (!(margin >= 0 && margin <= most_margin))
    table->refuse_key("margin", fmt::format("a table is not continued by {:g} of its range", margin),
                      "nothing was measured so far beyond its ends", "state a share between 0 and 0.1");
  const std::optional<double> beyond = table->number("beyond");
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
  return LoadingTable(std::move(inputs), std::move(levels), *loading, margin, beyond);
}

} // namespace gumshoe::scenario
