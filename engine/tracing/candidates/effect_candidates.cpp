#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "quantities/cells.h"
#include "tracing/candidates/candidate_families.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// What is tried together: an amplitude, or both components of a pair.
struct Group {
  const EffectCard* effect;
  std::size_t in_card, first, count; ///< where it starts in the card and among the scenario's quantities
};

std::vector<Group> groups_of(const propagation::Experiment& e, const effects::Active& active) {
  const EffectCard& card = *effects::cards()[active.effect];
  const auto paired = [&](std::size_t i) {
    return i < card.quantities.size() && card.quantities[i].role == Role::pair;
  };
  std::vector<Group> out;
  for (std::size_t i = 0; i < card.quantities.size(); ++i) {
    const std::size_t first = e.layout().effects[active.first + i];
    if (card.quantities[i].role == Role::amplitude) out.push_back({&card, i, first, 1});
    if (paired(i) && paired(i + 1)) out.push_back({&card, i++, first, 2});
  }
  return out;
}

/// Without columns yet.
Candidate candidate(const CandidateMaker& make, const Group& group) {
  Candidate out;
  out.name = group.effect->name;
  for (std::size_t i = 0; i < group.count; ++i)
    out.amplitudes.push_back(make.amplitude(group.first + i, group.effect->quantities[group.in_card + i]));
  return out;
}

/// A component of a pair that moves nothing here is no parameter.
void drop_still(Candidate& a) {
  for (Index j = a.columns.cols() - 1; j >= 0 && a.columns.cols() > 1; --j) {
    if (a.columns.col(j).norm() > 0) continue;
    const Matrix kept = a.columns.col(1 - j);
    a.columns = kept;
    a.amplitudes.erase(a.amplitudes.begin() + j);
  }
}

/// With its shape quantities at their defaults. @param mask  readings at which it acts; null: all
void add(const CandidateMaker& make, Candidate one, const Group& group, const std::vector<bool>* mask,
         std::vector<Candidate>& found) {
  if (group.count == 1) return make.add_single(std::move(one), group.first, mask, found);
  one.columns = masked(make.observations, make.moved.tangents.middleCols(index(group.first), 2), mask);
  drop_still(one);
  make.add(std::move(one), found);
}

void with_default_shapes(const CandidateMaker& make, std::vector<Candidate>& found) {
  for (const effects::Active& active : make.experiment.forward().active())
    for (const Group& group : groups_of(make.experiment, active))
      add(make, candidate(make, group), group, nullptr, found);
}

/// Values at which a shape quantity is tried, SI: its default, then a time constant by the duration of the data; others
/// from half the typical range's lower end to twice its
/// upper one, or a share of 0, 1/2 and 1.
std::vector<double> grid_of(const QuantityCard& card, const Observations& o) {
  std::vector<double> out{card.default_value};
  const auto& [low, high, note, positive] = card.typical;
  const auto time = std::ranges::find(o.covariates, "time", &Covariate::name);
  if (card.si_unit == "s" && time != o.covariates.end()) {
    const double duration = time->levels.back() - time->levels.front(),
                 least = duration * std::max(criteria.shortest, static_cast<double>(criteria.few_readings) /
                                                                    static_cast<double>(time->levels.size()));
    for (int i = 0; i < criteria.time_constants; ++i)
      out.push_back(least * std::pow(criteria.longest * duration / least, i / (criteria.time_constants - 1.0)));
  } else if (high > low && low > 0)
    for (int i = 0; i <= 5; ++i) out.push_back(0.5 * low * std::pow(4 * high / low, i / 5.0));
  else if (card.limits.low == 0 && card.limits.high == 1)
    out.insert(out.end(), {0.0, 0.5, 1.0});
  std::vector<double> kept;
  for (const double x : out)
    if (card.limits.contain(x) && std::ranges::find(kept, x) == kept.end()) kept.push_back(x);
  return kept;
}

/// A shape quantity, the values it is tried at, and what has that shape.
struct Grid {
  std::size_t shape;
  std::vector<double> values;
  std::vector<Group> groups;
};

std::vector<Grid> grids_of(const propagation::Experiment& e, const Observations& o) {
  std::vector<Grid> out;
  for (const effects::Active& active : e.forward().active()) {
    const auto& card = effects::cards()[active.effect]->quantities;
    std::vector<Group> groups = groups_of(e, active);
    // The shape of a size that is free already is fitted with it.
    std::erase_if(groups, [&](const Group& g) { return e.scenario().quantities[g.first].estimated; });
    for (std::size_t i = 0; i < card.size() && !groups.empty(); ++i)
      if (card[i].role == Role::shape)
        out.push_back({e.layout().effects[active.first + i], grid_of(card[i], o), groups});
  }
  return out;
}

/// Amplitudes again with every shape quantity at the other values of its grid; the amplitudes are at null, so all
/// effects can stand at their next grid value together.
void with_other_shapes(const CandidateMaker& make, std::vector<Candidate>& found) {
  const std::vector<Grid> grids = grids_of(make.experiment, make.observations);
  std::size_t longest = 0;
  for (const Grid& grid : grids) longest = std::max(longest, grid.values.size());
  for (std::size_t g = 1; g < longest; ++g) {
    Points at = make.at;
    std::vector<std::size_t> moved;
    for (const Grid& grid : grids) {
      if (g >= grid.values.size()) continue;
      for (auto& p : at) p[grid.shape] = grid.values[g];
      for (const Group& group : grid.groups)
        for (std::size_t i = 0; i < group.count; ++i) moved.push_back(group.first + i);
    }
    Vector f;
    Matrix derivative;
    if (moved.empty() || !make.simulator.derivatives(at, moved, f, derivative)) continue;
    Index column = 0;
    for (const Grid& grid : grids) {
      if (g >= grid.values.size()) continue;
      const auto& shape = make.experiment.scenario().quantities[grid.shape];
      for (const Group& group : grid.groups) {
        Candidate one = candidate(make, group);
        one.held = {{grid.shape, grid.values[g]}};
        one.shape =
            fmt::format("{} {:.3g} {}", shape.name.substr(shape.name.find('.') + 1),
                        units::from_si(grid.values[g], shape.unit, shape.si_unit), shape.unit == "1" ? "" : shape.unit);
        const auto count = index(group.count);
        one.columns = in_sequence(make.observations, derivative.middleCols(column, count));
        column += count;
        drop_still(one);
        make.add(std::move(one), found);
      }
    }
  }
}

/// An effect that only one rod, or one tool, has.
void of_parts(const CandidateMaker& make, std::vector<Candidate>& found) {
  const Observations& o = make.observations;
  for (const Grouping* label : part_labels(o))
    for (std::size_t g = 0; g < label->groups.size(); ++g) {
      std::vector<bool> mask;
      for (const std::size_t own : label->group) mask.push_back(own == g);
      const auto& of = make.experiment.scenario().readings[index(std::ranges::find(mask, true) - mask.begin())].labels;
      const quantities::Labels part{{label->name, *quantities::label_value(of, label->name)}};
      for (const effects::Active& active : make.experiment.forward().active())
        for (const Group& group : groups_of(make.experiment, active)) {
          if (make.experiment.scenario().quantities[group.first].estimated) continue;
          Candidate one = candidate(make, group);
          one.name += "[" + quantities::text_of(part) + "]";
          for (Amplitude& a : one.amplitudes) a.labels = part;
          add(make, std::move(one), group, &mask, found);
        }
    }
}

} // namespace

std::vector<Candidate> effect_candidates(const CandidateMaker& make) {
  std::vector<Candidate> found;
  with_default_shapes(make, found);
  of_parts(make, found);
  with_other_shapes(make, found);
  return found;
}

} // namespace gumshoe::tracing
