#include "models/tool_length/curve_descent.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

namespace {

/// Phases looked at per pitch of a flute, how many of the best are improved, and how many carried to their minimum.
constexpr std::size_t scanned = 192, tried = 24, carried = 4;
/// Noise allowed for while flutes are sought, in steps of the phase.
constexpr std::size_t margins[] = {1, 8};
/// A flute counts as seen if leaving it out raises the squares by this many variances: about one in a hundred that
/// shows nothing passes by chance.
constexpr double needed = 10;
constexpr double turn = 2 * pi;

using Candidate = CurveDescents::Candidate;

/// The best phases of a scan, local minima only.
std::vector<Candidate> scan(const CurveReadings& d, CurveDescents& fitter) {
  const double step = turn * d.drop / static_cast<double>(d.flutes * scanned);
  std::vector<Candidate> best;
  for (const std::size_t margin : margins) {
    const std::size_t stride = (margin + 1) / 2, n = scanned / stride * (d.alike ? 1 : d.flutes);
    std::vector<double> phases(n);
    for (std::size_t s = 0; s < n; ++s) phases[s] = step * static_cast<double>(stride * s);
    const std::vector<Candidate> all = fitter.longest(phases, step * static_cast<double>(margin));
    std::vector<Candidate> lowest;
    for (std::size_t s = 0; s < n; ++s)
      if (all[s].squares <= all[(s + 1) % n].squares && all[s].squares <= all[(s + n - 1) % n].squares)
        lowest.push_back(all[s]);
    std::ranges::stable_sort(lowest, {}, &Candidate::squares);
    if (lowest.size() > tried) lowest.resize(tried);
    best.insert(best.end(), lowest.begin(), lowest.end());
  }
  fitter.settle(best);
  std::ranges::stable_sort(best, {}, &Candidate::squares);
  // Several phases find one minimum.
  const auto twins = std::unique(best.begin(), best.end(), [](const Candidate& a, const Candidate& b) {
    return b.squares - a.squares < 1e-3 * b.squares && std::fabs(a.x[1] - b.x[1]) < one_minimum;
  });
  best.erase(twins, best.end());
  if (best.size() > carried) best.resize(carried);
  return best;
}

/// Greatest height of a hidden flute at which the readings are explained no worse than without it.
double greatest_height(const CurveReadings& d, CurveDescents& fitter, const Candidate& best, std::size_t flute) {
  const std::vector<double> without = fitter.residuals(best.x);
  std::vector<double> triggers(d.readings);
  const auto worse = [&](double h) {
    double sum = 0;
    fitter.triggers(flute, best.x[0] - h, triggers);
    for (std::size_t i = 0; i < d.readings; ++i) {
      const double r = h + triggers[i] - d.heights[i];
      if (r > without[i]) sum += r * r - without[i] * without[i];
    }
    return sum > curve_rounding * static_cast<double>(d.readings);
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
  CurveDescents fitter(d);
  std::fill_n(fitter.active.begin(), d.flutes, true);
  CurveFit fit;
  Candidate best;
  for (Candidate& c : scan(d, fitter)) {
    const bool converged = fitter.descend(c);
    if (c.squares < best.squares) best = c, fit.converged = converged;
    if (best.squares <= curve_rounding * static_cast<double>(d.readings)) break;
  }
  // Flutes that the readings can do without, the most dispensable first.
  int shown = static_cast<int>(d.flutes);
  while (shown > 1) {
    const double freedom = std::max(0.0, static_cast<double>(d.readings) - 1.0 - shown);
    const double allowed = (freedom > 0 ? best.squares * (1 + needed / freedom) : best.squares) +
                           curve_rounding * static_cast<double>(d.readings);
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
    fit.heights[k] = fit.seen[k] ? best.x[0] - best.x[k + 1] : greatest_height(d, fitter, best, k);
  }
  return fit;
}

} // namespace gumshoe::models::tool_length
