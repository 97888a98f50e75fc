#pragma once
/// Exact order statistics of a column of any length in bounded memory, by passes over it.
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "analysis/column.h"
#include "analysis/ordered_tails.h"
#include "analysis/sieve.h"

namespace gumshoe::analysis {

/// The values in cells by size, with their numbers: a pass over the column divides those cells that matter, or keeps
/// their values once they are few. A cell of equal values needs none. The result does not depend on the cells. For one
/// thread at a time; passes run on several.
class OrderedColumn {
public:
  /// What bounds the memory: values that are kept, beyond those of whole ranges asked for, and bins that a pass counts.
  struct Limits {
    std::size_t kept = std::size_t{1} << 19, bins = std::size_t{1} << 16;
  };

  /// A pass over the values, which another pass may make by the way: all leaves go through the sieve.
  struct Pass;

  /// `expected`: one or two rising ranges, near which ranks will be asked for; `valid`: how many values are not NaN.
  OrderedColumn(const Column& values, std::size_t valid, std::span<const RankRange> expected, int threads,
                Limits limits);
  OrderedColumn(const Column& values, std::size_t valid, std::span<const RankRange> expected, int threads)
      : OrderedColumn(values, valid, expected, threads, Limits{}) {}
  /// Not to be used before the first pass is finished.
  OrderedColumn(const Column& values, int threads, Limits limits);
  ~OrderedColumn();
  OrderedColumn(const OrderedColumn&) = delete;
  OrderedColumn& operator=(const OrderedColumn&) = delete;

  /// What find() makes ready in the same passes.
  struct Wanted {
    std::vector<RankRange> ranks = {};
    std::vector<std::size_t> spans = {}; ///< for shortest(span)
    double turn = 0;                     ///< of shortest(span, turn)
    std::optional<double> middle = {};   ///< for the search of an interval about it that leaves out `spare` values
    std::size_t spare = 0;
  };
  void find(const Wanted& wanted) const;

  /// About so many values are not NaN, going by the pilot.
  std::size_t about_valid() const;
  /// The first pass, with `expected` among about_valid() values; null: there is no need of one.
  std::unique_ptr<Pass> first_pass(std::span<const RankRange> expected) const;
  void finish_first(std::unique_ptr<Pass> pass, std::size_t valid);
  /// The next pass that find() would make; null: none.
  std::unique_ptr<Pass> next_pass(const Wanted& wanted) const;
  void finish(std::unique_ptr<Pass> pass) const;

  /// Value of rank r, from 0.
  double operator[](std::size_t rank) const;
  /// The first rank r < size - span at which value r + span less value r is smallest. On a circle of circumference
  /// `turn` > 0 any r < size, where the value of rank r + span >= size is that of rank r + span - size, a turn farther.
  std::size_t shortest(std::size_t span, double turn = 0) const;

  /// Among the intervals about the middle that leave out `spare` values, the narrowest leaves out so many below it.
  RankRange bracket_middle(double middle, std::size_t spare) const;
  /// pilot_sample() of the values; empty if there was no need of it.
  const std::vector<double>& pilot() const { return pilot_; }

  std::size_t size = 0; ///< values in all, NaN not counted

private:
  [[noreturn]] static void changed(); ///< between two passes
  struct Cell {
    std::int64_t first, last; ///< keys, both included
    std::uint64_t rank, count;
    const std::int64_t* values = nullptr; ///< keys of its values, if they are kept
    std::size_t end() const { return rank + count; }
    bool known() const { return values || first == last; }
  };
  /// What a pass is to do with a cell.
  enum class Use : std::uint8_t {
    none,
    some, ///< divide it, or keep its values if they are few
    all   ///< keep its values
  };

  std::unique_ptr<Pass> bracketing(std::span<const RankRange> expected, std::size_t valid) const;
  std::unique_ptr<Pass> pass_over(const std::vector<std::size_t>& chosen,
                                  const std::function<int(const Cell&)>& shift) const;
  void make(Pass& pass) const;
  std::size_t cell_of(std::size_t rank) const;
  /// Bounds of the value of a rank in the cell.
  double least(const Cell& cell, std::size_t rank) const;
  double most(const Cell& cell, std::size_t rank) const;
  /// Intervals that begin in one cell and end in one.
  struct Segment {
    std::size_t start, end; ///< cells
    std::size_t from, to;   ///< ranks of the first interval's ends
    std::size_t count;
    double add; ///< to the end: the turn, where it lies beyond the last value
  };
  struct Shortest {
    double bound; ///< none is longer
    double length = std::numeric_limits<double>::infinity();
    std::size_t rank = 0;
  };
  template <class Visit> void segments(std::size_t span, double turn, std::size_t from, const Visit& visit) const;
  double least_length(const Segment& segment) const;
  double shortest_bound(std::size_t span, double turn) const;
  std::size_t search(std::size_t span, double turn, std::size_t from, Shortest& best) const;
  /// Values of a cell of which shortest() finds room for several.
  std::size_t window_share() const { return limits_.kept / 4; }
  void join() const;
  void mark(RankRange ranks, std::vector<Use>& uses) const;
  void mark_shortest(std::size_t span, double turn, std::vector<Use>& uses) const;
  void mark_middle(double middle, std::size_t spare, std::vector<Use>& uses) const;
  const Column& values_;
  int threads_;
  Limits limits_;
  mutable std::vector<double> pilot_;
  mutable std::vector<Cell> cells_; ///< those with values, rising
  mutable std::vector<std::vector<std::int64_t>> kept_;
};

/// The values of the given ranks (from 0, rising) among those that are not NaN.
std::vector<double> values_of_ranks(const Column& values, std::size_t valid, std::span<const std::size_t> ranks,
                                    int threads);

struct OrderedColumn::Pass {
  Pass(std::vector<SieveRange> ranges, std::size_t second, bool outside) : sieve(std::move(ranges), second, outside) {}
  Sieve sieve;

private:
  friend OrderedColumn;
  std::vector<std::size_t> chosen; ///< the cells that its ranges are
};

} // namespace gumshoe::analysis
