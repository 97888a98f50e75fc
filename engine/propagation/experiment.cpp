#include "propagation/experiment.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "quantities/cells.h"

namespace gumshoe::propagation {

namespace {

/// The conditions of a reading in which the readings `alike` differ: "feed 30 mm/min".
std::string differing_conditions(const std::vector<quantities::Reading>& readings, std::size_t r,
                                 const std::vector<std::size_t>& alike, std::span<const VariableCard> conditions) {
  std::string text;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    const double mine = readings[r].conditions.at(c);
    if (std::ranges::all_of(alike, [&](std::size_t i) { return readings[i].conditions.at(c) == mine; })) continue;
    const VariableCard& v = conditions[c];
    text += fmt::format("{}{} {:.6g}{}", text.empty() ? "" : ", ", v.name,
                        units::from_si(mine, std::string(v.unit), std::string(v.si_unit)), units::suffix(v.unit));
  }
  return text;
}

/// Readings of equal names, by name.
std::map<std::string, std::vector<std::size_t>> grouped(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t r = 0; r < names.size(); ++r) groups[names[r]].push_back(r);
  return groups;
}

std::vector<std::string> unique_names(const std::vector<quantities::Reading>& readings, const ModelCard& card) {
  std::vector<std::string> names;
  for (const auto& reading : readings) names.push_back(quantities::text_of(reading.labels));
  const auto add = [&](std::size_t r, const std::string& text) {
    if (!text.empty()) names[r] += (names[r].empty() ? "" : ", ") + text;
  };
  for (const auto& [name, alike] : grouped(names))
    if (alike.size() > 1)
      for (const std::size_t r : alike) add(r, differing_conditions(readings, r, alike, card.conditions));
  for (const auto& [name, alike] : grouped(names))
    if (alike.size() > 1)
      for (const std::size_t r : alike) add(r, fmt::format("reading {}", r + 1));
  return names;
}

quantities::SamplePlan located_plan(const scenario::Scenario& s) {
  try {
    return quantities::make_plan(s.quantities, s.correlations, s.readings, s.run.seed);
  } catch (const InputError& error) {
    auto problems = error.problems();
    for (Problem& p : problems)
      if (p.where.file.empty())
        p.where = p.what.starts_with("correlation") ? find_line(s, "[[correlations]]") : Location{s.file};
    throw InputError(problems);
  }
}

ForwardModel forward_model_of(const scenario::Scenario& s, const models::Model& model) {
  const ModelCard& card = *model.card;
  // Quantities of the model, of effects, noise of the indications, sizes.
  std::size_t end = s.quantities.size() - card.indications.size();
  std::vector<std::pair<std::size_t, const scenario::StatedEffect*>> sizes;
  for (const auto& e : s.stated_effects)
    if (const auto size = std::ranges::find(s.quantities, e.name + ".size", &quantities::InputQuantity::name);
        size != s.quantities.end())
      sizes.emplace_back(size - s.quantities.begin(), &e);
  end -= sizes.size();
  std::vector<StatedSize> stated;
  for (const auto& [size, e] : sizes)
    for (const auto& part : e->parts)
      stated.push_back({size, (part.on_quantity ? 0 : end) + part.target, part.loading});
  std::vector<const EffectCard*> acting;
  std::size_t at = card.quantities.size();
  for (const EffectCard* e : effects::cards())
    if (at < end && s.quantities[at].name.starts_with(std::string(e->name) + ".")) {
      acting.push_back(e);
      at += e->quantities.size();
    }
  std::size_t evaluation = 0;
  for (std::size_t i = 0; i < card.evaluations.size(); ++i)
    if (card.evaluations[i].name == s.evaluation) evaluation = i;
  std::vector<std::vector<double>> conditions;
  for (const auto& reading : s.readings) {
    conditions.emplace_back();
    for (std::size_t c = 0; c < card.conditions.size(); ++c) conditions.back().push_back(reading.conditions.at(c));
  }
  return ForwardModel(model, acting, evaluation, std::move(conditions), std::move(stated));
}

/// The samples of outputs are datasets of their names; next to them the result file has these. Its dimensions hold
/// references to all of them, for which HDF5 has 64 KiB.
void refuse_names_of_datasets(const scenario::Scenario& s, std::span<const VariableCard> outputs) {
  constexpr std::size_t most = 4000;
  if (outputs.size() > most)
    throw InputError({{find_line(s, "[model]"), fmt::format("model: {} measurands are too many", outputs.size()),
                       fmt::format("a result file holds at most {}", most),
                       "divide the scenario, or read one measurand several times"}});
  constexpr std::array taken{"status", "sample", "reading"};
  for (const VariableCard& v : outputs)
    if (std::ranges::find(taken, v.name) != taken.end())
      throw InputError({{find_line(s, "[model]"),
                         fmt::format("model: '{}' cannot be the name of a measurand or of what is predicted", v.name),
                         "a dataset of the result file has this name", "choose another name"}});
}

} // namespace

Experiment::Experiment(const scenario::Scenario& s, Trial trial)
    : scenario_(s), made_(s.made), virtual_(s.method == scenario::Method::virtual_experiment),
      prediction_(s.method == scenario::Method::prediction) {
  const models::Model* model = made_ ? made_.get() : models::find(s.model);
  if (!model) throw InputError(fmt::format("model: unknown model '{}'", s.model));
  if (virtual_ && !model->kernels()->simulate)
    throw InputError({{find_line(s, "[model]"), "model: the model does not simulate the readings",
                       "a virtual experiment simulates every indication", "method = \"propagation\""}});
  if (prediction_ && !model->kernels()->simulate)
    throw InputError({{find_line(s, "[model]"), "model: the model does not simulate the readings",
                       "a prediction simulates every indication", "run it without --predict"}});
  plan_ = located_plan(s);
  reading_names_ = unique_names(s.readings, *model->card);
  forward_ = forward_model_of(s, *model);
  mean_ = s.mean_of_readings && !forward_.joint() && !prediction_;
  joint_ = (forward_.joint() || mean_) && !prediction_;
  for (std::size_t c = 0; c < plan_.columns.size(); ++c) {
    column_estimates_.push_back(plan_.estimate(c));
    if (joint_) every_column_.push_back(c);
  }
  for (std::size_t r = 0; r < s.readings.size() && trial == Trial::now; ++r) check_reading(r);
  measurands_ = prediction_ ? model->card->indications : model->card->measurands;
  if (forward_.joint() && !prediction_) {
    measurands_ = forward_.measurands(reading_point(0).data());
    forward_.declare(declared());
    check_together();
  }
  refuse_names_of_datasets(s, measurands_);
  for (std::size_t r = 0; r < (joint_ ? 1 : s.readings.size()); ++r) add_outputs(r);
  find_twins();
  keeping_ = models::keeping_kernels(this->model());
  if (prediction_ && !s.trace.priors.empty()) linearise_prediction();
}

void Experiment::linearise_prediction() {
  if (!forward_.has_derivatives()) return;
  for (std::size_t q = 0; q < layout().size(); ++q)
    if (!layout().indications.contains(q) &&
        std::ranges::any_of(plan_.gather, [&](const auto& at) { return !plan_.columns[at[q]].variates.empty(); }))
      partials_.push_back({q});
  linear_ = forward_.linearise(estimates(), partials_);
  if (linear_.status != Status::ok || linear_.kink) linear_ = {};
}

void Experiment::add_outputs(std::size_t r) {
  const auto labels = joint_ ? quantities::Labels{} : scenario_.readings[r].labels;
  const std::string at = joint_ ? "" : reading_names_[r];
  for (const VariableCard& m : measurands_) {
    const bool error = virtual_ && !m.diagnostic;
    const std::string unit(m.unit), si_unit(m.si_unit);
    outputs_.push_back({(error ? "error of " : "") + std::string(m.name) + (at.empty() ? "" : "[" + at + "]"),
                        std::string(m.name), r, error ? units::difference_unit(unit, si_unit) : unit, si_unit, labels,
                        m.diagnostic});
  }
}

/// Readings that agree in everything the solve reads share one solve.
void Experiment::find_twins() {
  const Layout& layout = forward_.layout();
  const auto same = [&](std::size_t a, std::size_t b) {
    for (std::size_t q = 0; q < layout.effects.end; ++q)
      if ((layout.effects.contains(q) || model().solve_reads(q)) && plan_.gather[a][q] != plan_.gather[b][q])
        return false;
    for (const StatedSize& s : forward_.stated())
      if (layout.model.contains(s.target) && model().solve_reads(s.target) && s.loading[a] != s.loading[b])
        return false;
    return forward_.active().empty() || std::ranges::equal(forward_.conditions(a), forward_.conditions(b));
  };
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r) {
    std::size_t twin = 0;
    while (!same(r, twin)) ++twin;
    solved_as_.push_back(twin);
  }
}

std::string Experiment::reading_text(std::size_t r) const {
  const std::string &name = reading_names_[r], position = fmt::format("reading {}", r + 1);
  return name.ends_with(position) ? name : position + (name.empty() ? "" : " (" + name + ")");
}

std::vector<std::string> Experiment::place_names() const {
  if (joint_) return {"all readings"};
  return reading_names_;
}

std::vector<double> Experiment::reading_point(std::size_t reading, const double* variates) const {
  const auto& read = scenario_.readings[reading].indications;
  const Range noise = layout().indications;
  std::vector<double> values;
  for (std::size_t q = 0; q < scenario_.quantities.size(); ++q) {
    const std::size_t c = plan_.gather[reading][q];
    double x = variates ? plan_.value(c, variates) : column_estimates_[c];
    if (noise.contains(q) && !read.empty() && !prediction_) x += read[q - noise.begin];
    values.push_back(x);
  }
  return values;
}

Points Experiment::estimates() const {
  Points out;
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r) out.push_back(reading_point(r));
  return out;
}

std::vector<double> Experiment::point(std::size_t reading, const double* variates) const {
  if (!joint_) return reading_point(reading, variates);
  if (!variates) return column_estimates_;
  std::vector<double> values;
  for (const std::size_t c : every_column_) values.push_back(plan_.value(c, variates));
  return values;
}

} // namespace gumshoe::propagation
