#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {
namespace {

/// A condition of the scenario, made of a column.
struct Covariate {
  std::string name;
  std::string text; ///< in formulas
  std::string unit; ///< of its differences
};

/// The name of a column without its unit: "load (N)" is load.
std::string short_name(const RecognisedColumn& c) {
  std::string out;
  const std::string unit = c.unit == "degC" ? "degC C" : c.unit;
  const auto units = words_of(unit);
  for (const std::string& word : words_of(c.name))
    if (std::ranges::find(units, word) == units.end()) out += (out.empty() ? "" : "_") + word;
  return plain_name(out.empty() ? c.name : out);
}

/// Conditions, coefficients and formula of a linear model.
class LinearModel {
public:
  LinearModel(const RecognisedData& data, const RecognisedColumn& reading)
      : data_(data), reading_(reading), reading_name_(names_.add(short_name(reading))) {}

  void add(const std::string& term) {
    std::vector<Covariate> products{{"", "", ""}};
    for (std::size_t at = 0; at <= term.size();) {
      const std::size_t end = std::min(term.find('*', at), term.size());
      const auto factors = covariates_of(column(term.substr(at, end - at)));
      std::vector<Covariate> longer;
      for (const Covariate& a : products)
        for (const Covariate& b : factors)
          longer.push_back({joined(a.name, "_", b.name), joined(a.text, " * ", b.text), joined(a.unit, "*", b.unit)});
      products = std::move(longer);
      at = end + 1;
    }
    for (const Covariate& p : products) add_product(p);
  }

  const std::string& reading_name() const { return reading_name_; }
  Names& names() { return names_; }
  const std::string& formula() const { return formula_; }
  const std::string& coefficients() const { return coefficients_; }
  const NamedColumns& conditions() const { return conditions_; }
  const std::set<std::string>& used() const { return used_; }

private:
  static std::string joined(const std::string& a, const char* by, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + by + b;
  }

  void add_product(const Covariate& product) {
    if (!named_.insert(product.name).second) return;
    const std::string name = names_.add("by_" + product.name);
    formula_ += fmt::format(" + {} * {}", name, product.text);
    const std::string read = unit_or(reading_, "1");
    coefficients_ +=
        line(name, fmt::format("{{ estimated = true, value = \"0 {}\" }}", units::quotient(read, product.unit.empty() ? "1" : product.unit)), "");
  }

  const RecognisedColumn& column(const std::string& text) const {
    const auto first = text.find_first_not_of(' ');
    const std::string name =
        first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
    for (const RecognisedColumn& c : data_.columns)
      if (&c != &reading_ && (c.name == name || short_name(c) == name)) return c;
    std::vector<std::string> names;
    for (const RecognisedColumn& c : data_.columns)
      if (&c != &reading_) names.push_back(short_name(c));
    throw InputError(
        fmt::format("--term: '{}' has no column '{}' other than its readings '{}'", data_.csv.file, name,
                    reading_.name),
        "", fmt::format("use {}, or products such as {}*{}", fmt::join(names, ", "), names.front(), names.back()));
  }

  /// The column itself where it is a number; a 0 or 1 for each word but the first where it is not.
  std::vector<Covariate> covariates_of(const RecognisedColumn& c) {
    const bool words = !c.number && c.clock.empty() && c.words.empty();
    if (!words && c.role != ColumnRole::cycle) {
      const std::string name = name_of(c);
      state(name, c);
      const std::string unit = !c.clock.empty() ? "s" : unit_or(c, "1");
      if (unit != "degC") return {{name, name, unit == "1" ? "" : unit}};
      if (!std::exchange(referred_, true)) // the constant holds at 20 degC, not at 0 K
        coefficients_ += line(reference, "\"20 degC\"", "ISO 1");
      return {{name, fmt::format("({} - {})", name, reference), "K"}};
    }
    std::vector<std::string> levels;
    const auto at = static_cast<std::size_t>(data_.csv.find(c.name));
    for (const auto& row : data_.csv.rows)
      if (std::ranges::find(levels, row[at].text) == levels.end()) levels.push_back(row[at].text);
    if (levels.size() < 2 || 2 * levels.size() > data_.csv.rows.size())
      throw InputError(fmt::format("--term: the column '{}' has {} different words in {} rows", c.name, levels.size(),
                                   data_.csv.rows.size()),
                       "a factor has two or more, each in several rows", "leave it out");
    std::vector<Covariate> out;
    for (std::size_t l = 1; l < levels.size(); ++l) {
      RecognisedColumn level = c;
      level.number = false;
      level.words.clear();
      for (std::size_t k = 0; k < levels.size(); ++k) level.words.emplace_back(levels[k], k == l ? 1.0 : 0.0);
      level.why = fmt::format("as a factor: 1 at {}, compared with {}", levels[l], levels[0]);
      const std::string one = name_of(c, ' ' + levels[l]);
      out.push_back({one, one, ""});
      state(out.back().name, made_.emplace_back(std::move(level)));
    }
    return out;
  }

  /// The name of a condition. @param level  of a factor, with a blank in front; empty: the column itself
  std::string name_of(const RecognisedColumn& c, const std::string& level = "") {
    std::string& name = made_of_[{c.name, level}];
    if (name.empty()) name = names_.add(short_name(c) + level);
    return name;
  }

  void state(const std::string& name, const RecognisedColumn& c) {
    used_.insert(c.name);
    if (std::ranges::find(conditions_, name, &NamedColumns::value_type::first) == conditions_.end())
      conditions_.emplace_back(name, &c);
  }

  static constexpr const char* reference = "reference_temperature";
  const RecognisedData& data_;
  const RecognisedColumn& reading_;
  Names names_{"constant", reference};
  std::string reading_name_;
  std::map<std::pair<std::string, std::string>, std::string> made_of_; ///< names of conditions by column and level
  std::deque<RecognisedColumn> made_;                                  ///< levels of factors
  NamedColumns conditions_;
  std::set<std::string> used_, named_;
  bool referred_ = false; ///< to the reference temperature
  std::string formula_, coefficients_;
};

/// Columns that a linear model has if none is named: numbers but the reading, its uncertainty and times; a direction.
bool by_default(const RecognisedColumn& c) {
  if (c.role == ColumnRole::reading || c.role == ColumnRole::uncertainty || c.role == ColumnRole::time ||
      c.role == ColumnRole::cycle)
    return false;
  return c.number || c.role == ColumnRole::direction;
}

} // namespace

std::string starter_linear(const StarterData& data, const std::vector<std::string>& terms,
                           const std::string& scenario) {
  const RecognisedData& found = data.found;
  const RecognisedColumn* const reading = found.find(ColumnRole::reading);
  if (!reading)
    throw InputError(found.csv.file + ": there is no column of readings", "a linear model explains one",
                     "tell which it is: --role COLUMN=reading");
  const RecognisedColumn* const sd = uncertainty_of(found);
  LinearModel model(found, *reading);
  for (const std::string& term : terms) model.add(term);
  for (const RecognisedColumn& c : found.columns)
    if (terms.empty() && by_default(c)) model.add(c.name);
  if (model.conditions().empty())
    throw InputError(found.csv.file + ": there is no column but the readings",
                     "a linear model explains them by columns", "name one: --term COLUMN");

  std::set<std::string> used = model.used();
  used.insert(reading->name);
  if (sd) used.insert(sd->name);
  std::string order;
  for (const auto& [name, c] : model.conditions())
    if (c->role == ColumnRole::time) order = name;
  const std::string recorded = columns_of(found, model.names(), used, order);
  const NamedColumns labels = labels_of(found, used);
  const std::string& name = model.reading_name();
  std::string out =
      fmt::format("# Question: how do the readings in {} depend on {}, and what does a linear model not explain?\n"
                  "#     gumshoe estimate {}\n#     gumshoe trace {}\n"
                  "# Written by gumshoe new. What was guessed is said in comments: correct it where it is "
                  "wrong.\n\nschema = 1\ntitle  = {}\n\n[model]\nname = \"expression\"\n\n[model.indications]\n",
                  data.file, terms.empty() ? "the other columns" : fmt::format("{}", fmt::join(terms, ", ")), scenario,
                  scenario, toml_string(data.file));
  out += line(name, toml_string("constant" + model.formula()), "add products by --term, such as --term \"x*y\"") + '\n';
  out += data_section(data, labels, model.conditions(), used);
  out += "\n[quantities]                            # fitted to the readings\n";
  out += line("constant", fmt::format("{{ estimated = true, value = \"0 {}\" }}", unit_or(*reading, "1")), "");
  out += model.coefficients();
  out += fmt::format("\n[indications.{}]\n", name) +
         line("readings", toml_string(reading->name), "recognised " + reading->why);
  out += noise_line(*reading, sd);
  return out + "\n[trace]\n" + blocks_of(found, labels) + recorded;
}

} // namespace gumshoe::scenario
