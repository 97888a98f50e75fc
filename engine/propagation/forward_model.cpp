#include "propagation/forward_model.h"

#include <algorithm>

#include "propagation/all_readings.h"

namespace gumshoe::propagation {

void Block::clear(std::size_t samples_wanted) {
  samples = samples_wanted;
  for (auto* columns : {&quantities, &effects, &indications, &sizes, &conditions}) columns->clear();
  readings.clear();
  solved_as.clear();
  moved.clear();
}

ForwardModel::ForwardModel(const models::Model& model, std::span<const EffectCard* const> acting,
                           std::size_t evaluation, std::vector<std::vector<double>> conditions,
                           std::vector<StatedSize> stated)
    : model_(&model), evaluation_(evaluation), conditions_(std::move(conditions)), stated_(std::move(stated)) {
  std::size_t effect_quantities = 0;
  for (const EffectCard* effect : acting) {
    const auto at = std::ranges::find(effects::cards(), effect) - effects::cards().begin();
    active_.push_back({static_cast<std::size_t>(at), effect_quantities});
    effect_quantities += effect->quantities.size();
  }
  const ModelCard& card = *model.card;
  layout_ = {card.quantities.size(), effect_quantities, card.indications.size(), 0};
  const std::size_t first = layout_.size();
  for (const StatedSize& s : stated_) layout_.sizes.end = std::max(layout_.sizes.end, s.quantity + 1);
  layout_.sizes.begin = first;
}

ForwardModel ForwardModel::on_threads(int threads) const {
  ForwardModel copy = *this;
  copy.threads_ = threads;
  return copy;
}

ForwardModel ForwardModel::with_condition(std::span<const std::size_t> readings, std::size_t condition,
                                          double value) const {
  ForwardModel copy = *this;
  copy.conditions_.clear();
  for (StatedSize& s : copy.stated_) s.loading.clear();
  for (const std::size_t r : readings) {
    copy.conditions_.push_back(conditions_[r]);
    copy.conditions_.back()[condition] = value;
    for (std::size_t s = 0; s < stated_.size(); ++s) copy.stated_[s].loading.push_back(stated_[s].loading[r]);
  }
  return copy;
}

void ForwardModel::declare(models::Declared declared) {
  declared_ = std::make_shared<const models::Declared>(std::move(declared));
}

bool ForwardModel::joint() const {
  const auto evaluations = model_->card->evaluations;
  return evaluation_ < evaluations.size() && evaluations[evaluation_].joint();
}

std::span<const VariableCard> ForwardModel::measurands(const double* quantities) const {
  if (!joint()) return model_->card->measurands;
  const std::span<const VariableCard> all = model_->card->evaluations[evaluation_].measurands;
  return model_->measurands_in_use ? all.first(model_->measurands_in_use(static_cast<int>(evaluation_), quantities))
                                   : all;
}

bool ForwardModel::has_simulation() const {
  return model_->simulate_gradient || (model_->kernels && model_->kernels() && model_->kernels()->simulate);
}

void ForwardModel::add(Block& block, std::size_t reading, std::span<const models::Column> row,
                       std::span<const models::Column> conditions) const {
  const auto append = [&](std::vector<models::Column>& to, Range part) {
    to.insert(to.end(), row.begin() + static_cast<std::ptrdiff_t>(part.begin),
              row.begin() + static_cast<std::ptrdiff_t>(part.end));
  };
  const std::size_t first = block.quantities.size();
  append(block.quantities, layout_.model);
  for (const StatedSize& s : stated_) {
    if (!layout_.model.contains(s.target)) continue;
    models::Column& quantity = block.quantities[first + s.target];
    const models::Column size = row[s.quantity];
    std::vector<double>& sum = block.moved.emplace_back(block.samples);
    for (std::size_t i = 0; i < block.samples; ++i)
      sum[i] = quantity.data[i * quantity.stride] + size.data[i * size.stride] * s.loading[reading];
    quantity = {sum.data(), 1};
  }
  append(block.effects, layout_.effects);
  append(block.indications, layout_.indications);
  append(block.sizes, layout_.sizes);
  if (conditions.empty())
    for (const double& c : conditions_[reading]) block.conditions.push_back({&c, 0});
  else
    block.conditions.insert(block.conditions.end(), conditions.begin(), conditions.end());
  block.solved_as.push_back(block.readings.size());
  block.readings.push_back(reading);
}

models::BlockCall ForwardModel::call(const Block& block, double* const* simulated, double* const* measurands,
                                     std::uint8_t* status) const {
  models::BlockCall call;
  call.samples = block.samples;
  call.readings = block.readings.size();
  call.quantities = block.quantities.data();
  call.effects = block.effects.data();
  call.effect_quantities = layout_.effects.size();
  call.active = active_;
  call.conditions = block.conditions.data();
  call.indications = block.indications.data();
  call.simulated = simulated;
  call.measurands = measurands;
  call.solved_as = block.solved_as.data();
  call.status = status;
  call.evaluation = static_cast<int>(evaluation_);
  call.context = model_->context;
  call.declared = declared_.get();
  call.first_sample = block.first_sample;
  return call;
}

template <class T> models::PointCall<T> ForwardModel::point_call(std::size_t reading, const T* point) const {
  models::PointCall<T> call;
  call.quantities = point + layout_.model.begin;
  call.effects = point + layout_.effects.begin;
  call.active = active_;
  call.conditions = conditions_[reading].data();
  call.indications = point + layout_.indications.begin;
  call.evaluation = static_cast<int>(evaluation_);
  call.context = model_->context;
  return call;
}

namespace {

/// Measurand rows of a block; a joint evaluation's follow from the quantities of its first sample.
std::size_t measurand_rows(const ForwardModel& forward, const Block& block) {
  if (!forward.joint()) return block.readings.size() * forward.model().card->measurands.size();
  std::vector<double> first;
  for (std::size_t q = 0; q < forward.layout().model.size(); ++q) first.push_back(*block.quantities[q].data);
  return forward.measurands(first.data()).size();
}

std::vector<double*> rows_of(std::vector<double>& values, std::size_t rows, std::size_t samples) {
  values.resize(rows * samples);
  std::vector<double*> out;
  for (std::size_t i = 0; i < rows; ++i) out.push_back(&values[i * samples]);
  return out;
}

} // namespace

BlockValues ForwardModel::simulate(const Block& block) const {
  const std::size_t places = block.readings.size(), n = block.samples;
  BlockValues out;
  out.status.assign(n, 0);
  if (n == 0 || places == 0) return out;
  const auto simulated = rows_of(out.indications, places * layout_.indications.size(), n),
             truth = rows_of(out.measurands, measurand_rows(*this, block), n);
  model_->kernels()->simulate(call(block, simulated.data(), truth.data(), out.status.data()));
  for (std::size_t s = 0; s < stated_.size(); ++s)
    for (std::size_t p = 0; p < places && layout_.indications.contains(stated_[s].target); ++p) {
      const models::Column size = block.sizes[p * layout_.sizes.size() + stated_[s].quantity - layout_.sizes.begin];
      double* x = simulated[p * layout_.indications.size() + stated_[s].target - layout_.indications.begin];
      const double loading = stated_[s].loading[block.readings[p]];
      for (std::size_t i = 0; i < n; ++i) x[i] += size.data[i * size.stride] * loading;
    }
  return out;
}

BlockValues ForwardModel::evaluate(const Block& block) const {
  const std::size_t places = block.readings.size(), n = block.samples, k = layout_.indications.size();
  BlockValues out;
  out.status.assign(n, 0);
  if (n == 0 || places == 0) return out;
  const auto evaluated = rows_of(out.measurands, measurand_rows(*this, block), n);
  auto run = call(block, nullptr, evaluated.data(), out.status.data());
  std::vector<double> without(stated_.empty() ? 0 : places * k * n);
  std::vector<models::Column> columns;
  if (!stated_.empty()) {
    for (std::size_t i = 0; i < places * k; ++i) {
      const models::Column read = block.indications[i];
      for (std::size_t j = 0; j < n; ++j) without[i * n + j] = read.data[j * read.stride];
      columns.push_back({&without[i * n], 1});
    }
    for (std::size_t s = 0; s < stated_.size(); ++s)
      for (std::size_t p = 0; p < places && layout_.indications.contains(stated_[s].target); ++p) {
        const models::Column size = block.sizes[p * layout_.sizes.size() + stated_[s].quantity - layout_.sizes.begin];
        double* x = &without[(p * k + stated_[s].target - layout_.indications.begin) * n];
        const double loading = stated_[s].loading[block.readings[p]];
        for (std::size_t i = 0; i < n; ++i) x[i] -= size.data[i * size.stride] * loading;
      }
    run.indications = columns.data();
  }
  model_->kernels()->evaluate(run);
  return out;
}

template <class T>
models::PointOutcome ForwardModel::evaluate_point(std::size_t reading, std::vector<T> point, std::vector<T>& out,
                                                  models::PointOutcome (*function)(const models::PointCall<T>&)) const {
  subtract_stated(reading, point.data());
  move_quantities(reading, point.data());
  out.resize(model_->card->measurands.size());
  auto call = point_call(reading, point.data());
  call.measurands = out.data();
  return function(call);
}

models::PointOutcome ForwardModel::measurands(std::size_t reading, std::vector<models::Gradient> point,
                                              std::vector<models::Gradient>& out) const {
  return evaluate_point(reading, std::move(point), out, model_->evaluate_gradient);
}

models::PointOutcome ForwardModel::measurands(std::size_t reading, std::vector<models::Curvature> point,
                                              std::vector<models::Curvature>& out) const {
  return evaluate_point(reading, std::move(point), out, model_->evaluate_curvature);
}

models::PointOutcome ForwardModel::indications(std::size_t reading, const std::vector<models::Gradient>& point,
                                               std::vector<models::Gradient>& out) const {
  out.resize(layout_.indications.size());
  std::vector<models::Gradient> truth(model_->card->measurands.size());
  std::vector<models::Gradient> moved(stated_.empty() ? 0 : point.size());
  if (!stated_.empty()) {
    std::ranges::copy(point, moved.begin());
    move_quantities(reading, moved.data());
  }
  auto call = point_call(reading, stated_.empty() ? point.data() : moved.data());
  call.measurands = truth.data();
  call.simulated = out.data();
  const auto outcome = model_->simulate_gradient(call);
  for (const StatedSize& s : stated_)
    if (layout_.indications.contains(s.target)) {
      models::Gradient& x = out[s.target - layout_.indications.begin];
      x = x + point[s.quantity] * s.loading[reading];
    }
  return outcome;
}

std::string ForwardModel::check(std::size_t reading, std::vector<double> point) const {
  subtract_stated(reading, point.data());
  move_quantities(reading, point.data());
  return model_->check(point_call<double>(reading, point.data()));
}

std::vector<models::Intermediate> ForwardModel::explain(std::size_t reading, const std::vector<double>& point) const {
  std::vector<double> moved = point;
  move_quantities(reading, moved.data());
  return model_->explain(point_call<double>(reading, moved.data()));
}

struct ForwardModel::Together : AllReadings {};

ForwardModel::Together ForwardModel::together(const Points& at) const { return {all_readings(*this, at)}; }

std::string ForwardModel::check_together(const Points& at) const {
  if (!model_->check_readings) return {};
  const Together all = together(at);
  return model_->check_readings(call(all.block, nullptr, nullptr, nullptr));
}

std::vector<std::string> ForwardModel::remarks(const Points& at) const {
  if (!model_->remarks) return {};
  const Together all = together(at);
  return model_->remarks(call(all.block, nullptr, nullptr, nullptr));
}

} // namespace gumshoe::propagation
