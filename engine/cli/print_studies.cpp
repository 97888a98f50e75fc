#include "cli/print_studies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "analysis/conformity.h"
#include "analysis/fields_json.h"
#include "analysis/result_fields.h"
#include "analysis/rounding.h"
#include "base/error.h"
#include "base/units.h"

namespace gumshoe::cli {
using namespace analysis;

namespace {

double difference(const propagation::Output& o, double x) {
  return units::from_si(x, o.unit, o.si_unit, units::Kind::difference);
}

/// "0.0030 mm", "0.0030" without a unit.
std::string shown(double x, const std::string& unit, const std::string& si_unit) {
  return fmt::format("{:.3g}{}", units::from_si(x, unit, si_unit, units::Kind::difference), units::suffix(unit));
}

std::string names(const std::vector<propagation::Output>& outputs) {
  std::string text;
  for (const auto& output : outputs) text += (text.empty() ? "" : ", ") + output.name;
  return text;
}

std::string three_decimals(double x) { return fmt::format("{:.3f}", x); }

/// "rod_length 0.410, beam_pitch 0.300, 3 more": rows by name, the largest first; empty if all are NaN.
template <class Row, class Value, class Name, class Text = std::string (*)(double)>
std::string largest(const std::vector<Row>& rows, Value value, Name name, Text text = three_decimals) {
  std::vector<std::pair<double, std::string>> sorted;
  for (const Row& row : rows)
    if (const double x = std::invoke(value, row); !std::isnan(x)) sorted.emplace_back(x, std::invoke(name, row));
  std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) { return a.first > b.first; });
  constexpr std::size_t most = 3;
  std::string line;
  for (std::size_t i = 0; i < std::min(most, sorted.size()); ++i)
    line += fmt::format("{}{} {}", i == 0 ? "" : ", ", sorted[i].second, text(sorted[i].first));
  if (sorted.size() > most) line += fmt::format(", {} more", sorted.size() - most);
  return line;
}

void print_joint(const Results& r, std::ostream& out) {
  for (const JointRegion& j : r.joint) {
    out << fmt::format("joint coverage region for {} of {}:", coverage_text(j.coverage_probability), names(j.outputs));
    if (std::isfinite(j.k_p)) out << fmt::format(" ellipsoid k_p = {:.3f},", j.k_p);
    if (std::isfinite(j.k_q)) out << fmt::format(" rectangle k_q = {:.3f}", j.k_q);
    out << (j.remark.empty() ? "" : " (" + j.remark + ")") << '\n';
  }
  for (const FitCovariance& f : r.fits) {
    out << fmt::format("least squares: {} indications, {:.4g} degrees of freedom", f.equations, f.degrees_of_freedom);
    if (std::isfinite(f.scatter)) out << ", s = " << shown(f.scatter, f.output.unit, f.output.si_unit);
    if (std::isfinite(f.chi_squared))
      out << fmt::format(", chi-squared {:.4g}, a larger one has a probability of {:.2g}", f.chi_squared, f.probability);
    out << "; u by the fit itself:";
    for (std::size_t k = 0; k < f.outputs.size(); ++k) {
      const propagation::Output& o = f.outputs[k];
      out << (k == 0 ? " " : ", ") << o.measurand << ' '
          << (std::isinf(f.standard_uncertainty[k]) ? "undetermined" : shown(f.standard_uncertainty[k], o.unit, o.si_unit));
    }
    out << '\n';
  }
}

/// A limit with the digits that the guard band and a tenth of the tolerance ask for.
std::string limit(const ConformityResult& c, double x) {
  const propagation::Output& o = c.output;
  const double width = std::isfinite(c.upper - c.lower) ? (c.upper - c.lower) / 10 : std::fabs(c.estimate) / 1000;
  const double finest = c.guard_band != 0 ? std::fmin(width, std::fabs(c.guard_band)) : width;
  return fixed(units::from_si(x, o.unit, o.si_unit),
               std::max(0, decimals_for(units::from_si(finest, o.unit, o.si_unit, units::Kind::difference)))) +
         units::suffix(o.unit);
}

std::string limits(const ConformityResult& c, double low, double high) {
  return std::isnan(low)    ? "at most " + limit(c, high)
         : std::isnan(high) ? "at least " + limit(c, low)
                            : "from " + limit(c, low) + " to " + limit(c, high);
}

std::string rule_text(const std::string& rule) {
  return rule == "iso_14253_1"         ? "ISO 14253-1"
         : rule == "ilac_g8"           ? "ILAC-G8"
         : rule == "simple_acceptance" ? "simple acceptance"
                                       : "as stated";
}

void print_conformity(const Results& r, std::ostream& out) {
  for (const ConformityResult& c : r.conformity) {
    const auto percent = [&](double p) { return probability_text(p, c.least_risk); };
    out << fmt::format("conformity of {}: {}, conformance probability {}", c.output.name, c.decision(),
                       percent(c.conformance_probability));
    const std::pair<const char*, double> risks[] = {{"specific consumer's risk", c.specific_consumer_risk},
                                                    {"specific producer's risk", c.specific_producer_risk},
                                                    {"global consumer's risk", c.global_consumer_risk},
                                                    {"global producer's risk", c.global_producer_risk}};
    for (const auto& [name, risk] : risks)
      if (std::isfinite(risk)) out << fmt::format(", {} {}", name, percent(risk));
    out << fmt::format("\n  tolerance {}, acceptance {}, estimate {}; decision rule {}, guard band w = {}{}\n",
                       limits(c, c.lower, c.upper), limits(c, c.acceptance_lower, c.acceptance_upper),
                       limit(c, c.estimate), rule_text(c.rule), shown(c.guard_band, c.output.unit, c.output.si_unit),
                       c.acceptance_lower >= c.acceptance_upper ? "; the guard bands leave no room for acceptance"
                                                                : "");
    for (const Summary& s : r.summaries)
      if (s.output.name == c.output.name && s.failed > 0)
        out << "  warning:" << failed_text(c, s.valid, s.failed) << '\n';
  }
}

void print_indices(const Results& r, std::ostream& out) {
  for (const Sensitivity& s : r.sensitivities) {
    std::map<std::string, std::size_t> verdicts;
    for (const SobolIndex& i : s.indices) ++verdicts[i.total_verdict];
    std::string counts;
    for (const auto& [word, count] : verdicts)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, word);
    if (const auto text = largest(s.indices, &SobolIndex::total, &SobolIndex::input); !text.empty())
      out << fmt::format("total Sobol' indices of {}: {} ({})\n", s.output.name, text, counts);
  }
  for (const Shapley& s : r.shapley)
    if (const auto text = largest(s.effects, &Index::value, &Index::input); !text.empty())
      out << fmt::format("Shapley effects of {}: {}\n", s.output.name, text);
  for (const GivenData& g : r.given_data)
    if (!g.delta.empty())
      out << fmt::format("Borgonovo's delta of {}, from {} stored samples: {}\n", g.output.name, g.samples,
                         largest(g.delta, &Index::value, &Index::input));
  for (const Dgsm& d : r.dgsm)
    if (const auto text = largest(d.rows, &DgsmRow::bound, &DgsmRow::input); !text.empty())
      out << fmt::format("total indices of {} are at most, by derivatives: {}\n", d.output.name, text);
}

/// Elementary effects and steps, in the output's unit.
void print_screening(const Results& r, std::ostream& out) {
  const auto in_unit_of = [](const propagation::Output& o) {
    return [&o](double x) { return shown(x, o.unit, o.si_unit); };
  };
  for (const Morris& m : r.morris)
    out << fmt::format("elementary effects (mu*) on {}: {}\n", m.output.name,
                       largest(m.rows, &MorrisRow::mean_absolute, &MorrisRow::input, in_unit_of(m.output)));
  for (const OneAtATimeTable& table : r.one_at_a_time)
    for (std::size_t o = 0; o < table.outputs.size(); ++o) {
      const auto change = [o](const OneAtATimeRow& row) { return std::fmax(std::fabs(row.up[o]), std::fabs(row.down[o])); };
      out << fmt::format("{}, largest changes of {}: {}\n",
                         table.title.empty() ? "one at a time" : printable(table.title), table.outputs[o].name,
                         largest(table.rows, change, &OneAtATimeRow::quantity, in_unit_of(table.outputs[o])));
    }
}

void print_target(const TargetResult& t, std::ostream& out) {
  const auto width = [&](double x) { return shown(x, t.output.unit, t.output.si_unit); };
  std::string alone;
  for (const TargetRow& row : t.rows)
    if (row.allowed < row.present)
      alone +=
          fmt::format("{}{} {}", alone.empty() ? "" : ", ", row.quantity, shown(row.allowed, row.unit, row.si_unit));
  out << fmt::format("target for {}: U = {} wanted, {} now; {}", t.output.name, width(t.wanted), width(t.present),
                     t.present <= t.wanted ? "met"
                     : alone.empty()       ? "no single quantity reaches it"
                                           : "sufficient alone: u of " + alone);
  if (std::isfinite(t.reached))
    out << fmt::format("; the cheapest combination reaches {} at {:.3g} times the cost", width(t.reached),
                       t.cost_ratio);
  out << '\n';
}

/// One object per input, component or quantity, by the name that `member` gives.
template <class Row, class Name>
void add_rows(Json& object, const Fields<Row>& fields, const std::vector<Row>& rows, Name name,
              const propagation::Output& output = {}) {
  for (const Row& row : rows) add_json(object[std::invoke(name, row)], fields, row, output);
}

Json target_object(const TargetResult& t) {
  Json object = json(target_study_fields, t), quantities = Json::object();
  add_rows(quantities, target_fields, t.rows, &TargetRow::quantity);
  for (const TargetRow& row : t.rows) {
    if (std::isinf(row.allowed)) quantities[row.quantity]["allowed"] = "any";
    if (std::isinf(row.allowed_gum)) quantities[row.quantity]["allowed_gum"] = "any";
  }
  object["quantities"] = quantities;
  return object;
}

Json one_at_a_time_object(const OneAtATimeTable& table, std::size_t o) {
  const propagation::Output& output = table.outputs[o];
  Json quantities = Json::object();
  add_rows(quantities, one_at_a_time_fields, table.rows, &OneAtATimeRow::quantity);
  for (const OneAtATimeRow& row : table.rows) {
    quantities[row.quantity]["up"] = number(difference(output, row.up[o]));
    quantities[row.quantity]["down"] = number(difference(output, row.down[o]));
  }
  return {{"title", table.title}, {"quantities", quantities}};
}

/// Correlation of one of the outputs with each, by name.
Json correlations(const std::vector<propagation::Output>& outputs, const std::vector<double>& matrix, std::size_t row) {
  Json object = Json::object();
  for (std::size_t k = 0; k < outputs.size(); ++k) object[outputs[k].name] = number(matrix[row * outputs.size() + k]);
  return object;
}

Json joint_object(const JointRegion& j, std::size_t row) {
  Json object = json(joint_fields, j);
  object["correlation"] = correlations(j.outputs, j.correlation, row);
  return object;
}

Json fit_object(const FitCovariance& f, std::size_t row) {
  Json object = json(fit_fields, f);
  object["standard_uncertainty"] = number(difference(f.outputs[row], f.standard_uncertainty[row]));
  object["correlation"] = correlations(f.outputs, f.correlation, row);
  return object;
}

} // namespace

void print_studies(const Results& r, std::ostream& out) {
  print_joint(r, out);
  print_conformity(r, out);
  print_indices(r, out);
  print_screening(r, out);
  for (const TargetResult& t : r.targets) print_target(t, out);
  if (!r.stopping.rule.empty()) out << r.stopping.statement << '\n';
}

void add_studies(const Results& r, const propagation::Output& output, Json& object) {
  const auto of_output = [&](const auto& studies, auto action) {
    for (const auto& study : studies)
      if (study.output.name == output.name) action(study);
  };
  const auto by_input = [&](const char* key, const auto& studies, const auto& fields, auto rows, auto name) {
    of_output(studies, [&](const auto& study) {
      if (!object.contains(key)) object[key] = Json::object();
      add_rows(object[key], fields, study.*rows, name, output);
    });
  };
  by_input("sobol", r.sensitivities, sobol_fields, &Sensitivity::indices, &SobolIndex::input);
  by_input("shapley", r.shapley, shapley_fields, &Shapley::effects, &Index::input);
  by_input("given_data", r.given_data, rank_fields, &GivenData::first, &Index::input);
  by_input("given_data", r.given_data, delta_fields, &GivenData::delta, &Index::input);
  by_input("morris", r.morris, morris_fields, &Morris::rows, &MorrisRow::input);
  by_input("dgsm", r.dgsm, dgsm_fields, &Dgsm::rows, &DgsmRow::input);
  for (const OneAtATimeTable& table : r.one_at_a_time)
    for (std::size_t o = 0; o < table.outputs.size(); ++o)
      if (table.outputs[o].name == output.name) object["one_at_a_time"].push_back(one_at_a_time_object(table, o));
  if (!r.stopping.rule.empty()) object["stopping"] = json(stopping_fields, r.stopping);
  of_output(r.circular, [&](const auto& c) { object["circular"] = json(circular_fields, c); });
  of_output(r.conformity, [&](const auto& c) { object["conformity"].push_back(json(conformity_fields, c)); });
  of_output(r.targets, [&](const auto& t) { object["targets"].push_back(target_object(t)); });
  for (const JointRegion& j : r.joint)
    if (const auto at = std::ranges::find(j.outputs, output.name, &propagation::Output::name); at != j.outputs.end())
      object["joint"].push_back(joint_object(j, static_cast<std::size_t>(at - j.outputs.begin())));
  for (const FitCovariance& f : r.fits)
    if (const auto at = std::ranges::find(f.outputs, output.name, &propagation::Output::name); at != f.outputs.end())
      object["fit"] = fit_object(f, static_cast<std::size_t>(at - f.outputs.begin()));
}

} // namespace gumshoe::cli
