#include "tracing/candidates/candidates.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "tracing/candidates/candidate_families.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {

bool Amplitude::far_too_large(double size) const {
  return typical > 0 && std::fabs(size) > criteria.implausible_size * typical;
}

namespace {

double alike(const Vector& a, const Vector& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? a.dot(b) / lengths : 0;
}

} // namespace

std::vector<const Grouping*> part_labels(const Observations& o) {
  const auto done_anew = [&](const Grouping& label) {
    return label.group == o.blocks.group ||
           std::ranges::any_of(o.replicate_groups, [&](const Grouping& g) { return g.group == label.group; });
  };
  std::vector<const Grouping*> out;
  for (const Grouping& label : o.labels)
    if (label.groups.size() <= criteria.most_parts && !done_anew(label)) out.push_back(&label);
  return out;
}

bool numbers_groups(const Observations& o, const Covariate& c) {
  if (c.commanded) return false;
  const auto numbered = [&](const Grouping& g) {
    if (g.groups.size() != c.levels.size()) return false;
    std::vector<double> level(g.groups.size(), std::nan(""));
    for (std::size_t r = 0; r < o.readings; ++r) {
      double& known = level[g.group[r]];
      if (std::isnan(known)) known = c.value[r];
      if (known != c.value[r]) return false;
    }
    return true; // as many levels as groups, and one in each
  };
  return std::ranges::any_of(o.replicate_groups, numbered) || std::ranges::any_of(o.labels, [&](const Grouping& g) {
           return g.groups.size() <= criteria.most_omnibus_groups && numbered(g);
         });
}

std::string without_indication(const std::string& name, const Observations& o) {
  for (const std::string& indication : o.names)
    if (o.indications > 1 && name.ends_with(" of " + indication))
      return name.substr(0, name.size() - indication.size() - 4);
  return name;
}

Matrix masked(const Observations& o, Matrix columns, const std::vector<bool>* mask) {
  for (Index i = 0; i < columns.rows() && mask; ++i)
    if (!(*mask)[index(i) / o.indications]) columns.row(i).setZero();
  return in_sequence(o, columns);
}

CandidateMaker::CandidateMaker(const propagation::Experiment& e, const Simulator& s, const Points& p,
                               const Observations& o, double change, const std::function<bool(const Candidate&)>& skip,
                               const BestStart& best)
    : experiment(e), simulator(s), at(p), observations(o), moved(signatures(e, s, p, change)), step(change),
      choose(best), skip_(skip) {}

CandidateMaker::CandidateMaker(const propagation::Experiment& e, const Simulator& s, const Points& p,
                               const Observations& o, double change, const BestStart& best)
    : experiment(e), simulator(s), at(p), observations(o), step(change), choose(best) {}

void CandidateMaker::add(Candidate a, std::vector<Candidate>& family) const {
  // What a whole SI unit would move by less than a ten-millionth of the noise is rounding, no signature.
  const double least = criteria.least_signature * step * std::sqrt(static_cast<double>(a.columns.rows()));
  if (skip_(a) || !(a.columns.norm() > least)) return;
  for (const Candidate& other : family)
    if (other.name == a.name && other.columns.cols() == 1 && a.columns.cols() == 1 &&
        other.amplitudes[0].scenario_name == a.amplitudes[0].scenario_name &&
        std::fabs(alike(other.columns.col(0), a.columns.col(0))) > criteria.same_signature)
      return;
  for (const auto& [label, value] : a.amplitudes[0].labels) a.depends_on.push_back(label);
  if (a.depends_on.empty() || a.in_part())
    for (std::string& on : dependence_of(a))
      if (std::ranges::find(a.depends_on, on) == a.depends_on.end()) a.depends_on.push_back(std::move(on));
  family.push_back(std::move(a));
}

void CandidateMaker::add_single(Candidate a, std::size_t quantity, const std::vector<bool>* mask,
                                std::vector<Candidate>& family) const {
  a.columns = masked(observations, moved.tangents.col(index(quantity)), mask);
  add(a, family);
  for (const std::size_t i : {2 * quantity, 2 * quantity + 1}) {
    if (moved.sizes[i] == 0) continue;
    Candidate finite = a;
    finite.columns = masked(observations, moved.secants.col(index(i)), mask);
    finite.finite = moved.sizes[i];
    const Amplitude& s = a.amplitudes[0];
    finite.shape =
        fmt::format("over {:+.3g} {}", units::from_si(moved.sizes[i], s.unit, s.si_unit, units::Kind::difference),
                    s.unit == "1" ? "" : s.unit);
    add(std::move(finite), family);
  }
}

Amplitude CandidateMaker::amplitude(std::size_t quantity, const QuantityCard& card) const {
  const auto& q = experiment.scenario().quantities[quantity];
  const auto& [low, high, note, positive] = card.typical;
  return {quantity,        std::string(card.name), q.unit, q.si_unit, q.name,  {},
          card.limits.low, card.limits.high,       high,   low,       positive};
}

std::vector<Candidate> stated_candidates(const CandidateMaker& make) {
  const Observations& o = make.observations;
  std::vector<Candidate> out;
  for (const auto& effect : make.experiment.scenario().stated_effects) {
    if (effect.freed) continue;
    Amplitude size;
    size.quantity = Amplitude::npos;
    size.name = "size";
    size.unit = effect.unit;
    size.si_unit = effect.si_unit;
    size.scenario_name = effect.name + ".size";
    Matrix column = Matrix::Zero(index(make.simulator.rows()), 1);
    for (std::size_t r = 0; r < o.readings; ++r)
      for (const auto& part : effect.parts)
        if (const Index row = index(r * o.indications); part.on_quantity)
          column.block(row, 0, index(o.indications), 1) +=
              part.loading[r] * make.moved.tangents.block(row, index(part.target), index(o.indications), 1);
        else
          column(row + index(part.target), 0) = part.loading[r];
    Candidate one;
    one.family = Family::stated;
    one.name = effect.name;
    one.depends_on = dependence(o, make.experiment, effect);
    one.amplitudes = {size};
    one.columns = in_sequence(o, column);
    make.add(std::move(one), out);
  }
  return out;
}

namespace {

/// The effect to which a quantity belongs; none: it is no effect's.
const effects::Active* effect_of(std::size_t q, const propagation::Experiment& experiment) {
  const auto& all = experiment.forward().active();
  const auto at = std::ranges::find_if(all, [&](const effects::Active& e) {
    const std::size_t first = experiment.layout().effects[e.first];
    return q >= first && q < first + effects::cards()[e.effect]->quantities.size();
  });
  return at == all.end() ? nullptr : &*at;
}

} // namespace

Candidate with_held_shape(const Candidate& a, const propagation::Experiment& experiment, const Points& at) {
  const bool effect = a.family == Family::effect && !a.amplitudes.empty() && a.amplitudes[0].labels.empty();
  const effects::Active* const active = effect ? effect_of(a.amplitudes[0].quantity, experiment) : nullptr;
  Candidate out = a;
  if (!active || !a.held.empty()) return out;
  const auto cards = effects::cards()[active->effect]->quantities;
  for (std::size_t i = 0; i < cards.size(); ++i)
    if (const std::size_t q = experiment.layout().effects[active->first + i];
        cards[i].role == Role::shape && !experiment.scenario().quantities[q].estimated)
      out.held.emplace_back(q, at[0][q]);
  return out;
}

Candidate with_free_shape(const Candidate& a, const propagation::Experiment& experiment) {
  Candidate out = a;
  out.shape.clear();
  for (const auto& [q, value] : a.held) {
    const auto& quantity = experiment.scenario().quantities[q];
    const effects::Active& active = *effect_of(q, experiment);
    const QuantityCard& card =
        effects::cards()[active.effect]->quantities[q - experiment.layout().effects[active.first]];
    Amplitude shape;
    shape.quantity = q;
    shape.name = card.name;
    shape.unit = quantity.unit;
    shape.si_unit = quantity.si_unit;
    shape.scenario_name = quantity.name;
    shape.low = card.limits.low - value;
    shape.high = card.limits.high - value;
    shape.is_shape = true;
    shape.held = value;
    out.amplitudes.push_back(shape);
  }
  out.columns.conservativeResize(Eigen::NoChange, index(out.amplitudes.size()));
  out.columns.rightCols(index(a.held.size())).setZero();
  return out;
}

const char* name(Family family) {
  static constexpr const char* names[] = {"effect", "declared", "stated", "shape", "omnibus"};
  return names[static_cast<int>(family)];
}

std::vector<Candidate> physical_candidates(const propagation::Experiment& experiment, const Simulator& simulator,
                                           const Points& at, const Observations& observations, double step,
                                           const std::function<bool(const Candidate&)>& skip, const BestStart& choose) {
  const CandidateMaker make(experiment, simulator, at, observations, step, skip, choose);
  std::vector<Candidate> out = effect_candidates(make);
  for (const auto family : {declared_candidates, stated_candidates}) {
    const std::vector<Candidate> more = family(make);
    out.insert(out.end(), more.begin(), more.end());
  }
  const std::vector<Candidate> jumping = jumping_candidates(make, out);
  out.insert(out.end(), jumping.begin(), jumping.end());
  return out;
}

} // namespace gumshoe::tracing
