#include "calibration/estimated_scenario.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/scenario_text.h"

namespace gumshoe::calibration {

using scenario::Node;

namespace {

/// The scatter about the fit as the repeatability of the readings, of which nothing else is declared: a reading to come
/// has it, too.
void state_noise(const propagation::Experiment& experiment, const Estimate& estimate, const std::string& source,
                 ScenarioText& out) {
  for (const VariableCard& card : experiment.model().card->indications) {
    Node& place = member(member(out.document(), "indications"), std::string(card.name));
    if (place.kind != Node::Kind::table) continue;
    Node noise;
    noise.members.push_back(
        {"s", 0, 0, measure_node(estimate.s, std::string(card.unit), std::string(card.si_unit), true)});
    if (experiment.scenario().estimate.t)
      noise.members.push_back({"degrees_of_freedom", 0, 0, number_node(estimate.degrees_of_freedom)});
    noise.members.push_back({"evaluation", 0, 0, text_node("A")});
    noise.members.push_back({"source", 0, 0, text_node(source)});
    member(place, "repeatability") = noise;
  }
}

} // namespace

std::string estimated_scenario(const propagation::Experiment& experiment, const Estimate& estimate,
                               const std::string& folder) {
  const auto& s = experiment.scenario();
  for (const Parameter& p : estimate.parameters) {
    if (std::isinf(p.standard_uncertainty))
      refuse(s.file, p.unknown.name + ": the data do not determine it", "it has no distribution that could be written",
             "give it a prior (u), add readings, or leave it out of the fit");
    if (!std::isfinite(p.standard_uncertainty))
      refuse(s.file, p.unknown.name + ": its uncertainty is unknown",
             "there are no redundant readings and no declared noise", "repeatability = { s = \"...\" }");
  }
  ScenarioText out(s, folder);
  const std::string source = fmt::format(
      "{}{}, {} readings{}, hash of scenario and data {}", estimate_source,
      std::filesystem::path(s.file).filename().string(), estimate.rows.size(),
      estimate.held.empty() ? "" : fmt::format(", without the uncertainty of {}", fmt::join(estimate.held, ", ")),
      s.hash);
  const double freedom = estimate.noise_declared ? estimate.noise_freedom : estimate.degrees_of_freedom;
  const bool t = s.estimate.t && std::isfinite(freedom);
  std::vector<std::size_t> uncertain;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const Parameter& p = estimate.parameters[i];
    const auto& quantity = s.quantities[p.unknown.quantity];
    erase_member(out.quantity(quantity.name), "estimated");
    Node& place = out.entry(quantity.name, quantity.entries[p.unknown.entry].labels);
    const auto measure = [&](double si, bool difference) {
      return measure_node(si, p.unknown.unit, p.unknown.si_unit, difference);
    };
    Node known;
    known.members.push_back({"value", 0, 0, measure(p.value, false)});
    if (p.standard_uncertainty > 0) {
      if (t) known.members.push_back({"distribution", 0, 0, text_node("t")});
      known.members.push_back({"u", 0, 0, measure(p.standard_uncertainty, true)});
      if (t) known.members.push_back({"degrees_of_freedom", 0, 0, number_node(freedom)});
      known.members.push_back({"evaluation", 0, 0, text_node("A")});
      uncertain.push_back(i);
    }
    known.members.push_back({"source", 0, 0, text_node(source)});
    place = known;
  }
  if (uncertain.size() > 1) {
    std::vector<std::string> names;
    std::vector<double> matrix;
    for (const std::size_t i : uncertain) {
      names.push_back(estimate.parameters[i].unknown.name);
      for (const std::size_t j : uncertain) matrix.push_back(estimate.correlation[i * estimate.parameters.size() + j]);
    }
    out.tie(names, matrix, t ? "multivariate_t" : "pearson", source); // what tied the priors is in the fit now
  }
  if (!estimate.noise_declared && estimate.s > 0 && std::isfinite(estimate.s))
    state_noise(experiment, estimate, source, out);
  return out.text(source);
}

} // namespace gumshoe::calibration
