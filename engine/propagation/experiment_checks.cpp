// What a model refuses of a scenario, where the scenario says it, and what a joint evaluation is told of its noise.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "propagation/experiment.h"
#include "quantities/correlations.h"

namespace gumshoe::propagation {

Location find_line(const scenario::Scenario& s, const std::string& start) {
  int line = 1;
  for (std::size_t at = 0; at < s.text.size(); ++line) {
    if (s.text.compare(at, start.size(), start) == 0) return {s.file, line, 1};
    const std::size_t end = s.text.find('\n', at);
    at = end == std::string::npos ? s.text.size() : end + 1;
  }
  return {s.file};
}

namespace {

/// Where the scenario states what a model complains of ("feed is not positive"), and the section that it belongs to.
std::pair<Location, std::string> place_of(const scenario::Scenario& s, const ModelCard& card,
                                          const std::string& problem) {
  const std::string word = problem.substr(0, problem.find_first_of(" ."));
  const bool condition = std::ranges::find(card.conditions, word, &VariableCard::name) != card.conditions.end();
  const std::string section = condition ? "conditions" : effects::find(word) ? "effects" : "quantities";
  for (const std::string& start : {"[" + section + "." + word, word + " ", word + "="})
    if (const Location at = find_line(s, start); at.line > 0) return {at, section};
  return {{s.file}, section};
}

} // namespace

void Experiment::check_reading(std::size_t r) const {
  const std::string problem = forward_.check(r, reading_point(r));
  if (problem.empty()) return;
  const std::string at = reading_names_[r];
  const auto [where, section] = place_of(scenario_, *model().card, problem);
  throw InputError(
      {{where, section + ": " + problem + (at.empty() ? "" : " at " + reading_text(r)), "physically impossible", ""}});
}

/// Draws as the model sees them.
models::Declared Experiment::declared() const {
  models::Declared out;
  const Range model = layout().model, noise = layout().indications;
  for (const auto& variate : plan_.variates) out.draws.push_back({variate.distribution.standard_uncertainty(), {}});
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r) {
    const auto moves = [&](std::size_t quantity, std::size_t column, double by) {
      for (const std::size_t v : plan_.columns[plan_.gather[r][quantity]].variates)
        out.draws[v].moves.push_back({r, column, by});
    };
    for (std::size_t q = 0; q < model.size(); ++q) {
      out.estimates.push_back(column_estimates_[plan_.gather[r][model[q]]]);
      moves(model[q], q, 1);
    }
    for (std::size_t k = 0; k < noise.size(); ++k) moves(noise[k], model.size() + k, 1);
    for (const StatedSize& s : forward_.stated())
      if (noise.contains(s.target)) {
        moves(s.quantity, model.size() + s.target - noise.begin, -s.loading[r]);
      } else {
        out.estimates[r * model.size() + s.target] += s.loading[r] * column_estimates_[plan_.gather[r][s.quantity]];
        moves(s.quantity, s.target, s.loading[r]);
      }
  }
  quantities::Correlations correlations(plan_);
  for (const auto& group : plan_.copulas) {
    const std::size_t n = group.variates.size();
    for (std::size_t i = 1; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const double r = correlations.between(group.variates[i], group.variates[j]); r != 0)
          out.ties.push_back({group.variates[i], group.variates[j], r});
  }
  return out;
}

void Experiment::check_together() {
  Points at = estimates();
  for (std::size_t r = 0; r < at.size(); ++r)
    for (std::size_t k = 0; k < layout().indications.size(); ++k) {
      const auto& read = scenario_.readings[r].indications;
      at[r][layout().indications[k]] = read.empty() ? 0.0 : read[k];
    }
  const std::string problem = forward_.check_together(at);
  if (!problem.empty())
    throw InputError({{find_line(scenario_, "[model]"), scenario_.evaluation + ": " + problem, "", ""}});
  if (model().check_readings) remarks_ = forward_.remarks(at);
}

} // namespace gumshoe::propagation
