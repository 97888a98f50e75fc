#include "tracing/candidates.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include <fmt/format.h>

#include "base/units.h"
#include "quantities/cells.h"

namespace gumshoe::tracing {
namespace {

using quantities::InputQuantity;
using scenario::Scenario;

const QuantityCard* effect_card(const propagation::Experiment& e, std::size_t quantity, const EffectCard** effect) {
  const std::size_t at = quantity - e.model_quantities();
  const effects::Active* owner = nullptr;
  for (const effects::Active& a : e.active())
    if (a.first <= at) owner = &a;
  *effect = effects::cards()[owner->effect];
  return &(*effect)->quantities[at - owner->first];
}

/// Values a shape quantity is tried at.
std::vector<double> grid_of(const QuantityCard& card) {
  std::vector<double> out{card.default_value};
  double low = 0;
  const double high = typical_size(card, &low);
  if (high > low && low > 0)
    for (int i = 0; i <= 5; ++i) out.push_back(0.5 * low * std::pow(4 * high / low, i / 5.0));
  else if (card.limits.low == 0 && card.limits.high == 1)
    out.insert(out.end(), {0.0, 0.5, 1.0});
  std::vector<double> kept;
  for (const double x : out)
    if (card.limits.contain(x) && std::find(kept.begin(), kept.end(), x) == kept.end()) kept.push_back(x);
  return kept;
}

double alike(const Vector& a, const Vector& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? a.dot(b) / lengths : 0;
}

/// Sets of labels by which a quantity may be off: all readings, then what its entries and scopes tell apart.
std::vector<std::vector<std::string>> label_sets(const InputQuantity& q) {
  std::set<std::vector<std::string>> out;
  const auto add = [&](std::vector<std::string> labels) {
    std::erase(labels, quantities::reading_label);
    if (labels.empty()) return;
    std::sort(labels.begin(), labels.end());
    for (const std::string& l : labels) out.insert({l});
    out.insert(labels);
  };
  for (const auto& entry : q.entries) {
    std::vector<std::string> names;
    for (const auto& [label, value] : entry.labels) names.push_back(label);
    add(names);
    for (const auto& c : entry.components) {
      auto all = names;
      all.insert(all.end(), c.per.begin(), c.per.end());
      add(all);
    }
  }
  std::vector<std::vector<std::string>> sets{{}};
  sets.insert(sets.end(), out.begin(), out.end());
  return sets;
}

class Builder {
public:
  Builder(const propagation::Experiment& e, const Simulator& simulator, const Points& at, const Observations& o,
          double step, const std::function<bool(const Alternative&)>& skip)
      : e_(e), simulator_(simulator), at_(at), o_(o), step_(step), skip_(skip) {}

  std::vector<Alternative> build() {
    for (std::size_t q = 0; q < e_.model_quantities() + e_.effect_quantities(); ++q) all_.push_back(q);
    Vector f;
    simulator_.derivatives(at_, all_, f, tangents_);
    secants();
    effects();
    declared();
    stated();
    return std::move(out_);
  }

private:
  /// Steps of both signs that move the indications by about `step_`, of the quantities of effects. What does not move
  /// them at all by its derivative takes its typical size; most of that (inserts that the tool does not have) does not
  /// move them by any, and one trial together tells.
  void secants() {
    std::vector<Variation> still(2), variations;
    std::vector<std::size_t> owner;
    sizes_.assign(2 * all_.size(), 0);
    for (const std::size_t q : all_) {
      if (q < e_.model_quantities() || e_.scenario().quantities[q].estimated) continue;
      const EffectCard* effect = nullptr;
      const QuantityCard* card = effect_card(e_, q, &effect);
      if (card->role == Role::shape) continue;
      // Another insert is another body, solved anew for every size; it does not jump from tooth to tooth.
      const bool body = effect->stage == "insert";
      const double slope =
          tangents_.col(static_cast<Index>(q)).norm() / std::sqrt(static_cast<double>(simulator_.rows()));
      const double typical = typical_size(*card);
      double size = slope > 0 ? step_ / slope : typical;
      if (slope > 0 && typical > 0) size = std::min(size, 3 * typical);
      for (const std::size_t i : {0, 1}) {
        const double signed_size = i == 0 ? size : -size;
        const bool inside = size > 0 && std::all_of(at_.begin(), at_.end(), [&](const auto& p) {
                              return card->limits.contain(p[q] + signed_size);
                            });
        if (!inside) continue;
        if (body && slope > 0) continue;
        sizes_[2 * q + i] = signed_size;
        if (slope > 0) {
          variations.push_back({{{q, signed_size, false}}});
          owner.push_back(2 * q + i);
        } else {
          still[i].changes.push_back({q, signed_size, false});
        }
      }
    }
    Matrix f;
    std::vector<bool> valid;
    still.push_back({});
    simulator_.vary(at_, still, f, valid);
    for (const Index i : {0, 1}) {
      const bool moved = !valid[static_cast<std::size_t>(i)] || (f.col(i) - f.col(2)).norm() > 0;
      for (const auto& c : still[static_cast<std::size_t>(i)].changes) {
        const std::size_t at = 2 * c.quantity + static_cast<std::size_t>(i);
        if (moved) {
          variations.push_back({{c}});
          owner.push_back(at);
        } else {
          sizes_[at] = 0;
        }
      }
    }
    variations.push_back({});
    simulator_.vary(at_, variations, f, valid);
    secants_ = Matrix::Zero(f.rows(), static_cast<Index>(sizes_.size()));
    for (std::size_t v = 0; v < owner.size(); ++v)
      if (valid[v])
        secants_.col(static_cast<Index>(owner[v])) =
            (f.col(static_cast<Index>(v)) - f.col(f.cols() - 1)) / sizes_[owner[v]];
      else
        sizes_[owner[v]] = 0;
  }

  void add(Alternative a, std::vector<Alternative>& family) {
    if (skip_(a) || !(a.columns.norm() > 0)) return;
    for (const Alternative& other : family)
      if (other.name == a.name && other.columns.cols() == 1 && a.columns.cols() == 1 &&
          other.amplitudes[0].scenario_name == a.amplitudes[0].scenario_name &&
          std::fabs(alike(other.columns.col(0), a.columns.col(0))) > 0.9995)
        return;
    for (const auto& [label, value] : a.amplitudes[0].labels) a.depends_on.push_back(label);
    if (a.depends_on.empty()) a.depends_on = dependence(o_, a.columns);
    family.push_back(std::move(a));
  }

  /// The tangent, then what differs from it over finite steps.
  void add_single(Alternative a, std::size_t quantity, const std::vector<bool>* mask,
                  std::vector<Alternative>& family) {
    const auto masked = [&](const Matrix& m, Index column) {
      Matrix one = m.col(column);
      if (mask)
        for (Index i = 0; i < one.rows(); ++i)
          if (!(*mask)[static_cast<std::size_t>(i) / o_.indications]) one(i, 0) = 0;
      return in_sequence(o_, one);
    };
    a.columns = masked(tangents_, static_cast<Index>(quantity));
    add(a, family);
    for (const std::size_t i : {2 * quantity, 2 * quantity + 1}) {
      if (sizes_[i] == 0) continue;
      Alternative finite = a;
      finite.columns = masked(secants_, static_cast<Index>(i));
      finite.finite = sizes_[i];
      const Amplitude& s = a.amplitudes[0];
      finite.shape =
          fmt::format("over {:+.3g} {}", units::from_si(sizes_[i], s.unit, s.si_unit, units::Kind::difference),
                      s.unit == "1" ? "" : s.unit);
      add(std::move(finite), family);
    }
  }

  Amplitude amplitude(std::size_t quantity, const QuantityCard& card) const {
    const auto& q = e_.scenario().quantities[quantity];
    return {quantity, std::string(card.name), q.unit,           q.si_unit,         q.name,
            {},       card.limits.low,        card.limits.high, typical_size(card)};
  }

  void effects() {
    std::vector<Alternative> found;
    for (const effects::Active& a : e_.active()) {
      const EffectCard& card = *effects::cards()[a.effect];
      const std::size_t first = e_.model_quantities() + a.first;
      for (std::size_t i = 0; i < card.quantities.size(); ++i) {
        const QuantityCard& q = card.quantities[i];
        if (q.role == Role::amplitude) {
          Alternative one;
          one.name = card.name;
          one.amplitudes = {amplitude(first + i, q)};
          add_single(one, first + i, nullptr, found);
        }
        if (q.role == Role::pair && i + 1 < card.quantities.size() && card.quantities[i + 1].role == Role::pair) {
          Alternative two;
          two.name = card.name;
          two.amplitudes = {amplitude(first + i, q), amplitude(first + i + 1, card.quantities[i + 1])};
          two.columns.resize(tangents_.rows(), 2);
          two.columns << tangents_.col(static_cast<Index>(first + i)), tangents_.col(static_cast<Index>(first + i + 1));
          two.columns = in_sequence(o_, two.columns);
          drop_still(two);
          add(std::move(two), found);
          ++i;
        }
      }
    }
    shaped(found);
    out_.insert(out_.end(), found.begin(), found.end());
  }

  /// A component of a pair that moves nothing here is no parameter.
  static void drop_still(Alternative& a) {
    for (Index j = a.columns.cols() - 1; j >= 0 && a.columns.cols() > 1; --j) {
      if (a.columns.col(j).norm() > 0) continue;
      const Matrix kept = a.columns.col(1 - j);
      a.columns = kept;
      a.amplitudes.erase(a.amplitudes.begin() + j);
    }
  }

  /// Amplitudes again with every shape quantity at the values of its grid; the amplitudes are at null, so all effects
  /// can stand at their next grid value together.
  void shaped(std::vector<Alternative>& found) {
    struct Grid {
      std::size_t shape, effect;
      std::vector<double> values;
    };
    std::vector<Grid> grids;
    std::size_t longest = 0;
    for (std::size_t k = 0; k < e_.active().size(); ++k) {
      const auto& a = e_.active()[k];
      const EffectCard& card = *effects::cards()[a.effect];
      for (std::size_t i = 0; i < card.quantities.size(); ++i)
        if (card.quantities[i].role == Role::shape) {
          grids.push_back({e_.model_quantities() + a.first + i, k, grid_of(card.quantities[i])});
          longest = std::max(longest, grids.back().values.size());
        }
    }
    for (std::size_t g = 1; g < longest; ++g) {
      Points at = at_;
      std::vector<std::size_t> moved;
      struct Group {
        const Grid* grid;
        std::size_t first, count; ///< among `moved`: an amplitude, or both of a pair
      };
      std::vector<Group> groups;
      for (const Grid& grid : grids) {
        if (g >= grid.values.size()) continue;
        for (auto& p : at) p[grid.shape] = grid.values[g];
        const auto& a = e_.active()[grid.effect];
        const auto& card = effects::cards()[a.effect]->quantities;
        for (std::size_t i = 0; i < card.size(); ++i) {
          const bool pair = card[i].role == Role::pair && i + 1 < card.size() && card[i + 1].role == Role::pair;
          if (card[i].role != Role::amplitude && !pair) continue;
          groups.push_back({&grid, moved.size(), pair ? std::size_t{2} : std::size_t{1}});
          moved.push_back(e_.model_quantities() + a.first + i);
          if (pair) moved.push_back(e_.model_quantities() + a.first + ++i);
        }
      }
      Vector f;
      Matrix d;
      if (moved.empty() || !simulator_.derivatives(at, moved, f, d)) continue;
      for (const Group& group : groups) {
        const double value = group.grid->values[g];
        const auto& shape = e_.scenario().quantities[group.grid->shape];
        Alternative one;
        for (std::size_t i = group.first; i < group.first + group.count; ++i) {
          const EffectCard* effect = nullptr;
          const QuantityCard* card = effect_card(e_, moved[i], &effect);
          one.name = effect->name;
          one.amplitudes.push_back(amplitude(moved[i], *card));
        }
        one.held = {{group.grid->shape, value}};
        one.shape = fmt::format("{} {:.3g} {}", shape.name.substr(shape.name.find('.') + 1),
                                units::from_si(value, shape.unit, shape.si_unit), shape.unit == "1" ? "" : shape.unit);
        one.columns = in_sequence(o_, d.middleCols(static_cast<Index>(group.first), static_cast<Index>(group.count)));
        drop_still(one);
        add(std::move(one), found);
      }
    }
  }

  void declared() {
    const auto& s = e_.scenario();
    for (std::size_t q = 0; q < e_.model_quantities(); ++q) {
      const InputQuantity& quantity = s.quantities[q];
      if (quantity.estimated && quantity.entries.front().components.empty()) continue; // free: absorbs itself
      std::vector<Alternative> found;
      for (const auto& labels : label_sets(quantity)) {
        std::set<std::vector<std::pair<std::string, std::string>>> cells;
        for (const auto& reading : s.readings) {
          std::vector<std::pair<std::string, std::string>> cell;
          for (const std::string& l : labels)
            if (const std::string* v = quantities::label_value(reading.labels, l)) cell.emplace_back(l, *v);
          if (cell.size() == labels.size()) cells.insert(cell);
        }
        if (!labels.empty() && (cells.size() < 2 || cells.size() > 60)) continue;
        for (const auto& cell : cells) {
          Alternative one;
          one.family = Family::declared;
          one.name = "declared:" + quantity.name + (cell.empty() ? "" : "[" + quantities::text_of(cell) + "]");
          one.amplitudes = {amplitude(q, e_.model().card->quantities[q])};
          one.amplitudes[0].labels = cell;
          one.amplitudes[0].low = one.amplitudes[0].high = 0;
          std::vector<bool> mask;
          double low = 1e300, high = -1e300;
          for (std::size_t r = 0; r < s.readings.size(); ++r) {
            mask.push_back(quantities::holds_for(cell, s.readings[r].labels));
            if (!mask.back()) continue;
            low = std::min(low, at_[r][q]);
            high = std::max(high, at_[r][q]);
          }
          const Limits& limits = e_.model().card->quantities[q].limits;
          one.amplitudes[0].low = limits.low - low; // of the shift
          one.amplitudes[0].high = limits.high - high;
          add_single(one, q, cell.empty() ? nullptr : &mask, found);
        }
      }
      out_.insert(out_.end(), found.begin(), found.end());
    }
  }

  void stated() {
    const auto& s = e_.scenario();
    for (const auto& effect : s.stated_effects) {
      Alternative one;
      one.family = Family::stated;
      one.name = effect.name;
      Amplitude size;
      size.quantity = Amplitude::npos;
      size.name = "size";
      size.unit = effect.unit;
      size.si_unit = effect.si_unit;
      size.scenario_name = effect.name + ".size";
      one.amplitudes = {size};
      Matrix column = Matrix::Zero(static_cast<Index>(simulator_.rows()), 1);
      for (std::size_t r = 0; r < o_.readings; ++r)
        column(static_cast<Index>(r * o_.indications + effect.indication), 0) = effect.loading[r];
      one.columns = in_sequence(o_, column);
      if (!effect.freed) add(std::move(one), out_);
    }
  }

  const propagation::Experiment& e_;
  const Simulator& simulator_;
  const Points& at_;
  const Observations& o_;
  double step_;
  const std::function<bool(const Alternative&)>& skip_;
  std::vector<std::size_t> all_;
  Matrix tangents_, secants_;
  std::vector<double> sizes_;
  std::vector<Alternative> out_;
};

/// Share of x's variance between groups of equal values.
double explained(const Vector& x, const std::vector<std::size_t>& group) {
  const std::size_t groups = *std::max_element(group.begin(), group.end()) + 1;
  std::vector<double> sum(groups, 0), count(groups, 0);
  for (std::size_t i = 0; i < group.size(); ++i) sum[group[i]] += x[static_cast<Index>(i)], ++count[group[i]];
  const double mean = x.mean(), total = (x.array() - mean).square().sum();
  double between = 0;
  for (std::size_t g = 0; g < groups; ++g)
    if (count[g] > 0) between += count[g] * (sum[g] / count[g] - mean) * (sum[g] / count[g] - mean);
  const double n = static_cast<double>(group.size()), k = static_cast<double>(groups);
  if (!(total > 0) || n <= k) return 0;
  return 1 - (total - between) / total * (n - 1) / (n - k);
}

} // namespace

const char* name(Family family) {
  static constexpr const char* names[] = {"effect", "declared", "stated", "shape", "omnibus"};
  return names[static_cast<int>(family)];
}

double typical_size(const QuantityCard& card, double* low) {
  const std::string text(card.typical), unit(card.unit), si(card.si_unit);
  char* end = nullptr;
  const double first = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return 0;
  double second = first;
  for (const std::string_view joint : {"-", " to ", " or "})
    if (std::string_view(end).starts_with(joint)) {
      const char* from = end + joint.size();
      second = std::strtod(from, &end);
      break;
    }
  std::string written = end;
  written = written.substr(0, written.find_first_of(":;,("));
  while (!written.empty() && written.front() == ' ') written.erase(0, 1);
  while (!written.empty() && written.back() == ' ') written.pop_back();
  if (written.empty() || !units::convertible(written, si)) written = unit;
  const auto to = [&](double x) { return units::to_si(x, written, si, units::Kind::difference); };
  if (low) *low = to(first);
  return to(second);
}

Matrix in_sequence(const Observations& o, const Matrix& rows) {
  Matrix out(rows.rows(), rows.cols());
  const auto k = static_cast<Index>(o.indications);
  for (std::size_t i = 0; i < o.sequence.size(); ++i)
    out.middleRows(static_cast<Index>(i) * k, k) = rows.middleRows(static_cast<Index>(o.sequence[i]) * k, k);
  return out;
}

std::vector<std::string> dependence(const Observations& o, const Matrix& columns) {
  const auto k = static_cast<Index>(o.indications);
  std::vector<std::string> out;
  const auto depends = [&](const std::vector<std::size_t>& by_reading) {
    std::vector<std::size_t> group;
    for (const std::size_t r : o.sequence) group.push_back(by_reading[r]);
    for (Index j = 0; j < columns.cols(); ++j)
      for (Index i = 0; i < k; ++i) {
        const Vector x = columns(Eigen::seq(i, Eigen::last, k), j);
        if (!(x.norm() > 1e-9 * columns.norm())) continue;
        if (explained(x, group) > 0.1 || explained(x.cwiseAbs(), group) > 0.1) return true;
      }
    return false;
  };
  for (const Covariate& c : o.covariates) {
    // At most eight groups of neighbouring values.
    std::vector<std::size_t> group;
    const std::size_t levels = c.levels.size(), bins = std::min<std::size_t>(levels, 8);
    for (const double x : c.value) {
      const auto rank =
          static_cast<std::size_t>(std::lower_bound(c.levels.begin(), c.levels.end(), x) - c.levels.begin());
      group.push_back(rank * bins / levels);
    }
    if (depends(group)) out.push_back(c.name);
  }
  for (const Grouping& g : o.labels)
    if (out.empty() && g.groups.size() <= 30 && depends(g.group)) out.push_back(g.name);
  return out;
}

namespace {

/// Quantities whose values come from these data ([trace] free): no prior, and tied to nothing.
void free_again(Scenario& s) {
  const auto freed = [&](const std::string& name) {
    return std::any_of(s.trace.free.begin(), s.trace.free.end(), [&](const std::string& q) {
      return name == q || name.starts_with(q + "[") || name.starts_with(q + ".");
    });
  };
  for (InputQuantity& q : s.quantities) {
    if (!freed(q.name)) continue;
    q.estimated = true;
    for (auto& entry : q.entries) entry.components.clear();
  }
  for (auto& c : s.correlations) {
    const std::size_t n = c.quantities.size();
    quantities::Correlation kept{c.kind, {}, {}};
    for (std::size_t i = 0; i < n; ++i) {
      if (freed(c.quantities[i])) continue;
      kept.quantities.push_back(c.quantities[i]);
      for (std::size_t j = 0; j < n; ++j)
        if (!freed(c.quantities[j])) kept.matrix.push_back(c.matrix[i * n + j]);
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
      const auto known =
          std::find_if(s.quantities.begin(), s.quantities.end(), [&](const auto& x) { return x.name == name; });
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

std::vector<Alternative> physical_candidates(const propagation::Experiment& experiment, const Simulator& simulator,
                                             const Points& at, const Observations& observations, double step,
                                             const std::function<bool(const Alternative&)>& skip) {
  return Builder(experiment, simulator, at, observations, step, skip).build();
}

} // namespace gumshoe::tracing
