#include "analysis/shapley.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "analysis/conditional_draws.h"
#include "analysis/influence.h"
#include "analysis/pick_freeze.h"
#include "analysis/units.h"
#include "base/hash.h"
#include "random/streams.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t rows_per_order = 8;

using Series = std::vector<double>;

/// Outputs that the same variates reach.
struct Game {
  std::vector<std::size_t> players, outputs;
};

std::vector<Game> games(const propagation::Experiment& e) {
  const auto reaches = reaching_variates(e);
  std::map<std::vector<bool>, std::size_t> known;
  std::vector<Game> all;
  for (std::size_t o = 0; o < reaches.size(); ++o) {
    const auto [at, is_new] = known.try_emplace(reaches[o], all.size());
    if (is_new) {
      all.emplace_back();
      for (std::size_t v = 0; v < reaches[o].size(); ++v)
        if (reaches[o][v]) all.back().players.push_back(v);
    }
    all[at->second].outputs.push_back(o);
  }
  return all;
}

/// For every row of a block, w of the empty set and the increment of each player, [output][player][row].
class BlockOfRows {
public:
  BlockOfRows(const propagation::Experiment& e, const ConditionalDraws& draws, const Game& game, std::uint64_t first,
              std::size_t rows)
      : whole(game.outputs.size() * rows), added(game.outputs.size() * game.players.size() * rows), failed(rows, 0),
        e_(e), draws_(draws), game_(game), first_(first), offset_(Aligned(first).offset), rows_(rows),
        block_(draws.draw(Aligned(first).begin, offset_ + rows)), y_(e.outputs().size() * rows), other_(y_.size()),
        status_(rows) {
    for (std::size_t v = 0; v < e.plan().variates.size(); ++v)
      pointers_.push_back(&block_.mixed[v * block_.rows + offset_]);
    run(y_); // mixed is A as drawn
  }

  void all_subsets() {
    const std::size_t d = game_.players.size();
    std::vector<double> weight(d, 1.0 / static_cast<double>(d)); // of a set of s others: s! (d - s - 1)! / d!
    for (std::size_t s = 1; s < d; ++s) weight[s] = weight[s - 1] * static_cast<double>(s) / static_cast<double>(d - s);
    for (std::size_t set = 0; set + 1 < std::size_t{1} << d; ++set) {
      std::vector<bool> frozen(pointers_.size(), false);
      std::size_t size = 0;
      for (std::size_t i = 0; i < d; ++i)
        if (set >> i & 1) frozen[game_.players[i]] = true, ++size;
      draws_.mix(block_, frozen, offset_, rows_);
      run(other_);
      for (std::size_t k = 0; k < game_.outputs.size(); ++k) {
        const std::vector<double> w = unexplained(k);
        if (set == 0) std::copy(w.begin(), w.end(), &whole[k * rows_]);
        for (std::size_t i = 0; i < d; ++i) {
          const double factor = set >> i & 1 ? -weight[size - 1] : weight[size];
          double* sum = &added[(k * d + i) * rows_];
          for (std::size_t r = 0; r < rows_; ++r) sum[r] += factor * w[r];
        }
      }
    }
  }

  void random_orders() {
    const std::size_t d = game_.players.size(), strips = rows_ / rows_per_order;
    std::vector<std::vector<std::size_t>> order(strips);
    for (std::size_t s = 0; s < strips; ++s) order[s] = random_order(first_ / rows_per_order + s);
    for (const bool backwards : {false, true}) {
      std::vector<std::vector<bool>> frozen(strips, std::vector<bool>(pointers_.size(), false));
      std::vector<std::vector<double>> before(game_.outputs.size());
      for (std::size_t step = 0; step <= d; ++step) {
        const auto player = [&](std::size_t s) { return order[s][backwards ? d - step : step - 1]; };
        for (std::size_t s = 0; s < strips; ++s) {
          if (step > 0) frozen[s][game_.players[player(s)]] = true;
          draws_.mix(block_, frozen[s], offset_ + s * rows_per_order, rows_per_order);
        }
        if (step < d) run(other_);
        for (std::size_t k = 0; k < game_.outputs.size(); ++k) {
          std::vector<double> w = step < d ? unexplained(k) : std::vector<double>(rows_, 0.0);
          if (step == 0) std::copy(w.begin(), w.end(), &whole[k * rows_]);
          for (std::size_t r = 0; step > 0 && r < rows_; ++r)
            added[(k * d + player(r / rows_per_order)) * rows_ + r] += 0.5 * (before[k][r] - w[r]);
          before[k] = std::move(w);
        }
      }
    }
  }

  std::vector<double> whole, added;
  std::vector<std::uint8_t> failed;

private:
  void run(std::vector<double>& y) {
    e_.run(pointers_, rows_, workspace_, y.data(), status_.data());
    for (std::size_t r = 0; r < rows_; ++r) failed[r] |= status_[r];
  }

  std::vector<double> unexplained(std::size_t k) const {
    const double *y = &y_[game_.outputs[k] * rows_], *other = &other_[game_.outputs[k] * rows_];
    std::vector<double> w(rows_);
    for (std::size_t r = 0; r < rows_; ++r) w[r] = 0.5 * (y[r] - other[r]) * (y[r] - other[r]);
    return w;
  }

  std::vector<std::size_t> random_order(std::uint64_t strip) const {
    const std::size_t d = game_.players.size(), stride = (d + 1) / 2 * 2;
    std::vector<double> u(stride);
    random::uniforms({hash64("shapley order", e_.scenario().run.seed), 0,
                      static_cast<std::uint16_t>(quantities::Purpose::pick_freeze)},
                     strip * stride, stride, u.data());
    std::vector<std::size_t> order(d);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = d; i-- > 1;) // Fisher and Yates
      std::swap(order[i], order[std::min(i, static_cast<std::size_t>(u[i] * static_cast<double>(i + 1)))]);
    return order;
  }

  const propagation::Experiment& e_;
  const ConditionalDraws& draws_;
  const Game& game_;
  std::uint64_t first_;
  std::size_t offset_, rows_;
  ConditionalDraws::Block block_;
  std::vector<double> y_, other_;
  std::vector<std::uint8_t> status_;
  std::vector<const double*> pointers_;
  propagation::Workspace workspace_;
};

/// Sums of a game over groups of rows: number of rows; by output w of the empty set; by output and player the
/// increments.
struct Sums {
  std::size_t outputs, players, groups;
  Series values; ///< [sum][group]
  Sums(const Game& game, std::size_t groups_)
      : outputs(game.outputs.size()), players(game.players.size()), groups(groups_), values(sums() * groups) {}
  std::size_t sums() const { return 1 + outputs * (1 + players); }
  double* rows() { return at(0); }
  double* whole(std::size_t output) { return at(1 + output); }
  double* added(std::size_t output, std::size_t player) { return at(1 + outputs + output * players + player); }
  double* at(std::size_t sum) { return &values[sum * groups]; }
};

/// Rows [first, last) into sums from the first group on.
void play(const propagation::Experiment& e, const ConditionalDraws& draws, const Game& game, const RowUnits& units,
          std::uint64_t first, std::uint64_t last, Sums& sums) {
  for (std::uint64_t at = first; at < last; at += most_rows) {
    const std::size_t rows = std::min<std::uint64_t>(most_rows, last - at);
    BlockOfRows block(e, draws, game, at, rows);
    if (sums.players <= most_for_all_subsets)
      block.all_subsets();
    else
      block.random_orders();
    for (std::size_t r = 0; r < rows; ++r) {
      if (block.failed[r] != 0) continue;
      const std::size_t g = (at - first + r) / units.per_group;
      sums.rows()[g] += 1;
      for (std::size_t k = 0; k < sums.outputs; ++k) {
        sums.whole(k)[g] += block.whole[k * rows + r];
        for (std::size_t i = 0; i < sums.players; ++i)
          sums.added(k, i)[g] += block.added[(k * sums.players + i) * rows + r];
      }
    }
  }
}

propagation::Work work_of(const propagation::Experiment& e, const Game& game,
                          std::shared_ptr<const ConditionalDraws> draws, const RowUnits& units, std::size_t number) {
  const std::size_t d = game.players.size(), sums = Sums(game, 0).sums();
  return {.name = "shapley " + std::to_string(number),
          .units = units.groups,
          .values = sums,
          .runs = units.per_group * (d <= most_for_all_subsets ? std::uint64_t{1} << d : 2 * d),
          .together = units.together(std::max<std::size_t>(e.model().block, most_rows / 4)),
          .compute = [&e, game, draws, units, sums](std::uint64_t first, std::uint64_t last, double* out) {
            Sums s(game, static_cast<std::size_t>(last - first));
            play(e, *draws, game, units, units.row(first), units.row(last), s);
            units.by_unit(s.values, sums, last - first, out);
          }};
}

void state(const propagation::Experiment& e, const Game& game, Sums& sums, std::uint64_t n,
           std::vector<Shapley>& results) {
  const auto sum = [&](const double* x) { return std::accumulate(x, x + sums.groups, 0.0); };
  for (std::size_t k = 0; k < sums.outputs; ++k) {
    Shapley& s = results[game.outputs[k]];
    s.dropped_rows = n - static_cast<std::uint64_t>(sum(sums.rows()));
    const double* whole = sums.whole(k);
    const double variance = sum(whole);
    for (std::size_t i = 0; i < sums.players; ++i) {
      const double* of_player = sums.added(k, i);
      const double value = variance > 0 ? sum(of_player) / variance : std::nan("");
      Series influence(sums.groups);
      for (std::size_t g = 0; g < sums.groups; ++g) influence[g] = (of_player[g] - value * whole[g]) / variance;
      const Estimate at = with_interval(value, influence, sums.rows());
      s.effects.push_back({e.plan().variates[game.players[i]].name, at.value, at.low, at.high, at.verdict});
    }
  }
}

/// Calls action(game, its work).
template <class Action> void for_games(const propagation::Experiment& e, const RowUnits& units, const Action& action) {
  const auto draws = std::make_shared<const ConditionalDraws>(e.plan());
  std::size_t number = 0;
  for (const Game& game : games(e))
    if (!game.players.empty()) action(game, work_of(e, game, draws, units, number++));
}

} // namespace

std::vector<propagation::Work> shapley_work(const propagation::Experiment& e, std::uint64_t n) {
  std::vector<propagation::Work> all;
  for_games(e, units_of_rows(n), [&](const Game&, propagation::Work work) { all.push_back(std::move(work)); });
  return all;
}

std::vector<Shapley> shapley_effects(const propagation::Experiment& e, std::uint64_t n,
                                     const propagation::Workers& workers) {
  const RowUnits units = units_of_rows(n);
  std::vector<Shapley> results;
  for (const auto& output : e.outputs()) results.push_back({output, units.rows, 0, {}});
  for_games(e, units, [&](const Game& game, const propagation::Work& work) {
    Sums sums(game, units.groups);
    workers.run(work, [&](std::uint64_t first, std::uint64_t last, const double* values) {
      units.by_sum(values, sums.sums(), first, last, sums.values);
    });
    state(e, game, sums, units.rows, results);
  });
  return results;
}

} // namespace gumshoe::analysis
