#include "scenario/studies.h"

#include <algorithm>

#include "scenario/quantity.h"

namespace gumshoe::scenario {
namespace {

Options<OneAtATime> one_at_a_time_options() {
  return {
      option::text("title", &OneAtATime::title, "heading of the table"),
      option::by_hand<OneAtATime>(
          "steps",
          shape::any_of({shape::list(shape::text(), R"("minItems": 1)"), shape::map(shape::reference("measure"))}),
          "a step for each quantity of its dimension, or steps by name")
          .needed("steps = [\"100 um\", \"0.1 mrad\"]"),
  };
}

Options<ConformityTest> conformity_options(const std::string& si_unit) {
  using Test = ConformityTest;
  return {
      option::by_hand<Test>(measurand_key()),
      option::by_hand<Test>(labels_key()),
      option::measure("lower", &Test::lower, {si_unit}, "lower tolerance limit"),
      option::measure("upper", &Test::upper, {si_unit}, "upper tolerance limit"),
      option::measure("guard_band", &Test::guard_band, {si_unit, units::Kind::difference},
                      "w, distance of the acceptance limits inside the tolerance limits; below 0: outside"),
      option::number("guard_factor", &Test::guard_factor, "r of w = r U"),
      option::word("rule", &Test::rule,
                   std::vector{DecisionRule::simple_acceptance, DecisionRule::iso_14253_1, DecisionRule::ilac_g8},
                   "decision rule by name instead of a guard band: w = 0; w = 1.65 u (ISO 14253-1); w = U (ILAC-G8)"),
      option::by_hand<Test>("process", shape::reference("quantity"),
                            "prior knowledge of the measurand, as one distribution; gives the global risks"),
  };
}

Options<Target> target_options(const std::string& si_unit) {
  return {
      option::by_hand<Target>(measurand_key()),
      option::by_hand<Target>(labels_key()),
      option::width("U", &Target::expanded_uncertainty, si_unit, "target expanded uncertainty").needed("U = \"5 um\""),
      option::by_hand<Target>("costs", shape::map(shape::reference("positive")),
                              "cost of a quantity at its present u; half of u costs twice as much"),
  };
}

const quantities::InputQuantity* find(const StudyScope& scope, const std::string& name) {
  const auto it = std::ranges::find(scope.quantities, name, &quantities::InputQuantity::name);
  return it == scope.quantities.end() ? nullptr : &*it;
}

void unknown_quantity(const Table& table, const Node& node, const std::string& name, const StudyScope& scope) {
  table.problems().add(node, fmt::format("{}: '{}' is not a quantity here", table.path(), name), "",
                       did_you_mean(name, names_of(scope.quantities)));
}

/// steps = { rod_radius = "100 um" }
void read_named_steps(Table table, const StudyScope& scope, OneAtATime& out) {
  for (const Member& m : table.members()) {
    const auto* q = find(scope, m.key);
    if (!q)
      unknown_quantity(table, m.value, m.key, scope);
    else if (const auto step = table.measure(m.key, {q->si_unit, units::Kind::difference}))
      out.steps.push_back({q->name, *step});
  }
}

/// steps = ["100 um", "0.1 mrad"], each for every quantity of its dimension.
void read_listed_steps(const std::vector<Node>& list, const std::string& path, const StudyScope& scope,
                       Problems& problems, OneAtATime& out) {
  const std::size_t model = std::min(scope.quantities.size(), scope.model.quantities.size());
  for (const Node& item : list) {
    const auto text = read_text(item, path, problems);
    if (!text) continue;
    try {
      const auto measure = units::parse(*text);
      const std::size_t before = out.steps.size();
      for (std::size_t i = 0; i < model; ++i) {
        const auto& q = scope.quantities[i];
        if (q.si_unit != "1" && units::convertible(measure.unit, q.si_unit))
          out.steps.push_back({q.name, units::to_si(measure.number, measure.unit, q.si_unit, units::Kind::difference)});
      }
      if (out.steps.size() == before)
        problems.add(item, fmt::format("{}: no quantity has the dimension of '{}'", path, *text));
    } catch (const InputError& error) {
      problems.add(item, path, error);
    }
  }
  // In the model's order, not the steps'.
  std::ranges::stable_sort(out.steps, {}, [&](const OneAtATime::Step& s) { return find(scope, s.quantity); });
}

} // namespace

OneAtATime read_one_at_a_time(Table table, const StudyScope& scope) {
  OneAtATime out;
  read_options(table, one_at_a_time_options(), out);
  const Node* steps = table.find("steps");
  if (steps && steps->kind == Node::Kind::table)
    read_named_steps(Table(*steps, table.path("steps"), table.problems()), scope, out);
  else if (const auto* list = table.array("steps"))
    read_listed_steps(*list, table.path("steps"), scope, table.problems(), out);
  for (const auto& s : out.steps)
    if (s.step == 0) table.refuse(fmt::format("the step of {} is zero", s.quantity));
  table.refuse_unknown();
  return out;
}

ConformityTest read_conformity(Table table, const StudyScope& scope, Context& context) {
  ConformityTest out;
  const auto* measurand = read_subject(table, scope, context, out);
  if (!measurand) return out;
  read_options(table, conformity_options(std::string(measurand->si_unit)), out);
  if (!table.has("lower") && !table.has("upper"))
    table.refuse("no tolerance limit is given", "", "give lower, upper or both");
  if (out.lower && out.upper && *out.lower >= *out.upper) table.refuse_key("lower", "lower must be below upper");
  if (table.has("guard_band") && table.has("guard_factor"))
    table.refuse("both guard_band and guard_factor are given", "both state the width", "leave one out");
  if (table.has("rule") && (table.has("guard_band") || table.has("guard_factor")))
    table.refuse("a guard band is given together with rule", "the rule fixes the guard band", "leave one out");
  if (const Node* process = table.find("process")) {
    const QuantityCard card{measurand->name, measurand->unit, measurand->si_unit, 0, {-1e300, 1e300}, "", ""};
    const std::size_t without_value = context.without_value.size();
    const auto q = read_quantity(*process, table.path("process"), card, std::string(measurand->name), context);
    if (context.without_value.size() > without_value) {
      context.without_value.resize(without_value);
      table.refuse_key("process", "has no value", "the mean of what the process makes is not known",
                       "process = { value = \"...\", u = \"...\" }");
    } else if (std::ranges::any_of(q.entries, [](const auto& e) {
                 return std::ranges::any_of(e.components, [](const auto& c) {
                   return c.distribution.family == quantities::Family::t && c.distribution.values;
                 });
               })) {
      table.refuse_key(
          "process", "is stated by observations",
          "a Type A evaluation gives the uncertainty of their mean, and not the spread of what the process makes",
          "process = { value = \"mean\", u = \"standard deviation\" }");
    } else if (q.entries.size() == 1 && q.entries[0].components.size() == 1) {
      out.process = q.entries[0].components[0].distribution;
      out.process_value = q.entries[0].value;
    } else if (context.problems.empty()) {
      table.refuse_key("process", "must be one distribution", "",
                       "process = { distribution = \"normal\", value = \"...\", u = \"...\" }");
    }
  }
  table.refuse_unknown();
  return out;
}

Target read_target(Table table, const StudyScope& scope, Context& context) {
  Target out;
  const auto* measurand = read_subject(table, scope, context, out);
  if (!measurand) return out;
  read_options(table, target_options(std::string(measurand->si_unit)), out);
  if (auto costs = table.table("costs"))
    for (const Member& m : costs->members()) {
      const auto cost = costs->positive(m.key);
      if (!find(scope, m.key))
        unknown_quantity(*costs, m.value, m.key, scope);
      else if (cost)
        out.costs.emplace_back(m.key, *cost);
    }
  table.refuse_unknown();
  return out;
}

Shape one_at_a_time_shape() { return table_shape(one_at_a_time_options()); }
Shape target_shape() { return table_shape(target_options("1")); }
Shape conformity_shape() {
  return table_shape(conformity_options("1"), R"("anyOf": [{"required": ["lower"]}, {"required": ["upper"]}], )"
                                              R"("not": {"required": ["guard_band", "guard_factor"]})");
}

Key measurand_key() { return {"measurand", shape::text(), "measurand of the evaluation", true}; }
Key labels_key() { return {"labels", shape::reference("labels"), "labels of the readings; default: all"}; }

const VariableCard* read_measurand(Table& table, const ModelCard& model) {
  if (!table.require("measurand")) return nullptr;
  const auto index = table.choice("measurand", names_of(model.measurands));
  return index ? &model.measurands[*index] : nullptr;
}

quantities::Labels read_labels(Table& table, Context& context) {
  quantities::Labels out;
  if (auto labels = table.table("labels")) {
    for (const Member& m : labels->members())
      if (const auto text = read_text(m.value, labels->path(m.key), context.problems)) out.emplace_back(m.key, *text);
  }
  const auto fits = [&](const quantities::Labels& reading) { return quantities::holds_for(out, reading); };
  if (context.readings_known && !out.empty() && std::ranges::none_of(context.readings, fits))
    table.refuse(fmt::format("no reading has {}", text_of(out)));
  return out;
}

} // namespace gumshoe::scenario
