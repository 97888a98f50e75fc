#include "propagation/experiment.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe::propagation {

std::string reading_name(const quantities::Reading& reading) {
  std::string name;
  for (const auto& [label, value] : reading.labels)
    // "rod 2" says that it is a rod; "1" does not say that it is a setup.
    name += (name.empty() ? "" : ", ") + (value.starts_with(label) ? value : label + " " + value);
  return name;
}

namespace {

/// The first line of the scenario's text that begins with `start`, for messages on what was read.
Location find_line(const scenario::Scenario& s, const std::string& start) {
  int line = 1;
  for (std::size_t at = 0; at < s.text.size(); ++line) {
    if (s.text.compare(at, start.size(), start) == 0) return {s.file, line, 1};
    const std::size_t end = s.text.find('\n', at);
    at = end == std::string::npos ? s.text.size() : end + 1;
  }
  return {s.file};
}

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

} // namespace

Experiment::Experiment(const scenario::Scenario& s)
    : scenario_(s), model_(s.made ? s.made.get() : models::find(s.model)), made_(s.made) {
  if (!model_) throw InputError(fmt::format("model: unknown model '{}'", s.model));
  if (s.method == scenario::Method::virtual_experiment && !model_->kernels()->simulate)
    throw InputError({{find_line(s, "[model]"), "model: it does not say what the readouts would be",
                       "a virtual experiment simulates every indication", "method = \"propagation\""}});
  plan_ = located_plan(s);
  const ModelCard& card = *model_->card;
  indications_ = card.indications.size();
  for (const auto& e : s.stated_effects) {
    const auto size = std::ranges::find(s.quantities, e.name + ".size", &quantities::InputQuantity::name);
    if (size != s.quantities.end())
      stated_.push_back({static_cast<std::size_t>(size - s.quantities.begin()), e.indication, &e.loading});
  }
  effect_quantities_ = s.quantities.size() - card.quantities.size() - indications_ - stated_.size();
  for (std::size_t e = 0, at = 0; e < effects::cards().size(); ++e) {
    const std::string prefix = std::string(effects::cards()[e]->name) + ".";
    if (at < effect_quantities_ && s.quantities[card.quantities.size() + at].name.starts_with(prefix)) {
      active_.push_back({e, at});
      at += effects::cards()[e]->quantities.size();
    }
  }
  for (std::size_t i = 0; i < card.evaluations.size(); ++i)
    if (card.evaluations[i].name == s.evaluation) evaluation_ = i;
  joint_ = evaluation_ < card.evaluations.size() && card.evaluations[evaluation_].joint();
  measurands_ = joint_ ? card.evaluations[evaluation_].measurands : card.measurands;
  mean_ = s.mean_of_readings && !joint_;
  for (std::size_t c = 0; c < plan_.columns.size(); ++c) column_estimates_.push_back(plan_.estimate(c));

  for (const auto& reading : s.readings)
    for (std::size_t c = 0; c < card.conditions.size(); ++c) conditions_.push_back(reading.conditions.at(c));
  for (std::size_t r = 0; r < s.readings.size(); ++r) check_reading(r);
  if (joint_ || mean_)
    for (std::size_t c = 0; c < plan_.columns.size(); ++c) every_column_.push_back(c);
  if (joint_) {
    if (model_->measurands_in_use)
      measurands_ =
          measurands_.first(model_->measurands_in_use(static_cast<int>(evaluation_), reading_point(0, nullptr).data()));
    declare();
    check_all();
  }
  joint_ = joint_ || mean_;
  for (std::size_t r = 0; r < (joint_ ? 1 : s.readings.size()); ++r) add_outputs(r);

  // Readings that agree in everything the solve reads share one solve.
  const auto same = [&](std::size_t a, std::size_t b) {
    for (std::size_t q = 0; q < card.quantities.size() + effect_quantities_; ++q)
      if ((q >= card.quantities.size() || model_->solve_reads(q)) && plan_.gather[a][q] != plan_.gather[b][q])
        return false;
    const std::size_t c = card.conditions.size();
    return active_.empty() || std::equal(&conditions_[a * c], &conditions_[a * c] + c, &conditions_[b * c]);
  };
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    std::size_t twin = 0;
    while (!same(r, twin)) ++twin;
    solved_as_.push_back(twin);
  }
}

void Experiment::add_outputs(std::size_t r) {
  const auto labels = joint_ ? quantities::Labels{} : scenario_.readings[r].labels;
  const std::string at = joint_ ? "" : reading_name(scenario_.readings[r]);
  const bool virtual_experiment = scenario_.method == scenario::Method::virtual_experiment;
  for (const VariableCard& m : measurands_)
    outputs_.push_back(
        {(virtual_experiment ? "error of " : "") + std::string(m.name) + (at.empty() ? "" : "[" + at + "]"),
         std::string(m.name), r, std::string(m.unit), std::string(m.si_unit), labels});
}

void Experiment::check_reading(std::size_t r) const {
  const std::string at = reading_name(scenario_.readings[r]);
  auto values = reading_point(r, nullptr);
  take_off_stated(r, values.data());
  models::PointCall<double> call;
  call.quantities = values.data();
  call.effects = values.data() + model_quantities();
  call.active = active_;
  call.conditions = scenario_.readings[r].conditions.data();
  call.indications = call.effects + effect_quantities_;
  call.evaluation = static_cast<int>(evaluation_);
  call.context = model_->context;
  const std::string problem = model_->check(call);
  if (problem.empty()) return;
  const auto [where, section] = place_of(scenario_, *model_->card, problem);
  throw InputError({{where, section + ": " + problem + (at.empty() ? "" : " at reading [" + at + "]"),
                     "physically impossible", ""}});
}

/// Draws as the model sees them; correlations are left out.
void Experiment::declare() {
  const std::size_t nq = model_quantities(), first_noise = first_indication();
  for (const auto& variate : plan_.variates)
    declared_.draws.push_back({std::sqrt(variate.distribution.variance()), {}});
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r) {
    for (std::size_t q = 0; q < first_noise + indications_; ++q) {
      const std::size_t c = plan_.gather[r][q];
      if (q < nq) declared_.estimates.push_back(column_estimates_[c]);
      if (q >= nq && q < first_noise) continue;
      for (const std::size_t v : plan_.columns[c].variates)
        declared_.draws[v].moves.push_back({r, q < nq ? q : q - effect_quantities_});
    }
    for (const StatedSize& s : stated_)
      for (const std::size_t v : plan_.columns[plan_.gather[r][s.quantity]].variates)
        declared_.draws[v].moves.push_back({r, nq + s.indication, -(*s.loading)[r]});
  }
}

void Experiment::check_all() {
  if (!model_->check_readings) return;
  Workspace w;
  wire(w, true);
  std::vector<double> read;
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r)
    for (std::size_t k = 0; k < indications_; ++k)
      read.push_back(scenario_.readings[r].indications.empty() ? 0.0 : scenario_.readings[r].indications[k]);
  for (std::size_t r = 0; r < scenario_.readings.size(); ++r)
    for (const StatedSize& s : stated_)
      read[r * indications_ + s.indication] -= column_estimates_[plan_.gather[r][s.quantity]] * (*s.loading)[r];
  for (const double& x : read) w.indication_columns.push_back({&x, 0});
  models::BlockCall call;
  call.samples = 1;
  call.readings = scenario_.readings.size();
  call.quantities = w.quantity_columns.data();
  call.effects = w.effect_columns.data();
  call.effect_quantities = effect_quantities_;
  call.active = active_;
  call.conditions = w.condition_columns.data();
  call.indications = w.indication_columns.data();
  call.evaluation = static_cast<int>(evaluation_);
  call.context = model_->context;
  call.declared = &declared_;
  const std::string problem = model_->check_readings(call);
  if (!problem.empty())
    throw InputError({{find_line(scenario_, "[model]"), scenario_.evaluation + ": " + problem, "", ""}});
  if (model_->remarks) remarks_ = model_->remarks(call);
}

std::vector<std::string> Experiment::place_names() const {
  if (joint_) return {"all readings"};
  std::vector<std::string> names;
  for (const auto& r : scenario_.readings) names.push_back(reading_name(r));
  return names;
}

std::vector<double> Experiment::reading_point(std::size_t reading, const double* variates) const {
  std::vector<double> values;
  const std::size_t first_noise = first_indication();
  for (std::size_t q = 0; q < scenario_.quantities.size(); ++q) {
    const std::size_t c = plan_.gather[reading][q];
    double x = variates ? plan_.value(c, variates) : column_estimates_[c];
    if (q >= first_noise && q < first_noise + indications_ && !scenario_.readings[reading].indications.empty())
      x += scenario_.readings[reading].indications[q - first_noise];
    values.push_back(x);
  }
  return values;
}

std::vector<double> Experiment::point(std::size_t reading, const double* variates) const {
  if (!joint_) return reading_point(reading, variates);
  if (!variates) return column_estimates_;
  std::vector<double> values;
  for (const std::size_t c : every_column_) values.push_back(plan_.value(c, variates));
  return values;
}

/// Points the call's columns at the block's buffers: drawn columns, or the estimates.
void Experiment::wire(Workspace& w, bool estimates) const {
  const std::size_t readings = scenario_.readings.size(), nq = model_quantities();
  const auto column = [&](std::size_t c) { return estimates ? models::Column{&column_estimates_[c], 0} : w.drawn[c]; };
  w.quantity_columns.clear();
  w.effect_columns.clear();
  w.condition_columns.clear();
  for (std::size_t r = 0; r < readings; ++r) {
    for (std::size_t q = 0; q < nq; ++q) w.quantity_columns.push_back(column(plan_.gather[r][q]));
    for (std::size_t q = 0; q < effect_quantities_; ++q) w.effect_columns.push_back(column(plan_.gather[r][nq + q]));
  }
  for (const double& c : conditions_) w.condition_columns.push_back({&c, 0});
}

namespace {

// One pass without a branch each: most blocks have none.
bool none_failed(const std::uint8_t* status, std::size_t n) {
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < n; i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, status + i, 8);
    found |= eight;
  }
  return found == 0;
}

bool perhaps_nan(const double* x, std::size_t n) {
  double sums[8] = {}; // of zeros, unless there is a NaN (or an infinity: looked at again then)
  for (std::size_t i = 0; i < n; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sums[k] += x[i + k] * 0.0;
  double sum = 0;
  for (const double s : sums) sum += s;
  return std::isnan(sum);
}

} // namespace

void Experiment::run(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs,
                     std::uint8_t* status, const std::vector<std::size_t>* changed) const {
  w.columns.resize(plan_.columns.size() * n);
  if (changed)
    for (const std::size_t c : *changed) plan_.assemble_column(c, variates, n, &w.columns[c * n]);
  else
    plan_.assemble(variates, n, w.columns.data(), n); // constant columns are read with stride 0
  w.drawn.clear();
  for (std::size_t c = 0; c < plan_.columns.size(); ++c)
    w.drawn.push_back(plan_.columns[c].variates.empty() ? models::Column{&column_estimates_[c], 0}
                                                        : models::Column{&w.columns[c * n], 1});
  run_drawn(n, w, outputs, status);
}

void Experiment::run_columns(std::span<const double* const> columns, std::size_t n, Workspace& w, double* outputs,
                             std::uint8_t* status) const {
  w.drawn.clear();
  for (std::size_t c = 0; c < plan_.columns.size(); ++c)
    w.drawn.push_back(columns[c] ? models::Column{columns[c], 1} : models::Column{&column_estimates_[c], 0});
  run_drawn(n, w, outputs, status);
}

void Experiment::run_drawn(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  if (!mean_) return run_model(n, w, outputs, status);
  const std::size_t readings = scenario_.readings.size(), rows = outputs_.size();
  w.single.resize(readings * rows * n);
  run_model(n, w, w.single.data(), status);
  const double share = 1 / static_cast<double>(readings);
  for (std::size_t i = 0; i < rows * n; ++i) {
    double sum = 0;
    for (std::size_t r = 0; r < readings; ++r) sum += w.single[r * rows * n + i];
    outputs[i] = sum * share;
  }
}

void Experiment::run_model(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const {
  const std::size_t readings = scenario_.readings.size(), rows = outputs_.size() * (mean_ ? readings : 1);
  const bool virtual_experiment = scenario_.method == scenario::Method::virtual_experiment;
  w.indications.resize(readings * indications_ * n);
  w.measurands.resize(rows);
  for (std::size_t i = 0; i < rows; ++i) w.measurands[i] = outputs + i * n;
  std::fill_n(status, n, std::uint8_t{0});
  wire(w, false);

  models::BlockCall call;
  call.samples = n;
  call.readings = readings;
  call.quantities = w.quantity_columns.data();
  call.effects = w.effect_columns.data();
  call.effect_quantities = effect_quantities_;
  call.active = active_;
  call.conditions = w.condition_columns.data();
  call.measurands = w.measurands.data();
  call.solved_as = solved_as_.data();
  call.status = status;
  call.evaluation = static_cast<int>(evaluation_);
  call.context = model_->context;
  call.first_sample = w.first_sample;
  call.declared = joint_ && !mean_ ? &declared_ : nullptr;

  if (virtual_experiment) {
    w.truth.resize(rows * n);
    w.true_measurands.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) w.true_measurands[i] = &w.truth[i * n];
    w.simulated.resize(readings * indications_);
    for (std::size_t i = 0; i < w.simulated.size(); ++i) w.simulated[i] = &w.indications[i * n];
    call.measurands = w.true_measurands.data();
    call.simulated = w.simulated.data();
    if (!joint_) call.evaluation = 0; // the machine itself, not what an approximate evaluation takes it for
    model_->kernels()->simulate(call);
    call.evaluation = static_cast<int>(evaluation_);
  }

  // Indications: what was read (or simulated) plus the drawn noise.
  const std::size_t first_noise = first_indication();
  w.indication_columns.clear();
  for (std::size_t r = 0; r < readings; ++r)
    for (std::size_t k = 0; k < indications_; ++k) {
      double* x = &w.indications[(r * indications_ + k) * n];
      const models::Column noise = w.drawn[plan_.gather[r][first_noise + k]];
      const double read = virtual_experiment ? 0 : scenario_.readings[r].indications[k];
      for (std::size_t i = 0; i < n; ++i) x[i] = (virtual_experiment ? x[i] : read) + noise.data[i * noise.stride];
      w.indication_columns.push_back({x, 1});
    }
  // Stated effects: the evaluation takes the drawn size off; in a virtual experiment that stands in the readout, and
  // the estimate is taken off.
  for (const StatedSize& s : stated_)
    for (std::size_t r = 0; r < readings; ++r) {
      double* x = &w.indications[(r * indications_ + s.indication) * n];
      const models::Column size = w.drawn[plan_.gather[r][s.quantity]];
      const double held = virtual_experiment ? column_estimates_[plan_.gather[r][s.quantity]] : 0;
      const double loading = virtual_experiment ? (*s.loading)[r] : -(*s.loading)[r];
      for (std::size_t i = 0; i < n; ++i) x[i] += (size.data[i * size.stride] - held) * loading;
    }
  call.indications = w.indication_columns.data();
  call.measurands = w.measurands.data();
  if (virtual_experiment) wire(w, true);
  model_->kernels()->evaluate(call);

  if (virtual_experiment)
    for (std::size_t i = 0; i < rows * n; ++i) outputs[i] -= w.truth[i];
  for (std::size_t row = 0; row < rows; ++row) {
    if (!perhaps_nan(outputs + row * n, n)) continue;
    for (std::size_t i = 0; i < n; ++i)
      if (status[i] == 0 && std::isnan(outputs[row * n + i]))
        status[i] = code(Status::no_solution);
  }
  if (none_failed(status, n)) return;
  for (std::size_t i = 0; i < n; ++i)
    if (status[i] != 0)
      for (std::size_t row = 0; row < rows; ++row) outputs[row * n + i] = std::numeric_limits<double>::quiet_NaN();
}

} // namespace gumshoe::propagation
