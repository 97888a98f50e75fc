#include "choice/setup.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "propagation/propagate.h"
#include "scenario/choose_time.h"
#include "scenario/conditions.h"

namespace gumshoe::choice {

namespace {

using scenario::Knob;
constexpr std::size_t block = propagation::block_samples;

const ModelCard& card_of(const scenario::Scenario& s) {
  const models::Model* model = s.made ? s.made.get() : models::find(s.model);
  if (!model) throw InputError(fmt::format("model: unknown model '{}'", s.model));
  return *model->card;
}

} // namespace

scenario::Scenario with(const scenario::Scenario& scenario, const std::vector<scenario::Setting>& settings) {
  scenario::Scenario s = scenario;
  s.mean_of_readings = true;
  const ModelCard& card = card_of(s);
  for (const auto& [knob, value] : settings) // first: readings take their conditions from the ones there are
    if (knob.kind == Knob::Kind::readings) scenario::take_readings(s, card, static_cast<std::size_t>(value));
  for (const auto& [knob, value] : settings) {
    if (knob.kind == Knob::Kind::evaluation) s.evaluation = card.evaluations[static_cast<std::size_t>(value)].name;
    if (knob.kind == Knob::Kind::quantity) s.quantities[knob.index].entries[0].value = value;
    if (knob.kind == Knob::Kind::condition)
      for (auto& reading : s.readings) reading.conditions[knob.index] = value;
  }
  s.trace.columns.clear();
  scenario::update_loadings(s);
  return s;
}

Setup::Setup(const scenario::Scenario& s, const std::vector<scenario::Setting>& settings)
    : scenario_(std::make_unique<scenario::Scenario>(with(s, settings))),
      experiment_(std::make_unique<propagation::Experiment>(*scenario_)),
      sampler_(std::make_unique<quantities::Sampler>(experiment_->plan(), quantities::PointSet::monte_carlo, 0)) {
  const auto& choose = *scenario_->choose;
  const auto& outputs = experiment_->outputs();
  const auto it = std::ranges::find(outputs, choose.measurand, &propagation::Output::measurand);
  if (it == outputs.end())
    throw InputError(fmt::format("choose: {} does not yield {}", scenario_->evaluation, choose.measurand));
  output_ = static_cast<std::size_t>(it - outputs.begin());
  seconds_ = choose.time.at(experiment_->forward().evaluation())->seconds(scenario_->readings, experiment_->estimates());
  if (!(std::isfinite(seconds_) && seconds_ >= 0))
    throw InputError(
        fmt::format("choose.time: {}", std::isfinite(seconds_) ? "the time is negative" : "the formula has no value"));
}

void Setup::errors(std::uint64_t first, std::size_t n, quantities::Purpose purpose,
                   const std::vector<double*>& out) const {
  const auto& plan = experiment_->plan();
  const std::size_t variates = plan.variates.size(), rows = experiment_->outputs().size();
  std::vector<double> drawn(variates * n), outputs(rows * n), assembled(out.size() > 1 ? plan.columns.size() * n : 0);
  std::vector<std::uint8_t> status(n);
  std::vector<const double*> pointers;
  sampler_->draw(first, n, purpose, drawn.data(), n);
  for (std::size_t v = 0; v < variates; ++v) pointers.push_back(&drawn[v * n]);
  propagation::Workspace workspace;
  experiment_->run(pointers, n, workspace, outputs.data(), status.data());
  std::copy_n(&outputs[output_ * n], n, out[0]);
  if (out.size() == 1) return;

  // In a case the truth is given; the evaluation goes on with the estimates, like whoever measures.
  plan.assemble(pointers, n, assembled.data(), n);
  for (std::size_t k = 0; k + 1 < out.size(); ++k) {
    std::vector<const double*> columns;
    std::vector<std::vector<double>> given;
    for (std::size_t c = 0; c < plan.columns.size(); ++c)
      columns.push_back(plan.columns[c].variates.empty() ? nullptr : &assembled[c * n]);
    for (const auto& [knob, value] : scenario_->choose->cases[k].values) {
      given.emplace_back(n, value);
      for (std::size_t c = 0; c < plan.columns.size(); ++c)
        if (plan.columns[c].quantity == knob.index) columns[c] = given.back().data();
    }
    experiment_->run_columns(columns, n, workspace, outputs.data(), status.data());
    std::copy_n(&outputs[output_ * n], n, out[1 + k]);
  }
}

Errors errors(const std::vector<const Setup*>& setups, std::uint64_t samples, quantities::Purpose purpose,
              int threads) {
  const std::size_t padded = (samples + 7) / 8 * 8, blocks = (padded + block - 1) / block;
  Errors out;
  for (const Setup* s : setups)
    out.emplace_back(1 + s->experiment().scenario().choose->cases.size(), std::vector<double>(padded));
  propagation::parallel_for(setups.size() * blocks, threads, [&](std::size_t task) {
    const std::size_t setup = task / blocks, first = task % blocks * block;
    std::vector<double*> rows;
    for (auto& row : out[setup]) rows.push_back(row.data() + first);
    setups[setup]->errors(first, std::min(block, padded - first), purpose, rows);
  });
  for (auto& of_setup : out)
    for (auto& row : of_setup) row.resize(samples);
  return out;
}

} // namespace gumshoe::choice
