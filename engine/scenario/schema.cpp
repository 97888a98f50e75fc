#include "scenario/schema.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenario/analysis.h"
#include "scenario/choose.h"
#include "scenario/plan.h"
#include "scenario/conditions.h"
#include "scenario/correlations.h"
#include "scenario/series.h"
#include "scenario/expected.h"
#include "scenario/machine.h"
#include "scenario/made_models.h"
#include "scenario/options.h"
#include "scenario/quantity.h"
#include "scenario/readouts_file.h"
#include "scenario/row_filter.h"
#include "scenario/readings.h"
#include "scenario/stated_effects.h"
#include "scenario/trace.h"
#include "scenario/volume.h"

namespace gumshoe::scenario {
namespace {

/// Starts like a number; `sign`: the signs it may have.
Shape measure_text(const char* sign) {
  return fmt::format(R"("type": "string", "pattern": "^\\s*[{}]?(\\d+\\.?\\d*|\\.\\d+)([eE][+-]?\\d+)?\\s*")", sign);
}

/// What references name.
std::vector<Key> definitions() {
  using namespace shape;
  const Shape above_zero = number() + R"(, "exclusiveMinimum": 0)";
  return {
      {"measure", any_of({number(), measure_text("+-")}),
       "a number with its unit, such as \"0.6 um\"; a bare number only if it has no dimension"},
      {"width", any_of({above_zero, measure_text("+")}), "above 0, with its unit"},
      {"positive", above_zero, "above 0"},
      {"source", R"("type": ["string", "object", "array"])",
       "source of the number: text, or a table such as { certificate = \"...\", date = 2026-01-15 }"},
      {"labels", map(text(), R"("propertyNames": {"not": {"const": "reading"}})"), "label = value"},
      {"series", series_shape(), "numbers with their units, or a column of a data file"},
      {"where", where_shape(), "label or column = text, list of texts, or { not = ... }"},
      {"formula", R"("type": ["string", "number"])",
       "+ - * / ^ ( ), functions, pi, e, and names of quantities, conditions, indications and intermediates"},
      {"component", component_shape(), "a deviation from the value"},
      {"quantity", quantity_shape(), "an input quantity: a value alone, or with its uncertainty"},
      {"by", map(map(reference("quantity")), R"("minProperties": 1, "maxProperties": 1)"),
       "a label with a quantity for each of its values; \"*\" is every value that has none of its own"},
      {"condition", condition_shape(),
       "one value, a list with a value for each reading, or values evenly spread over n readings, the last value "
       "excluded"},
      {"indication", indication_shape(), "readings of an indication, and their noise"},
  };
}

/// What the cards call their quantities, conditions or indications; a name of several models has several meanings.
class NamedInCards {
public:
  explicit NamedInCards(const char* definition) : definition_(definition) {}
  template <class Cards> void add(const ModelCard& model, const Cards& cards) {
    for (const auto& card : cards) {
      const std::string meaning =
          fmt::format("{}: {}{}", model.name, card.meaning, card.unit == "1" ? "" : fmt::format(", {}", card.unit));
      const auto it = std::ranges::find(keys_, std::string(card.name), &Key::name);
      if (it == keys_.end())
        keys_.push_back({std::string(card.name), shape::reference(definition_), meaning});
      else
        it->meaning += "; " + meaning;
    }
  }
  /// Models that a scenario describes have names of their own.
  Shape shape() const { return shape::table(keys_, "", shape::reference(definition_)); }

private:
  const char* definition_;
  std::vector<Key> keys_;
};

std::string only(const char* section, const std::vector<std::string>& names) {
  return fmt::format(R"("{}": {{"propertyNames": {{"enum": {}}}}})", section, shape::json_string(names));
}

/// What a model of the catalogue has: other names are refused. A described machine renames quantities and conditions.
std::string rules_of(const ModelCard& model, const Catalogue& catalogue) {
  std::vector<std::string> effects;
  for (const EffectCard* e : catalogue.effects)
    if (!catalogue.applies || catalogue.applies(model, *e)) effects.emplace_back(e->name);
  const std::string fixed = fmt::format(R"("model": {{"properties": {{"evaluation": {{{}}}}}}}, {}, {})",
                                        shape::words(names_of(model.evaluations)),
                                        only("indications", names_of(model.indications)), only("effects", effects));
  const std::string named =
      only("conditions", names_of(model.conditions)) + ", " + only("quantities", names_of(model.quantities));
  const auto rule = [&](const std::string& also_if, const std::string& then) {
    return fmt::format(R"({{"if": {{"properties": {{"model": {{"properties": {{"name": {{"const": {}}}}}}}}}{}}}, )"
                       R"("then": {{"properties": {{{}}}}}}})",
                       shape::json_string(model.name), also_if, then);
  };
  const models::Model* row = models::find(model.name);
  if (!row || !row->on_machine) return rule("", fixed + ", " + named);
  return rule("", fixed) + ", " + rule(R"(, "not": {"required": ["machine"]})", named);
}

Shape effects_shape(const Catalogue& catalogue) {
  std::vector<Key> effects;
  for (const EffectCard* e : catalogue.effects) {
    std::vector<Key> quantities;
    for (const QuantityCard& q : e->quantities)
      quantities.push_back({std::string(q.name), shape::reference("quantity"),
                            fmt::format("{}{}", q.meaning, q.unit == "1" ? "" : fmt::format(", {}", q.unit))});
    effects.push_back({std::string(e->name), shape::table(quantities), std::string(e->title)});
  }
  return shape::table(effects);
}

} // namespace

std::vector<Key> model_keys() {
  using namespace shape;
  std::string described;
  for (const MadeModelRow& row : made_models())
    described += fmt::format("{}{} ({})", described.empty() ? "" : ", ", row.name, row.what);
  const Shape formula = reference("formula");
  const Shape measurand = table({{"formula", formula},
                                 {"unit", text(), "unit in which it is shown"},
                                 {"meaning", text(), "command: description of the measurand"}});
  return {
      {"name", text(), "one that gumshoe models lists; or " + described, true},
      {"method", words({"propagation", "virtual_experiment"}),
       "propagation of distributions (JCGM 101), or virtual experiment: draw the true value, simulate and evaluate",
       false, json_string("propagation")},
      {"evaluation", text(), "evaluation of the model; default: the first"},
      {"intermediates", map(formula), "expression: formulas used by others, in any order"},
      {"measurands", map(any_of({formula, measurand})),
       "expression: name = formula, or { formula, unit }; command: name = unit, or { unit, meaning }"},
      {"indications", map(formula), "expression: the simulated readings, for virtual experiments and fits"},
      {"measured", words({"position", "distance"}),
       "serial_chain: what the instrument measures of the target: x, y and z, or its distance", false,
       json_string("position")},
      {"library", text(), "plugin: the shared library, relative to the scenario's folder"},
      {"command", list(text(), R"("minItems": 1)"),
       "command: the program and its arguments; run in the scenario's folder, points as CSV on standard input, results "
       "as CSV on standard output"},
      {"batch", whole(1, 10'000'000), "command: largest number of points per call", false, "10000"},
      {"time_limit", reference("width"), "command: time limit per call; default: 60 s"},
  };
}

std::vector<std::string> sections_with(const std::string& key) {
  std::vector<std::string> out;
  for (const Key& section : sections())
    if (const auto shape = nlohmann::json::parse('{' + section.shape + '}');
        shape.contains("properties") && shape["properties"].contains(key))
      out.push_back(section.name);
  return out;
}

const std::vector<Key>& sections() {
  using namespace shape;
  static const std::vector<Key> all = {
      {"schema", R"("const": 1)", "version of this format", true},
      {"title", text(), "one line, shown in the report"},
      {"model", table(model_keys()), "the model, and how it is evaluated", true},
      {"machine", machine_shape(),
       "the machine on which a model measures, where it works on any: the name of a predefined one, or the axes of "
       "your own"},
      {"data", table(data_keys()),
       "the data file that the readings stand in: its columns that are labels and conditions, and the rows that count"},
      {"conditions", map(reference("condition")), "what was commanded; exact"},
      {"quantities", map(reference("quantity")), "quantities of the model; those left out keep their defaults"},
      {"effects", "", "effects left out stay at their null value"},
      {"indications", map(reference("indication")), "readings of the indications"},
      {"correlations", list(correlation_shape()), "dependence between input quantities"},
      {"estimate", table_shape(estimate_options()), "options of gumshoe estimate"},
      {"run", table_shape(run_options()), "number and kind of samples"},
      {"analysis", table_shape(analysis_options()), "studies of the samples"},
      {"expected", list(expected_shape()),
       "published or exact figures; gumshoe gauge compares the computed ones with "
       "them"},
      {"choose", choose_shape(),
       "options of gumshoe choose: the fastest settings within a target expanded "
       "uncertainty"},
      {"plan", plan_shape(),
       "options of gumshoe plan: the further readings that are allowed, their costs, and what they must reach"},
      {"volume", volume_shape(),
       "options of gumshoe volume: the commands of the machine's axes over which its errors are mapped"},
      {"trace", trace_shape(),
       "options of gumshoe trace: blocks, order, re-done set-up steps, and what was recorded with the readings"},
      {"stated_effects", stated_effects_shape(),
       "effects as formulas: size times formula is added to an indication; without a size, a candidate of gumshoe "
       "trace"},
  };
  return all;
}

std::string schema(const Catalogue& catalogue) {
  NamedInCards conditions("condition"), quantities("quantity"), indications("indication");
  std::string rules;
  for (const ModelCard* model : catalogue.models) {
    conditions.add(*model, model->conditions);
    quantities.add(*model, model->quantities);
    indications.add(*model, model->indications);
    rules += (rules.empty() ? "" : ", ") + rules_of(*model, catalogue);
  }
  std::vector<Key> all = sections();
  for (Key& section : all) {
    if (section.name == "conditions") section.shape = conditions.shape();
    if (section.name == "quantities") section.shape = quantities.shape();
    if (section.name == "indications") section.shape = indications.shape();
    if (section.name == "effects") section.shape = effects_shape(catalogue);
  }
  std::string defined;
  for (const Key& d : definitions())
    defined += (defined.empty() ? "" : ", ") + shape::json_string(d.name) + ": " + shape::described(d);
  return R"({"$schema": "http://json-schema.org/draft-07/schema#", "title": "Gumshoe scenario", "description": )" +
         shape::json_string(
             "What is measured and what is known of each input quantity. Numbers with a dimension are text "
             "with a unit: \"0.6 um\", \"0.2836 deg\".") +
         ", " + shape::table(all, fmt::format(R"("allOf": [{}])", rules)) + R"(, "definitions": {)" + defined + "}}";
}

} // namespace gumshoe::scenario
