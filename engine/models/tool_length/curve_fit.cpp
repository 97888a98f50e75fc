#include "models/tool_length/curve_fit.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

namespace {

/// Phase u, then for each flute a_k = u - H_k: u shifts all indications alike, and a flute's curve jumps at values of
/// its own a_k, whatever the rest.
using Unknowns = std::array<double, chain::most_inserts + 1>;

/// Phases looked at per pitch of a flute, how many of the best are improved, and how many carried to their minimum.
constexpr std::size_t scanned = 192, tried = 24, carried = 4;
/// Noise allowed for while flutes are sought, in steps of the phase.
constexpr std::size_t margins[] = {1, 8};
/// A flute counts as seen if leaving it out raises the squares by this many variances: about one in a hundred that
/// shows nothing passes by chance.
constexpr double needed = 10;
/// Error of the tabulated curves, squared.
constexpr double rounding = 2.5e-21;
/// Near the end of a hump the slope grows without bound: what a step may take for one.
constexpr double steepest = 100;
/// How far inside a jump is inside, m.
constexpr double inside = 1e-14;
/// Minima nearer than this are one, m.
constexpr double alike = 1e-9;
constexpr double turn = 2 * pi;

class Fitter {
public:
  explicit Fitter(const CurveReadings& d)
      : d_(d), now_(d), trial_(d), rows_(7 * d.readings * d.flutes), places_(&rows_[5 * d.readings * d.flutes]),
        lines_(&rows_[6 * d.readings * d.flutes]), points_{&rows_[0], &rows_[d.readings * d.flutes],
                                                           &rows_[2 * d.readings * d.flutes],
                                                           &rows_[3 * d.readings * d.flutes],
                                                           &rows_[4 * d.readings * d.flutes]} {
    for (std::size_t k = 0; k < d.flutes; ++k)
      for (std::size_t i = 0; i < d.readings; ++i) lines_[k * d.readings + i] = d.lines[i * d.flutes + k];
  }

  struct Candidate {
    Unknowns x{};
    double squares = 1e300;
  };
  std::array<bool, chain::most_inserts> active{};

  /// Every flute as long as the readings allow at this phase: none may trigger more than `margin` before its reading.
  Candidate longest(double phase, double margin) {
    Candidate c;
    c.x[0] = phase;
    const std::size_t n = d_.readings;
    for (std::size_t k = 0; k < d_.flutes; ++k)
      for (std::size_t i = 0; i < n; ++i)
        places_[k * n + i] = (lines_[k * n + i] + phase - d_.heights[i] - margin) / d_.drop;
    each_curve([&](const TriggerCurve& curve, std::size_t from, std::size_t count) {
      curve.record({places_ + from, count}, points_.height + from);
    });
    for (std::size_t k = 0; k < d_.flutes; ++k) {
      double a = -1e300;
      for (std::size_t i = 0; i < n; ++i) a = std::max(a, points_.height[k * n + i] - lines_[k * n + i]);
      c.x[k + 1] = a;
    }
    c.squares = look(c.x, now_);
    return c;
  }

  double squares(const Unknowns& x, double* residuals) {
    const double sum = look(x, trial_);
    for (std::size_t i = 0; i < d_.readings; ++i) residuals[i] = trial_.residual[i];
    return sum;
  }

  /// Down to the minimum between the jumps around c. False if the steps do not end.
  bool settle(Candidate& c) {
    c.squares = look(c.x, now_);
    double gain = 0;
    for (int iteration = 0; iteration < 50; ++iteration) {
      Unknowns step;
      const double promised = best_step(c.x, step), before = c.squares;
      if (promised <= 1e-9 * before + 1e-30) return true;
      // Where the curve bends strongly a step may overshoot, even if it gains: half of it is tried, too.
      const Candidate start = c;
      for (double share = 1; share > 1e-4; share *= 0.5) {
        Candidate next = start;
        for (std::size_t j = 0; j <= d_.flutes; ++j) next.x[j] += share * step[j];
        next.squares = look(next.x, trial_);
        if (next.squares < c.squares) {
          c = next;
          std::swap(now_, trial_);
        } else if (c.squares < before) {
          break;
        }
        if (before - c.squares > 0.5 * promised) break;
      }
      gain = before - c.squares;
      if (gain < 1e-10 * before) return true; // or at a kink, where one flute takes over from another
    }
    return gain < 1e-6 * c.squares; // slow, and a thousandth of a standard deviation from the minimum
  }

  /// The same, then across the jumps nearby as long as that helps, or until it comes to where an earlier descent began
  /// a round: that one has gone on from there.
  bool descend(Candidate& c) {
    bool settled = settle(c);
    for (int round = 0; round < 50; ++round) {
      if (known(c)) return settled;
      known_.emplace_back(active, c);
      const Candidate before = c;
      const Box box = now_.box;
      for (std::size_t k = 0; k < d_.flutes; ++k) {
        if (!active[k]) continue;
        for (const double across : {box.low[k] - inside, box.high[k] + inside}) {
          if (std::fabs(across) > 1e3) continue;
          Candidate next = before;
          next.x[k + 1] = across;
          const bool done = settle(next);
          if (next.squares < c.squares) c = next, settled = done;
        }
      }
      if (!(c.squares < before.squares)) {
        look(c.x, now_);
        return settled;
      }
      c.squares = look(c.x, now_);
    }
    return false;
  }

private:
  /// Between which values of a_k no indication jumps.
  struct Box {
    std::array<double, chain::most_inserts> low, high;
  };
  struct Look {
    explicit Look(const CurveReadings& d) : residual(d.readings), slope(d.readings), flute(d.readings) {}
    std::vector<double> residual, slope;
    std::vector<std::size_t> flute;
    Box box;
  };

  /// Calls f(curve, from, count) for all flutes' readings, flute by flute, those of one curve together.
  template <class F> void each_curve(const F& f) const {
    const std::size_t n = d_.readings, all = n * d_.flutes;
    const auto curve = [&](std::size_t at) { return d_.curves[at % n * d_.flutes + at / n]; };
    for (std::size_t from = 0, to; from < all; from = to) {
      for (to = from + 1; to < all && curve(to) == curve(from);) ++to;
      f(*curve(from), from, to - from);
    }
  }

  double look(const Unknowns& x, Look& out) const {
    const std::size_t n = d_.readings;
    for (std::size_t k = 0; k < d_.flutes; ++k)
      for (std::size_t i = 0; i < n; ++i) places_[k * n + i] = lines_[k * n + i] + x[k + 1];
    each_curve([&](const TriggerCurve& curve, std::size_t from, std::size_t count) {
      curve.at({places_ + from, count}, points_.from_row(from));
    });
    out.box.low.fill(-1e300);
    out.box.high.fill(1e300);
    double sum = 0;
    for (std::size_t i = 0; i < d_.readings; ++i) {
      double best = -1e300, end = 0;
      struct Rival {
        double low, height;
      } rivals[chain::most_inserts];
      for (std::size_t k = 0; k < d_.flutes; ++k) {
        if (!active[k]) continue;
        const std::size_t ki = k * n + i;
        const double h = x[0] - x[k + 1], low = points_.from[ki] - lines_[ki];
        rivals[k] = {low, x[0] - low + points_.before[ki]};
        if (h + points_.height[ki] <= best) continue;
        best = h + points_.height[ki];
        out.slope[i] = points_.slope[ki];
        out.flute[i] = k;
        end = points_.to[ki] - lines_[ki];
      }
      double& high = out.box.high[out.flute[i]];
      high = std::min(high, end);
      for (std::size_t k = 0; k < d_.flutes; ++k)
        if (active[k] && rivals[k].height > best) out.box.low[k] = std::max(out.box.low[k], rivals[k].low);
      out.residual[i] = best - d_.heights[i];
      sum += out.residual[i] * out.residual[i];
    }
    return sum;
  }

  /// Gauss-Newton step within the box from now_. Returns the predicted reduction of the sum of squares.
  double best_step(const Unknowns& x, Unknowns& step) const {
    const std::size_t n = d_.flutes;
    Unknowns square{}, mixed{}, gradient{};
    for (std::size_t i = 0; i < d_.readings; ++i) {
      const std::size_t k = now_.flute[i] + 1;
      const double s = std::clamp(now_.slope[i], -steepest, steepest) - 1;
      square[k] += s * s;
      mixed[k] += s;
      gradient[0] += now_.residual[i];
      gradient[k] += s * now_.residual[i];
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
            std::max(x[k] + step[k] - (now_.box.high[k - 1] - inside), now_.box.low[k - 1] + inside - (x[k] + step[k]));
        if (!held[k] && beyond > worst) worst = beyond, over = k;
      }
      if (over == 0) break;
      held[over] = true;
      const double low = now_.box.low[over - 1] + inside - x[over], high = now_.box.high[over - 1] - inside - x[over];
      step[over] = step[over] > 0 ? std::max(high, 0.0) : std::min(low, 0.0);
    }
    double promised = 0; // -(2 g s + s J'J s)
    promised -= 2 * gradient[0] * step[0] + static_cast<double>(d_.readings) * step[0] * step[0];
    for (std::size_t k = 1; k <= n; ++k)
      promised -= 2 * gradient[k] * step[k] + square[k] * step[k] * step[k] + 2 * mixed[k] * step[k] * step[0];
    return promised;
  }

  bool known(const Candidate& c) const {
    return std::ranges::any_of(known_, [&](const auto& earlier) {
      const auto& [flutes, at] = earlier;
      bool same = flutes == active && std::fabs(at.x[0] - c.x[0]) < alike;
      for (std::size_t k = 0; k < d_.flutes; ++k)
        same = same && !(active[k] && std::fabs(at.x[k + 1] - c.x[k + 1]) > alike);
      return same;
    });
  }

  const CurveReadings& d_;
  Look now_, trial_;
  std::vector<std::pair<std::array<bool, chain::most_inserts>, Candidate>> known_; ///< where rounds began
  std::vector<double> rows_;
  double *places_, *lines_; ///< [flute][reading]
  CurvePoints points_;      ///< likewise
};

using Candidate = Fitter::Candidate;

/// The best phases of a scan, local minima only.
std::vector<Candidate> scan(const CurveReadings& d, Fitter& fitter) {
  const double step = turn * d.drop / static_cast<double>(d.flutes * scanned);
  std::vector<Candidate> best;
  for (const std::size_t margin : margins) {
    const std::size_t stride = (margin + 1) / 2, n = scanned / stride * (d.alike ? 1 : d.flutes);
    std::vector<Candidate> all(n), lowest;
    for (std::size_t s = 0; s < n; ++s)
      all[s] = fitter.longest(step * static_cast<double>(stride * s), step * static_cast<double>(margin));
    for (std::size_t s = 0; s < n; ++s)
      if (all[s].squares <= all[(s + 1) % n].squares && all[s].squares <= all[(s + n - 1) % n].squares)
        lowest.push_back(all[s]);
    std::ranges::stable_sort(lowest, {}, &Candidate::squares);
    if (lowest.size() > tried) lowest.resize(tried);
    best.insert(best.end(), lowest.begin(), lowest.end());
  }
  for (Candidate& c : best) fitter.settle(c);
  std::ranges::stable_sort(best, {}, &Candidate::squares);
  // Several phases find one minimum.
  const auto twins = std::unique(best.begin(), best.end(), [](const Candidate& a, const Candidate& b) {
    return b.squares - a.squares < 1e-3 * b.squares && std::fabs(a.x[1] - b.x[1]) < alike;
  });
  best.erase(twins, best.end());
  if (best.size() > carried) best.resize(carried);
  return best;
}

/// Greatest height of a hidden flute at which the readings are explained no worse than without it.
double greatest_height(const CurveReadings& d, Fitter& fitter, const Candidate& best, int flute) {
  std::vector<double> without(d.readings);
  fitter.squares(best.x, without.data());
  const auto worse = [&](double h) {
    double sum = 0;
    for (std::size_t i = 0; i < d.readings; ++i) {
      const std::size_t ik = i * d.flutes + static_cast<std::size_t>(flute);
      const double r = h + d.curves[ik]->at(d.lines[ik] + best.x[0] - h).height - d.heights[i];
      if (r > without[i]) sum += r * r - without[i] * without[i];
    }
    return sum > rounding * static_cast<double>(d.readings);
  };
  double high = -1e300;
  for (std::size_t k = 0; k < d.flutes; ++k)
    if (fitter.active[k]) high = std::max(high, best.x[0] - best.x[k + 1]);
  const double period = turn * d.drop;
  high += period;
  double low = high - period;
  while (worse(low)) high = low, low -= period;
  while (high - low > 1e-14) {
    const double middle = 0.5 * (low + high);
    (worse(middle) ? high : low) = middle;
  }
  return low;
}

} // namespace

CurveFit fit_curve(const CurveReadings& d) {
  Fitter fitter(d);
  std::fill_n(fitter.active.begin(), d.flutes, true);
  CurveFit fit;
  Candidate best;
  for (Candidate& c : scan(d, fitter)) {
    const bool converged = fitter.descend(c);
    if (c.squares < best.squares) best = c, fit.converged = converged;
    if (best.squares <= rounding * static_cast<double>(d.readings)) break;
  }
  // Flutes that the readings can do without, the most dispensable first.
  int shown = static_cast<int>(d.flutes);
  while (shown > 1) {
    const double freedom = std::max(0.0, static_cast<double>(d.readings) - 1.0 - shown);
    const double allowed = (freedom > 0 ? best.squares * (1 + needed / freedom) : best.squares) +
                           rounding * static_cast<double>(d.readings);
    int least = -1;
    Candidate reduced;
    for (std::size_t k = 0; k < d.flutes; ++k) {
      if (!fitter.active[k]) continue;
      fitter.active[k] = false;
      Candidate c = best;
      fitter.descend(c);
      if (c.squares < reduced.squares) reduced = c, least = static_cast<int>(k);
      fitter.active[k] = true;
    }
    if (reduced.squares > allowed) break;
    best = reduced;
    fitter.active[static_cast<std::size_t>(least)] = false;
    fit.converged = fitter.descend(best);
    --shown;
  }
  const double period = turn * d.drop;
  fit.phase = best.x[0] - period * std::floor(best.x[0] / period);
  fit.squares = best.squares;
  for (std::size_t k = 0; k < d.flutes; ++k) {
    fit.seen[k] = fitter.active[k];
    fit.heights[k] = fit.seen[k] ? best.x[0] - best.x[k + 1] : greatest_height(d, fitter, best, static_cast<int>(k));
  }
  return fit;
}

} // namespace gumshoe::models::tool_length
