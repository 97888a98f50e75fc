#include "tracing/findings/period.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "tracing/candidates/waves.h"
#include "tracing/criteria.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

struct Fitted {
  double squares = 0, amplitude = 0;
};

/// A constant, a straight line and a wave of so many cycles over the range.
Fitted fitted(const Vector& x, const Vector& y, double cycles) {
  Matrix a(x.size(), 4);
  const Vector turn = 2 * std::numbers::pi * cycles * x;
  a << Vector::Ones(x.size()), x, turn.array().cos().matrix(), turn.array().sin().matrix();
  const Vector b = a.colPivHouseholderQr().solve(y);
  return {(y - a * b).squaredNorm(), b.tail(2).norm()};
}

/// Whether the places lie in stretches with gaps between them that are far longer than their steps.
bool in_stretches(const Vector& x) {
  std::vector<double> places(x.data(), x.data() + x.size()), gaps;
  std::ranges::sort(places);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i] > places[i - 1]) gaps.push_back(places[i] - places[i - 1]);
  if (gaps.empty()) return false;
  std::ranges::sort(gaps);
  constexpr double far = 5;
  return gaps.back() > far * gaps[gaps.size() / 2];
}

} // namespace

std::vector<double> alike(const Vector& along, const Vector& wave, double period) {
  const double range = along.maxCoeff() - along.minCoeff(), own = range / period;
  const Vector x = (along.array() - along.minCoeff()) / range;
  if (!in_stretches(x)) return {};
  constexpr double nearly = 0.9, step = 0.02, least = 1, octaves = 4, most_work = 2e7;
  const double most = std::min(octaves * own, least + step * most_work / static_cast<double>(x.size()));
  const double all = (wave.array() - wave.mean()).matrix().squaredNorm();
  const auto share = [&](double cycles) { return 1 - fitted(x, wave, cycles).squares / all; };
  // Each run of cycles that explain so much has its best; that with the wave itself is its own.
  std::vector<std::pair<double, double>> found; // share, cycles
  double best = 0, at = 0, from = 0;
  const auto end_of_run = [&](double until) {
    if (best > 0 && !(from - step <= own && own <= until + step)) found.emplace_back(best, at);
    best = 0;
  };
  for (double cycles = least; cycles <= most; cycles += step) {
    const double here = share(cycles);
    if (here < nearly) {
      end_of_run(cycles);
      continue;
    }
    if (best == 0) from = cycles;
    if (here > best) best = here, at = cycles;
  }
  end_of_run(most);
  std::ranges::sort(found, std::greater{});
  constexpr std::size_t told = 4;
  if (found.size() > told) found.resize(told);
  std::vector<double> out;
  for (const auto& [explained, cycles] : found) out.push_back(range / cycles);
  std::ranges::sort(out, std::greater{});
  return out;
}

std::string unit_of_duration(const Covariate& c, double duration) {
  if (c.si_unit != "s" || c.unit != "s") return c.unit;
  for (const auto& [unit, seconds] : {std::pair{"d", 86400.0}, {"h", 3600.0}, {"min", 60.0}})
    if (duration >= 2 * seconds) return unit;
  return "s";
}

std::string shown_period(const Covariate& c, double period) {
  return shown_size(period, unit_of_duration(c, period), c.si_unit);
}

std::string aliases(const Covariate& c, double period) {
  const std::vector<double> levels = places(c);
  const double step = even_step(levels, criteria.uneven_step), range = levels.back() - levels.front();
  if (!(step > 0) || 2 * step * static_cast<double>(levels.size()) < range) return ""; // few of its multiples
  const auto shown = [&](double x) { return shown_period(c, x); };
  // At two steps a period, the first is the wave itself.
  const double longer = 1 / (1 / step - 1 / period), shorter = 1 / (1 / step + 1 / period);
  return fmt::format("; read in steps of {}, {} look{} the same", shown(step),
                     longer < 0.99 * period ? fmt::format("waves of period {} and {}", shown(longer), shown(shorter))
                                            : fmt::format("a wave of period {}", shown(shorter)),
                     longer < 0.99 * period ? "" : "s");
}

std::string wave_of(const CellTable& table, const std::string& unit) {
  if (table.keys.size() != 1 || table.keys[0].x.size() < criteria.levels_of_waves) return "";
  const CellTable::Key& along = table.keys[0];
  const Index n = index(along.x.size());
  const double first = along.x.front(), range = along.x.back() - first;
  Vector x = Eigen::Map<const Vector>(along.x.data(), n), y = Eigen::Map<const Vector>(table.y.data(), n);
  x = (x.array() - first) / range;
  const double most = 0.9 * most_cycles(along.x); // of half the levels only one phase is seen
  double cycles = 2, least = HUGE_VAL;
  for (const double step : {0.05, 0.002}) {
    const double middle = cycles, low = step == 0.05 ? 2 : middle - 0.05, high = step == 0.05 ? most : middle + 0.05;
    for (double k = low; k <= high; k += step)
      if (const double squares = fitted(x, y, k).squares; squares < least) least = squares, cycles = k;
  }
  const Vector about_line = y - [&] {
    Matrix line(n, 2);
    line << Vector::Ones(n), x;
    return Vector(line * line.colPivHouseholderQr().solve(y));
  }();
  const double share = 1 - least / about_line.squaredNorm();
  if (!(share >= criteria.share_of_waves)) return "";
  return fmt::format("a wave of period {} and amplitude {} explains {:.0f} % of it",
                     shown_size(range / cycles, along.unit, along.si_unit),
                     shown_size(fitted(x, y, cycles).amplitude, unit, table.indication_si_unit), 100 * share);
}

} // namespace gumshoe::tracing
