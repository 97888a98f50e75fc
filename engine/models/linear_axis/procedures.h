#pragma once
/// Joint evaluations of a linear axis: the figures of ISO 230-2:2014.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "models/block.h"
#include "models/linear_axis/measurement.h"

namespace gumshoe::models::linear_axis {

template <class T> using Readings = Together<Rows, T>;

/// Numbers of the readings at one target, by the side from which it was reached.
struct Target {
  double position = 0; ///< m
  std::vector<std::size_t> up, down;
};
/// What is commanded is the same in every sample: the first number that x holds.
template <class T> double first_number(const T& x) {
  if constexpr (numbers_in < T >> 1)
    return x.get(0);
  else
    return num::value(x);
}

/// In the order in which the targets occur.
template <class T> std::vector<Target> targets_of(const Readings<T>& all) {
  std::vector<Target> out;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const double position = first_number(all.at[r].c.position);
    auto target = std::ranges::find(out, position, &Target::position);
    if (target == out.end()) target = out.insert(out.end(), {position, {}, {}});
    (first_number(all.at[r].c.direction) > 0 ? target->up : target->down).push_back(r);
  }
  return out;
}

/// What is wrong with the readings for figures that need `fewest` runs in each direction; empty if nothing is.
std::string problem_of(const Readings<double>& all, std::size_t fewest);

template <class T> T larger(const T& a, const T& b) { return num::select(a < b, b, a); }

/// Smallest and largest of the values that it has seen.
template <class T> struct Range {
  T low = T(HUGE_VAL), high = T(-HUGE_VAL);
  void see(const T& x) { see(x, x); }
  void see(const T& lower, const T& upper) {
    low = num::select(lower < low, lower, low);
    high = larger(high, upper);
  }
  T width() const { return high - low; }
};

/// Mean m_i and standard deviation s_i of the deviations at one target from one side; s_i = 0 of a single one.
template <class T> struct Unidirectional {
  T mean = T(0.0), deviation = T(0.0);
  Unidirectional(const std::vector<T>& x, const std::vector<std::size_t>& readings) {
    const auto n = static_cast<double>(readings.size());
    for (const std::size_t r : readings) mean = mean + x[r];
    mean = mean / T(n);
    if (readings.size() < 2) return;
    T squares(0.0);
    for (const std::size_t r : readings) squares = squares + (x[r] - mean) * (x[r] - mean);
    deviation = num::sqrt(squares / T(n - 1.0));
  }
};

struct SystematicRows {
  GUMSHOE_NAMED(Measurands, E, E_up, E_down, M, B, mean_reversal);
};
struct AllRows {
  GUMSHOE_NAMED(Measurands, A, A_up, A_down, R, R_up, R_down, E, E_up, E_down, M, B, mean_reversal);
};

/// All figures from the corrected deviations `x` of the readings. Of a single run per direction those with s_i mean
/// nothing.
template <class T> AllRows::Measurands<T> figures_of(const std::vector<Target>& targets, const std::vector<T>& x) {
  Range<T> means_up, means_down, both, limits_up, limits_down;
  T reversal(0.0), sum(0.0), repeatability(0.0), repeatability_up(0.0), repeatability_down(0.0);
  for (const Target& target : targets) {
    const Unidirectional<T> up(x, target.up), down(x, target.down);
    const T jump = up.mean - down.mean, s_up = 2.0 * up.deviation, s_down = 2.0 * down.deviation;
    means_up.see(up.mean), means_down.see(down.mean);
    both.see(0.5 * (up.mean + down.mean));
    limits_up.see(up.mean - s_up, up.mean + s_up), limits_down.see(down.mean - s_down, down.mean + s_down);
    reversal = larger(reversal, T(num::abs(jump)));
    sum = sum + jump;
    repeatability_up = larger(repeatability_up, T(2.0 * s_up));
    repeatability_down = larger(repeatability_down, T(2.0 * s_down));
    repeatability = larger(repeatability, T(s_up + s_down + num::abs(jump)));
  }
  repeatability = larger(repeatability, larger(repeatability_up, repeatability_down));
  Range<T> means = means_up, limits = limits_up;
  means.see(means_down.low, means_down.high), limits.see(limits_down.low, limits_down.high);
  return {limits.width(), limits_up.width(), limits_down.width(),
          repeatability,  repeatability_up,  repeatability_down,
          means.width(),  means_up.width(),  means_down.width(),
          both.width(),   reversal,          sum / T(static_cast<double>(targets.size()))};
}

/// What both evaluations share: F::of takes from all figures those that it has.
template <class F, std::size_t fewest_runs> struct OfDeviations {
  template <class T> struct Memory {
    std::vector<Target> targets;
    explicit Memory(const Readings<double>& all) : targets(targets_of(all)) {}
  };
  template <class T> static auto evaluate(const Readings<T>& all, Memory<T>& memory, Outcome<T>&) {
    std::vector<T> x;
    for (std::size_t r = 0; r < all.size(); ++r)
      x.push_back(linear_axis::evaluate(all.at[r], all.read[r]).corrected_deviation);
    return F::of(figures_of(memory.targets, x));
  }
  template <class T, class Shown>
  static auto truth(const Readings<T>& all, const std::vector<Shown>& shown, Outcome<T>&) {
    std::vector<T> x;
    for (const Shown& s : shown) x.push_back(s.measurands.corrected_deviation);
    return F::of(figures_of(targets_of(all), x));
  }
  static std::string check(const Readings<double>& all) { return problem_of(all, fewest_runs); }
};

struct Figures : OfDeviations<Figures, 2> {
  template <class T> using Measurands = AllRows::Measurands<T>;
  using Names = AllRows::MeasurandsRow;
  template <class T> static Measurands<T> of(const AllRows::Measurands<T>& all) { return all; }
};
struct SystematicFigures : OfDeviations<SystematicFigures, 1> {
  template <class T> using Measurands = SystematicRows::Measurands<T>;
  using Names = SystematicRows::MeasurandsRow;
  template <class T> static Measurands<T> of(const AllRows::Measurands<T>& all) {
    return {all.E, all.E_up, all.E_down, all.M, all.B, all.mean_reversal};
  }
};

} // namespace gumshoe::models::linear_axis
