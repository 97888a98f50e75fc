#include "cli/print_studies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe::cli {
using namespace analysis;

namespace {

double difference(const propagation::Output& o, double x) {
  return units::from_si(x, o.unit, o.si_unit, units::Kind::difference);
}

/// "0.0030 mm", "0.0030" without a unit.
std::string shown(double x, const std::string& unit, const std::string& si_unit) {
  return fmt::format("{:.3g}{}", units::from_si(x, unit, si_unit, units::Kind::difference),
                     unit == "1" ? "" : " " + unit);
}

std::string names(const std::vector<propagation::Output>& outputs) {
  std::string text;
  for (const auto& output : outputs) text += (text.empty() ? "" : ", ") + output.name;
  return text;
}

/// "rod_length 0.41, beam_pitch 0.30, 3 more", the largest first.
std::string largest(std::vector<std::pair<double, std::string>> indices, std::size_t most = 3) {
  std::erase_if(indices, [](const auto& index) { return std::isnan(index.first); });
  std::ranges::stable_sort(indices, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min(most, indices.size()); ++i)
    text += fmt::format("{}{} {:.3f}", i == 0 ? "" : ", ", indices[i].second, indices[i].first);
  if (indices.size() > most) text += fmt::format(", {} more", indices.size() - most);
  return text;
}

void print_joint(const Results& r, std::ostream& out) {
  for (const JointRegion& j : r.joint) {
    out << fmt::format("joint coverage region for {:.4g} % of {}:", 100 * j.coverage_probability, names(j.outputs));
    if (std::isfinite(j.k_p)) out << fmt::format(" ellipsoid k_p = {:.3f},", j.k_p);
    if (std::isfinite(j.k_q)) out << fmt::format(" rectangle k_q = {:.3f}", j.k_q);
    out << (j.remark.empty() ? "" : " (" + j.remark + ")") << '\n';
  }
  for (const CircularSummary& c : r.circular)
    if (!c.remark.empty())
      out << fmt::format("{} on the circle: mean direction {}, standard deviation {} ({})\n", c.output.name,
                         shown(c.mean_direction, c.output.unit, c.output.si_unit),
                         shown(c.standard_deviation, c.output.unit, c.output.si_unit), c.remark);
}

void print_conformity(const Results& r, std::ostream& out) {
  for (const ConformityResult& c : r.conformity) {
    out << fmt::format("conformity of {}: {}, conformance probability {:.4g} %", c.output.name,
                       c.accepted ? "accepted" : "rejected", 100 * c.conformance_probability);
    const std::pair<const char*, double> risks[] = {{"specific consumer's risk", c.specific_consumer_risk},
                                                    {"specific producer's risk", c.specific_producer_risk},
                                                    {"global consumer's risk", c.global_consumer_risk},
                                                    {"global producer's risk", c.global_producer_risk}};
    for (const auto& [name, risk] : risks)
      if (std::isfinite(risk)) out << fmt::format(", {} {:.3g} %", name, 100 * risk);
    out << '\n';
  }
}

void print_indices(const Results& r, std::ostream& out) {
  for (const Sensitivity& s : r.sensitivities) {
    std::vector<std::pair<double, std::string>> totals;
    std::map<std::string, std::size_t> verdicts;
    for (const SobolIndex& i : s.indices) {
      totals.emplace_back(i.total, i.input);
      ++verdicts[i.total_verdict];
    }
    if (std::ranges::all_of(totals, [](const auto& t) { return std::isnan(t.first); })) continue; // it does not vary
    std::string counts;
    for (const auto& [word, count] : verdicts)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, word);
    out << fmt::format("total Sobol' indices of {}: {} ({})\n", s.output.name, largest(std::move(totals)), counts);
  }
  for (const Shapley& s : r.shapley) {
    std::vector<std::pair<double, std::string>> effects;
    for (const Index& i : s.effects) effects.emplace_back(i.value, i.input);
    out << fmt::format("Shapley effects of {}: {}\n", s.output.name, largest(std::move(effects)));
  }
  for (const GivenData& g : r.given_data) {
    std::vector<std::pair<double, std::string>> deltas;
    for (const Index& i : g.delta) deltas.emplace_back(i.value, i.input);
    if (!deltas.empty())
      out << fmt::format("Borgonovo's delta of {}, from {} stored samples: {}\n", g.output.name, g.samples,
                         largest(std::move(deltas)));
  }
  for (const Dgsm& d : r.dgsm) {
    std::vector<std::pair<double, std::string>> bounds;
    for (const DgsmRow& row : d.rows) bounds.emplace_back(row.bound, row.input);
    if (const std::string text = largest(std::move(bounds)); !text.empty())
      out << fmt::format("total indices of {} are at most, by derivatives: {}\n", d.output.name, text);
  }
}

/// Elementary effects and steps, in the output's unit, the largest first.
std::string largest_changes(std::vector<std::pair<double, std::string>> changes, const propagation::Output& o) {
  std::erase_if(changes, [](const auto& change) { return std::isnan(change.first); });
  std::ranges::stable_sort(changes, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, changes.size()); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", changes[i].second, shown(changes[i].first, o.unit, o.si_unit));
  if (changes.size() > 3) text += fmt::format(", {} more", changes.size() - 3);
  return text;
}

void print_screening(const Results& r, std::ostream& out) {
  for (const Morris& m : r.morris) {
    std::vector<std::pair<double, std::string>> effects;
    for (const MorrisRow& row : m.rows) effects.emplace_back(row.mean_absolute, row.input);
    out << fmt::format("elementary effects (mu*) on {}: {}\n", m.output.name,
                       largest_changes(std::move(effects), m.output));
  }
  for (const OneAtATimeTable& table : r.one_at_a_time)
    for (std::size_t o = 0; o < table.outputs.size(); ++o) {
      std::vector<std::pair<double, std::string>> changes;
      for (const OneAtATimeRow& row : table.rows)
        changes.emplace_back(std::fmax(std::fabs(row.up[o]), std::fabs(row.down[o])), row.quantity);
      out << fmt::format("{}, largest changes of {}: {}\n", table.title.empty() ? "one at a time" : table.title,
                         table.outputs[o].name, largest_changes(std::move(changes), table.outputs[o]));
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
                     : alone.empty()       ? "no quantity reaches it alone"
                                           : "alone would do u of " + alone);
  if (std::isfinite(t.reached))
    out << fmt::format("; the cheapest combination reaches {} at {:.3g} times the cost", width(t.reached),
                       t.cost_ratio);
  out << '\n';
}

nlohmann::ordered_json number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}
nlohmann::ordered_json index(double value, double low, double high, const Verdict& verdict) {
  return {{"value", number(value)}, {"low", number(low)}, {"high", number(high)}, {"verdict", verdict}};
}

nlohmann::ordered_json conformity_object(const ConformityResult& c) {
  const auto point = [&](double x) { return number(units::from_si(x, c.output.unit, c.output.si_unit)); };
  return {{"lower", point(c.lower)},
          {"upper", point(c.upper)},
          {"acceptance_lower", point(c.acceptance_lower)},
          {"acceptance_upper", point(c.acceptance_upper)},
          {"accepted", c.accepted},
          {"conformance_probability", number(c.conformance_probability)},
          {"specific_consumer_risk", number(c.specific_consumer_risk)},
          {"specific_producer_risk", number(c.specific_producer_risk)},
          {"global_consumer_risk", number(c.global_consumer_risk)},
          {"global_producer_risk", number(c.global_producer_risk)}};
}

nlohmann::ordered_json target_object(const TargetResult& t) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::object();
  for (const TargetRow& row : t.rows) {
    const auto shown = [&](double x) {
      return number(units::from_si(x, row.unit, row.si_unit, units::Kind::difference));
    };
    const auto allowed = [&](double x) { return std::isinf(x) ? nlohmann::ordered_json("any") : shown(x); };
    rows[row.quantity] = {{"unit", row.unit},
                          {"present", shown(row.present)},
                          {"allowed", allowed(row.allowed)},
                          {"allowed_gum", allowed(row.allowed_gum)},
                          {"cheapest", shown(row.cheapest)}};
  }
  return {{"wanted", number(difference(t.output, t.wanted))},
          {"present", number(difference(t.output, t.present))},
          {"reached", number(difference(t.output, t.reached))},
          {"quantities", rows}};
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

void add_studies(const Results& r, const propagation::Output& output, nlohmann::ordered_json& object) {
  const auto same = [&](const auto& study) { return study.output.name == output.name; };
  const auto keep = [&](const char* key, const auto& studies, const auto& members) {
    for (const auto& study : studies)
      if (same(study)) object[key] = members(study);
  };
  keep("sobol", r.sensitivities, [](const Sensitivity& s) {
    auto inputs = nlohmann::ordered_json::object();
    for (const SobolIndex& i : s.indices)
      inputs[i.input] = {{"first", index(i.first, i.first_low, i.first_high, i.first_verdict)},
                         {"total", index(i.total, i.total_low, i.total_high, i.total_verdict)}};
    return inputs;
  });
  keep("shapley", r.shapley, [](const Shapley& s) {
    auto inputs = nlohmann::ordered_json::object();
    for (const Index& i : s.effects) inputs[i.input] = index(i.value, i.low, i.high, i.verdict);
    return inputs;
  });
  keep("given_data", r.given_data, [](const GivenData& g) {
    auto inputs = nlohmann::ordered_json::object();
    for (const Index& i : g.first) inputs[i.input]["first"] = index(i.value, i.low, i.high, i.verdict);
    for (const Index& i : g.delta) inputs[i.input]["delta"] = index(i.value, i.low, i.high, i.verdict);
    return inputs;
  });
  keep("morris", r.morris, [](const Morris& m) {
    const auto shown = [&](double x) { return number(difference(m.output, x)); };
    auto inputs = nlohmann::ordered_json::object();
    for (const MorrisRow& row : m.rows)
      inputs[row.input] = {{"mean", shown(row.mean)},
                           {"mean_absolute", shown(row.mean_absolute)},
                           {"standard_deviation", shown(row.standard_deviation)}};
    return inputs;
  });
  keep("dgsm", r.dgsm, [](const Dgsm& d) {
    auto inputs = nlohmann::ordered_json::object();
    for (const DgsmRow& row : d.rows)
      inputs[row.input] = {
          {"bound", number(row.bound)}, {"low", number(row.bound_low)}, {"high", number(row.bound_high)}};
    return inputs;
  });
  for (const OneAtATimeTable& table : r.one_at_a_time)
    for (std::size_t o = 0; o < table.outputs.size(); ++o) {
      if (table.outputs[o].name != output.name) continue;
      auto rows = nlohmann::ordered_json::object();
      for (const OneAtATimeRow& row : table.rows)
        rows[row.quantity] = {
            {"unit", row.unit},
            {"step", number(units::from_si(row.step, row.unit, row.si_unit, units::Kind::difference))},
            {"up", number(difference(output, row.up[o]))},
            {"down", number(difference(output, row.down[o]))}};
      object["one_at_a_time"].push_back({{"title", table.title}, {"quantities", rows}});
    }
  if (!r.stopping.rule.empty())
    object["stopping"] = {{"rule", r.stopping.rule},
                          {"trials", r.stopping.trials},
                          {"jcgm_trials", r.stopping.jcgm_trials},
                          {"stein_trials", r.stopping.stein_trials},
                          {"reached", r.stopping.reached}};
  keep("circular", r.circular, [](const CircularSummary& c) {
    return nlohmann::ordered_json{{"mean_direction", number(difference(c.output, c.mean_direction))},
                                  {"resultant_length", number(c.resultant_length)},
                                  {"standard_deviation", number(difference(c.output, c.standard_deviation))},
                                  {"arc", {number(difference(c.output, c.low)), number(difference(c.output, c.high))}}};
  });
  for (const ConformityResult& c : r.conformity)
    if (same(c)) object["conformity"].push_back(conformity_object(c));
  for (const TargetResult& t : r.targets)
    if (same(t)) object["targets"].push_back(target_object(t));
  for (const JointRegion& j : r.joint) {
    const auto at = std::ranges::find(j.outputs, output.name, &propagation::Output::name);
    if (at == j.outputs.end()) continue;
    const auto row = static_cast<std::size_t>(at - j.outputs.begin()), n = j.outputs.size();
    auto correlations = nlohmann::ordered_json::object();
    for (std::size_t k = 0; k < n; ++k) correlations[j.outputs[k].name] = number(j.correlation[row * n + k]);
    object["joint"].push_back({{"coverage_probability", j.coverage_probability},
                               {"k_p", number(j.k_p)},
                               {"k_q", number(j.k_q)},
                               {"correlation", correlations}});
  }
}

} // namespace gumshoe::cli
