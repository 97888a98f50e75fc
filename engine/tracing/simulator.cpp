#include "tracing/simulator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "propagation/propagate.h"

namespace gumshoe::tracing {

Simulator::Simulator(const propagation::Experiment& e, int threads)
    : experiment_(e), readings_(e.scenario().readings.size()), indications_(e.model().card->indications.size()),
      threads_(threads) {
  const auto& s = e.scenario();
  for (std::size_t i = 0; i < s.stated_effects.size(); ++i)
    for (std::size_t q = 0; q < s.quantities.size(); ++q)
      if (s.quantities[q].name == s.stated_effects[i].name + ".size") stated_.push_back({q, i});
}

Points Simulator::estimates() const {
  Points out;
  for (std::size_t r = 0; r < readings_; ++r) out.push_back(experiment_.reading_point(r));
  return out;
}

void Simulator::add_stated(const Points& at, const std::vector<std::size_t>& quantities, Vector& f,
                           Matrix* derivative) const {
  for (const Stated& s : stated_) {
    const auto& effect = experiment_.scenario().stated_effects[s.effect];
    const auto column = std::find(quantities.begin(), quantities.end(), s.quantity) - quantities.begin();
    for (std::size_t r = 0; r < readings_; ++r) {
      const auto row = static_cast<Index>(r * indications_ + effect.indication);
      f[row] += at[r][s.quantity] * effect.loading[r];
      if (derivative && column < derivative->cols()) (*derivative)(row, column) = effect.loading[r];
    }
  }
}

std::vector<std::size_t> Simulator::alike_together(const Points& at) const {
  std::vector<std::size_t> out(readings_);
  std::iota(out.begin(), out.end(), 0);
  const auto end = static_cast<std::ptrdiff_t>(experiment_.model_quantities());
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(at[a].begin(), at[a].begin() + end, at[b].begin(), at[b].begin() + end);
  });
  return out;
}

bool Simulator::simulate(const Points& at, Vector& f) const {
  Matrix all;
  std::vector<bool> valid;
  vary(at, {{}}, all, valid);
  f = all.col(0);
  return valid[0];
}

void Simulator::vary(const Points& at, const std::vector<Variation>& variations, Matrix& f,
                     std::vector<bool>& valid) const {
  const auto& e = experiment_;
  const std::size_t count = variations.size(), samples = (count + 7) / 8 * 8, n = rows();
  const std::size_t mq = e.model_quantities(), eq = e.effect_quantities(), used = mq + eq + indications_;
  // Only what some variation changes needs a value per sample.
  std::map<std::size_t, std::vector<std::pair<std::size_t, Variation::Change>>> changed;
  for (std::size_t v = 0; v < count; ++v)
    for (const auto& c : variations[v].changes) changed[c.quantity].push_back({v, c});
  f.resize(static_cast<Index>(n), static_cast<Index>(count));
  valid.assign(count, true);
  // Readings in parts, so that threads share the work and buffers stay small.
  constexpr std::size_t part = 32;
  const std::size_t parts = (readings_ + part - 1) / part;
  std::vector<std::vector<std::uint8_t>> status(parts, std::vector<std::uint8_t>(samples, 0));
  const auto order = alike_together(at);
  const auto one = [&](std::size_t p) {
    const std::size_t first = p * part, last = std::min(readings_, first + part), here = last - first;
    std::vector<double> values, out(here * indications_ * samples),
        truth(here * e.model().card->measurands.size() * samples);
    values.reserve(here * changed.size() * samples);
    std::vector<models::Column> q, effects, conditions, indications;
    std::vector<double*> simulated, measurands;
    std::vector<std::size_t> own(here);
    for (std::size_t place = first; place < last; ++place) {
      const std::size_t r = order[place];
      own[place - first] = place - first;
      for (std::size_t i = 0; i < used; ++i) {
        models::Column column{&at[r][i], 0};
        if (const auto it = changed.find(i); it != changed.end()) {
          const std::size_t start = values.size();
          values.resize(start + samples, at[r][i]);
          for (const auto& [v, c] : it->second) values[start + v] = c.absolute ? c.value : at[r][i] + c.value;
          column = {&values[start], 1};
        }
        (i < mq ? q : i < mq + eq ? effects : indications).push_back(column);
      }
      for (const double& c : e.scenario().readings[r].conditions) conditions.push_back({&c, 0});
    }
    for (std::size_t i = 0; i < here * indications_; ++i) simulated.push_back(&out[i * samples]);
    for (std::size_t i = 0; i < truth.size() / samples; ++i) measurands.push_back(&truth[i * samples]);
    models::BlockCall call;
    call.samples = samples;
    call.readings = here;
    call.quantities = q.data();
    call.effects = effects.data();
    call.effect_quantities = eq;
    call.active = e.active();
    call.conditions = conditions.data();
    call.indications = indications.data();
    call.simulated = simulated.data();
    call.measurands = measurands.data();
    call.solved_as = own.data();
    call.status = status[p].data();
    call.evaluation = static_cast<int>(e.evaluation());
    call.context = e.model().context;
    e.model().kernels()->simulate(call);
    for (std::size_t i = 0; i < here * indications_; ++i) {
      const std::size_t row = order[first + i / indications_] * indications_ + i % indications_;
      for (std::size_t v = 0; v < count; ++v) f(static_cast<Index>(row), static_cast<Index>(v)) = out[i * samples + v];
    }
  };
  // What a user wrote may not be safe to call from several threads.
  if (e.scenario().made || parts == 1)
    for (std::size_t p = 0; p < parts; ++p) one(p);
  else
    propagation::parallel_for(parts, threads_, one);
  for (const auto& s : status)
    for (std::size_t v = 0; v < count; ++v)
      if (s[v] != 0) valid[v] = false;
  for (const Stated& s : stated_)
    for (std::size_t v = 0; v < count; ++v) {
      const auto& effect = e.scenario().stated_effects[s.effect];
      for (std::size_t r = 0; r < readings_; ++r) {
        double size = at[r][s.quantity];
        for (const auto& c : variations[v].changes)
          if (c.quantity == s.quantity) size = c.absolute ? c.value : size + c.value;
        f(static_cast<Index>(r * indications_ + effect.indication), static_cast<Index>(v)) += size * effect.loading[r];
      }
    }
}

namespace {

/// Place of the first that is the same quantity: one may be asked for twice, as declared and as a term's.
std::size_t first_like(const std::vector<std::size_t>& quantities, std::size_t i) {
  return static_cast<std::size_t>(std::find(quantities.begin(), quantities.end(), quantities[i]) - quantities.begin());
}

} // namespace

bool Simulator::derivatives(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                            bool* kink) const {
  derivative = Matrix::Zero(static_cast<Index>(rows()), static_cast<Index>(quantities.size()));
  f = Vector::Zero(static_cast<Index>(rows()));
  if (kink) *kink = false;
  if (!experiment_.model().simulate_gradient) return by_differences(at, quantities, f, derivative);
  if (!by_dual_numbers(at, quantities, f, derivative, kink)) return false;
  add_stated(at, quantities, f, &derivative);
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (const std::size_t first = first_like(quantities, i); first < i)
      derivative.col(static_cast<Index>(i)) = derivative.col(static_cast<Index>(first));
  return true;
}

bool Simulator::by_dual_numbers(const Points& at, const std::vector<std::size_t>& quantities, Vector& f,
                                Matrix& derivative, bool* kink) const {
  constexpr std::size_t chunk = 8;
  const auto& e = experiment_;
  const std::size_t mq = e.model_quantities(), eq = e.effect_quantities();
  std::vector<std::size_t> wanted; // positions in `quantities` of what the model reads
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (quantities[i] < mq + eq && first_like(quantities, i) == i) wanted.push_back(i);
  std::vector<std::uint8_t> failed(readings_, 0), bent(readings_, 0);
  const auto one = [&](std::size_t r) {
    std::vector<models::Gradient> point(at[r].begin(), at[r].end()), out(indications_),
        measurands(e.model().card->measurands.size());
    models::PointCall<models::Gradient> call;
    call.quantities = point.data();
    call.effects = point.data() + mq;
    call.active = e.active();
    call.conditions = e.scenario().readings[r].conditions.data();
    call.indications = point.data() + mq + eq;
    call.measurands = measurands.data();
    call.simulated = out.data();
    call.evaluation = static_cast<int>(e.evaluation());
    call.context = e.model().context;
    std::size_t from = 0;
    do {
      const std::size_t to = std::min(wanted.size(), from + chunk);
      for (std::size_t i = from; i < to; ++i) {
        const std::size_t q = quantities[wanted[i]];
        point[q] = models::Gradient::variable(at[r][q], static_cast<int>(i - from));
      }
      const auto outcome = e.model().simulate_gradient(call);
      if (outcome.status != 0) {
        failed[r] = outcome.status;
        return;
      }
      if (outcome.kink) bent[r] = 1;
      for (std::size_t k = 0; k < indications_; ++k) {
        const auto row = static_cast<Index>(r * indications_ + k);
        f[row] = out[k].v;
        for (std::size_t i = from; i < to; ++i) derivative(row, static_cast<Index>(wanted[i])) = out[k].d[i - from];
      }
      for (std::size_t i = from; i < to; ++i)
        point[quantities[wanted[i]]] = models::Gradient(at[r][quantities[wanted[i]]]);
      from = to;
    } while (from < wanted.size());
  };
  const auto order = alike_together(at);
  constexpr std::size_t part = 16;
  propagation::parallel_for((readings_ + part - 1) / part, threads_, [&](std::size_t p) {
    for (std::size_t i = p * part; i < std::min(readings_, (p + 1) * part); ++i) one(order[i]);
  });
  if (kink) *kink = std::find(bent.begin(), bent.end(), 1) != bent.end();
  return std::all_of(failed.begin(), failed.end(), [](std::uint8_t s) { return s == 0; });
}

double Simulator::step(std::size_t quantity, const Points& at) const {
  double size = 0;
  for (const auto& p : at) size = std::max(size, std::fabs(p[quantity]));
  if (size == 0) {
    const auto& card = *experiment_.model().card;
    if (quantity < card.quantities.size()) size = std::fabs(card.quantities[quantity].default_value);
  }
  return 6e-6 * (size > 0 ? size : 1); // the cube root of the rounding error
}

bool Simulator::by_differences(const Points& at, const std::vector<std::size_t>& quantities, Vector& f,
                               Matrix& derivative) const {
  std::vector<Variation> variations{{}};
  for (const std::size_t q : quantities)
    for (const double sign : {1.0, -1.0}) variations.push_back({{{q, sign * step(q, at), false}}});
  Matrix all;
  std::vector<bool> valid;
  vary(at, variations, all, valid);
  f = all.col(0);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto up = static_cast<Index>(1 + 2 * i);
    if (!valid[1 + 2 * i] || !valid[2 + 2 * i]) continue; // no derivative to be had: nothing moves
    derivative.col(static_cast<Index>(i)) = (all.col(up) - all.col(up + 1)) / (2 * step(quantities[i], at));
  }
  return valid[0];
}

} // namespace gumshoe::tracing
