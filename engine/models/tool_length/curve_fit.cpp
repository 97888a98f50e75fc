#include "models/tool_length/curve_fit.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::mill {

namespace {

constexpr int most = chain::most_inserts + 1; ///< unknowns: the phase, then heights
using Unknowns = std::array<double, most>;

/// Phases looked at per pitch of a flute, how many of the best are improved, and how many carried to their minimum.
constexpr std::size_t scanned = 96, tried = 16, carried = 3;
/// A flute counts as seen if leaving it out raises the squares by this many variances: about one in a hundred that
/// shows nothing passes by chance.
constexpr double needed = 10;
/// Error of the tabulated curves, squared.
constexpr double rounding = 2.5e-21;
/// Near the end of a hump the slope grows without bound: what a step may take for one.
constexpr double steepest = 100;

class Fitter {
public:
  explicit Fitter(const CurveReadings& d)
      : d_(d), flutes_(static_cast<int>(d.flutes)), residual_(d.readings), trial_(d.readings) {}

  struct Reading {
    double residual, slope;
    int flute;
  };
  struct Candidate {
    Unknowns x{};
    double squares = 1e300;
  };
  std::array<bool, most> active{}; ///< by flute

  double squares(const Unknowns& x, std::vector<Reading>& out) const {
    double sum = 0;
    for (std::size_t i = 0; i < d_.readings; ++i) {
      Reading best{-1e300, 0, 0};
      for (int k = 0; k < flutes_; ++k) {
        if (!active[static_cast<std::size_t>(k)]) continue;
        const std::size_t ik = i * d_.flutes + static_cast<std::size_t>(k);
        const double h = x[static_cast<std::size_t>(k) + 1];
        if (h + d_.curves[ik]->highest() - d_.heights[i] <= best.residual) continue;
        const auto p = d_.curves[ik]->at(d_.lines[ik] + x[0] - h);
        const double r = h + p.height - d_.heights[i];
        if (r > best.residual) best = {r, p.slope, k};
      }
      out[i] = best;
      sum += best.residual * best.residual;
    }
    return sum;
  }

  /// Every flute as long as the readings allow at this phase: none may trigger more than `margin` before its reading.
  Candidate longest(double phase, double margin) {
    Candidate c;
    c.x[0] = phase;
    for (std::size_t k = 0; k < d_.flutes; ++k) {
      double h = 1e300;
      for (std::size_t i = 0; i < d_.readings; ++i) {
        const std::size_t ik = i * d_.flutes + k;
        const double line = d_.lines[ik] + phase;
        h = std::min(h, line - d_.curves[ik]->record((line - d_.heights[i] - margin) / d_.drop));
      }
      c.x[k + 1] = h;
    }
    c.squares = squares(c.x, residual_);
    return c;
  }

  /// Levenberg-Marquardt. True at a minimum; false where a jump of the residuals stops it.
  bool damped_steps(Candidate& c) {
    c.squares = squares(c.x, residual_);
    double damping = 1e-4;
    for (int iteration = 0; iteration < 60; ++iteration) {
      const double promised = normal_equations();
      if (promised <= 1e-9 * c.squares + 1e-28) return true;
      bool better = false;
      for (int attempt = 0; attempt < 12 && !better; ++attempt) {
        const Candidate next = step(c, damping);
        if (next.squares < c.squares) {
          better = true;
          c = next;
          residual_.swap(trial_);
          damping = std::max(damping * 0.1, 1e-12);
        } else {
          damping *= 8;
        }
      }
      if (!better) return false;
    }
    return false;
  }

  /// The same, then along the directions in which no line slides over its flute's curve, in turn.
  bool descend(Candidate& c) {
    for (int round = 0; round < 20; ++round) {
      if (damped_steps(c) || c.squares <= rounding * static_cast<double>(d_.readings)) return true;
      if (!slide(c)) return true;
    }
    return false;
  }

private:
  /// J'J and J'r from residual_; the drop of the squares that a full step promises.
  double normal_equations() {
    for (auto& row : matrix_) row.fill(0);
    gradient_.fill(0);
    for (const Reading& r : residual_) {
      const double s = std::clamp(r.slope, -steepest, steepest);
      const std::size_t k = static_cast<std::size_t>(r.flute) + 1;
      matrix_[0][0] += s * s;
      matrix_[k][k] += (1 - s) * (1 - s);
      matrix_[k][0] += s * (1 - s);
      gradient_[0] += s * r.residual;
      gradient_[k] += (1 - s) * r.residual;
    }
    const Unknowns full = solved(1e-13);
    double promised = 0;
    for (std::size_t j = 0; j < most; ++j) promised += full[j] * gradient_[j];
    return promised;
  }

  /// (J'J + damping diag) step = J'r. The heights' block is diagonal: eliminate them, then the phase.
  Unknowns solved(double damping) const {
    double phase = matrix_[0][0] * (1 + damping), right = gradient_[0];
    for (std::size_t k = 1; k < most; ++k)
      if (matrix_[k][k] > 0) {
        const double pivot = matrix_[k][k] * (1 + damping);
        phase -= matrix_[k][0] * matrix_[k][0] / pivot;
        right -= matrix_[k][0] * gradient_[k] / pivot;
      }
    Unknowns s{};
    s[0] = phase > 1e-14 * matrix_[0][0] ? right / phase : 0.0;
    for (std::size_t k = 1; k < most; ++k)
      if (matrix_[k][k] > 0) s[k] = (gradient_[k] - matrix_[k][0] * s[0]) / (matrix_[k][k] * (1 + damping));
    return s;
  }

  Candidate step(const Candidate& c, double damping) {
    const Unknowns s = solved(damping);
    Candidate next = c;
    for (std::size_t j = 0; j < most; ++j) next.x[j] -= s[j];
    next.squares = squares(next.x, trial_);
    return next;
  }

  bool slide(Candidate& c) {
    const double before = c.squares;
    const double whole = 2 * 3.14159265358979323846 * d_.drop / static_cast<double>(flutes_);
    for (double length = whole / 16; length > 1e-6 * whole; length *= 0.5)
      for (int direction = 0; direction < 2 * flutes_ + 2; ++direction)
        for (const double sign : {1.0, -1.0}) {
          Candidate next = c;
          const int k = direction / 2; // a height alone or with the phase; all heights with the phase or without
          if (direction % 2) next.x[0] += sign * length;
          for (int j = 0; j < flutes_; ++j)
            if (j == k || k == flutes_) next.x[static_cast<std::size_t>(j) + 1] += sign * length;
          next.squares = squares(next.x, trial_);
          if (next.squares < c.squares) {
            c = next;
            residual_.swap(trial_);
          }
        }
    return c.squares < before * (1 - 1e-6);
  }

  const CurveReadings& d_;
  int flutes_;
  std::vector<Reading> residual_, trial_;
  std::array<std::array<double, most>, most> matrix_{};
  Unknowns gradient_{};
};

using Candidate = Fitter::Candidate;

/// The best phases of a scan, local minima only.
std::vector<Candidate> scan(const CurveReadings& d, Fitter& fitter) {
  const double turn = 2 * 3.14159265358979323846 * d.drop;
  const std::size_t n = scanned * (d.alike ? 1 : d.flutes);
  const double step = turn / static_cast<double>(d.flutes * scanned);
  std::vector<Candidate> all(n), lowest;
  for (std::size_t s = 0; s < n; ++s) all[s] = fitter.longest(step * static_cast<double>(s), step);
  for (std::size_t s = 0; s < n; ++s)
    if (all[s].squares <= all[(s + 1) % n].squares && all[s].squares <= all[(s + n - 1) % n].squares)
      lowest.push_back(all[s]);
  std::ranges::stable_sort(lowest, {}, &Candidate::squares);
  if (lowest.size() > tried) lowest.resize(tried);
  for (Candidate& c : lowest) fitter.damped_steps(c);
  std::ranges::stable_sort(lowest, {}, &Candidate::squares);
  if (lowest.size() > carried) lowest.resize(carried);
  return lowest;
}

/// Greatest height of a hidden flute at which the readings are explained no worse than without it.
double greatest_height(const CurveReadings& d, const Fitter& fitter, const Candidate& best, int flute) {
  std::vector<Fitter::Reading> without(d.readings);
  fitter.squares(best.x, without);
  const auto worse = [&](double h) {
    double sum = 0;
    for (std::size_t i = 0; i < d.readings; ++i) {
      const std::size_t ik = i * d.flutes + static_cast<std::size_t>(flute);
      const double r = h + d.curves[ik]->at(d.lines[ik] + best.x[0] - h).height - d.heights[i];
      if (r > without[i].residual) sum += r * r - without[i].residual * without[i].residual;
    }
    return sum > rounding * static_cast<double>(d.readings);
  };
  const double turn = 2 * 3.14159265358979323846 * d.drop;
  double high = -1e300;
  for (int k = 0; k < static_cast<int>(d.flutes); ++k)
    if (fitter.active[static_cast<std::size_t>(k)]) high = std::max(high, best.x[static_cast<std::size_t>(k) + 1]);
  high += turn;
  double low = high - turn;
  while (worse(low)) high = low, low -= turn;
  while (high - low > 1e-14) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (worse(middle) ? high : low) = middle;
  }
  return low;
}

} // namespace

void curve_heights(const CurveReadings& d, double phase, const double* heights, const bool* seen, double* out) {
  for (std::size_t i = 0; i < d.readings; ++i) {
    out[i] = -1e300;
    for (std::size_t k = 0; k < d.flutes; ++k)
      if (seen[k]) {
        const std::size_t ik = i * d.flutes + k;
        out[i] = std::max(out[i], heights[k] + d.curves[ik]->at(d.lines[ik] + phase - heights[k]).height);
      }
  }
}

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
      fitter.damped_steps(c);
      if (c.squares < reduced.squares) reduced = c, least = static_cast<int>(k);
      fitter.active[k] = true;
    }
    if (reduced.squares > allowed) break;
    best = reduced;
    fitter.active[static_cast<std::size_t>(least)] = false;
    fit.converged = fitter.descend(best);
    --shown;
  }
  const double turn = 2 * 3.14159265358979323846 * d.drop;
  fit.phase = best.x[0] - turn * std::floor(best.x[0] / turn);
  fit.squares = best.squares;
  fit.unknowns = shown + 1;
  for (std::size_t k = 0; k < d.flutes; ++k) {
    fit.seen[k] = fitter.active[k];
    fit.heights[k] = fit.seen[k] ? best.x[k + 1] : greatest_height(d, fitter, best, static_cast<int>(k));
  }
  return fit;
}

} // namespace gumshoe::models::mill
