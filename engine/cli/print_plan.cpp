#include "cli/print_plan.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include <fmt/format.h>

#include "analysis/fields_json.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/units.h"
#include "quantities/cells.h"
#include "tracing/planning/fields.h"

namespace gumshoe::cli {

namespace {

using analysis::Json;
using scenario::AllowedReading;
using scenario::PlanColumn;
using tracing::GoalReached;
using tracing::Planned;

std::string cell(const PlanColumn& column, const AllowedReading& reading) {
  if (column.holds == PlanColumn::Holds::nothing) return "";
  if (column.holds == PlanColumn::Holds::label) {
    const std::string* value = quantities::label_value(reading.labels, column.label);
    return value ? *value : "";
  }
  const double x = reading.conditions[column.condition];
  for (const auto& [word, value] : column.words)
    if (value == x) return word;
  return fmt::format("{:.12g}", units::from_si(x, column.unit, column.si_unit));
}

std::string share(double p) {
  if (p > 0.999) return "> 99.9 %";
  if (p < 0.001) return "< 0.1 %";
  return fmt::format("{:.{}f} %", 100 * p, p < 0.0995 || p > 0.99 ? 1 : 0);
}

bool is_test(const GoalReached& g) { return g.kind == GoalReached::Kind::split || g.kind == GoalReached::Kind::detect; }

std::string figure(const Planned& plan, const GoalReached& g, double x) {
  if (is_test(g)) return share(x);
  if (std::isinf(x)) return "unknown";
  if (plan.noise == Planned::Noise::unknown) return fmt::format("{:.3g}", x);
  const double shown = units::from_si(x, g.unit, g.si_unit, units::Kind::difference);
  return fmt::format("{:.3g}{}", shown, units::suffix(g.unit));
}

std::string words(const GoalReached& g) {
  if (!is_test(g)) return "u of " + g.of;
  const double shown = units::from_si(g.size, g.unit, g.si_unit, units::Kind::difference);
  const std::string size = fmt::format("{:.3g}{}", shown, units::suffix(g.unit));
  return g.kind == GoalReached::Kind::detect ? fmt::format("{} of {} is detected", g.of, size)
                                             : fmt::format("{} of {} is not taken for {}", g.of, size, g.against);
}

void print_readings(const Planned& plan) {
  std::size_t width = 7;
  for (const auto& r : plan.readings) width = std::max(width, r.setting.size());
  std::cout << fmt::format("{:>8}  {:<{}}  {:>6}\n", "readings", "setting", width, "cost");
  for (const auto& r : plan.readings)
    std::cout << fmt::format("{:>8}  {:<{}}  {:>6.4g}\n", r.count, r.setting, width, r.cost);
}

void print_goals(const Planned& plan) {
  std::size_t width = 4;
  for (const GoalReached& g : plan.goals) width = std::max(width, words(g).size());
  std::cout << fmt::format("{:<{}}  {:>10}  {:>10}  {:>10}\n", "goal", width, "before", "after", "wanted");
  for (const GoalReached& g : plan.goals)
    std::cout << fmt::format("{:<{}}  {:>10}  {:>10}  {:>10}{}\n", words(g), width, figure(plan, g, g.before),
                             figure(plan, g, g.after), g.wanted > 0 ? figure(plan, g, g.wanted) : "",
                             g.met ? "" : "  not met");
  std::set<std::string> said;
  for (const GoalReached& g : plan.goals)
    if (!g.remark.empty() && said.insert(g.remark).second) std::cout << g.remark << '\n';
}

std::string answer(const Planned& plan) {
  const std::string what = plan.count == 1 ? "1 further reading" : fmt::format("{} further readings", plan.count);
  const std::string setups = plan.opened.empty() ? "" : fmt::format(", with {}", fmt::join(plan.opened, ", "));
  const std::string all =
      fmt::format("{}{}{}, cost {:.4g}", what, setups, plan.repeats ? ", repeats told apart" : "", plan.cost);
  if (plan.d_optimal) return "the most informative: " + all;
  if (plan.met) return plan.count == 0 ? "every goal is met without further readings" : "every goal is met by " + all;
  const bool possible = std::ranges::any_of(plan.goals, [](const GoalReached& g) { return g.possible; });
  return possible ? "within the limits not every goal is met; closest to it: " + all
                  : "a thousand of each allowed reading meet no goal, so that none is listed; see below";
}

void print_text(const scenario::Scenario& s, const Planned& plan, const std::string& file) {
  if (!s.title.empty()) std::cout << printable(s.title) << '\n';
  std::cout << answer(plan) << '\n';
  if (!plan.readings.empty()) print_readings(plan);
  print_goals(plan);
  if (plan.noise == Planned::Noise::unknown)
    std::cout << "no noise is known: u is in units of the noise of a reading\n";
  for (const auto& v : plan.verified)
    std::cout << fmt::format("gumshoe trace on simulated readings: {}{} in {} of {} data sets\n", v.of,
                             v.against.empty() ? " found" : fmt::format(" found and not {}", v.against), v.found,
                             v.sets);
  for (const std::string& note : plan.notes) std::cout << "note: " << note << '\n';
  std::cout << fmt::format("{} allowed readings compared; to be filled in: {}\n", plan.allowed, file);
}

void print_json(const scenario::Scenario& s, const Planned& plan, const std::string& file) {
  Json out{{"scenario", s.file}, {"hash", s.hash}};
  analysis::add_json(out, tracing::plan_fields, plan);
  const auto list = [&](const char* key, const auto& fields, const auto& rows) {
    out[key] = Json::array();
    for (const auto& row : rows) out[key].push_back(analysis::json(fields, row));
  };
  list("readings", tracing::planned_reading_fields, plan.readings);
  list("goals", tracing::goal_fields, plan.goals);
  list("verified", tracing::verified_fields, plan.verified);
  out["opened"] = plan.opened;
  out["notes"] = plan.notes;
  out["file"] = file;
  std::cout << json_text(out) << '\n';
}

} // namespace

std::string plan_table(const scenario::Scenario& s, const Planned& plan) {
  std::string out;
  const auto& columns = s.plan->columns;
  for (std::size_t c = 0; c < columns.size(); ++c) out += (c > 0 ? "," : "") + csv_cell(columns[c].header);
  const bool told = plan.repeats && std::ranges::find(columns, "repeat", &PlanColumn::header) == columns.end();
  out += told ? ",repeat\n" : "\n";
  for (const auto& r : plan.readings)
    for (int n = 0; n < r.count; ++n) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        out += (c > 0 ? "," : "") + csv_cell(cell(columns[c], s.plan->readings[r.allowed]));
      out += told ? fmt::format(",{}\n", n + 1) : "\n";
    }
  return out;
}

void print_plan(const scenario::Scenario& s, const Planned& plan, const std::string& file, const std::string& format) {
  if (format == "json")
    print_json(s, plan, file);
  else if (format == "csv")
    std::cout << plan_table(s, plan);
  else
    print_text(s, plan, file);
}

} // namespace gumshoe::cli
