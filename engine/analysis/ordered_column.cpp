#include "analysis/ordered_column.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "analysis/leaves.h"
#include "analysis/order_key.h"
#include "analysis/ordered_tails.h"

namespace gumshoe::analysis {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

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

[[noreturn]] void changed() { throw std::logic_error("samples changed while they were analysed"); }

} // namespace

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
  if (!pass) return add(key_of(-inf), key_of(inf), valid);
  const Sieved found = pass->sieve.found();
  const std::vector<SieveRange>& ranges = pass->sieve.ranges();
  const std::uint64_t inside = std::accumulate(found.counts.begin(), found.counts.end(), std::uint64_t{0});
  const std::uint64_t between = size - found.below - found.above - inside;
  if (between > size || (ranges.size() == 1 && between != 0)) changed();
  add(key_of(-inf), ranges.front().first - 1, found.below);
  for (const SieveRange& r : ranges) {
    if (&r != &ranges.front()) add(ranges.front().last + 1, r.first - 1, between);
    each_bin(r, [&](std::size_t bin, std::int64_t first, std::int64_t last) { add(first, last, found.counts[bin]); });
  }
  add(ranges.back().last + 1, key_of(inf), found.above);
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

/// Calls visit(segment) for the intervals that begin at rank `from` or later, those which begin in one cell and end in
/// one together, until it returns false.
template <class Visit>
void OrderedColumn::segments(std::size_t span, double turn, std::size_t from, const Visit& visit) const {
  const auto sweep = [&](std::size_t first, std::size_t last, std::size_t to, double add) {
    if (first >= last) return true;
    for (std::size_t i = cell_of(first), j = cell_of(to); first < last;) {
      const std::size_t n = std::min({cells_[i].end() - first, cells_[j].end() - to, last - first});
      if (!visit(Segment{i, j, first, to, n, add})) return false;
      first += n, to += n;
      if (first == cells_[i].end()) ++i;
      if (to == cells_[j].end()) ++j;
    }
    return true;
  };
  if (!sweep(from, size - span, from + span, 0) || !(turn > 0)) return;
  from = std::max(from, size - span);
  sweep(from, size, from + span - size, turn);
}

/// No interval of the segment is shorter. Differences are monotonic in both ends, however they are rounded.
double OrderedColumn::least_length(const Segment& s) const {
  return least(cells_[s.end], s.to) + s.add - most(cells_[s.start], s.from + s.count - 1);
}

/// No shortest interval is longer.
double OrderedColumn::shortest_bound(std::size_t span, double turn) const {
  double bound = inf;
  segments(span, turn, 0, [&](const Segment& s) {
    const double length = most(cells_[s.end], s.to) + s.add - least(cells_[s.start], s.from);
    if (length < bound) bound = length;
    return true;
  });
  return bound;
}

void OrderedColumn::mark(RankRange ranks, std::vector<Use>& uses) const {
  for (std::size_t i = cell_of(ranks.first); i < cells_.size() && cells_[i].rank <= ranks.last; ++i)
    uses[i] =
        std::max(uses[i], cells_[i].rank >= ranks.first && cells_[i].end() <= ranks.last + 1 ? Use::all : Use::some);
}

/// Intervals of almost equal lengths, as those of evenly spread values, cannot be excluded by bounds: of too many cells
/// only the large ones are divided, and shortest() goes through the others a few at a time.
void OrderedColumn::mark_shortest(std::size_t span, double turn, std::vector<Use>& uses) const {
  const double bound = shortest_bound(span, turn);
  std::vector<bool> may(cells_.size());
  segments(span, turn, 0, [&](const Segment& s) {
    if (!(least_length(s) > bound)) may[s.start] = may[s.end] = true;
    return true;
  });
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) unknown += may[i] && !cells_[i].known() ? 1 : 0;
  const bool many = unknown > 2 * limits_.bins || cells_.size() > 6 * limits_.bins;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (may[i] && (!many || cells_[i].count > window_share())) uses[i] = std::max(uses[i], Use::some);
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
template <class Shift>
std::unique_ptr<OrderedColumn::Pass> OrderedColumn::pass_over(const std::vector<std::size_t>& chosen,
                                                              const Shift& shift) const {
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

std::size_t OrderedColumn::shortest(std::size_t span, double turn) const {
  find({.spans = {span}, .turn = turn});
  Shortest best{shortest_bound(span, turn)};
  const std::size_t end = turn > 0 ? size : size - span;
  for (std::size_t from = 0; from < end;) from = search(span, turn, from, best);
  return best.rank;
}

/// Looks at the intervals that begin at rank `from` or later, as far as the values of their cells find room, which are
/// kept for that time only; returns where to go on.
std::size_t OrderedColumn::search(std::size_t span, double turn, std::size_t from, Shortest& best) const {
  std::vector<Segment> some;
  std::vector<std::size_t> wanted; // cells whose values are not known
  std::uint64_t values = 0;
  std::size_t next = size;
  segments(span, turn, from, [&](const Segment& s) {
    if (least_length(s) > best.bound) return true;
    const std::size_t before = wanted.size();
    for (const std::size_t i : {s.start, s.end})
      if (!cells_[i].known() && (some.empty() || (i != some.back().start && i != some.back().end)))
        wanted.push_back(i), values += cells_[i].count;
    if (values > limits_.kept && before > 0) {
      wanted.resize(before);
      next = s.from;
      return false;
    }
    some.push_back(s);
    return true;
  });
  std::ranges::sort(wanted);
  const auto twice = std::ranges::unique(wanted);
  wanted.erase(twice.begin(), twice.end());
  Sieved found;
  if (!wanted.empty()) {
    const auto pass = pass_over(wanted, [](const Cell&) { return SieveRange::keep; });
    make(*pass);
    found = pass->sieve.found();
  }
  const std::int64_t* values_of = found.kept.data();
  for (const std::size_t i : wanted) cells_[i].values = values_of, values_of += cells_[i].count;
  if (values_of != found.kept.data() + found.kept.size()) changed();
  for (const Segment& s : some) {
    const Cell &start = cells_[s.start], &end = cells_[s.end];
    // Of intervals that begin with equal values the first is as short as any.
    for (std::size_t k = 0; k < (start.values ? s.count : 1); ++k)
      if (const double length = least(end, s.to + k) + s.add - least(start, s.from + k); length < best.length)
        best.length = length, best.rank = s.from + k;
  }
  best.bound = std::min(best.bound, best.length);
  for (const std::size_t i : wanted) cells_[i].values = nullptr;
  return next;
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
