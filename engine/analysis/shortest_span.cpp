/// The shortest span among ordered values, by bounds of their cells.
#include <algorithm>

#include "analysis/ordered_column.h"

namespace gumshoe::analysis {

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
  double bound = std::numeric_limits<double>::infinity();
  segments(span, turn, 0, [&](const Segment& s) {
    const double length = most(cells_[s.end], s.to) + s.add - least(cells_[s.start], s.from);
    if (length < bound) bound = length;
    return true;
  });
  return bound;
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
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
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
    // No interval that begins with an equal value is shorter than the first such one.
    for (std::size_t k = 0; k < (start.values ? s.count : 1); ++k)
      if (const double length = least(end, s.to + k) + s.add - least(start, s.from + k); length < best.length)
        best.length = length, best.rank = s.from + k;
  }
  best.bound = std::min(best.bound, best.length);
  for (const std::size_t i : wanted) cells_[i].values = nullptr;
  return next;
}

} // namespace gumshoe::analysis
