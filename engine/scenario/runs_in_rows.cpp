#include "scenario/runs_in_rows.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/column_words.h"
#include "scenario/recognise.h"

namespace gumshoe::scenario {
namespace {

/// A column of readings.
struct Part {
  std::size_t column;
  std::vector<std::string> said; ///< by its name, in the order of Layout::added
  double sign = 1;               ///< below 0: taken on the way back
};
struct Layout {
  std::vector<std::string> added; ///< names of the columns that tell the parts apart
  std::vector<Part> parts;
  std::string unit;     ///< of the readings, by the names of their columns; empty: they do not say it
  bool by_rows = false; ///< each row is a run, else each part is one
};

/// Names of runs and targets are short; a regular expression may not be asked about a line of megabytes.
constexpr std::size_t longest_header = 40;

double sign_of(const std::string& word) {
  const auto known = signs({word});
  return known.empty() ? 0 : known.front().second;
}

/// Whether a word of a direction may be something else: "pos" is a position as a rule, "rev" a revision.
bool is_doubtful(const std::string& word) { return word.size() < 2 || word == "pos" || word == "rev"; }

const std::string words_of_runs = "r|run|lauf|cycle|zyklus|messung|reihe|series|serie|trial|pass|meas|rep|repeat|n";

/// A column whose name without its unit has a form, with the form's groups.
struct Named {
  std::size_t column;
  std::string unit;
  std::vector<std::string> groups; ///< from the form's first on
};
std::vector<Named> columns_like(const Csv& csv, const std::regex& form) {
  std::vector<Named> out;
  for (std::size_t c = 0; c < csv.header.size(); ++c) {
    if (csv.header[c].text.size() > longest_header) continue;
    std::string name;
    std::smatch match;
    const std::string unit = unit_in(csv.header[c].text, name);
    if (std::regex_match(name, match, form)) out.push_back({c, unit, {std::next(match.begin()), match.end()}});
  }
  return out;
}

/// "up_1", "fwd1", "Up run 2 (um)": a direction, then the number of the run. Both ways are there, or it is none.
std::optional<Layout> numbered_ways(const Csv& csv) {
  static const std::regex form(R"(\s*([^\s_.\d]+)(?:[\s_.]+(?:)" + words_of_runs + R"())?[\s_.#]*(\d+)\s*)",
                               std::regex::icase);
  Layout out{{"run", "direction"}, {}, "", false};
  std::set<std::pair<int, double>> known; // each run goes each way once
  for (const auto& [c, unit, groups] : columns_like(csv, form)) {
    const std::string &word = groups[0], &run = groups[1];
    const auto words = words_of(word);
    const double sign = sign_of(word);
    if (words.size() != 1 || is_doubtful(words.front()) || sign == 0 || run.size() > 6) continue;
    if (!out.parts.empty() && unit != out.unit) return std::nullopt; // not the same quantity
    out.unit = unit;
    if (!known.emplace(std::stoi(run), sign).second) return std::nullopt;
    out.parts.push_back({c, {run, word}, sign});
  }
  const auto forward = std::ranges::count_if(out.parts, [](const Part& p) { return p.sign > 0; });
  if (forward == 0 || forward == std::ssize(out.parts)) return std::nullopt;
  // A machine that has gone up comes down before it goes up again.
  std::ranges::stable_sort(out.parts, {}, [](const Part& p) { return std::stoi(p.said[0]); });
  return out;
}

/// "R1+", "Run 2 up", "Cycle 3 [um]".
std::optional<Layout> runs(const Csv& csv) {
  static const std::regex form(R"(\s*()" + words_of_runs + R"(|)[\s_.#]*(\d+)[\s_.]*([^\s_.\d]*)\s*)",
                               std::regex::icase);
  Layout out{{"run"}, {}, "", false};
  bool ways = true, numbers = true;
  for (const auto& [c, unit, groups] : columns_like(csv, form)) {
    const std::string &run = groups[1], &word = groups[2];
    if (!word.empty() && sign_of(word) == 0) continue;
    if (groups[0].empty() && !unit.empty()) continue;                // a target: "50 mm"
    if (!out.parts.empty() && unit != out.unit) return std::nullopt; // not the same quantity
    out.unit = unit;
    ways &= !word.empty();
    numbers &= groups[0].empty() && word.empty() && run == std::to_string(out.parts.size() + 1);
    if (groups[0].empty() && word.empty() && !numbers) return std::nullopt; // targets
    out.parts.push_back({c, {run, word}, word.empty() ? 1 : sign_of(word)});
  }
  if (out.parts.size() < 3) return std::nullopt;
  if (ways) out.added.emplace_back("direction");
  for (Part& p : out.parts) {
    p.said.resize(out.added.size());
    if (!ways) p.sign = 1;
  }
  return out;
}

/// "Forward (um)", "Backward (um)", "Reading up", "Reading down".
std::optional<Layout> directions(const Csv& csv) {
  Layout out{{"direction"}, {}, "", false};
  double sum = 0;
  for (std::size_t c = 0; c < csv.header.size(); ++c) {
    std::string rest;
    const std::string unit = unit_in(csv.header[c].text, rest);
    auto words = words_of(rest);
    std::erase_if(words, [&](const std::string& w) { return role_by_name({w}, unit) == ColumnRole::reading; });
    const double sign = words.size() != 1 || is_doubtful(words.front()) ? 0 : sign_of(words.front());
    if (sign == 0) continue;
    out.parts.push_back({c, {words.front()}, sign});
    out.unit = unit;
    sum += sign;
  }
  if (out.parts.size() != 2 || sum != 0) return std::nullopt;
  return out;
}

/// "0 mm", "50 mm": four or more, up or down.
std::optional<Layout> targets(const Csv& csv) {
  static const std::regex form(R"(([+-]?\d+([.,]\d+)?)\s*(\S*))");
  Layout out{{}, {}, "", true};
  std::string unit;
  std::vector<double> at;
  for (std::size_t c = 0; c < csv.header.size(); ++c) {
    std::smatch match;
    if (csv.header[c].text.size() > longest_header || !std::regex_match(csv.header[c].text, match, form)) continue;
    if (!match[3].str().empty() && unit_below(match[3]).empty()) continue;
    unit = match[3];
    out.parts.push_back({c, {match[1]}});
    std::string number = match[1];
    std::ranges::replace(number, ',', '.');
    at.push_back(std::stod(number));
  }
  const bool rise = std::ranges::is_sorted(at, std::less_equal{}),
             fall = std::ranges::is_sorted(at, std::greater_equal{});
  if (at.size() < 4 || !(rise || fall)) return std::nullopt;
  out.added.push_back(unit.empty() ? "position" : fmt::format("position [{}]", unit));
  return out;
}

/// Writes one row for each reading.
class Rewriter {
public:
  Rewriter(const Csv& csv, Layout layout) : csv_(csv), layout_(std::move(layout)) {
    for (std::size_t c = 0; c < csv.header.size(); ++c)
      if (std::ranges::find(layout_.parts, c, &Part::column) == layout_.parts.end()) others_.push_back(c);
    const CsvCell& below = csv.rows.front()[layout_.parts.front().column];
    for (const std::size_t c : others_) {
      std::set<std::string> words;
      for (const auto& row : csv.rows) words.insert(row[c].text);
      if (!signs(words).empty()) way_ = c;
    }
    units_ = !is_number(csv, below, '.') && !is_number(csv, below, ',') && !says_missing(below.text);
    if (units_) layout_.unit = below.text;
  }
  bool useful() const { return !others_.empty(); }

  std::string write() {
    const auto named = [](const std::string& name, const std::string& unit) {
      return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
    };
    for (const std::size_t c : others_)
      out_ += named(csv_.header[c].text, units_ ? csv_.rows.front()[c].text : "") + ';';
    out_ += fmt::format("{};{}\n", fmt::join(layout_.added, ";"), named("reading", layout_.unit));
    for (std::size_t from = units_ ? 1 : 0, to = from; from < csv_.rows.size(); from = to) {
      while (to < csv_.rows.size() && same_run(from, to)) ++to;
      layout_.by_rows ? row(from) : stretch(from, to);
    }
    return std::move(out_);
  }

private:
  /// Rows of one run of all parts: of one row each, else those that agree in the column of the cycles.
  bool same_run(std::size_t a, std::size_t b) const {
    return layout_.by_rows ? a == b : std::ranges::all_of(others_, [&](std::size_t c) {
      const bool cycle = role_by_name(words_of(csv_.header[c].text), "") == ColumnRole::cycle;
      return !cycle || csv_.rows[a][c].text == csv_.rows[b][c].text;
    });
  }
  void stretch(std::size_t from, std::size_t to) {
    for (const Part& part : layout_.parts)
      for (std::size_t i = from; i < to; ++i) add(part.sign < 0 ? from + to - 1 - i : i, part);
  }
  void row(std::size_t r) {
    const bool back = way_ && sign_of(csv_.rows[r][*way_].text) < 0;
    const std::size_t n = layout_.parts.size();
    for (std::size_t i = 0; i < n; ++i) add(r, layout_.parts[back ? n - 1 - i : i]);
  }
  void add(std::size_t r, const Part& part) {
    const auto& cells = csv_.rows[r];
    if (says_missing(cells[part.column].text)) return;
    for (const std::size_t c : others_) out_ += cells[c].text + ';';
    out_ += fmt::format("{};{}\n", fmt::join(part.said, ";"), cells[part.column].text);
  }

  const Csv& csv_;
  Layout layout_;
  std::vector<std::size_t> others_;
  std::optional<std::size_t> way_; ///< column of direction words
  bool units_ = false;             ///< the first row holds them
  std::string out_;
};

} // namespace

std::string below_each_other(const Csv& csv) {
  for (const auto kind : {runs, numbered_ways, directions, targets})
    if (auto layout = kind(csv)) {
      Rewriter rewriter(csv, std::move(*layout));
      if (rewriter.useful()) return rewriter.write();
    }
  return "";
}

} // namespace gumshoe::scenario
