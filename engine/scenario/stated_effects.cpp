#include "scenario/stated_effects.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/dimension.h"
#include "base/units.h"
#include "formula/compile.h"
#include "formula/interpreter.h"
#include "scenario/loading_table.h"
#include "scenario/option.h"
#include "scenario/quantity.h"

namespace gumshoe::scenario {

namespace {

Options<StatedEffect> stated_effect_options() {
  const auto by_hand = [](const char* key, const Shape& shape, const char* meaning) {
    return option::by_hand<StatedEffect>(key, shape, meaning);
  };
  return {
      by_hand("indication", shape::text(),
              "indication to which the effect is added; required if there are several and one formula"),
      by_hand("quantity", shape::text(),
              "instead of an indication: quantity of the model to which the effect is added at each reading"),
      by_hand(
          "formula", R"("type": ["string", "number", "object"])",
          "formula of conditions and columns of [trace.columns], in SI units; of an effect on several indications a "
          "formula for each: { X = \"cos(C)\", Y = \"sin(C)\" }"),
      by_hand("table", loading_table_shape(),
              "instead of a formula: its values at levels of conditions and columns, linear "
              "between the levels of one where all others agree; elsewhere there is no value"),
      by_hand("unit", shape::text(), "unit of the size; size times formula has the dimension of what it adds to")
          .needed("unit = \"um\""),
      by_hand("size", shape::reference("quantity"),
              "size of the effect; default: its null value, as a candidate of "
              "gumshoe trace"),
      option::text("meaning", &StatedEffect::meaning, ""),
      option::source(&StatedEffect::source),
  };
}

class StatedEffectsReader {
public:
  StatedEffectsReader(Table table, const std::string& name, const StatedScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context), problems_(context.problems) {
    out_.name = name;
  }

  StatedEffect read(std::vector<quantities::InputQuantity>& sizes) {
    const std::size_t before = problems_.size();
    name_is_free();
    read_options(table_, stated_effect_options(), out_);
    const bool has_unit = unit();
    parts();
    const auto table = read_loading_table(table_, scope_, context_);
    if (table_.has("formula") == table_.has("table"))
      table_.refuse(table_.has("table") ? "it has a formula and a table" : "it has neither a formula nor a table",
                    "one of them says how readings change", "formula = \"1 / feed\"");
    if (const Node* size = table_.find("size"); size && has_unit) {
      const QuantityCard card{"size", out_.unit, out_.si_unit, 0, {-HUGE_VAL, HUGE_VAL}, "", "", Role::amplitude};
      sizes.push_back(read_quantity(*size, table_.path("size"), card, out_.name + ".size", context_));
      out_.freed = true;
    }
    table_.refuse_unknown();
    if (problems_.size() == before && table) tabulate(*table);
    for (std::size_t i = 0; i < formulas_.size() && problems_.size() == before; ++i)
      compute(out_.parts[i], *formulas_[i]);
    return std::move(out_);
  }

private:
  void name_is_free() const {
    const auto is_it = [&](const auto& card) { return card.name == out_.name; };
    std::string owner;
    if (std::ranges::find(scope_.effects, out_.name) != scope_.effects.end()) owner = "an effect of the catalogue";
    if (std::ranges::any_of(scope_.model.conditions, is_it)) owner = "a condition";
    if (std::ranges::any_of(scope_.columns, is_it)) owner = "a column";
    if (std::ranges::any_of(scope_.model.indications, is_it)) owner = "an indication";
    if (std::ranges::any_of(scope_.model.quantities, is_it)) owner = "a quantity of the model";
    if (!owner.empty())
      table_.refuse(owner + " has this name", "names must be unique", "choose another name");
    else if (!formula::is_name(out_.name))
      table_.refuse("the name cannot be used for an effect", "use letters, digits and _, with no digit first");
  }

  /// An indication and its formula; a table of formulas holds one for each indication that it names.
  void parts() {
    const std::vector<std::string> indications = names_of(scope_.model.indications);
    const Node* formula = table_.find("formula");
    if (formula && formula->kind == Node::Kind::table) {
      if (table_.has("indication"))
        table_.refuse_key("indication", "the formulas name their indications", "", "leave it out");
      Table of = *table_.table("formula");
      for (const Member& m : of.members()) {
        const auto known = std::ranges::find(indications, m.key);
        if (known == indications.end())
          of.refuse_key(m.key, fmt::format("'{}' is not an indication", m.key), "", did_you_mean(m.key, indications));
        else
          add_part(static_cast<std::size_t>(known - indications.begin()), of, m.key);
      }
      if (of.members().empty()) table_.refuse_key("formula", "it is empty", "", "formula = \"1 / feed\"");
      return;
    }
    const bool on_quantity = table_.has("quantity");
    if (on_quantity && table_.has("indication"))
      table_.refuse_key("indication", "the effect adds to a quantity", "", "leave it out");
    const std::string key = on_quantity ? "quantity" : "indication";
    const Node* node =
        on_quantity || indications.size() == 1 ? table_.find(key) : table_.require(key, "indication = \"...\"");
    const auto index =
        node ? table_.choice(key, on_quantity ? names_of(scope_.model.quantities) : indications) : std::nullopt;
    if (formula)
      add_part(index.value_or(0), table_, "formula");
    else
      out_.parts.push_back({index.value_or(0), false, {}, {}, {}});
    out_.parts.back().on_quantity = on_quantity;
  }

  /// Unit and name of what a part adds to.
  struct Target {
    std::string name, unit, si_unit;
  };
  Target target(const StatedPart& part) const {
    const auto of = [](const auto& card) {
      return Target{std::string(card.name), std::string(card.unit), std::string(card.si_unit)};
    };
    return part.on_quantity ? of(scope_.model.quantities[part.target]) : of(scope_.model.indications[part.target]);
  }

  void add_part(std::size_t indication, Table& table, const std::string& key) {
    const Node& node = *table.find(key);
    const bool number = node.kind == Node::Kind::integer || node.kind == Node::Kind::real;
    out_.parts.push_back(
        {indication, false, number ? fmt::format("{}", node.number) : table.text(key).value_or(""), {}, {}});
    formulas_.push_back(&node);
  }

  bool unit() {
    const auto text = table_.text("unit");
    if (!text) return false;
    const auto si_unit = read_si_unit(*table_.find("unit"), table_.path("unit"), *text, problems_);
    if (!si_unit) return false;
    out_.unit = *text;
    out_.si_unit = *si_unit;
    if (units::to_si(0, *text, *si_unit) == 0) return true;
    table_.refuse_key("unit", fmt::format("'{}' has its own zero", *text), "a size is a difference", "use " + *si_unit);
    return false;
  }

  void tabulate(const LoadingTable& table) {
    StatedPart& part = out_.parts.front();
    const std::size_t conditions = scope_.model.conditions.size();
    for (const std::size_t i : table.inputs()) {
      const bool column = i >= conditions;
      out_.of_columns |= column;
      part.formula += (part.formula.empty() ? "table of " : ", ") +
                      (column ? scope_.columns[i - conditions].name : std::string(scope_.model.conditions[i].name));
    }
    const Target card = target(part);
    if (!gumshoe::Dimension::of(out_.unit).like(gumshoe::Dimension::of(card.si_unit)))
      table_.refuse_key("unit", fmt::format("a size in {} does not change {}", out_.unit, card.name),
                        "the loadings of a table are plain numbers", fmt::format("use {}", card.unit));
    part.loading_at = [table](const std::vector<double>& at_conditions, const std::vector<double>& columns) {
      std::vector<double> known = at_conditions;
      known.insert(known.end(), columns.begin(), columns.end());
      return table.at(known);
    };
    try {
      load(part, [&](std::size_t r) { return without_value(table, r); });
    } catch (const InputError& error) {
      problems_.add(error, *table_.find("table"));
    }
  }

  /// What a reading lacks: which quantity lies beyond which limits, or levels that no rows of the table share.
  Problem without_value(const LoadingTable& table, std::size_t r) {
    const Node& node = *table_.find("table");
    std::vector<double> known = scope_.readings[r].conditions;
    for (const TraceColumn& c : scope_.columns) known.push_back(c.values[r]);
    const std::size_t conditions = known.size() - scope_.columns.size();
    const auto shown = [&](std::size_t place, double x) {
      const auto of = [&](const auto& card) {
        const std::string unit(card.unit);
        return fmt::format("{:.6g}{}", units::from_si(x, unit, std::string(card.si_unit)), units::suffix(unit));
      };
      return place < conditions ? of(scope_.model.conditions[place]) : of(scope_.columns[place - conditions]);
    };
    std::string where;
    const auto add = [&](std::size_t place) {
      const std::string name = place < conditions ? std::string(scope_.model.conditions[place].name)
                                                  : scope_.columns[place - conditions].name;
      where += fmt::format("{}{} = {}", where.empty() ? "" : ", ", name, shown(place, known[place]));
    };
    const auto beyond = table.beyond(known);
    if (beyond)
      add(beyond->place);
    else
      for (const std::size_t place : table.inputs()) add(place);
    return {{problems_.file(), node.line, node.column},
            fmt::format("{}: it has no value at reading {}, where {}", table_.path("table"), reading(r), where),
            beyond ? fmt::format("it is known from {} to {}", shown(beyond->place, beyond->low),
                                 shown(beyond->place, beyond->high))
                   : "it has no rows that differ from this in one level alone",
            "measure there and add the level, or leave the reading out by where in [data]"};
  }

  /// "3 (setup 2)"
  std::string reading(std::size_t r) const {
    const std::string of = text_of(scope_.readings[r].labels);
    return fmt::format("{}{}", r + 1, of.empty() ? "" : " (" + of + ")");
  }

  void compute(StatedPart& part, const Node& node) {
    formula::Stated stated;
    stated.formula = {table_.path(), part.formula, {problems_.file(), node.line, node.column + 1}, {}};
    try {
      formula::parse(stated.formula);
      names(stated.formula);
      stated.formula.nodes.clear();
      formula::Statement statement;
      for (const VariableCard& c : scope_.model.conditions)
        statement.conditions.push_back({std::string(c.name), std::string(c.unit), std::string(c.si_unit), ""});
      for (const TraceColumn& c : scope_.columns) statement.conditions.push_back({c.name, c.unit, c.si_unit, ""});
      statement.measurands.push_back(std::move(stated));
      std::vector<std::string> ignored;
      const auto compiled = std::make_shared<const formula::Compiled>(formula::compile(std::move(statement), ignored));
      const formula::Compiled& e = *compiled;
      fits(e, target(part));
      part.loading_at = [compiled](const std::vector<double>& conditions, const std::vector<double>& columns) {
        const formula::Program& program = compiled->evaluate;
        std::vector<double> known = conditions;
        known.insert(known.end(), columns.begin(), columns.end());
        const double none = 0; // the formula reads no quantity and no indication
        return formula::interpret<double>(program, {&none, known.data(), &none}).steps[program.outputs[0]];
      };
      load(part, [&](std::size_t r) {
        return e.formulas[0].problem(0, "the formula has no finite value at reading " + reading(r));
      });
    } catch (const InputError& error) {
      problems_.add(error, node);
    }
  }

  /// Adds a problem for each name that is neither a condition nor a recorded column.
  void names(const formula::Formula& f) {
    std::vector<Problem> found;
    std::vector<std::string> known;
    for (const VariableCard& c : scope_.model.conditions) known.emplace_back(c.name);
    for (const TraceColumn& c : scope_.columns) known.push_back(c.name);
    for (const formula::Node& n : f.nodes) {
      const auto is_it = [&](const auto& card) { return card.name == n.name; };
      out_.of_columns |= n.operation == formula::Operation::name && std::ranges::any_of(scope_.columns, is_it);
      if (n.operation != formula::Operation::name || std::ranges::find(known, n.name) != known.end() ||
          formula::find_constant(n.name))
        continue;
      if (std::ranges::any_of(scope_.model.indications, is_it))
        found.push_back(f.problem(n.at, fmt::format("'{}' is an indication", n.name),
                                  "a signature computed from what was measured explains itself",
                                  "use what was commanded, or a column of [trace.columns]"));
      else if (std::ranges::any_of(scope_.model.quantities, is_it))
        found.push_back(f.problem(n.at, fmt::format("'{}' is a quantity of the model", n.name),
                                  "a signature is known before the fit",
                                  "use what was commanded, or a column of [trace.columns]"));
      else
        found.push_back(f.problem(n.at, fmt::format("'{}' is neither a condition nor a column", n.name), "",
                                  did_you_mean(n.name, known)));
    }
    if (!found.empty()) throw InputError(found);
  }

  /// Size times formula is of the dimension of what it adds to.
  void fits(const formula::Compiled& e, const Target& card) const {
    const gumshoe::Dimension formula = gumshoe::Dimension::of(e.explained[0].unit),
                             size = gumshoe::Dimension::of(out_.unit), wanted = gumshoe::Dimension::of(card.si_unit);
    if ((size * formula).like(wanted)) return;
    const gumshoe::Dimension right = wanted / formula;
    throw InputError({e.formulas[0].problem(0,
                                            fmt::format("the formula gives {}; multiplied by a size in {}, it gives {}",
                                                        formula.words(), out_.unit, (size * formula).words()),
                                            fmt::format("{} is {}", card.name, wanted.words()),
                                            right.has_unit() ? fmt::format("unit = \"{}\"", right.si_unit()) : "")});
  }

  /// @param without the problem of a reading at which there is no value
  void load(StatedPart& part, const std::function<Problem(std::size_t)>& without) {
    const auto read = [&](const auto& c) { return c.values.size() == scope_.readings.size(); };
    if (!std::ranges::all_of(scope_.columns, read)) return;
    bool any = false;
    for (std::size_t r = 0; r < scope_.readings.size(); ++r) {
      std::vector<double> columns;
      for (const TraceColumn& c : scope_.columns) columns.push_back(c.values[r]);
      const double x = part.loading_at(scope_.readings[r].conditions, columns);
      if (!std::isfinite(x)) throw InputError({without(r)});
      any |= x != 0;
      part.loading.push_back(x);
    }
    if (!any) context_.notes.push_back(table_.path() + ": it is 0 at every reading and changes nothing");
  }

  Table table_;
  const StatedScope& scope_;
  Context& context_;
  Problems& problems_;
  StatedEffect out_;
  std::vector<const Node*> formulas_; ///< by part
};

} // namespace

Shape stated_effects_shape() { return shape::map(table_shape(stated_effect_options())); }

StatedEffects read_stated_effects(Table& table, const StatedScope& scope, Context& context) {
  StatedEffects out;
  for (const Member& m : table.members())
    if (auto own = table.table(m.key))
      out.effects.push_back(StatedEffectsReader(*own, m.key, scope, context).read(out.sizes));
  return out;
}

} // namespace gumshoe::scenario
