#include "tracing/fit/jumping_unknowns.h"

#include <algorithm>
#include <cmath>

#include "effects/effect.h"
#include "quantities/effect_of.h"
#include "tracing/candidates/candidate_families.h"
#include "tracing/criteria.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {
namespace {

using Places = std::vector<std::size_t>; ///< of quantities of the extended scenario
using propagation::Experiment;
using scenario::Scenario;

/// The card of a quantity of the model or of an effect; null: of another.
const QuantityCard* card_of(const Experiment& e, std::size_t quantity) {
  if (e.layout().model.contains(quantity)) return &e.model().card->quantities[quantity - e.layout().model.begin];
  const std::string& name = e.scenario().quantities[quantity].name;
  const EffectCard* effect = effects::find(quantities::effect_of(name));
  if (!effect) return nullptr;
  const auto card = std::ranges::find_if(
      effect->quantities, [&](const QuantityCard& q) { return name.substr(effect->name.size() + 1) == q.name; });
  return card == effect->quantities.end() || card->role == Role::shape ? nullptr : &*card;
}

/// Free unknowns that have one value for all readings, which no earlier trace has found.
Places of_one_value(const Experiment& e, const Fitter& fitter) {
  Places out;
  for (const FreeUnknown& u : fitter.unknowns()) {
    const auto& quantity = e.scenario().quantities[u.quantity];
    if (u.jump == 0 && quantity.entries.size() == 1 && quantity.entries[0].labels.empty() && card_of(e, u.quantity) &&
        !fitted_before(e.scenario().trace, quantity.name))
      out.push_back(u.quantity);
  }
  return out;
}

Scenario without_estimating(Scenario s, const Places& quantities) {
  for (const std::size_t q : quantities) s.quantities[q].estimated = false;
  return s;
}

/// Changes of these quantities from where they are; two that follow each other as a pair of an effect are one candidate.
std::vector<Candidate> changes_of(const CandidateMaker& make, const Places& quantities) {
  std::vector<Candidate> out;
  Vector f;
  Matrix tangents;
  if (!make.simulator.derivatives(make.at, quantities, f, tangents)) return out;
  tangents = in_sequence(make.observations, tangents);
  const auto role = [&](std::size_t q) { return card_of(make.experiment, q)->role; };
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const std::size_t q = quantities[i], first = i;
    Places own{q};
    if (i + 1 < quantities.size() && quantities[i + 1] == q + 1 && role(q) == Role::pair && role(q + 1) == Role::pair &&
        quantities::effect_of(make.experiment.scenario().quantities[q].name) ==
            quantities::effect_of(make.experiment.scenario().quantities[q + 1].name))
      own.push_back(quantities[++i]);
    Candidate one;
    one.name = make.experiment.scenario().quantities[q].name;
    one.columns = tangents.middleCols(index(first), index(own.size()));
    for (const std::size_t each : own) {
      const QuantityCard& card = *card_of(make.experiment, each);
      Amplitude a = make.amplitude(each, card);
      a.low = card.limits.low - make.at[0][each];
      a.high = card.limits.high - make.at[0][each];
      one.amplitudes.push_back(std::move(a));
    }
    if (one.columns.norm() > 0) out.push_back(std::move(one));
  }
  return out;
}

/// Those of the quantities with which readings jump. @param left  root mean square of what is left of the readings, SI
Places jumping_among(const Experiment& e, const Simulator& simulator, const Observations& o, const Places& quantities,
                     double left) {
  const BestStart first = [](const Candidate&, const Matrix& sizes, double) {
    return std::optional(Start{sizes.col(0)});
  };
  const Points at = simulator.estimates();
  const CandidateMaker make(e, simulator, at, o, criteria.secant_step * left, first);
  Places out;
  for (const Candidate& a : jumping_candidates(make, changes_of(make, quantities)))
    for (const Amplitude& one : a.amplitudes) out.push_back(one.quantity);
  std::ranges::sort(out);
  return out;
}

/// Root mean square of what one step by the tangents leaves of the readings, SI.
double left_by_tangents(const Fitter& fitter) {
  const JointFit fit = fitter.linearised(1);
  if (!fit.valid) return 0;
  const Whitened plain(fit.design, fitter.rows(), independent(fit.design, fitter.rows()), {});
  const double squares = plain.squares(plain.winsorised(plain.take(fit.residual)))[0];
  return std::sqrt(squares / static_cast<double>(std::max<Index>(1, plain.degrees_of_freedom()))) *
         fit.design.reference[0];
}

/// Terms for the quantities, one after the other as they explain the readings, all fitted together.
std::vector<Term> found(const Experiment& e, const Simulator& simulator, const Observations& o,
                        const std::vector<Index>& rows, Places quantities, int threads) {
  const Fitter fitter(e, simulator, o, rows, threads);
  JointFit fit = fitter.fit({}, 0);
  while (fit.valid && !quantities.empty()) {
    const double left = std::sqrt(std::max(1e-300, fit.variance)) * fit.design.reference[0];
    const BestStart best = [&](const Candidate& a, const Matrix& sizes, double step) {
      return fitter.best_start(fit, a, sizes, step);
    };
    const CandidateMaker make(e, simulator, fit.at, o, criteria.secant_step * left, best);
    const auto candidates = jumping_candidates(make, changes_of(make, quantities));
    if (candidates.empty()) break;
    const Candidate& next = *std::ranges::max_element(candidates, {}, &Candidate::exact_ratio);
    auto terms = fit.terms;
    terms.push_back(at_start(next));
    JointFit with = fitter.fit(terms, fit.noise, &fit);
    if (!with.valid) break;
    for (const Amplitude& a : next.amplitudes) std::erase(quantities, a.quantity);
    fit = std::move(with);
  }
  return fit.terms;
}

} // namespace

bool fitted_before(const scenario::TraceOptions& trace, const std::string& name) {
  return std::ranges::find(trace.free, name) != trace.free.end() ||
         std::ranges::find(trace.priors, name, &quantities::InputQuantity::name) != trace.priors.end();
}

std::optional<Scenario> with_jumping_found(const Scenario& scenario, const Experiment& experiment,
                                           const Simulator& simulator, const Observations& observations,
                                           const Fitter& fitter, int threads) {
  const Places open = of_one_value(experiment, fitter);
  const double left = open.empty() ? 0 : left_by_tangents(fitter);
  if (!(left > 0)) return std::nullopt;
  const Places jumping = jumping_among(experiment, simulator, observations, open, left);
  if (jumping.empty()) return std::nullopt;
  const Scenario held = without_estimating(experiment.scenario(), jumping);
  const Experiment without(held); // keeps a reference
  Scenario out = scenario;
  for (const Term& t : found(without, Simulator(without, threads), observations, fitter.rows(), jumping, threads))
    for (std::size_t j = 0; j < t.candidate.amplitudes.size(); ++j) {
      const std::string& name = t.candidate.amplitudes[j].scenario_name;
      std::ranges::find(out.quantities, name, &quantities::InputQuantity::name)->entries[0].value += t.size[index(j)];
      out.trace.jumping.emplace_back(name, found_size(t));
    }
  return out.trace.jumping.size() > scenario.trace.jumping.size() ? std::optional(std::move(out)) : std::nullopt;
}

} // namespace gumshoe::tracing
