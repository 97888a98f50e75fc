#include "tracing/scenario_out/corrections.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"

namespace gumshoe::tracing {
namespace {

/// The indication that a shape moves: it has one alone, and others move by rounding.
std::size_t indication_of(const Observations& o, const Matrix& columns) {
  std::size_t out = 0;
  double most = 0;
  for (std::size_t i = 0; i < o.indications; ++i) {
    const double moved = columns(Eigen::seq(index(i), Eigen::last, index(o.indications)), Eigen::all).norm();
    if (moved > most) most = moved, out = i;
  }
  return out;
}

/// Conditions and columns that the scenario knows by name, those that the shape is named after first; among these the
/// number of the reading may be, which the traced scenario states.
std::vector<const Covariate*> keys_of(const TraceContext& c, const std::vector<std::string>& first) {
  const auto& s = c.experiment.scenario();
  const auto known = [&](const Covariate& v) {
    const auto is_it = [&](const auto& named) { return named.name == v.name; };
    return std::ranges::any_of(c.experiment.model().card->conditions, is_it) ||
           std::ranges::any_of(s.trace.columns, is_it);
  };
  std::vector<const Covariate*> keys;
  for (const std::string& name : first)
    for (const Covariate& v : c.observations.covariates)
      if (v.name == name && (known(v) || (v.course && v.name == "order"))) keys.push_back(&v);
  if (keys.size() < first.size()) return {};
  for (const Covariate& v : c.observations.covariates)
    if (known(v) && std::ranges::find(first, v.name) == first.end()) keys.push_back(&v);
  return keys;
}

/// Rows of a table: levels of the keys and the loadings there, or nothing if one level has several loadings.
using Rows = std::map<std::vector<double>, Vector>;
std::optional<Rows> rows_by(const Observations& o, const Matrix& loading, std::span<const Covariate* const> keys) {
  Rows rows;
  for (std::size_t i = 0; i < o.readings; ++i) {
    std::vector<double> level;
    for (const Covariate* key : keys) level.push_back(key->value[o.sequence[i]]);
    const Vector here = loading.row(index(i));
    const auto [known, fresh] = rows.insert({std::move(level), here});
    if (!fresh && known->second != here) return std::nullopt;
  }
  return rows;
}

Correction common(const TraceContext& c, const Candidate& shape, const std::string& name, std::size_t indication) {
  const VariableCard& card = c.experiment.model().card->indications[indication];
  Correction out;
  out.name = name;
  out.shape = shape.name;
  out.meaning = fmt::format("unknown: {}{}", shape.name, shape.shape.empty() ? "" : ", " + shape.shape);
  out.indication = card.name;
  out.si_unit = card.si_unit;
  out.unit = unit_of_size(card);
  return out;
}

/// A straight line: y at x = 0, and its slope.
struct StraightLine {
  double at_zero, slope;
  double operator()(double x) const { return at_zero + slope * x; }
};

/// The line on which all rows, two at least, lie; empty if there is none.
std::optional<StraightLine> line_of(const std::map<double, double>& rows) {
  const auto& [x, y] = *rows.begin();
  const auto& [end_x, end_y] = *rows.rbegin();
  if (x == end_x) return std::nullopt;
  const double slope = (end_y - y) / (end_x - x), size = std::max(std::fabs(y), std::fabs(end_y));
  const StraightLine line{y - slope * x, slope};
  const double rounding = 1e-12 * std::max(size, std::fabs(line.at_zero));
  const bool all =
      std::ranges::all_of(rows, [&](const auto& row) { return std::fabs(row.second - line(row.first)) <= rounding; });
  return all ? std::optional(line) : std::nullopt;
}

/// The line on which the last two of them lie.
StraightLine line_of_end(const std::map<double, double>& rows) {
  const auto last = std::prev(rows.end()), before = std::prev(last);
  const double slope = (last->second - before->second) / (last->first - before->first);
  return {last->second - slope * last->first, slope};
}

/// A group's own dependence on a condition over the levels it met, by one column of the loading. Where other groups
/// went beyond them, a line goes on, and so does what a step or a bend left; of anything else it is empty.
std::optional<Correction> in_a_group(const TraceContext& c, const Vector& loading, const Grouping& g,
                                     const std::string& condition, Correction out) {
  const Observations& o = c.observations;
  const auto keys = keys_of(c, {condition});
  if (keys.empty()) return std::nullopt;
  std::size_t active = 0;
  for (std::size_t i = 0; i < o.readings; ++i)
    if (loading[index(i)] != 0) active = g.group[o.sequence[i]];
  std::map<double, double> rows;
  for (std::size_t i = 0; i < o.readings; ++i)
    if (g.group[o.sequence[i]] == active) rows[keys[0]->value[o.sequence[i]]] = loading[index(i)];
  const auto& levels = keys[0]->levels;
  if (levels.front() < rows.begin()->first || levels.back() > rows.rbegin()->first) {
    const bool bend = out.shape.starts_with("bend:"),
               step = out.shape.starts_with("step:") || out.shape.starts_with("while:");
    const auto line = bend && rows.size() > 1 ? std::optional(line_of_end(rows)) : line_of(rows);
    if (!line && !step) return std::nullopt;
    const double first = step || bend ? rows.begin()->second : (*line)(levels.front()),
                 last = step ? rows.rbegin()->second : (*line)(levels.back());
    rows.try_emplace(levels.front(), first);
    rows.try_emplace(levels.back(), last);
  }
  out.keys = {{keys[0]->name, keys[0]->unit, keys[0]->si_unit, {}}};
  for (const auto& [level, here] : rows) {
    out.keys[0].levels.push_back(level);
    out.loading.push_back(here);
  }
  return out;
}

/// What a shape says of each group of a label at each level of a condition.
class Cells {
public:
  /// Sizes by group and level, made of those of the term. None where a cell has several loadings, or where there are
  /// more cells than readings.
  static std::optional<Cells> of(const TraceContext& c, const Matrix& loading, const Grouping& g, const Covariate& key) {
    const Observations& o = c.observations;
    Cells out;
    out.levels = key.levels;
    out.by_group.resize(g.groups.size());
    if (key.levels.size() * g.groups.size() > o.readings) return std::nullopt;
    for (const Index row : c.fitter.rows()) {
      const Index i = row / index(o.indications);
      const std::size_t reading = o.sequence[index(i)];
      const Vector here = loading.row(i);
      const auto [known, fresh] = out.by_group[g.group[reading]].try_emplace(key.value[reading], here);
      if (!fresh && (known->second - here).norm() > rounding * here.norm()) return std::nullopt;
    }
    return out;
  }

  /// What each group has at a level; between levels that it met it is linear.
  Matrix at(double level, Index sizes) const {
    Matrix out = Matrix::Constant(index(by_group.size()), sizes, std::nan(""));
    for (std::size_t g = 0; g < by_group.size(); ++g) {
      const auto above = by_group[g].lower_bound(level);
      if (above == by_group[g].end()) continue;
      if (above->first == level)
        out.row(index(g)) = above->second;
      else if (above != by_group[g].begin()) {
        const auto below = std::prev(above);
        const double share = (level - below->first) / (above->first - below->first);
        out.row(index(g)) = (1 - share) * below->second + share * above->second;
      }
    }
    return out;
  }

  std::vector<double> levels;

private:
  static constexpr double rounding = 1e-9;
  std::vector<std::map<double, Vector>> by_group;
};

/// Groups at which a column of the loading is not zero.
std::set<std::size_t> active_groups(const Observations& o, const Vector& loading, const Grouping& g) {
  std::set<std::size_t> out;
  for (std::size_t i = 0; i < o.readings; ++i)
    if (loading[index(i)] != 0) out.insert(g.group[o.sequence[i]]);
  return out;
}

/// Any value for each group of a label: of a group that the fit has no reading of, nothing is known, unless the shape
/// is that of other groups alone.
Matrix shares_by_label(const TraceContext& c, const Matrix& loading, const Grouping& g, bool any_value) {
  const Observations& o = c.observations;
  Matrix out = Matrix::Constant(index(g.groups.size()), loading.cols(), any_value ? std::nan("") : 0);
  const auto take = [&](Index i) { out.row(index(g.group[o.sequence[index(i)]])) = loading.row(i); };
  if (any_value)
    for (const Index row : c.fitter.rows()) take(row / index(o.indications));
  else
    for (Index i = 0; i < loading.rows(); ++i) take(i);
  return out;
}

/// A size for each group at each level of a condition: one effect for each level, which is one there and falls to zero
/// at its neighbours.
std::optional<WrittenShape> by_level(const TraceContext& c, const Matrix& loading, const Grouping& g,
                                     const std::string& condition, const Correction& common, const std::string& name) {
  const auto keys = keys_of(c, {condition});
  if (keys.empty()) return std::nullopt;
  const auto cells = Cells::of(c, loading, g, *keys[0]);
  if (!cells) return std::nullopt;
  WrittenShape out;
  out.label = &g;
  for (std::size_t level = 0; level < cells->levels.size(); ++level) {
    Correction one = common;
    one.name = fmt::format("{}_{}", name, level + 1);
    one.keys = {{keys[0]->name, keys[0]->unit, keys[0]->si_unit, cells->levels}};
    one.loading.assign(cells->levels.size(), 0);
    one.loading[level] = 1;
    out.effects.push_back(std::move(one));
    out.shares.push_back(cells->at(cells->levels[level], loading.cols()));
  }
  return out;
}

} // namespace

std::string unit_of_size(const VariableCard& card) {
  const std::string si_unit(card.si_unit);
  return units::difference_unit(units::error_unit(std::string(card.unit), si_unit), si_unit);
}

double margin_of(const Correction& c) {
  constexpr double small = 0.05;
  bool any = false;
  for (const Correction::Key& key : c.keys) {
    if (key.name == "order" || key.si_unit == "s" || key.si_unit == "rad") return 0;
    any |= key.si_unit != "1";
  }
  return any ? small : 0;
}

std::optional<double> before_and_after(const Correction& c) {
  constexpr double nothing = 0.01; // of its height
  if (!(c.shape.starts_with("pulse:") || c.shape.starts_with("while:")) || c.keys.size() != 1) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(c.loading);
  const double before = c.loading.front(), after = c.loading.back();
  return std::fabs(after - before) <= nothing * (high - low) ? std::optional((before + after) / 2) : std::nullopt;
}

std::optional<WrittenShape> written_shape(const TraceContext& c, const Term& term, const std::string& name) {
  const Observations& o = c.observations;
  const std::size_t indication = indication_of(o, term.candidate.columns);
  const Matrix loading =
      term.candidate.columns(Eigen::seq(index(indication), Eigen::last, index(o.indications)), Eigen::all);
  const auto& depends_on = term.candidate.depends_on;
  const auto named = [&](const std::string& n) { return common(c, term.candidate, n, indication); };
  WrittenShape out;
  for (const auto* groupings : {&o.labels, &o.label_pairs})
    for (const Grouping& g : *groupings)
      if (depends_on == g.labels) {
        out.effects = {named(name)};
        out.label = &g;
        out.shares = {shares_by_label(c, loading, g, term.candidate.family == Family::omnibus)};
        return out;
      }
  for (const Grouping& g : o.labels)
    if (depends_on.size() == 2 && g.labels == std::vector{depends_on[1]}) {
      for (Index j = 0; j < loading.cols(); ++j) {
        const auto active = active_groups(o, loading.col(j), g);
        if (active.size() > 1 || term.candidate.family == Family::omnibus)
          return by_level(c, loading, g, depends_on[0], named(name), name);
        const std::string own = loading.cols() > 1 ? fmt::format("{}_{}", name, j + 1) : name;
        std::optional<Correction> one = in_a_group(c, loading.col(j), g, depends_on[0], named(own));
        if (!one) return std::nullopt;
        out.effects.push_back(std::move(*one));
        out.shares.push_back(Matrix::Zero(index(g.groups.size()), loading.cols()));
        for (const std::size_t group : active) out.shares.back()(index(group), j) = 1;
      }
      out.label = &g;
      return out;
    }
  // What a condition leaves behind is known by when, and not by the condition.
  const auto by = term.candidate.form == Form::lag ? std::vector{depends_on[1]} : depends_on;
  const auto keys = keys_of(c, by);
  std::optional<Rows> rows;
  std::size_t used = by.size();
  for (; used > 0 && used <= keys.size(); ++used)
    if ((rows = rows_by(o, loading, std::span(keys).first(used)))) break;
  if (!rows) return std::nullopt;
  for (Index j = 0; j < loading.cols(); ++j) {
    Correction one = named(loading.cols() > 1 ? fmt::format("{}_{}", name, j + 1) : name);
    for (std::size_t k = 0; k < used; ++k) {
      one.keys.push_back({keys[k]->name, keys[k]->unit, keys[k]->si_unit, {}});
      for (const auto& [level, here] : *rows) one.keys[k].levels.push_back(level[k]);
    }
    for (const auto& [level, here] : *rows) one.loading.push_back(here[j]);
    out.effects.push_back(std::move(one));
    out.shares.push_back(Matrix::Identity(loading.cols(), loading.cols()).row(j));
  }
  return out;
}

} // namespace gumshoe::tracing
