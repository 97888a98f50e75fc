#include "scenario/reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace gumshoe::scenario {

namespace {
constexpr std::size_t most_in_data = 20; ///< a column read wrongly is wrong in every row
}

void Problems::add(int line, int column, std::string what, std::string why, std::string remedy) {
  list_.push_back({{file_, line, column}, std::move(what), std::move(why), std::move(remedy)});
}

void Problems::add(const InputError& error) {
  list_.insert(list_.end(), error.problems().begin(), error.problems().end());
}

void Problems::add(const InputError& error, const Node& node) {
  for (Problem p : error.problems()) {
    if (p.where.file.empty()) p.where = {file_, node.line, node.column};
    list_.push_back(std::move(p));
  }
}

void Problems::add(const Node& node, const std::string& path, const InputError& error) {
  const Problem& p = error.problems().front();
  add(node, path + ": " + p.what, p.why, p.remedy);
}

void Problems::shorten(std::vector<Problem>& sorted) const {
  const auto in_data = [&](const Problem& p) { return p.where.file != file_ && p.where.line > 0; };
  const auto first = std::ranges::find_if(sorted, in_data);
  const std::size_t count = static_cast<std::size_t>(std::ranges::count_if(sorted, in_data));
  if (count <= most_in_data) return;
  const auto last = std::remove_if(first, sorted.end(), [&, n = std::size_t{0}](const Problem& p) mutable {
    return in_data(p) && ++n > most_in_data;
  });
  sorted.erase(last, sorted.end());
  sorted.push_back({{}, fmt::format("{} more problems of the data are not listed", count - most_in_data), "", ""});
}

void Problems::raise() const {
  if (list_.empty()) return;
  std::vector<Problem> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Problem& a, const Problem& b) {
    const bool other_a = a.where.file != file_, other_b = b.where.file != file_;
    return std::tie(other_a, a.where.line, a.where.column) < std::tie(other_b, b.where.line, b.where.column);
  });
  // Two readers of one key may find the same fault.
  sorted.erase(std::unique(sorted.begin(), sorted.end(),
                           [](const Problem& a, const Problem& b) { return format(a) == format(b); }),
               sorted.end());
  shorten(sorted);
  throw InputError(std::move(sorted));
}

namespace {

/// Words that people use for ours; what they mean is offered where it is a candidate.
constexpr std::pair<std::string_view, std::string_view> synonyms[] = {
    {"uniform", "rectangular"},     {"rectangle", "rectangular"},    {"square", "rectangular"},
    {"gaussian", "normal"},         {"gauss", "normal"},             {"student", "t"},
    {"student_t", "t"},             {"students_t", "t"},             {"u_shaped", "arcsine"},
    {"ushaped", "arcsine"},         {"trapezoidal", "trapezoid"},    {"triangle", "triangular"},
    {"standard_uncertainty", "u"},  {"std", "u"},                    {"stddev", "u"},
    {"sd", "u"},                    {"standard_deviation", "u"},     {"sigma", "u"},
    {"expanded_uncertainty", "U"},  {"coverage_factor", "k"},        {"dof", "degrees_of_freedom"},
    {"nu", "degrees_of_freedom"},   {"df", "degrees_of_freedom"},    {"type", "evaluation"},
    {"estimate", "value"},          {"nominal", "value"},            {"mean", "value"},
    {"tolerance", "half_width"},    {"halfwidth", "half_width"},     {"half-width", "half_width"},
    {"a", "half_width"},            {"min", "low"},                  {"lower", "low"},
    {"minimum", "low"},             {"max", "high"},                 {"upper", "high"},
    {"maximum", "high"},            {"scope", "per"},                {"reference", "source"},
    {"dist", "distribution"},       {"measurements", "observations"}, {"samples", "observations"},
};

/// What is meant by another word for it, or empty.
std::string synonym_of(std::string word, const std::vector<std::string>& candidates) {
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [theirs, ours] : synonyms)
    if (word == theirs && std::ranges::find(candidates, ours) != candidates.end()) return std::string(ours);
  return {};
}

} // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const auto offered = [&](const char* name) { return std::ranges::find(candidates, name) != candidates.end(); };
  if (word.find("uncertainty") != word.npos && word.find('_') == word.npos && offered("u") && offered("U"))
    return "write u for a standard uncertainty, or U with k for an expanded one";
  if (const std::string meant = synonym_of(word, candidates); !meant.empty())
    return fmt::format("did you mean '{}'?", meant);
  const std::string near = nearest(word, candidates);
  if (!near.empty()) return fmt::format("did you mean '{}'?", near);
  if (candidates.empty()) return {};
  const std::string all = fmt::format("use one of {}", fmt::join(candidates, ", "));
  return all.size() <= 500 ? all : std::string{}; // a list that nobody would read
}

void require_possible_temperature(double number, const std::string& unit, const Dimension& dimension) {
  if (dimension.si_unit != "K" || dimension.kind != units::Kind::point || !units::convertible(unit, "K")) return;
  if (units::to_si(0, unit, "K") == 0 || units::to_si(number, unit, "K") >= 0) return;
  throw InputError(fmt::format("{} {} is below absolute zero", number, unit),
                   fmt::format("{:.6g} {}", units::from_si(0, unit, "K"), unit),
                   "correct the sign or the unit, or state a difference of temperatures in K");
}

std::optional<double> read_measure(const Node& node, const std::string& path, const Dimension& dimension,
                                   Problems& problems) {
  const std::string kind = units::kind_name(dimension.si_unit);
  if (node.kind == Node::Kind::integer || node.kind == Node::Kind::real) {
    if (!std::isfinite(node.number)) {
      problems.add(node, fmt::format("{}: the number is not finite", path));
    } else if (dimension.si_unit == "1") {
      return node.number;
    } else {
      problems.add(node, fmt::format("{}: {} is not {}", path, node.number, kind),
                   "a number with a dimension needs a unit",
                   fmt::format("write it as text with a unit, such as \"{} ...\"", node.number));
    }
    return std::nullopt;
  }
  if (node.kind != Node::Kind::text) {
    problems.add(node, fmt::format("{}: {} is not {}", path, describe(node.kind), kind), "",
                 "write it as text with a unit, such as \"0.6 um\"");
    return std::nullopt;
  }
  try {
    const units::Measure measure = units::parse(node.text);
    require_possible_temperature(measure.number, measure.unit, dimension);
    return units::to_si(measure.number, measure.unit, dimension.si_unit, dimension.kind);
  } catch (const InputError& error) {
    Problem p = error.problems().front();
    const std::string number_and_unit = units::kind_name(dimension.si_unit);
    // A share has no dimension: what it is of decides.
    if (p.what.ends_with("is not " + number_and_unit) && units::convertible(units::parse(node.text).unit, "1"))
      p.remedy += (p.remedy.empty() ? "" : "; ") + std::string("only u, U and half_width may be a percentage, of the value");
    // "'N' is not a length" names the unit; a reader looks for what he wrote.
    if (p.what.ends_with("is not " + number_and_unit)) p.what = fmt::format("'{}' is not {}", node.text, kind);
    problems.add(node, path + ": " + p.what, p.why, p.remedy);
    return std::nullopt;
  }
}

std::optional<double> read_number(const Node& node, const std::string& path, Problems& problems) {
  if (node.kind != Node::Kind::integer && node.kind != Node::Kind::real) {
    problems.add(node, fmt::format("{}: a number without a unit is expected, not {}", path, describe(node.kind)));
    return std::nullopt;
  }
  if (!std::isfinite(node.number)) {
    problems.add(node, fmt::format("{}: the number is not finite", path));
    return std::nullopt;
  }
  return node.number;
}

std::optional<std::string> read_text(const Node& node, const std::string& path, Problems& problems) {
  if (node.kind == Node::Kind::text) return node.text;
  problems.add(node, fmt::format("{}: text is expected, not {}", path, describe(node.kind)), "", "put it in quotes");
  return std::nullopt;
}

std::optional<std::string> read_si_unit(const Node& node, const std::string& path, const std::string& unit,
                                        Problems& problems) {
  try {
    return units::si_unit_of(unit);
  } catch (const InputError& error) {
    problems.add(node, path, error);
    return std::nullopt;
  }
}

std::optional<Table> as_table(const Node& node, const std::string& path, Problems& problems) {
  if (node.kind == Node::Kind::table) return Table(node, path, problems);
  problems.add(node, fmt::format("{}: a table is expected, not {}", path, describe(node.kind)));
  return std::nullopt;
}

const Node* Table::find(const std::string& key) {
  known_.insert(key);
  for (const Member& m : node_->members)
    if (m.key == key) return &m.value;
  return nullptr;
}

const Node* Table::require(const std::string& key, const std::string& remedy) {
  const Node* node = find(key);
  if (!node) add(fmt::format("{} is missing", path(key)), "", remedy);
  return node;
}

std::optional<std::string> Table::text(const std::string& key) {
  const Node* node = find(key);
  return node ? read_text(*node, path(key), *problems_) : std::nullopt;
}

std::optional<double> Table::number(const std::string& key) {
  const Node* node = find(key);
  return node ? read_number(*node, path(key), *problems_) : std::nullopt;
}

std::optional<double> Table::positive(const std::string& key) {
  const auto value = number(key);
  if (!value || *value > 0) return value;
  refuse_key(key, fmt::format("{} must be above 0", *value));
  return std::nullopt;
}

std::optional<double> Table::measure(const std::string& key, const Dimension& dimension) {
  const Node* node = find(key);
  return node ? read_measure(*node, path(key), dimension, *problems_) : std::nullopt;
}

std::optional<double> Table::width(const std::string& key, const std::string& si_unit) {
  const auto value = measure(key, {si_unit, units::Kind::difference});
  if (!value || *value > 0) return value;
  refuse_key(key, "must be above 0");
  return std::nullopt;
}

std::optional<bool> Table::boolean(const std::string& key) {
  const Node* node = find(key);
  if (!node) return std::nullopt;
  if (node->kind == Node::Kind::boolean) return node->boolean;
  refuse_key(key, fmt::format("expected true or false, found {}", describe(node->kind)));
  return std::nullopt;
}

std::optional<std::int64_t> Table::integer(const std::string& key, std::int64_t low, std::int64_t high) {
  const Node* node = find(key);
  const auto value = node ? read_number(*node, path(key), *problems_) : std::nullopt;
  if (!value) return std::nullopt;
  if (std::floor(*value) != *value) {
    refuse_key(key, fmt::format("{} is not a whole number", *value));
    return std::nullopt;
  }
  constexpr double exact = 9e15; // larger ones are not known to the last digit
  const bool large = std::abs(*value) > exact;
  const std::int64_t whole = large ? 0 : static_cast<std::int64_t>(*value);
  if (large || whole < low || whole > high) {
    refuse_key(key, fmt::format("{} must lie between {} and {}",
                                large ? fmt::format("{:g}", *value) : std::to_string(whole), low, high));
    return std::nullopt;
  }
  return whole;
}

std::optional<Table> Table::table(const std::string& key) {
  const Node* node = find(key);
  return node ? as_table(*node, path(key), *problems_) : std::nullopt;
}

const std::vector<Node>* Table::array(const std::string& key) {
  const Node* node = find(key);
  if (!node) return nullptr;
  if (node->kind == Node::Kind::array) return &node->items;
  const bool table = node->kind == Node::Kind::table;
  refuse_key(key, fmt::format("expected an array, found {}", describe(node->kind)), "",
             table ? fmt::format("write [[{}]] in place of [{}], or {} = [ {{ ... }} ]", path(key), path(key), key)
                   : fmt::format("write {} = [ ... ]", key));
  return nullptr;
}

std::vector<Table> Table::tables(const std::string& key) {
  std::vector<Table> out;
  const auto* items = array(key);
  for (std::size_t i = 0; items && i < items->size(); ++i)
    if (auto one = as_table((*items)[i], fmt::format("{}[{}]", path(key), i + 1), *problems_))
      out.push_back(std::move(*one));
  return out;
}

std::vector<std::string> Table::texts(const std::string& key) {
  const Node* node = find(key);
  std::vector<std::string> out;
  if (!node) return out;
  if (node->kind != Node::Kind::array) {
    if (auto one = read_text(*node, path(key), *problems_)) out.push_back(*one);
    return out;
  }
  for (const Node& item : node->items)
    if (auto one = read_text(item, path(key), *problems_)) out.push_back(*one);
  return out;
}

namespace {
std::string render(const Node& node) {
  switch (node.kind) {
  case Node::Kind::text:
  case Node::Kind::date:
    return node.text;
  case Node::Kind::integer:
    return fmt::format("{}", node.integer);
  case Node::Kind::real:
    return fmt::format("{}", node.number);
  case Node::Kind::boolean:
    return node.boolean ? "true" : "false";
  case Node::Kind::array: {
    std::string out;
    for (const Node& item : node.items) out += (out.empty() ? "" : ", ") + render(item);
    return out;
  }
  case Node::Kind::table: {
    std::string out;
    for (const Member& m : node.members) out += (out.empty() ? "" : ", ") + m.key + ": " + render(m.value);
    return out;
  }
  }
  return {};
}
} // namespace

std::string Table::rendered(const std::string& key) {
  const Node* node = find(key);
  return node ? render(*node) : std::string();
}

std::optional<std::size_t> Table::choice(const std::string& key, const std::vector<std::string>& words) {
  const auto word = text(key);
  if (!word) return std::nullopt;
  const auto it = std::ranges::find(words, *word);
  if (it != words.end()) return static_cast<std::size_t>(it - words.begin());
  refuse_key(key, fmt::format("'{}' is unknown", *word), "", did_you_mean(*word, words));
  return std::nullopt;
}

const std::vector<Member>& Table::members() {
  for (const Member& m : node_->members) known_.insert(m.key);
  declared_.clear();
  return node_->members;
}

void Table::refuse_key(const std::string& key, const std::string& what, std::string why, std::string remedy) {
  const Node* node = find(key);
  problems_->add(node ? *node : *node_, path(key) + ": " + what, std::move(why), std::move(remedy));
}

void Table::declare(const std::vector<Key>& keys) {
  for (const Key& k : keys) declared_.insert(k.name);
}

void Table::refuse_undeclared() {
  for (const Member& m : node_->members)
    if (!declared_.contains(m.key) && refused_.insert(m.key).second) refuse_as_unknown(m, declared_);
}

void Table::refuse_as_unknown(const Member& m, const std::set<std::string>& names) {
  refuse_stray(m, "", did_you_mean(m.key, {names.begin(), names.end()}));
}

void Table::refuse_stray(const Member& m, std::string why, std::string remedy) {
  refused_.insert(m.key);
  const std::string prefix = path_.empty() ? "" : path_ + ": ";
  problems_->add(m, fmt::format("{}unknown key '{}'", prefix, m.key), std::move(why), std::move(remedy));
}

void Table::refuse_unknown() {
  if (!declared_.empty() && !std::ranges::includes(declared_, known_))
    throw std::logic_error(path_ + ": the reader asks for a key that the schema lacks");
  for (const Member& m : node_->members) {
    if (known_.contains(m.key) || refused_.contains(m.key)) continue;
    if (declared_.contains(m.key)) { // a key of another form of this table
      const std::string prefix = path_.empty() ? "" : path_ + ": ";
      problems_->add(m, fmt::format("{}the key '{}' means nothing together with the others", prefix, m.key), "",
                     "leave it out, or state what it belongs to");
      continue;
    }
    std::set<std::string> names = known_;
    names.insert(declared_.begin(), declared_.end());
    refuse_as_unknown(m, names);
  }
}

} // namespace gumshoe::scenario
