#include "tracing/scenario_out/corrections.h"

#include <algorithm>
#include <cmath>
#include <map>

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

/// Slope of a line through the origin on which all rows lie; empty if there is none.
std::optional<double> slope_of(const std::map<double, double>& rows) {
  const auto& [x, y] = *rows.rbegin();
  if (x == 0) return std::nullopt;
  const double slope = y / x;
  constexpr double rounding = 1e-12;
  const bool line = std::ranges::all_of(
      rows, [&](const auto& row) { return std::fabs(row.second - slope * row.first) <= rounding * std::fabs(y); });
  return line ? std::optional(slope) : std::nullopt;
}

/// A group's own dependence on a condition over the levels it met, by one column of the loading. Where other groups
/// went beyond them, a line goes on; of anything else it is empty.
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
    const auto slope = slope_of(rows);
    if (!slope) return std::nullopt;
    for (const double end : {levels.front(), levels.back()}) rows.try_emplace(end, *slope * end);
  }
  out.keys = {{keys[0]->name, keys[0]->unit, keys[0]->si_unit, {}}};
  for (const auto& [level, here] : rows) {
    out.keys[0].levels.push_back(level);
    out.loading.push_back(here);
  }
  return out;
}

} // namespace

std::string unit_of_size(const VariableCard& card) {
  const std::string si_unit(card.si_unit);
  return units::difference_unit(units::error_unit(std::string(card.unit), si_unit), si_unit);
}

std::optional<WrittenShape> written_shape(const TraceContext& c, const Term& term, const std::string& name) {
  const Observations& o = c.observations;
  const std::size_t indication = indication_of(o, term.candidate.columns);
  const Matrix loading =
      term.candidate.columns(Eigen::seq(index(indication), Eigen::last, index(o.indications)), Eigen::all);
  const auto& depends_on = term.candidate.depends_on;
  const auto named = [&](const std::string& n) { return common(c, term.candidate, n, indication); };
  WrittenShape out;
  for (const Grouping& g : o.labels)
    if (depends_on == g.labels) {
      out.effects = {named(name)};
      out.label = &g;
      return out;
    }
  for (const Grouping& g : o.labels)
    if (depends_on.size() == 2 && g.labels == std::vector{depends_on[1]}) {
      for (Index j = 0; j < loading.cols(); ++j) {
        const std::string own = loading.cols() > 1 ? fmt::format("{}_{}", name, j + 1) : name;
        std::optional<Correction> one = in_a_group(c, loading.col(j), g, depends_on[0], named(own));
        if (!one) return std::nullopt;
        out.effects.push_back(std::move(*one));
      }
      out.label = &g;
      return out;
    }
  const auto keys = keys_of(c, depends_on);
  std::optional<Rows> rows;
  std::size_t used = depends_on.size();
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
  }
  return out;
}

} // namespace gumshoe::tracing
