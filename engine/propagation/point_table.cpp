#include "propagation/point_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/units.h"
#include "propagation/run.h"

namespace gumshoe::propagation {

namespace {

/// One value of the model that a table column may set.
struct Slot {
  std::string name, unit, si_unit;
  double value;
  Limits limits;
  std::vector<double> column; ///< given values, SI; empty: the default
  std::string given_unit;
  int given_column = -1;
};

constexpr Limits any{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

std::vector<Slot> slots_of(const models::Model& model) {
  std::vector<Slot> slots;
  const auto add = [&](const std::string& prefix, const auto& q, const Limits& limits) {
    slots.push_back({prefix + std::string(q.name),
                     std::string(q.unit),
                     std::string(q.si_unit),
                     q.default_value,
                     limits,
                     {},
                     {},
                     -1});
  };
  for (const auto& q : model.card->quantities) add("", q, q.limits);
  for (const EffectCard* e : effects::cards())
    if (effects::applies(*model.card, *e))
      for (const auto& q : e->quantities) add(std::string(e->name) + ".", q, q.limits);
  for (const auto& c : model.card->conditions) add("", c, any);
  for (const auto& i : model.card->indications) add("", i, any);
  return slots;
}

/// "beam_pitch (deg)" -> name and unit; a name without brackets has unit 1.
std::pair<std::string, std::string> split_header(const std::string& text) {
  const auto open = text.find('(');
  if (open == std::string::npos || text.back() != ')') return {text, "1"};
  std::string name = text.substr(0, open), unit = text.substr(open + 1, text.size() - open - 2);
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return {name, unit};
}

void read_columns(std::vector<Slot>& slots, const Csv& table, std::vector<Problem>& problems,
                  std::vector<Problem>& impossible, std::vector<bool>& bad_row) {
  std::vector<std::string> names;
  for (const Slot& s : slots) names.push_back(s.name);
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const auto [name, unit] = split_header(table.header[c].text);
    Slot* slot = nullptr;
    for (Slot& s : slots)
      if (s.name == name) slot = &s;
    if (!slot) {
      const std::string meant = nearest(name, names);
      problems.push_back({table.at(table.header[c]), "unknown column '" + name.substr(0, 60) + "'", "",
                          meant.empty() ? "" : "did you mean '" + meant + "'?"});
      continue;
    }
    if (slot->given_column >= 0) {
      problems.push_back({table.at(table.header[c]), "column '" + name + "' stands twice", "", "remove one of them"});
      continue;
    }
    slot->given_column = static_cast<int>(c);
    slot->given_unit = unit;
    try {
      units::to_si(1, unit, slot->si_unit);
    } catch (const InputError& error) {
      Problem p = error.problems().front();
      p.where = table.at(table.header[c]);
      p.what = name + ": " + p.what;
      problems.push_back(p);
      continue;
    }
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const CsvCell& cell = table.rows[r][c];
      try {
        const double x = units::to_si(table.number(cell), unit, slot->si_unit);
        slot->column.push_back(x);
        if (!slot->limits.contain(x)) {
          bad_row[r] = true;
          const auto shown = [&](double v) { return units::from_si(v, slot->unit, slot->si_unit); };
          impossible.push_back(
              {table.at(cell), fmt::format("{}: {} {} is impossible", name, cell.text, unit),
               fmt::format("limits {}{:g}, {:g}{} {}", slot->limits.low_open ? "above " : "", shown(slot->limits.low),
                           shown(slot->limits.high), slot->limits.high_open ? " excluded" : "", slot->unit),
               ""});
        }
      } catch (const InputError& error) {
        Problem p = error.problems().front();
        if (p.where.file.empty()) p.where = table.at(cell);
        problems.push_back(p);
        slot->column.push_back(0);
      }
    }
  }
}

/// Only effects that the table names are active.
std::vector<effects::Active> named_effects(const ModelCard& card, const std::vector<Slot>& slots) {
  std::vector<effects::Active> active;
  for (std::size_t e = 0, at = card.quantities.size(); e < effects::cards().size(); ++e) {
    if (!effects::applies(card, *effects::cards()[e])) continue;
    const std::size_t size = effects::cards()[e]->quantities.size();
    bool named = false;
    for (std::size_t i = at; i < at + size; ++i) named |= slots[i].given_column >= 0;
    if (named) active.push_back({e, at - card.quantities.size()});
    at += size;
  }
  return active;
}

/// A joint evaluation: every row of the table is a reading, and there is one result.
void evaluate_together(const models::Model& model, int evaluation, const std::vector<Slot>& slots, const Csv& table,
                       const std::vector<bool>& bad_row, PointTable& result) {
  constexpr std::size_t n = 8; // one lane group; every lane the same
  if (table.rows.empty()) throw InputError({{{table.file}, "the table has no rows", "every row is a reading", ""}});
  const ModelCard& card = *model.card;
  const std::size_t rows = table.rows.size(), q = card.quantities.size(), k = card.indications.size();
  const std::size_t effect_quantities = slots.size() - q - card.conditions.size() - k;
  std::vector<models::Column> quantities, of_effects, conditions, indications;
  std::vector<double> first;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const models::Column column{slots[i].column.empty() ? &slots[i].value : &slots[i].column[r], 0};
      (i < q                       ? quantities
       : i < q + effect_quantities ? of_effects
       : i + k < slots.size()      ? conditions
                                   : indications)
          .push_back(column);
      if (r == 0 && i < q) first.push_back(*column.data);
    }
  auto measurands = card.evaluations[static_cast<std::size_t>(evaluation)].measurands;
  if (model.measurands_in_use) measurands = measurands.first(model.measurands_in_use(evaluation, first.data()));
  std::vector<double> values(measurands.size() * n);
  std::vector<double*> value_rows;
  for (std::size_t m = 0; m < measurands.size(); ++m) value_rows.push_back(&values[m * n]);
  std::vector<std::size_t> itself(rows);
  for (std::size_t r = 0; r < rows; ++r) itself[r] = r;
  std::uint8_t status[n] = {};
  const auto active = named_effects(card, slots);
  models::BlockCall call;
  call.samples = n;
  call.readings = rows;
  call.quantities = quantities.data();
  call.effects = of_effects.data();
  call.effect_quantities = effect_quantities;
  call.active = active;
  call.conditions = conditions.data();
  call.indications = indications.data();
  call.measurands = value_rows.data();
  call.solved_as = itself.data();
  call.status = status;
  call.evaluation = evaluation;
  call.context = model.context;
  for (std::size_t r = 0; r < rows; ++r) {
    std::vector<double> point;
    for (const Slot& s : slots) point.push_back(s.column.empty() ? s.value : s.column[r]);
    models::PointCall<double> at;
    at.quantities = point.data();
    at.effects = at.quantities + q;
    at.active = active;
    at.conditions = at.effects + effect_quantities;
    at.indications = at.conditions + card.conditions.size();
    at.evaluation = evaluation;
    at.context = model.context;
    const std::string wrong = bad_row[r] ? std::string() : model.check(at);
    if (!wrong.empty())
      result.impossible.push_back({{table.file, table.rows[r][0].line, 1}, wrong, "physically impossible", ""});
  }
  const bool possible = result.impossible.empty() && std::ranges::find(bad_row, true) == bad_row.end();
  const std::string problem = model.check_readings && possible ? model.check_readings(call) : std::string();
  if (!problem.empty()) result.impossible.push_back({{table.file}, problem, "", ""});
  if (problem.empty() && possible && model.remarks) result.notes = model.remarks(call);
  if (problem.empty() && possible)
    model.kernels()->evaluate(call);
  else
    status[0] = code(Status::out_of_domain);
  result.joint = true;
  for (std::size_t m = 0; m < measurands.size(); ++m) {
    const VariableCard& v = measurands[m];
    result.header.push_back(fmt::format("{} ({})", v.name, v.unit));
    result.columns.push_back({status[0] == 0
                                  ? units::from_si(values[m * n], std::string(v.unit), std::string(v.si_unit))
                                  : std::numeric_limits<double>::quiet_NaN()});
  }
  result.status = {status_name(static_cast<Status>(status[0]))};
}

} // namespace

PointTable evaluate_points(const models::Model& model, const Csv& table, const std::string& evaluation) {
  const ModelCard& card = *model.card;
  const std::size_t rows = table.rows.size(), n = (rows + 7) / 8 * 8;
  std::vector<Slot> slots = slots_of(model);
  std::vector<Problem> problems;
  PointTable result;
  std::vector<bool> bad_row(rows, false);
  read_columns(slots, table, problems, result.impossible, bad_row);
  const auto given = [&](std::string_view name) -> const Slot* {
    for (const Slot& s : slots)
      if (s.name == name && s.given_column >= 0) return &s;
    return nullptr;
  };
  bool indicated = false;
  for (const auto& i : card.indications) indicated |= given(i.name) != nullptr;
  for (const auto& i : card.indications)
    if (indicated && !given(i.name))
      problems.push_back(
          {{table.file}, fmt::format("column '{}' is missing", i.name), "the other indications are given", ""});
  for (const auto& m : card.measurands)
    if (const Slot* s = given(m.name); s && indicated)
      problems.push_back({table.at(table.header[static_cast<std::size_t>(s->given_column)]),
                          "column '" + s->name + "' is what the indications are evaluated for", "it is an output here",
                          "remove one of them"});
  std::size_t chosen = card.evaluations.size();
  for (std::size_t i = 0; i < card.evaluations.size(); ++i)
    if (evaluation.empty() ? i == 0 : card.evaluations[i].name == evaluation) chosen = i;
  if (chosen == card.evaluations.size()) {
    std::vector<std::string> names;
    for (const EvaluationCard& e : card.evaluations) names.emplace_back(e.name);
    const std::string meant = nearest(evaluation, names);
    problems.push_back(
        {{}, "unknown evaluation '" + evaluation + "'", "", meant.empty() ? "" : "did you mean '" + meant + "'?"});
  } else if (!indicated && card.evaluations[chosen].joint()) {
    problems.push_back({{table.file},
                        "no column of readings: '" + evaluation + "' evaluates them together",
                        "",
                        fmt::format("add a column '{} ({})'", card.indications[0].name, card.indications[0].unit)});
  }
  if (!problems.empty()) throw InputError(problems);

  if (indicated && card.evaluations[chosen].joint()) {
    evaluate_together(model, static_cast<int>(chosen), slots, table, bad_row, result);
    return result;
  }

  // Columns padded to whole lane groups; the padding repeats the last row.
  std::vector<models::Column> columns;
  for (Slot& s : slots) {
    if (!s.column.empty()) s.column.resize(n, s.column.back());
    columns.push_back(s.column.empty() ? models::Column{&s.value, 0} : models::Column{s.column.data(), 1});
  }
  const std::size_t q = card.quantities.size(), m = card.measurands.size(), k = card.indications.size();
  const std::size_t conditions = slots.size() - k - card.conditions.size();
  const std::vector<effects::Active> active = named_effects(card, slots);

  std::vector<double> measured(m * n), simulated(k * n);
  std::vector<double*> measurand_rows, simulated_rows;
  for (std::size_t i = 0; i < m; ++i) measurand_rows.push_back(&measured[i * n]);
  for (std::size_t i = 0; i < k; ++i) simulated_rows.push_back(&simulated[i * n]);
  std::vector<std::uint8_t> status(n, 0);
  const std::size_t itself = 0;
  models::BlockCall call;
  call.samples = n;
  call.readings = 1;
  call.quantities = columns.data();
  call.effects = columns.data() + q;
  call.effect_quantities = conditions - q;
  call.active = active;
  call.conditions = columns.data() + conditions;
  call.indications = columns.data() + slots.size() - k;
  call.simulated = simulated_rows.data();
  call.measurands = measurand_rows.data();
  call.solved_as = &itself;
  call.status = status.data();
  call.evaluation = static_cast<int>(chosen);
  call.context = model.context;
  if (n > 0) (indicated ? model.kernels()->evaluate : model.kernels()->simulate)(call);

  const auto add = [&](const VariableCard& v, const std::vector<double>& values, std::size_t row) {
    result.header.push_back(fmt::format("{} ({})", v.name, v.unit));
    result.columns.emplace_back();
    for (std::size_t i = 0; i < rows; ++i)
      result.columns.back().push_back(
          status[i] == 0 ? units::from_si(values[row * n + i], std::string(v.unit), std::string(v.si_unit))
                         : std::numeric_limits<double>::quiet_NaN());
  };
  for (std::size_t r = 0; r < rows; ++r) {
    const std::string problem = [&] {
      std::vector<double> point;
      for (const models::Column& c : columns) point.push_back(c.data[c.stride * r]);
      models::PointCall<double> at;
      at.quantities = point.data();
      at.effects = at.quantities + q;
      at.active = active;
      at.conditions = at.quantities + conditions;
      at.indications = at.quantities + slots.size() - k;
      at.evaluation = static_cast<int>(chosen);
      at.context = model.context;
      return model.check(at);
    }();
    if (!problem.empty() && !bad_row[r])
      result.impossible.push_back(
          {table.rows[r].empty() ? Location{table.file} : Location{table.file, table.rows[r][0].line, 1}, problem,
           "physically impossible", ""});
    if (!problem.empty() || bad_row[r]) status[r] = code(Status::out_of_domain);
  }
  for (std::size_t i = 0; i < m; ++i) {
    bool is_quantity = false; // simulation repeats its input, the true measurand
    for (const auto& c : card.quantities) is_quantity |= c.name == card.measurands[i].name;
    if (indicated || !is_quantity) add(card.measurands[i], measured, i);
  }
  if (!indicated)
    for (std::size_t i = 0; i < k; ++i) add(card.indications[i], simulated, i);
  for (std::size_t r = 0; r < rows; ++r) result.status.push_back(status_name(static_cast<Status>(status[r])));
  return result;
}

} // namespace gumshoe::propagation
