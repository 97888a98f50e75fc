#include "analysis/moments.h"

#include <array>
#include <cmath>

#include "analysis/leaves.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

/// Sums of eight interleaved series, which do not wait for each other.
using Lanes = std::array<double, 8>;
double total(const Lanes& s) { return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])); }

template <class Add> void each_lane(std::span<const double> x, const Add& add) {
  std::size_t i = 0;
  for (; i + 8 <= x.size(); i += 8)
    for (std::size_t l = 0; l < 8; ++l) add(l, x[i + l]);
  for (; i < x.size(); ++i) add(i % 8, x[i]);
}

struct First {
  double sum = 0, valid = 0;
  void operator+=(const First& other) { sum += other.sum, valid += other.valid; }
};

/// The first that is not NaN; NaN if there is none.
double first_value(const Column& x) {
  Room room;
  for (std::size_t at = 0; at < x.size(); at += piece_values)
    for (const double v : x.read(at, std::min(piece_values, x.size() - at), room))
      if (!std::isnan(v)) return v;
  return nan;
}

struct Central {
  double second = 0, third = 0, fourth = 0;
  void operator+=(const Central& o) { second += o.second, third += o.third, fourth += o.fourth; }
};

void show(Sieve* also, std::span<const double> leaf) {
  if (also) also->take(leaf);
}

} // namespace

Moments first_moments(const Column& x, int threads, Sieve* also) {
  const double origin = first_value(x); // keeps the sum small against its rounding
  if (std::isnan(origin)) return {nan, nan, nan, nan, 0};
  const First sums = leaf_sum<First>(x, threads, [&](std::span<const double> leaf) {
    Lanes sum{}, valid{};
    each_lane(leaf, [&](std::size_t l, double v) {
      sum[l] += v == v ? v - origin : 0.0;
      valid[l] += v == v ? 1.0 : 0.0;
    });
    show(also, leaf);
    return First{total(sum), total(valid)};
  });
  Moments m;
  m.valid = static_cast<std::size_t>(sums.valid);
  m.mean = origin + sums.sum / sums.valid;
  return m;
}

void add_central_moments(Moments& m, const Column& x, int threads, Sieve* also) {
  if (m.valid == 0) return;
  const double n = static_cast<double>(m.valid);
  const Central central = leaf_sum<Central>(x, threads, [&](std::span<const double> leaf) {
    Lanes second{}, third{}, fourth{};
    each_lane(leaf, [&](std::size_t l, double v) {
      const double d = v == v ? v - m.mean : 0.0, square = d * d;
      second[l] += square;
      third[l] += square * d;
      fourth[l] += square * square;
    });
    show(also, leaf);
    return Central{total(second), total(third), total(fourth)};
  });
  const double m2 = central.second / n, m3 = central.third / n, m4 = central.fourth / n;
  m.variance = n > 1 ? m2 * n / (n - 1) : nan;
  m.skewness = m2 > 0 ? m3 / std::pow(m2, 1.5) : 0;
  m.kurtosis = m2 > 0 ? m4 / (m2 * m2) : 0;
}

Moments moments(const Column& x, int threads) {
  Moments m = first_moments(x, threads, nullptr);
  add_central_moments(m, x, threads, nullptr);
  return m;
}

} // namespace gumshoe::analysis
