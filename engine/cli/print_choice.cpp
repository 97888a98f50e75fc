#include "cli/print_choice.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "analysis/fields_json.h"
#include "analysis/rounding.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/units.h"
#include "choice/choose.h"
#include "choice/fields.h"

namespace gumshoe::cli {

namespace {

using analysis::Json;
using analysis::number;
using choice::Candidate;
using choice::Figures;
using choice::Result;
using scenario::Knob;

double length(const Result& r, double si) { return units::from_si(si, r.unit, r.si_unit, units::Kind::difference); }

/// "3.1 um", with the decimals that U asks for.
std::string width(const Result& r, double si, double expanded) {
  return analysis::fixed(length(r, si), analysis::decimals_for(length(r, expanded))) + units::suffix(r.unit);
}

std::string value_text(const Result& r, std::size_t variable, double value, int digits) {
  const Knob& k = r.asked.variables[variable].knob;
  if (k.kind == Knob::Kind::evaluation) return r.evaluations[static_cast<std::size_t>(value)];
  return fmt::format("{:.{}g}", units::from_si(value, k.unit, k.si_unit), digits);
}

/// Inputs by total effect, the largest first.
std::vector<std::pair<std::string, double>> limiting(const Result& r) {
  std::vector<std::pair<std::string, double>> rows;
  for (const auto& i : r.sensitivity.indices) rows.emplace_back(i.input, i.total);
  for (const auto& i : r.shapley.effects) rows.emplace_back(i.input, i.value);
  std::ranges::stable_sort(rows, [](const auto& a, const auto& b) { return a.second > b.second; });
  return rows;
}

void print_text(const Result& r, const std::string& file) {
  const bool worst = r.asked.worst_case;
  // Two digits of every U; a bias has the decimals of its U.
  const auto u = [&](double si) { return width(r, si, si); };
  if (!r.title.empty()) std::cout << printable(r.title) << '\n';
  std::cout << r.statement << '\n';
  const Figures& searched = asked(r.candidates[r.best], worst);
  std::cout << fmt::format("U of the average {}, bias {}, standard deviation {}; in the search U was {}\n",
                           u(r.fresh.average.expanded), width(r, r.fresh.average.mean, r.fresh.average.expanded),
                           u(r.fresh.average.standard_deviation), u(searched.expanded));
  for (std::size_t k = 0; k < r.fresh.cases.size(); ++k)
    std::cout << fmt::format("case {}: U {}, mean error left {}\n", r.asked.cases[k].name, u(r.fresh.cases[k].expanded),
                             width(r, r.fresh.cases[k].left, r.fresh.cases[k].expanded));
  const auto limits = limiting(r);
  if (!limits.empty()) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(5, limits.size()); ++i)
      if (limits[i].second >= 0.005)
        text +=
            fmt::format("{}{} {}", text.empty() ? "" : ", ", limits[i].first, analysis::share_text(limits[i].second));
    std::cout << fmt::format("what limits it ({} of the variance): {}\n",
                             r.shapley.effects.empty() ? "total Sobol' indices" : "Shapley effects", text);
  }
  for (const auto& n : r.neighbours) {
    const Candidate& c = r.candidates[n.candidate];
    const Knob& knob = r.asked.variables[n.variable].knob;
    std::cout << fmt::format("instead {} {}{}: time {:+.1f} %, U {:+.1f} %{}\n", knob.name,
                             value_text(r, n.variable, c.values[n.variable], 4), units::suffix(knob.unit),
                             100 * (n.time_ratio - 1), 100 * (n.expanded_ratio - 1),
                             !c.meets    ? ", misses the target"
                             : c.refuted ? ", not confirmed by fresh samples"
                                         : "");
  }
  if (r.near_count > 1) {
    std::string text;
    for (std::size_t v = 0; v < r.near.size(); ++v)
      if (const Knob& k = r.asked.variables[v].knob; k.kind != Knob::Kind::evaluation)
        text += fmt::format(", {} {} to {}{}", k.name, value_text(r, v, r.near[v].low, 4),
                            value_text(r, v, r.near[v].high, 4), units::suffix(k.unit));
    std::cout << fmt::format("{} candidates meet the target within {:.3g} % of the least time{}\n", r.near_count,
                             100 * r.asked.near, text);
  }
  for (const auto& c : r.compared) {
    const Figures& f = asked(c.candidate, worst);
    std::cout << fmt::format("compared, {} ({}): {}, U = {}, bias {}{}; {:.3g} times as long as {}\n", c.name,
                             c.setting, choice::duration(c.candidate.time), width(r, f.expanded, f.expanded),
                             width(r, c.candidate.average.mean, f.expanded),
                             c.candidate.meets ? "" : ", misses the target", c.candidate.time / r.fresh.time,
                             r.reached ? "the recommended one" : "that of the smallest U");
  }
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < r.candidates.size(); ++i)
    if (r.candidates[i].pareto) front.push_back(i);
  std::ranges::stable_sort(front, {}, [&](std::size_t i) { return r.candidates[i].time; });
  constexpr std::size_t most = 12; // of a long front some, evenly
  std::cout << fmt::format("Pareto front (time, U){}:\n",
                           front.size() > most ? fmt::format(", some of its {} settings", front.size()) : "");
  const std::size_t step = (front.size() + most - 1) / most;
  for (std::size_t k = 0; k < front.size(); ++k) {
    const Candidate& c = r.candidates[front[k]];
    if (k % step != 0 && k + 1 != front.size() && front[k] != r.best) continue;
    std::cout << fmt::format("  {:>12}  {:>12}  {}{}\n", choice::duration(c.time),
                             width(r, asked(c, worst).expanded, asked(c, worst).expanded),
                             choice::in_words(r, c.values),
                             front[k] == r.best ? r.reached ? "  <- recommended" : "  <- smallest U"
                             : c.refuted        ? "  not confirmed by fresh samples"
                             : !c.meets         ? "  misses the target"
                                                : "");
  }
  for (const std::string& note : r.notes) std::cout << "note: " << note << '\n';
  for (const std::string& why : r.skipped_why) std::cout << "skipped: " << why << '\n';
  std::cout << fmt::format("{} candidates of {} samples{}, seed {}, {} definition, target asked of the {}: {}\n",
                           r.candidates.size(), r.asked.samples,
                           r.skipped > 0 ? fmt::format(" ({} combinations are impossible)", r.skipped) : "", r.seed,
                           name(r.asked.definition), worst ? "worst case" : "average", file);
}

void print_csv(const Result& r) {
  for (const auto& v : r.asked.variables)
    std::cout << v.knob.name << (v.knob.unit == "1" ? "" : " (" + v.knob.unit + ")") << ',';
  const std::string unit = r.unit == "1" ? "" : " (" + r.unit + ")";
  std::cout << fmt::format("time (s),U{0},U_se{0},bias{0},bias_se{0},standard_deviation{0},", unit);
  for (const auto& c : r.asked.cases) std::cout << fmt::format("U[{0}]{1},left[{0}]{1},", c.name, unit);
  std::cout << "meets,refuted,pareto,recommended,round,failed\n";
  for (std::size_t i = 0; i < r.candidates.size(); ++i) {
    const Candidate& c = r.candidates[i];
    for (std::size_t v = 0; v < c.values.size(); ++v) std::cout << value_text(r, v, c.values[v], 15) << ',';
    std::cout << fmt::format("{:.9g}", c.time);
    for (const double x :
         {c.average.expanded, c.average.expanded_se, c.average.mean, c.average.mean_se, c.average.standard_deviation})
      std::cout << fmt::format(",{:.9g}", length(r, x));
    for (const Figures& f : c.cases)
      std::cout << fmt::format(",{:.9g},{:.9g}", length(r, f.expanded), length(r, f.left));
    std::cout << fmt::format(",{:d},{:d},{:d},{:d},{},{}\n", c.meets, c.refuted, c.pareto, i == r.best, c.round,
                             c.average.failed);
  }
}

Json figures_json(const Result& r, const Figures& f) {
  propagation::Output measurand;
  measurand.unit = r.unit;
  measurand.si_unit = r.si_unit;
  Json out = json(choice::figure_fields, f, measurand);
  out["left"] = number(length(r, f.left));
  return out;
}

Json settings_json(const Result& r, const Candidate& c) {
  Json settings = Json::object();
  for (std::size_t v = 0; v < c.values.size(); ++v) {
    const Knob& k = r.asked.variables[v].knob;
    if (k.kind == Knob::Kind::evaluation)
      settings[k.name] = value_text(r, v, c.values[v], 0);
    else
      settings[k.name] = number(units::from_si(c.values[v], k.unit, k.si_unit));
  }
  return settings;
}

/// Time, number of readings and figures, without the setting.
Json candidate_json(const Result& r, const Candidate& c) {
  const choice::CandidateRow row{&c, &asked(c, r.asked.worst_case), "", "", ""};
  Json out = json(choice::candidate_fields, row);
  add_json(out, choice::asked_fields, row);
  out["average"] = figures_json(r, c.average);
  for (std::size_t k = 0; k < c.cases.size(); ++k) out["cases"][r.asked.cases[k].name] = figures_json(r, c.cases[k]);
  if (!c.cases.empty()) out["worst"] = r.asked.cases[c.worst].name;
  return out;
}

Json setting_json(const Result& r, const Candidate& c) {
  Json out{{"settings", settings_json(r, c)}};
  out.update(candidate_json(r, c));
  return out;
}

/// What limits the recommended setting, what lies about it, and what it is compared with.
void add_context(Json& out, const Result& r) {
  out["limits"] = out["neighbours"] = out["compared"] = Json::array();
  for (const auto& i : r.sensitivity.indices)
    out["limits"].push_back({{"input", i.input}, {"first", number(i.first)}, {"total", number(i.total)}});
  for (const auto& i : r.shapley.effects) out["limits"].push_back({{"input", i.input}, {"shapley", number(i.value)}});
  for (const auto& n : r.neighbours) {
    Json row = setting_json(r, r.candidates[n.candidate]);
    row["variable"] = r.asked.variables[n.variable].knob.name;
    add_json(row, choice::neighbour_fields, n);
    out["neighbours"].push_back(row);
  }
  const auto fresh = choice::fresh_rows(r);
  for (std::size_t k = 1; k < fresh.size(); ++k) {
    out["compared"].push_back(json(choice::fresh_fields, fresh[k]));
    out["compared"].back().update(candidate_json(r, *fresh[k].candidate));
  }
}

void print_json(const Result& r, const std::string& file) {
  Json out{{"scenario", r.scenario_file},
           {"hash", r.scenario_hash},
           {"unit", r.unit},
           {"coverage_probability", r.coverage_probability}};
  add_json(out, choice::question_fields, r);
  out["recommended"] = setting_json(r, r.fresh);
  out["searched"] = setting_json(r, r.candidates[r.best]);
  add_context(out, r);
  Json variables = Json::object(), spans = Json::object();
  for (const auto& v : choice::variable_rows(r)) {
    variables[v.name] = json(choice::variable_fields, v);
    if (v.kind != "evaluation" && r.near_count > 0)
      spans[v.name] = {units::from_si(v.near_low, v.unit, v.si_unit), units::from_si(v.near_high, v.unit, v.si_unit)};
  }
  out["near"]["spans"] = spans;
  out["variables"] = variables;
  for (const auto& row : choice::candidate_rows(r)) {
    out["candidates"].push_back(setting_json(r, *row.candidate));
    add_json(out["candidates"].back(), choice::searched_fields, row);
  }
  out["skipped"]["reasons"] = r.skipped_why;
  out["notes"] = r.notes;
  out["file"] = file;
  std::cout << json_text(out) << '\n';
}

} // namespace

void print_choice(const Result& r, const std::string& file, const std::string& format) {
  if (format == "json")
    print_json(r, file);
  else if (format == "csv")
    print_csv(r);
  else
    print_text(r, file);
}

} // namespace gumshoe::cli
