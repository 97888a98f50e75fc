#include "tracing/noise/replicates.h"

#include <algorithm>
#include <map>
#include <set>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Numbers equal values alike, in the order in which they are met.
template <class T> std::vector<std::size_t> numbered(const std::vector<T>& values) {
  std::map<T, std::size_t> known;
  std::vector<std::size_t> out;
  for (const T& x : values) out.push_back(known.insert({x, known.size()}).first->second);
  return out;
}

std::size_t count(const std::vector<std::size_t>& level) { return std::set(level.begin(), level.end()).size(); }

/// Whether a level comes back in half of the blocks or more, on average: what was set again, and no name of a block.
bool comes_back(const std::vector<std::size_t>& level, const std::vector<std::size_t>& block) {
  std::set<std::pair<std::size_t, std::size_t>> met;
  for (std::size_t i = 0; i < level.size(); ++i) met.insert({level[i], block[i]});
  return 2 * met.size() >= count(level) * count(block);
}

/// Whether readings of other values are none of equal conditions, however close: a position counts, the time and the
/// temperature that were recorded with it do not.
bool is_set(const Covariate& c) { return c.commanded && c.si_unit != "s" && c.si_unit != "K"; }

bool is_one_in_each(const std::vector<std::size_t>& level, const std::vector<std::size_t>& block) {
  std::set<std::pair<std::size_t, std::size_t>> met;
  for (std::size_t i = 0; i < level.size(); ++i) met.insert({level[i], block[i]});
  return met.size() == count(block);
}

} // namespace

std::vector<std::size_t> Replicates::cells(std::size_t without) const {
  std::vector<std::vector<std::size_t>> all(pass.size());
  for (std::size_t f = 0; f < factors.size(); ++f)
    for (std::size_t i = 0; i < all.size() && f != without; ++i) all[i].push_back(factors[f].level[i]);
  return numbered(all);
}

Replicates Replicates::without(std::size_t factor) const {
  Replicates out = *this;
  out.factors.erase(out.factors.begin() + index(factor));
  out.cell = cells(factor);
  return out;
}

Replicates find_replicates(const Observations& o) {
  const std::size_t n = o.readings;
  Replicates out;
  out.passes_are_blocks = o.blocks.groups.size() > 1;
  for (std::size_t i = 0; i < n; ++i)
    out.pass.push_back(out.passes_are_blocks ? o.blocks.group[o.sequence[i]] : i * criteria.stretches / n);
  const auto in_order = [&](const auto& by_reading) {
    auto values = by_reading;
    for (std::size_t i = 0; i < n; ++i) values[i] = by_reading[o.sequence[i]];
    return numbered(values);
  };
  for (const Covariate& c : o.covariates) {
    if (!is_set(c) && c.levels.size() * criteria.least_repeats > n) continue;
    auto level = in_order(c.value);
    if (is_set(c) || !out.passes_are_blocks || comes_back(level, out.pass) ||
        (c.commanded && is_one_in_each(level, out.pass)))
      out.factors.push_back({c.name, level});
  }
  for (const Grouping& g : o.labels) {
    const bool repeated_step =
        std::ranges::any_of(o.replicate_groups, [&](const Grouping& r) { return r.labels == g.labels; });
    auto level = in_order(g.group);
    if (g.group != o.blocks.group && (out.passes_are_blocks ? comes_back(level, out.pass) : !repeated_step))
      out.factors.push_back({g.name, level});
  }
  if (out.passes_are_blocks && o.order_known) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> met;
    std::vector<std::size_t> place;
    const auto cell = out.cells(out.factors.size());
    for (std::size_t i = 0; i < n; ++i) place.push_back(met[{cell[i], out.pass[i]}]++);
    if (count(place) > 1) out.factors.push_back({"place in the block", place});
  }
  out.cell = out.cells(out.factors.size());
  return out;
}

Matrix columns_by_group(const std::vector<Index>& rows, std::size_t indications, const std::vector<std::size_t>& group,
                        bool line) {
  const auto k = index(indications);
  std::map<std::size_t, std::vector<Index>> places;
  for (std::size_t i = 0; i < rows.size(); i += indications) places[group[index(rows[i] / k)]].push_back(index(i));
  Matrix out = Matrix::Zero(index(rows.size()), index(places.size()) * k);
  Index column = 0;
  for (const auto& [number, first] : places)
    for (Index j = 0; j < k; ++j, ++column)
      for (const Index i : first)
        out(i + j, column) = line ? static_cast<double>(rows[index(i)] - rows[index(first[first.size() / 2])]) : 1.0;
  return out;
}

} // namespace gumshoe::tracing
