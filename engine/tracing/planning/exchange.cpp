#include "tracing/planning/exchange.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace gumshoe::tracing {
namespace {

constexpr double rounding = 1e-9;            ///< differences of scores and costs below this are none
constexpr int starts = 6;                    ///< plans from which exchanges start in addition to the greedy one
constexpr std::size_t most_exchanges = 2000; ///< of a plan, up to which more starts are tried, by cost
constexpr std::size_t all_subsets = 4;       ///< set-ups up to which every choice of them is tried
constexpr std::size_t most_paired = 60;      ///< readings of a new set-up of which the best two are sought

/// Information on the columns `of` when `others` are unknown, too.
Matrix eliminated(const Matrix& m, const std::vector<Index>& of, const std::vector<Index>& others) {
  const Matrix own = m(of, of);
  if (others.empty()) return own;
  const Matrix cross = m(others, of);
  return own - cross.transpose() * Matrix(m(others, others)).ldlt().solve(cross);
}

struct State {
  std::vector<int> count;
  Matrix information;
  double cost = 0, score = 0;
  int readings = 0;
  bool met = false;
};

class Search {
public:
  Search(const PlanTask& task, std::vector<bool> open) : task_(task) {
    for (std::size_t i = 0; i < task.rows.size(); ++i)
      if (std::ranges::all_of(task.opens[i], [&](std::size_t s) { return open[s]; })) allowed_.push_back(i);
    for (std::size_t s = 0; s < open.size(); ++s)
      if (open[s]) opened_.push_back(s);
  }

  State best() const {
    State out = empty();
    bool seeded = seed(out);
    fill(out, task_.budget);
    improve(out);
    if (allowed_.size() < 2 || !seeded || allowed_.size() * static_cast<std::size_t>(out.readings) > most_exchanges)
      return out;
    for (int start = 0; start < starts; ++start) {
      State other = empty();
      const std::size_t n = static_cast<std::size_t>(std::max(1, out.readings));
      for (std::size_t j = 0; j < n; ++j) {
        // Spread over the allowed readings, each start shifted against the one before.
        const std::size_t i =
            (j * allowed_.size() / n + static_cast<std::size_t>(start) * allowed_.size() / starts) % allowed_.size();
        if (fits(other, allowed_[i], task_.budget)) other = with(other, allowed_[i], 1);
      }
      fill(other, task_.budget);
      improve(other);
      if (better(other, out)) out = std::move(other);
    }
    return out;
  }

  bool better(const State& a, const State& b) const {
    if (a.met != b.met) return a.met;
    const bool cheaper = a.cost < b.cost - rounding * (1 + b.cost);
    const bool closer = a.score > b.score + rounding * (1 + std::fabs(b.score));
    if (a.met && !task_.goals.empty()) return cheaper;
    return closer || (cheaper && a.score > b.score - rounding * (1 + std::fabs(b.score)));
  }

private:
  void judge(State& s) const {
    s.met = true;
    s.score = 0;
    if (task_.goals.empty()) {
      s.score = log_determinant(task_, s.information);
      return;
    }
    for (const PlanGoal& goal : task_.goals) {
      const double value = reached(goal, s.information);
      s.met = s.met && value >= enough;
      s.score += std::log(std::clamp(value, 1e-300, 1.0));
    }
  }

  State empty() const {
    State out{std::vector<int>(task_.rows.size(), 0), task_.base};
    judge(out);
    return out;
  }

  double cost_of(const std::vector<int>& count) const {
    double out = 0;
    std::vector<bool> open(task_.opening.size(), false);
    for (std::size_t i = 0; i < count.size(); ++i) {
      out += count[i] * task_.cost[i];
      for (const std::size_t s : task_.opens[i]) open[s] = open[s] || count[i] > 0;
    }
    for (std::size_t s = 0; s < open.size(); ++s) out += open[s] ? task_.opening[s] : 0;
    return out;
  }

  State with(const State& s, std::size_t reading, int change) const {
    State out = s;
    out.count[reading] += change;
    out.readings += change;
    out.information += change * (task_.rows[reading].transpose() * task_.rows[reading]);
    out.cost = cost_of(out.count);
    judge(out);
    return out;
  }

  bool within(const State& s) const { return s.readings <= task_.most && s.cost <= task_.budget * (1 + rounding); }
  bool fits(const State& s, std::size_t reading, double budget) const {
    if (s.readings >= task_.most) return false;
    auto count = s.count;
    ++count[reading];
    return cost_of(count) <= budget * (1 + rounding);
  }

  /// The best two readings of every set-up that is opened: one alone tells its offset and nothing else.
  bool seed(State& s) const {
    for (const std::size_t setup : opened_) {
      std::vector<std::size_t> own;
      for (const std::size_t i : allowed_)
        if (std::ranges::find(task_.opens[i], setup) != task_.opens[i].end()) own.push_back(i);
      if (std::ranges::any_of(own, [&](std::size_t i) { return s.count[i] > 0; }) || own.empty()) continue;
      const std::size_t every = own.size() / most_paired + 1;
      State best = s;
      bool found = false;
      for (std::size_t a = 0; a < own.size(); a += every) {
        const State one = with(s, own[a], 1);
        for (std::size_t b = a; b < own.size() && within(one); b += every) {
          State two = with(one, own[b], 1);
          if (!within(two) || (found && !better(two, best))) continue;
          best = std::move(two);
          found = true;
        }
      }
      if (!found) return false;
      s = std::move(best);
    }
    return true;
  }

  /// Adds what gains most for its cost, until the goals are met or nothing more fits.
  void fill(State& s, double budget) const {
    while (!(s.met && !task_.goals.empty())) {
      State best;
      double most = 0;
      for (const std::size_t i : allowed_) {
        if (!fits(s, i, budget)) continue;
        State next = with(s, i, 1);
        const double gain = (next.score - s.score) / (next.cost - s.cost);
        if (gain <= most) continue;
        most = gain;
        best = std::move(next);
      }
      if (most <= 0) return;
      s = std::move(best);
    }
  }

  /// Each reading in turn for the one that serves better than any other (Cook and Nachtsheim 1980), as long as one
  /// does.
  void exchange(State& s, double budget) const {
    for (bool moved = true; moved;) {
      moved = false;
      for (const std::size_t out : allowed_) {
        if (s.count[out] == 0) continue;
        const State less = with(s, out, -1);
        State best = s;
        if (better(less, best)) best = less;
        for (const std::size_t in : allowed_) {
          if (in == out || !fits(less, in, budget)) continue;
          State next = with(less, in, 1);
          if (better(next, best)) best = std::move(next);
        }
        if (!better(best, s)) continue;
        s = std::move(best);
        moved = true;
      }
    }
  }

  /// Exchanges and removals; then with a reading less, and exchanges that make up for it.
  void improve(State& s) const {
    exchange(s, task_.budget);
    fill(s, task_.budget);
    exchange(s, task_.budget);
    for (bool moved = s.met && !task_.goals.empty(); moved;) {
      moved = false;
      for (const std::size_t out : allowed_) {
        if (s.count[out] == 0) continue;
        State less = with(s, out, -1);
        const double budget = s.cost * (1 - 2 * rounding);
        exchange(less, budget);
        fill(less, budget);
        if (!better(less, s)) continue;
        s = std::move(less);
        moved = true;
        break;
      }
    }
  }

  const PlanTask& task_;
  std::vector<std::size_t> allowed_, opened_;
};

/// Choices of set-ups that are tried: every one of a few; of many none, each alone, and all.
std::vector<std::vector<bool>> choices(std::size_t setups) {
  std::vector<std::vector<bool>> out;
  if (setups <= all_subsets) {
    for (std::size_t bits = 0; bits < (std::size_t{1} << setups); ++bits) {
      out.emplace_back();
      for (std::size_t s = 0; s < setups; ++s) out.back().push_back((bits >> s & 1) != 0);
    }
    return out;
  }
  out = {std::vector<bool>(setups, false), std::vector<bool>(setups, true)};
  for (std::size_t s = 0; s < setups; ++s) {
    out.emplace_back(setups, false);
    out.back()[s] = true;
  }
  return out;
}

} // namespace

double reached(const PlanGoal& goal, const Matrix& information) {
  const Matrix scaled =
      goal.weight.asDiagonal() * eliminated(information, goal.of, goal.others) * goal.weight.asDiagonal();
  if (goal.kind == PlanGoal::Kind::size)
    return std::max(0.0, scaled.size() == 1
                             ? scaled(0, 0)
                             : Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0]) /
           goal.required;
  // weight' inverse(S) weight, of S without the weights.
  const Matrix own = eliminated(information, goal.of, goal.others);
  return 1 / (goal.weight.dot(own.ldlt().solve(goal.weight)) * goal.required);
}

double log_determinant(const PlanTask& task, const Matrix& information) {
  std::vector<Index> others;
  for (Index j = 0; j < information.rows(); ++j)
    if (std::ranges::find(task.free, j) == task.free.end()) others.push_back(j);
  const Matrix own = eliminated(information, task.free, others);
  const Vector pivots = own.ldlt().vectorD();
  double out = 0;
  for (const double x : pivots) out += std::log(std::max(x, 1e-300));
  return out;
}

Matrix information(const PlanTask& task, const std::vector<int>& count) {
  Matrix out = task.base;
  for (std::size_t i = 0; i < count.size(); ++i) out += count[i] * (task.rows[i].transpose() * task.rows[i]);
  return out;
}

PlanFound find_plan(const PlanTask& task) {
  std::optional<State> best;
  for (const auto& open : choices(task.opening.size())) {
    const Search search(task, open);
    State found = search.best();
    if (!best || search.better(found, *best)) best = std::move(found);
  }
  return {best->count, best->cost, best->met};
}

} // namespace gumshoe::tracing
