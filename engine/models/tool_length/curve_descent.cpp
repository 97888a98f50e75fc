#include "models/tool_length/curve_descent.h"

#include <algorithm>

namespace gumshoe::models::tool_length {

namespace {

/// A descent is given up if so many times the gain that its next step promises would not bring it down to the least
/// squares known.
constexpr double patience = 4;
constexpr int most_steps = 50, most_rounds = 50;
/// Least part of a step that is tried.
constexpr double least_share = 1e-4;
/// Near the end of a hump the slope grows without bound: what a step may take for one.
constexpr double steepest = 100;
/// How far inside a jump is inside, m.
constexpr double inside = 1e-14;

} // namespace

CurveDescents::CurveDescents(const CurveReadings& d) : d_(d) {
  for (std::size_t k = 0; k < d.flutes; ++k)
    for (std::size_t i = 0; i < d.readings; ++i) {
      lines_.push_back(d.lines[i * d.flutes + k]);
      tables_.push_back(&d.curves[i * d.flutes + k]->table());
      one_curve_ = one_curve_ && tables_.back() == tables_.front();
    }
}

std::vector<CurveDescents::Candidate> CurveDescents::longest(const std::vector<double>& phases, double margin) const {
  const std::size_t n = phases.size();
  std::vector<double> begins(d_.flutes * n), squares(n);
  curve_table_kernels().longest({d_.readings, d_.flutes, d_.drop, tables_.data(), lines_.data(), d_.heights.data()},
                                margin, n, phases.data(), begins.data(), squares.data());
  std::vector<Candidate> all(n);
  for (std::size_t s = 0; s < n; ++s) {
    all[s].x[0] = phases[s];
    for (std::size_t k = 0; k < d_.flutes; ++k) all[s].x[k + 1] = begins[k * n + s];
    all[s].squares = squares[s];
  }
  return all;
}

std::vector<double> CurveDescents::residuals(const Unknowns& x) {
  Descent& d = descent(0, {x});
  look({&d});
  std::vector<double> out;
  for (const Residual& r : d.trial.residuals) out.push_back(r.value);
  return out;
}

void CurveDescents::triggers(std::size_t flute, double begin, std::vector<double>& out) {
  const std::size_t n = d_.readings, first = flute * n;
  make_room(n * d_.flutes);
  for (std::size_t i = 0; i < n; ++i) places_[first + i] = lines_[first + i] + begin;
  look_up(first, first + n);
  std::copy_n(points_.height + first, n, out.begin());
}

void CurveDescents::settle(std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < candidates.size(); ++i) descent(i, candidates[i]);
  run(candidates.size(), HUGE_VAL);
  for (std::size_t i = 0; i < candidates.size(); ++i) candidates[i] = descents_[i].c;
}

bool CurveDescents::descend(Candidate& c) {
  descent(0, c);
  run(1, HUGE_VAL);
  bool settled = descents_[0].settled;
  Box box = descents_[0].now.box;
  c = descents_[0].c;
  for (int round = 0; round < most_rounds; ++round) {
    if (known(c)) return settled;
    known_.emplace_back(active, c);
    std::size_t n = 0;
    for (std::size_t k = 0; k < d_.flutes; ++k) {
      if (!active[k]) continue;
      for (const double across : {box.low[k] - inside, box.high[k] + inside}) {
        if (std::fabs(across) > 1e3) continue;
        descent(n++, c).next.x[k + 1] = across;
      }
    }
    run(n, c.squares);
    const Descent* best = nullptr;
    for (std::size_t i = 0; i < n; ++i)
      if (descents_[i].c.squares < (best ? best->c.squares : c.squares)) best = &descents_[i];
    if (!best) return settled;
    c = best->c, settled = best->settled, box = best->now.box;
  }
  return false;
}

/// The i-th descent, at its start.
CurveDescents::Descent& CurveDescents::descent(std::size_t i, const Candidate& from) {
  while (descents_.size() <= i) {
    Descent& fresh = descents_.emplace_back();
    for (Look* l : {&fresh.now, &fresh.trial}) l->residuals.resize(d_.readings);
  }
  Descent& d = descents_[i];
  d.next = from;
  d.steps = 0;
  d.done = d.settled = false;
  return d;
}

/// Runs the first `descents` side by side. Gives up those whose minimum lies far above `limit`.
void CurveDescents::run(std::size_t descents, double limit) {
  const auto still = [&] {
    looking_.clear();
    for (std::size_t i = 0; i < descents; ++i)
      if (!descents_[i].done) looking_.push_back(&descents_[i]);
    return !looking_.empty();
  };
  still();
  look(looking_);
  for (Descent* d : looking_) {
    d->c = d->next;
    std::swap(d->now, d->trial);
    begin_step(*d, limit);
  }
  while (still()) {
    look(looking_);
    for (Descent* d : looking_) go_on(*d, limit);
  }
}

void CurveDescents::begin_step(Descent& d, double limit) const {
  d.before = d.c.squares;
  d.promised = best_step(d.c, d.now, d.step);
  d.share = 1;
  d.settled = d.promised <= 1e-9 * d.before + 1e-30;
  d.done = d.settled || d.before - patience * d.promised > limit;
  d.start = d.c;
  for (std::size_t j = 0; j <= d_.flutes; ++j) d.next.x[j] = d.start.x[j] + d.step[j];
}

/// Takes or refuses the step that was looked at. Where the curve bends strongly a step may overshoot, even if it gains:
/// half of it is tried, too.
void CurveDescents::go_on(Descent& d, double limit) const {
  const bool better = d.next.squares < d.c.squares, gained = d.c.squares < d.before;
  if (better) {
    d.c = d.next;
    std::swap(d.now, d.trial);
  }
  const double gain = d.before - d.c.squares;
  d.share *= 0.5;
  if ((better || !gained) && !(gain > 0.5 * d.promised) && d.share > least_share) {
    for (std::size_t j = 0; j <= d_.flutes; ++j) d.next.x[j] = d.start.x[j] + d.share * d.step[j];
    return;
  }
  // At a kink, where one flute takes over from another, it gains nothing, too.
  d.settled = gain < 1e-10 * d.before;
  d.done = d.settled;
  if (d.done) return;
  if (++d.steps == most_steps) {
    d.settled = gain < 1e-6 * d.c.squares; // slow, and a thousandth of a standard deviation from the minimum
    d.done = true;
    return;
  }
  begin_step(d, limit);
}

void CurveDescents::make_room(std::size_t places) {
  if (places_.size() >= places) return;
  places_.resize(places);
  rows_.resize(5 * places);
  points_ = {&rows_[0], &rows_[places], &rows_[2 * places], &rows_[3 * places], &rows_[4 * places]};
}

/// Points of the curves at places from `first` to `last`, excluded; those of one curve together.
void CurveDescents::look_up(std::size_t first, std::size_t last) {
  for (std::size_t from = first, to = last; from < last; from = to) {
    const CurveTable* table = tables_[from % tables_.size()];
    if (!one_curve_)
      for (to = from + 1; to < last && tables_[to % tables_.size()] == table;) ++to;
    curve_table_kernels().at(*table, to - from, &places_[from], points_.from_row(from));
  }
}

/// Looks where the descents want to.
void CurveDescents::look(const std::vector<Descent*>& descents) {
  const std::size_t n = d_.readings, each = n * d_.flutes, all = each * descents.size();
  make_room(all);
  for (std::size_t j = 0; j < descents.size(); ++j)
    for (std::size_t k = 0; k < d_.flutes; ++k)
      for (std::size_t i = 0; i < n; ++i)
        places_[j * each + k * n + i] = lines_[k * n + i] + descents[j]->next.x[k + 1];
  look_up(0, all);
  for (std::size_t j = 0; j < descents.size(); ++j) {
    Descent& d = *descents[j];
    d.next.squares = judge(d.next.x, j * each, d.trial);
  }
}

/// Which flute makes each reading, from the curves' points from row `first` on. Returns the sum of squares.
double CurveDescents::judge(const Unknowns& x, std::size_t first, Look& out) const {
  const std::size_t n = d_.readings;
  out.box.low.fill(-1e300);
  out.box.high.fill(1e300);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Residual& r = out.residuals[i];
    double best = -1e300, end = 0;
    struct Rival {
      double low, height;
    } rivals[chain::most_inserts];
    for (std::size_t k = 0; k < d_.flutes; ++k) {
      if (!active[k]) continue;
      const std::size_t at = first + k * n + i;
      const double line = lines_[k * n + i], h = x[0] - x[k + 1], low = points_.from[at] - line;
      rivals[k] = {low, x[0] - low + points_.before[at]};
      if (h + points_.height[at] <= best) continue;
      best = h + points_.height[at];
      r.slope = points_.slope[at];
      r.flute = k;
      end = points_.to[at] - line;
    }
    double& high = out.box.high[r.flute];
    high = std::min(high, end);
    for (std::size_t k = 0; k < d_.flutes; ++k)
      if (active[k] && rivals[k].height > best) out.box.low[k] = std::max(out.box.low[k], rivals[k].low);
    r.value = best - d_.heights[i];
    sum += r.value * r.value;
  }
  return sum;
}

/// Gauss-Newton step within the box. Returns the predicted reduction of the sum of squares.
double CurveDescents::best_step(const Candidate& c, const Look& at, Unknowns& step) const {
  const std::size_t n = d_.flutes;
  Unknowns square{}, mixed{}, gradient{};
  for (const Residual& r : at.residuals) {
    const std::size_t k = r.flute + 1;
    const double s = std::clamp(r.slope, -steepest, steepest) - 1;
    square[k] += s * s;
    mixed[k] += s;
    gradient[0] += r.value;
    gradient[k] += s * r.value;
  }
  std::array<bool, chain::most_inserts + 1> held{};
  for (;;) {
    double pivot = static_cast<double>(d_.readings) * (1 + 1e-12), right = -gradient[0];
    for (std::size_t k = 1; k <= n; ++k) {
      if (held[k]) {
        right -= mixed[k] * step[k];
      } else if (square[k] > 0) {
        pivot -= mixed[k] * mixed[k] / square[k];
        right += mixed[k] * gradient[k] / square[k];
      }
    }
    step[0] = right / pivot;
    double worst = 0;
    std::size_t over = 0;
    for (std::size_t k = 1; k <= n; ++k) {
      if (!held[k]) step[k] = square[k] > 0 ? (-gradient[k] - mixed[k] * step[0]) / square[k] : 0.0;
      const double beyond =
          std::max(c.x[k] + step[k] - (at.box.high[k - 1] - inside), at.box.low[k - 1] + inside - (c.x[k] + step[k]));
      if (!held[k] && beyond > worst) worst = beyond, over = k;
    }
    if (over == 0) break;
    held[over] = true;
    const double low = at.box.low[over - 1] + inside - c.x[over], high = at.box.high[over - 1] - inside - c.x[over];
    step[over] = step[over] > 0 ? std::max(high, 0.0) : std::min(low, 0.0);
  }
  double promised = 0; // -(2 g s + s J'J s)
  promised -= 2 * gradient[0] * step[0] + static_cast<double>(d_.readings) * step[0] * step[0];
  for (std::size_t k = 1; k <= n; ++k)
    promised -= 2 * gradient[k] * step[k] + square[k] * step[k] * step[k] + 2 * mixed[k] * step[k] * step[0];
  return promised;
}

bool CurveDescents::known(const Candidate& c) const {
  return std::ranges::any_of(known_, [&](const auto& earlier) {
    const auto& [flutes, at] = earlier;
    bool same = flutes == active && std::fabs(at.x[0] - c.x[0]) < one_minimum;
    for (std::size_t k = 0; k < d_.flutes; ++k)
      same = same && !(active[k] && std::fabs(at.x[k + 1] - c.x[k + 1]) > one_minimum);
    return same;
  });
}

} // namespace gumshoe::models::tool_length
