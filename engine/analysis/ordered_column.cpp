#include "analysis/ordered_column.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/leaves.h"
#include "analysis/order_key.h"
#include "analysis/ordered_tails.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

/// Keys of values at and above, at and below: both zeros are one value.
std::int64_t from_value(double v) { return key_of(v == 0 ? -0.0 : v); }
std::int64_t to_value(double v) { return key_of(v == 0 ? 0.0 : v); }

/// Where the ranks lie, from a sample of the values: four standard deviations of its own ranks to either side; beyond
/// its ends by half of what it spans.
SieveRange bracket(RankRange ranks, std::size_t valid, std::span<const double> pilot) {
  const auto m = static_cast<double>(pilot.size());
  const auto place = [&](std::size_t rank, double side) {
    const double share = static_cast<double>(rank) / static_cast<double>(valid);
    return share * m + side * (4 * std::sqrt(m * share * (1 - share)) + 1);
  };
  const double from = std::floor(place(ranks.first, -1)), to = std::ceil(place(ranks.last, 1));
  double low = pilot[from < 0 ? 0 : static_cast<std::size_t>(from)];
  double high = pilot[to >= m ? pilot.size() - 1 : static_cast<std::size_t>(to)];
  const double beyond = 0.5 * (high - low);
  if (from < 0 && std::isfinite(low - beyond)) low -= beyond;
  if (to >= m && std::isfinite(high + beyond)) high += beyond;
  return {from_value(low), to_value(high)};
}

/// Bins of 2^shift keys, so that a range has at most `bins`.
int shift_for(std::int64_t first, std::int64_t last, std::size_t bins) {
  int shift = 0;
  while ((distance(first, last) >> shift) + 1 > bins) ++shift;
  return shift;
}

/// Calls body(bin, first key, last key) for the bins of a range.
template <class Body> void each_bin(const SieveRange& r, const Body& body) {
  const std::uint64_t width = (std::uint64_t{1} << r.shift) - 1, all = distance(r.first, r.last);
  for (std::size_t b = 0; b < r.bins(); ++b) {
    const std::uint64_t up = static_cast<std::uint64_t>(b) << r.shift;
    body(r.bin + b, moved(r.first, up), moved(r.first, std::min(up + width, all)));
  }
}

} // namespace

void OrderedColumn::changed() { throw std::logic_error("samples changed while they were analysed"); }

OrderedColumn::OrderedColumn(const Column& values, int threads, Limits limits)
    : values_(values), threads_(threads), limits_(limits) {}

OrderedColumn::OrderedColumn(const Column& values, std::size_t valid, std::span<const RankRange> expected, int threads,
                             Limits limits)
    : OrderedColumn(values, threads, limits) {
  std::unique_ptr<Pass> first;
  if (valid > limits.kept) {
    pilot_ = pilot_sample(values);
    first = bracketing(expected, valid);
  }
  if (first) make(*first);
  finish_first(std::move(first), valid);
}

OrderedColumn::~OrderedColumn() = default;

std::size_t OrderedColumn::about_valid() const {
  if (pilot_.empty()) pilot_ = pilot_sample(values_);
  const std::size_t step = (values_.size() + most_pilots - 1) / most_pilots;
  return std::min(values_.size(), step * pilot_.size());
}

std::unique_ptr<OrderedColumn::Pass> OrderedColumn::first_pass(std::span<const RankRange> expected) const {
  return bracketing(expected, about_valid());
}

std::unique_ptr<OrderedColumn::Pass> OrderedColumn::bracketing(std::span<const RankRange> expected,
                                                               std::size_t valid) const {
  if (pilot_.empty()) return nullptr;
  std::vector<SieveRange> ranges;
  for (const RankRange& wanted : expected) {
    const SieveRange next = bracket(wanted, valid, pilot_);
    if (!ranges.empty() && next.first <= ranges.back().last)
      ranges.back().last = std::max(ranges.back().last, next.last);
    else
      ranges.push_back(next);
  }
  for (SieveRange& r : ranges)
    r.shift = shift_for(r.first, r.last, std::max<std::size_t>(2, limits_.bins / ranges.size()));
  return std::make_unique<Pass>(ranges, 1, true);
}

void OrderedColumn::make(Pass& pass) const {
  for_parts(values_, threads_, [&](std::size_t, std::span<const double> some) {
    for (std::size_t at = 0; at < some.size(); at += leaf_values)
      pass.sieve.take(some.subspan(at, std::min(leaf_values, some.size() - at)));
  });
}

void OrderedColumn::finish_first(std::unique_ptr<Pass> pass, std::size_t valid) {
  size = valid;
  if (valid == 0) return;
  std::uint64_t rank = 0;
  const auto add = [&](std::int64_t first, std::int64_t last, std::uint64_t count) {
    if (count > 0) cells_.push_back({first, last, rank, count});
    rank += count;
  };
  if (!pass) return add(key_of(-infinity), key_of(infinity), valid);
  const Sieved found = pass->sieve.found();
  const std::vector<SieveRange>& ranges = pass->sieve.ranges();
  const std::uint64_t inside = std::accumulate(found.counts.begin(), found.counts.end(), std::uint64_t{0});
  const std::uint64_t between = size - found.below - found.above - inside;
  if (between > size || (ranges.size() == 1 && between != 0)) changed();
  add(key_of(-infinity), ranges.front().first - 1, found.below);
  for (const SieveRange& r : ranges) {
    if (&r != &ranges.front()) add(ranges.front().last + 1, r.first - 1, between);
    each_bin(r, [&](std::size_t bin, std::int64_t first, std::int64_t last) { add(first, last, found.counts[bin]); });
  }
  add(ranges.back().last + 1, key_of(infinity), found.above);
}

std::size_t OrderedColumn::cell_of(std::size_t rank) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(cells_, rank, {}, &Cell::rank) - cells_.begin()) - 1;
}

double OrderedColumn::least(const Cell& cell, std::size_t rank) const {
  return value_of(cell.values ? cell.values[rank - cell.rank] : cell.first);
}

double OrderedColumn::most(const Cell& cell, std::size_t rank) const {
  return value_of(cell.values ? cell.values[rank - cell.rank] : cell.last);
}

void OrderedColumn::mark(RankRange ranks, std::vector<Use>& uses) const {
  for (std::size_t i = cell_of(ranks.first); i < cells_.size() && cells_[i].rank <= ranks.last; ++i)
    uses[i] =
        std::max(uses[i], cells_[i].rank >= ranks.first && cells_[i].end() <= ranks.last + 1 ? Use::all : Use::some);
}

RankRange OrderedColumn::bracket_middle(double middle, std::size_t spare) const {
  if (!std::isfinite(middle)) return {0, spare}; // no order of the differences
  const std::size_t last = size - 1;
  const auto first_of = [&](const auto& bound) {
    std::size_t low = 0;
    for (std::size_t high = spare; low < high;) {
      const std::size_t m = low + (high - low) / 2;
      if (middle - bound(m) <= bound(last - (spare - m - 1)) - middle)
        high = m;
      else
        low = m + 1;
    }
    return low;
  };
  return {first_of([&](std::size_t r) { return most(cells_[cell_of(r)], r); }),
          first_of([&](std::size_t r) { return least(cells_[cell_of(r)], r); })};
}

void OrderedColumn::mark_middle(double middle, std::size_t spare, std::vector<Use>& uses) const {
  if (!std::isfinite(middle)) return;
  const auto [from, to] = bracket_middle(middle, spare);
  const std::size_t last = size - 1;
  for (const RankRange ranks : {RankRange{from, to}, {last - spare + from, std::min(last, last - spare + to + 1)}})
    for (std::size_t i = cell_of(ranks.first); i < cells_.size() && cells_[i].rank <= ranks.last; ++i)
      uses[i] = std::max(uses[i], Use::some);
}

void OrderedColumn::find(const Wanted& wanted) const {
  while (auto pass = next_pass(wanted)) {
    make(*pass);
    finish(std::move(pass));
  }
}

/// A pass over the chosen cells, each with the shift of its bins.
std::unique_ptr<OrderedColumn::Pass> OrderedColumn::pass_over(const std::vector<std::size_t>& chosen,
                                                              const std::function<int(const Cell&)>& shift) const {
  std::vector<SieveRange> ranges;
  std::size_t second = 0;
  std::uint64_t widest = 0; // gap, in values
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Cell& cell = cells_[chosen[k]];
    ranges.push_back({cell.first, cell.last, shift(cell)});
    if (k == 0) continue;
    const std::uint64_t gap = cell.rank - cells_[chosen[k - 1]].end();
    if (gap >= widest) widest = gap, second = k;
  }
  return std::make_unique<Pass>(std::move(ranges), second, false);
}

std::unique_ptr<OrderedColumn::Pass> OrderedColumn::next_pass(const Wanted& wanted) const {
  std::vector<Use> uses(cells_.size());
  for (const RankRange& ranks : wanted.ranks) mark(ranks, uses);
  for (const std::size_t span : wanted.spans) mark_shortest(span, wanted.turn, uses);
  if (wanted.middle) mark_middle(*wanted.middle, wanted.spare, uses);
  std::vector<std::size_t> chosen;
  std::uint64_t some = 0; // values that may be kept or divided
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (uses[i] == Use::none || cells_[i].known()) continue;
    chosen.push_back(i);
    if (uses[i] == Use::some) some += cells_[i].count;
  }
  if (chosen.empty()) return nullptr;
  auto pass = pass_over(chosen, [&](const Cell& cell) {
    if (uses[static_cast<std::size_t>(&cell - cells_.data())] == Use::all || some <= limits_.kept)
      return SieveRange::keep;
    const double share = static_cast<double>(cell.count) / static_cast<double>(some);
    const auto bins = static_cast<std::size_t>(share * static_cast<double>(limits_.bins));
    return shift_for(cell.first, cell.last, std::max<std::size_t>(2, bins));
  });
  pass->chosen = std::move(chosen);
  return pass;
}

/// Puts what was found into the place of the chosen cells.
void OrderedColumn::finish(std::unique_ptr<Pass> pass) const {
  Sieved found = pass->sieve.found();
  kept_.push_back(std::move(found.kept));
  const std::vector<std::int64_t>& kept = kept_.back();
  std::size_t taken = 0, k = 0;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell cell = cells_[i];
    if (k == pass->chosen.size() || pass->chosen[k] != i) {
      cells.push_back(cell);
      continue;
    }
    const SieveRange& r = pass->sieve.ranges()[k++];
    if (r.shift == SieveRange::keep) {
      if (taken + cell.count > kept.size() || kept[taken] < r.first || kept[taken + cell.count - 1] > r.last) changed();
      cell.values = kept.data() + taken;
      taken += cell.count;
      cells.push_back(cell);
      continue;
    }
    std::uint64_t rank = cell.rank;
    each_bin(r, [&](std::size_t bin, std::int64_t first, std::int64_t last) {
      if (found.counts[bin] > 0) cells.push_back({first, last, rank, found.counts[bin]});
      rank += found.counts[bin];
    });
    if (rank != cell.end()) changed();
  }
  cells_ = std::move(cells);
}

/// Joins neighbours whose values are not kept: ranks elsewhere are asked for.
void OrderedColumn::join() const {
  std::vector<Cell> cells;
  for (const Cell& cell : cells_)
    if (!cells.empty() && !cells.back().values && !cell.values)
      cells.back().last = cell.last, cells.back().count += cell.count;
    else
      cells.push_back(cell);
  cells_ = std::move(cells);
}

double OrderedColumn::operator[](std::size_t rank) const {
  std::size_t i = cell_of(rank);
  if (!cells_[i].known()) {
    if (cells_.size() > 2 * limits_.bins) join();
    find({.ranks = {{rank, rank}}});
    i = cell_of(rank);
  }
  return least(cells_[i], rank);
}

std::vector<double> values_of_ranks(const Column& values, std::size_t valid, std::span<const std::size_t> ranks,
                                    int threads) {
  const RankRange all{ranks.front(), ranks.back()};
  const OrderedColumn ordered(values, valid, {&all, 1}, threads);
  OrderedColumn::Wanted wanted;
  for (const std::size_t r : ranks) wanted.ranks.push_back({r, r});
  ordered.find(wanted);
  std::vector<double> found;
  for (const std::size_t r : ranks) found.push_back(ordered[r]);
  return found;
}

} // namespace gumshoe::analysis
