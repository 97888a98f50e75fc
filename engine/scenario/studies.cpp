#include "scenario/studies.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenario/family.h"
#include "scenario/quantity.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most = std::int64_t{1} << 40;

std::vector<std::string> names_of(const std::vector<quantities::InputQuantity>& quantities) {
  std::vector<std::string> names;
  for (const auto& q : quantities) names.push_back(q.name);
  return names;
}

void unknown_quantity(const Table& table, const Node& node, const std::string& name, const StudyScope& scope) {
  table.problems().add(node, fmt::format("{}: '{}' is no quantity here", table.path(), name), "",
                       did_you_mean(name, names_of(scope.quantities)));
}

const quantities::InputQuantity* find(const StudyScope& scope, const std::string& name) {
  const auto it =
      std::ranges::find_if(scope.quantities, [&](const quantities::InputQuantity& q) { return q.name == name; });
  return it == scope.quantities.end() ? nullptr : &*it;
}

} // namespace

const VariableCard* read_measurand(Table& table, const ModelCard& model) {
  std::vector<std::string> names;
  for (const VariableCard& m : model.measurands) names.emplace_back(m.name);
  if (!table.require("measurand")) return nullptr;
  const auto index = table.choice("measurand", names);
  return index ? &model.measurands[*index] : nullptr;
}

quantities::Labels read_labels(Table& table, Context& context) {
  quantities::Labels out;
  if (auto labels = table.table("labels")) {
    for (const Member& m : labels->members())
      if (const auto text = read_text(m.value, labels->path(m.key), context.problems)) out.emplace_back(m.key, *text);
  }
  const auto fits = [&](const quantities::Labels& reading) { return matches(reading, out); };
  if (context.readings_known && !out.empty() && std::none_of(context.readings.begin(), context.readings.end(), fits))
    table.add(fmt::format("{}: no reading has {}", table.path(), text_of(out)));
  return out;
}

Adaptive read_adaptive(Table table) {
  Adaptive out;
  out.rule = StoppingRule::stein;
  if (const auto rule = table.choice("rule", {"jcgm_101", "stein"}))
    out.rule = *rule == 0 ? StoppingRule::jcgm_101 : StoppingRule::stein;
  if (const auto n = table.integer("digits", 1, 4)) out.digits = static_cast<int>(*n);
  if (const auto n = table.integer("max_samples", 20'000, most)) out.most = static_cast<std::uint64_t>(*n);
  table.refuse_unknown();
  return out;
}

SensitivityOptions read_sensitivity(Table table) {
  SensitivityOptions out;
  const std::pair<const char*, std::uint64_t SensitivityOptions::*> counts[] = {
      {"sobol", &SensitivityOptions::sobol},
      {"shapley", &SensitivityOptions::shapley},
      {"given_data", &SensitivityOptions::given_data},
      {"morris", &SensitivityOptions::morris},
      {"dgsm", &SensitivityOptions::dgsm}};
  for (const auto& [key, member] : counts)
    if (const auto n = table.integer(key, 0, most)) out.*member = static_cast<std::uint64_t>(*n);
  out.second_order = table.boolean("second_order").value_or(false);
  if (const auto by = table.choice("by", {"draw", "quantity"})) out.by_quantity = *by == 1;
  if (out.by_quantity && out.sobol == 0)
    table.problems().add(*table.find("by"), table.path("by") + ": needs a base size", "it is about Sobol' indices",
                         "sobol = 65536");
  if (out.second_order && out.sobol == 0)
    table.problems().add(*table.find("second_order"), table.path("second_order") + ": needs a base size", "",
                         "sobol = 65536");
  table.refuse_unknown();
  return out;
}

OneAtATime read_one_at_a_time(Table table, const StudyScope& scope, Context& context) {
  OneAtATime out;
  out.title = table.text("title").value_or("");
  const Node* steps = table.require("steps", "steps = [\"100 um\", \"0.1 mrad\"]");
  if (steps && steps->kind == Node::Kind::table) {
    Table given(*steps, table.path("steps"), context.problems);
    for (const Member& m : given.members()) {
      const auto* q = find(scope, m.key);
      if (!q) {
        unknown_quantity(given, m.value, m.key, scope);
      } else if (const auto step = given.measure(m.key, {q->si_unit, units::Kind::difference})) {
        out.steps.push_back({q->name, *step});
      }
    }
  } else if (const auto* list = table.array("steps")) {
    const std::size_t model = std::min(scope.quantities.size(), scope.model.quantities.size());
    for (const Node& item : *list) {
      const auto text = read_text(item, table.path("steps"), context.problems);
      if (!text) continue;
      try {
        const auto measure = units::parse(*text);
        const std::size_t before = out.steps.size();
        for (std::size_t i = 0; i < model; ++i) {
          const auto& q = scope.quantities[i];
          if (q.si_unit != "1" && units::convertible(measure.unit, q.si_unit))
            out.steps.push_back(
                {q.name, units::to_si(measure.number, measure.unit, q.si_unit, units::Kind::difference)});
        }
        if (out.steps.size() == before)
          context.problems.add(item,
                               fmt::format("{}: no quantity has the dimension of '{}'", table.path("steps"), *text));
      } catch (const InputError& error) {
        const Problem& p = error.problems().front();
        context.problems.add(item, table.path("steps") + ": " + p.what, p.why, p.remedy);
      }
    }
    // In the model's order, not the steps'.
    std::ranges::stable_sort(out.steps, {}, [&](const OneAtATime::Step& s) { return find(scope, s.quantity); });
  }
  for (const auto& s : out.steps)
    if (s.step == 0) table.add(fmt::format("{}: the step of {} is zero", table.path(), s.quantity));
  table.refuse_unknown();
  return out;
}

/// The measurand and the labels that a study is about; null if there is no such measurand: then nothing else is judged.
template <class Study>
static const VariableCard* read_subject(Table& table, const StudyScope& scope, Context& context, Study& out) {
  const VariableCard* measurand = read_measurand(table, scope.model);
  out.labels = read_labels(table, context);
  if (measurand)
    out.measurand = measurand->name;
  else
    table.members();
  return measurand;
}

ConformityTest read_conformity(Table table, const StudyScope& scope, Context& context) {
  ConformityTest out;
  const auto* measurand = read_subject(table, scope, context, out);
  if (!measurand) return out;
  const std::string si(measurand->si_unit);
  out.lower = table.measure("lower", {si});
  out.upper = table.measure("upper", {si});
  if (!table.has("lower") && !table.has("upper"))
    table.add(table.path() + ": no tolerance limit", "", "give lower, upper or both");
  if (out.lower && out.upper && *out.lower >= *out.upper)
    table.problems().add(*table.find("lower"), table.path("lower") + ": lower must be below upper");
  if (table.has("guard_band") && table.has("guard_factor"))
    table.add(table.path() + ": guard_band beside guard_factor", "both state the width", "leave one out");
  out.guard_band = table.measure("guard_band", {si, units::Kind::difference}).value_or(0);
  out.guard_factor = table.number("guard_factor").value_or(0);
  if (const Node* process = table.find("process")) {
    const QuantityCard card{measurand->name, measurand->unit, measurand->si_unit, 0, {-1e300, 1e300}, "", ""};
    const auto q = read_quantity(*process, table.path("process"), card, std::string(measurand->name), context);
    if (q.entries.size() != 1 || q.entries[0].components.size() != 1) {
      if (context.problems.empty())
        context.problems.add(*process, table.path("process") + ": must be one distribution", "",
                             "process = { distribution = \"normal\", value = \"...\", u = \"...\" }");
    } else {
      out.process = q.entries[0].components[0].distribution;
      out.process_value = q.entries[0].value;
    }
  }
  table.refuse_unknown();
  return out;
}

Target read_target(Table table, const StudyScope& scope, Context& context) {
  Target out;
  const auto* measurand = read_subject(table, scope, context, out);
  if (!measurand) return out;
  const Node* wanted = table.require("U", "U = \"5 um\"");
  const auto u = table.measure("U", {std::string(measurand->si_unit), units::Kind::difference});
  if (wanted && u && *u <= 0) context.problems.add(*wanted, table.path("U") + ": must be above 0");
  out.expanded_uncertainty = u.value_or(1);
  if (auto costs = table.table("costs")) {
    for (const Member& m : costs->members()) {
      const auto cost = costs->positive(m.key);
      if (!find(scope, m.key))
        unknown_quantity(*costs, m.value, m.key, scope);
      else if (cost)
        out.costs.emplace_back(m.key, *cost);
    }
  }
  table.refuse_unknown();
  return out;
}

std::vector<std::vector<std::string>> read_joint(Table& table, const StudyScope& scope, Problems& problems) {
  std::vector<std::vector<std::string>> out;
  const auto* groups = table.array("joint");
  if (!groups) return out;
  std::vector<std::string> names;
  for (const VariableCard& m : scope.model.measurands) names.emplace_back(m.name);
  for (const Node& group : *groups) {
    std::vector<std::string> measurands;
    for (const Node& item : group.items) {
      const auto name = read_text(item, table.path("joint"), problems);
      if (!name) continue;
      if (std::ranges::find(names, *name) == names.end())
        problems.add(item, fmt::format("{}: '{}' is no measurand here", table.path("joint"), *name), "",
                     did_you_mean(*name, names));
      else if (std::ranges::find(measurands, *name) != measurands.end())
        problems.add(item, fmt::format("{}: '{}' is named twice", table.path("joint"), *name));
      measurands.push_back(*name);
    }
    if (group.kind != Node::Kind::array || measurands.size() < 2)
      problems.add(group, table.path("joint") + ": each group needs two measurands or more", "",
                   "joint = [[\"a\", \"b\"]]");
    out.push_back(measurands);
  }
  return out;
}

} // namespace gumshoe::scenario
