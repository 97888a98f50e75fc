#include "tracing/candidates/extended_scenario.h"

#include <algorithm>

#include "effects/effect.h"
#include "quantities/effect_of.h"

namespace gumshoe::tracing {
namespace {

using quantities::InputQuantity;
using scenario::Scenario;

/// Quantities whose values come from these data ([trace] free): no prior, and tied to nothing. Those of [trace] priors
/// are known as they were before these data. Of other data than the scenario's own, all but the offsets of blocks are
/// known beforehand, as stated.
void free_again(Scenario& s) {
  const bool own = s.data.empty();
  const auto is_of = [](const std::string& name, const std::string& q) {
    return name == q || name.starts_with(q + "[") || name.starts_with(q + ".") || name.starts_with(q + ":");
  };
  const auto earlier = [&](const std::string& name) {
    return own && std::ranges::any_of(s.trace.priors, [&](const InputQuantity& q) { return is_of(name, q.name); });
  };
  const auto freed = [&](const std::string& name) {
    return std::ranges::any_of(s.trace.free, [&](const std::string& q) {
      return (own || quantities::effect_of(q).empty()) && is_of(name, q);
    });
  };
  if (own)
    for (const InputQuantity& prior : s.trace.priors)
      *std::ranges::find(s.quantities, prior.name, &InputQuantity::name) = prior;
  for (InputQuantity& q : s.quantities) {
    if (!freed(q.name)) continue;
    q.estimated = true;
    // A size that was found for some labels is exactly null for all others.
    const bool some = std::ranges::any_of(q.entries, [](const auto& entry) { return !entry.components.empty(); });
    quantities::Component held;
    held.name = "held";
    held.distribution = {quantities::Family::constant, {0}, nullptr, nullptr};
    for (auto& entry : q.entries)
      entry.components = some && entry.components.empty() ? std::vector{held} : std::vector<quantities::Component>{};
  }
  const auto fitted_anew = [&](const std::string& name) { return freed(name) || earlier(name); };
  for (auto& c : s.correlations) {
    const std::size_t n = c.quantities.size();
    quantities::Correlation kept{c.kind, {}, {}};
    for (std::size_t i = 0; i < n; ++i) {
      if (fitted_anew(c.quantities[i])) continue;
      kept.quantities.push_back(c.quantities[i]);
      for (std::size_t j = 0; j < n; ++j)
        if (!fitted_anew(c.quantities[j])) kept.matrix.push_back(c.matrix[i * n + j]);
    }
    c = std::move(kept);
  }
  std::erase_if(s.correlations, [](const auto& c) { return c.quantities.size() < 2; });
}

} // namespace

Scenario extended(const Scenario& s) {
  Scenario out = s;
  const models::Model* model = s.made ? s.made.get() : models::find(s.model);
  const std::size_t first = model->card->quantities.size();
  std::vector<InputQuantity> effect_quantities;
  for (const EffectCard* card : effects::cards()) {
    if (!effects::applies(*model->card, *card)) continue;
    for (const QuantityCard& q : card->quantities) {
      const std::string name = std::string(card->name) + "." + std::string(q.name);
      const auto known = std::ranges::find_if(s.quantities, [&](const auto& x) { return x.name == name; });
      if (known != s.quantities.end()) {
        effect_quantities.push_back(*known);
        continue;
      }
      quantities::Entry entry;
      entry.value = q.default_value;
      effect_quantities.push_back({name, std::string(q.unit), std::string(q.si_unit), {entry}, false});
    }
  }
  // Model's, effects', noise, sizes of stated effects.
  std::size_t noise = first;
  while (noise < s.quantities.size() && s.quantities[noise].name != model->card->indications[0].name) ++noise;
  out.quantities.assign(s.quantities.begin(), s.quantities.begin() + static_cast<std::ptrdiff_t>(first));
  out.quantities.insert(out.quantities.end(), effect_quantities.begin(), effect_quantities.end());
  out.quantities.insert(out.quantities.end(), s.quantities.begin() + static_cast<std::ptrdiff_t>(noise),
                        s.quantities.end());
  free_again(out);
  return out;
}

} // namespace gumshoe::tracing
