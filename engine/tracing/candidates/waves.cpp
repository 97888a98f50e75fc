#include "tracing/candidates/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

class Waves {
public:
  /// @param indication  the one that waves
  Waves(const Observations& o, const Covariate& c, std::size_t indication)
      : range_(c.levels.back() - c.levels.front()), rows_(index(o.readings * o.indications)),
        every_(index(o.indications)), first_(index(indication)), x_(index(o.readings)) {
    for (std::size_t i = 0; i < o.readings; ++i) x_[index(i)] = (c.value[o.sequence[i]] - c.levels.front()) / range_;
  }

  /// Cosine and sine of so many cycles over the range.
  Matrix columns(double cycles) const {
    Matrix out = Matrix::Zero(rows_, 2);
    const Vector turn = 2 * std::numbers::pi * cycles * x_;
    out(Eigen::seq(first_, Eigen::last, every_), 0) = turn.array().cos();
    out(Eigen::seq(first_, Eigen::last, every_), 1) = turn.array().sin();
    return out;
  }

  /// Cycles over the range that explain most: the best of a grid, then by Brent's method about it.
  double best(double most, const Gain& gain) const {
    const double step = 1.0 / criteria.wave_grid;
    const auto count = static_cast<Index>(std::floor((most - least_cycles) / step)) + 1;
    double found = least_cycles, height = -1;
    for (Index from = 0; from < count; from += at_once) {
      const Index n = std::min(at_once, count - from);
      Matrix pairs(rows_, 2 * n);
      for (Index k = 0; k < n; ++k)
        pairs.middleCols(2 * k, 2) = columns(least_cycles + step * static_cast<double>(from + k));
      Index highest = 0;
      const double here = gain(pairs, 2, criteria.own_wave).maxCoeff(&highest);
      if (here > height) height = here, found = least_cycles + step * static_cast<double>(from + highest);
    }
    const auto loss = [&](double cycles) { return -gain(columns(cycles), 2, criteria.own_wave)[0]; };
    constexpr int bits = 20; // of the cycles: far finer than the data resolve
    return boost::math::tools::brent_find_minima(loss, std::max(least_cycles, found - step),
                                                 std::min(most, found + step), bits)
        .first;
  }

  static constexpr double least_cycles = 2; ///< fewer are a drift or a bend

private:
  double range_;
  Index rows_, every_, first_;
  Vector x_; ///< in the order of measurement, 0 to 1 over the range
};

/// Whether all levels are multiples of a step from the first on, but for a share of it.
bool in_steps(const std::vector<double>& levels, double step, double tolerance) {
  return std::ranges::all_of(levels, [&](double x) {
    const double steps = (x - levels.front()) / step;
    return std::fabs(steps - std::round(steps)) <= tolerance;
  });
}

} // namespace

std::vector<double> places(const Covariate& c) {
  const double near = 0.1 * (c.levels.back() - c.levels.front()) / static_cast<double>(c.levels.size() - 1);
  std::vector<double> out{c.levels.front()};
  for (std::size_t i = 1; i < c.levels.size(); ++i)
    if (c.levels[i] - c.levels[i - 1] > near) out.push_back(c.levels[i]);
  return out;
}

double even_step(const std::vector<double>& levels, double tolerance) {
  const double range = levels.back() - levels.front();
  std::vector<double> gaps;
  for (std::size_t i = 1; i < levels.size(); ++i) gaps.push_back(levels[i] - levels[i - 1]);
  if (gaps.empty()) return 0;
  // Some targets may be missing: a gap is a whole number of steps; or the steps are those of the smallest gap.
  std::vector<double> sorted = gaps;
  std::ranges::sort(sorted);
  const double usual = sorted[sorted.size() / 2];
  double steps = 0;
  for (const double gap : gaps) steps += std::max(1.0, std::round(gap / usual));
  for (const double count : {steps, std::round(range / sorted.front())})
    if (in_steps(levels, range / count, tolerance)) return range / count;
  return 0;
}

double most_cycles(const std::vector<double>& levels) {
  const double step = even_step(levels, criteria.jittered_step), range = levels.back() - levels.front(),
               uneven = criteria.uneven_reach * static_cast<double>(levels.size() - 1) / 2;
  return step > 0 ? std::min(uneven, std::round(range / step) / 2) : uneven;
}

Candidate wave(const Observations& o, const Covariate& c, std::size_t indication, double cycles) {
  Candidate a;
  a.family = Family::shape;
  a.name = "wave:" + c.name + (o.indications > 1 ? " of " + o.names[indication] : "");
  const double range = c.levels.back() - c.levels.front();
  a.shape = fmt::format("period {:.4g}{}", units::from_si(range / cycles, c.unit, c.si_unit, units::Kind::difference),
                        units::suffix(c.unit));
  a.columns = Waves(o, c, indication).columns(cycles);
  a.form = Form::wave;
  a.parameter = cycles;
  a.depends_on = {c.name};
  Amplitude size;
  size.quantity = Amplitude::npos;
  size.name = "size";
  a.amplitudes.assign(2, size);
  return a;
}

std::vector<Candidate> waves(const Observations& o, const std::vector<const Candidate*>& known, const Gain& plain,
                             const Gain& in_time) {
  std::vector<Candidate> out;
  const bool programme =
      std::ranges::any_of(o.covariates, [&](const Covariate& c) { return c.commanded && !c.course; });
  for (const Covariate& c : o.covariates) {
    const Gain& gain = c.course && !c.comes_back && programme ? in_time : plain;
    if (!gain || c.angle || !(c.course || c.commanded) || c.levels.size() < 2) continue;
    const std::vector<double> levels = places(c);
    if (levels.size() <= criteria.levels_for_fine_omnibus) continue;
    const double most = std::min(most_cycles(levels), criteria.most_cycles),
                 usual = std::min(most, static_cast<double>(levels.size() - 1) / 2);
    for (std::size_t i = 0; i < o.indications; ++i) {
      const Waves sought(o, c, i);
      const auto explained = [&](double cycles) { return gain(sought.columns(cycles), 2, criteria.own_wave)[0]; };
      double cycles = sought.best(usual, gain);
      // A short wave must explain clearly more: that a long one is there needs no uneven targets.
      if (most > usual)
        if (const double shorter = sought.best(most, gain); explained(shorter) > explained(cycles) + criteria.split)
          cycles = shorter;
      Candidate a = wave(o, c, i, cycles);
      a.searched = 4 * (cycles > usual ? most : usual);
      const bool resolved = std::ranges::none_of(known, [&](const Candidate* other) {
        return other->name == a.name && std::fabs(other->parameter - a.parameter) < 1;
      });
      if (resolved) out.push_back(std::move(a));
    }
  }
  return out;
}

} // namespace gumshoe::tracing
