#pragma once
/// Path length against time of a commanded move from rest to rest: constant acceleration, or constant jerk where the jerk
/// is limited. Commanded, hence exact: plain doubles in SI.
#include <array>
#include <cmath>
#include <span>

namespace gumshoe::chain {

/// A stretch of constant jerk; path length and its derivatives are those at `begin`.
struct FeedPhase {
  double begin = 0, end = 0; ///< s since the start of the move
  double s = 0, v = 0, a = 0, j = 0;
  double path(double t) const { return s + (t - begin) * (v + (t - begin) * (a / 2 + (t - begin) * j / 6)); }
  double feed(double t) const { return v + (t - begin) * (a + (t - begin) * j / 2); }
  double acceleration(double t) const { return a + (t - begin) * j; }
};

class FeedProfile {
public:
  /// @param length        m, positive
  /// @param feed          m/s, positive; not reached on a short move
  /// @param acceleration  m/s2, positive; not reached where the jerk is low
  /// @param jerk          m/s3; 0: not limited, the acceleration jumps
  FeedProfile(double length, double feed, double acceleration, double jerk) : length_(length) {
    const double v = std::fmin(feed, highest_feed(length, acceleration, jerk));
    const double rise = jerk > 0 ? std::fmin(acceleration / jerk, std::sqrt(v / jerk)) : 0; // of the acceleration
    const double a = jerk > 0 ? rise * jerk : acceleration;
    const double hold = std::fmax(0, v / a - rise);
    const double cruise = std::fmax(0, length / v - (hold + 2 * rise)); // a ramp covers half of its time at v
    add(rise, 0, 0, jerk), add(hold, -1, a, 0), add(rise, -1, a, -jerk);
    steady_from_ = end();
    add(cruise, v, 0, 0);
    steady_to_ = end();
    add(rise, v, 0, -jerk), add(hold, -1, -a, 0), add(rise, -1, -a, jerk);
  }

  std::span<const FeedPhase> phases() const { return {phases_.data(), count_}; }
  double length() const { return length_; }           ///< m
  double end() const { return count_ ? phases_[count_ - 1].end : 0; } ///< s
  double steady_from() const { return steady_from_; } ///< s: the feed is constant from here
  double steady_to() const { return steady_to_; }     ///< s: to here

  /// Path length, m, and feed, m/s, at a time; at rest before and after the move.
  double path(double t) const { return t <= 0 ? 0 : t >= end() ? length_ : at(t).path(t); }
  double feed(double t) const { return t <= 0 || t >= end() ? 0 : at(t).feed(t); }
  /// When a path length from 0 to length() is reached, s: bisection to the last bit.
  double time_at(double path) const {
    double low = 0, high = end();
    for (double middle = high / 2; low < middle && middle < high; middle = (low + high) / 2)
      (this->path(middle) < path ? low : high) = middle;
    return high;
  }

private:
  /// Highest feed that a move of this length reaches, m/s: its first half is the ramp up.
  static double highest_feed(double length, double a, double j) {
    if (!(j > 0)) return std::sqrt(length * a);
    const double v = a / (2 * j) * (std::sqrt(a * a + 4 * length * j * j / a) - a); // v/a + a/j is the ramp's time
    return v >= a * a / j ? v : std::cbrt(length * length * j / 4);
  }
  const FeedPhase& at(double t) const {
    std::size_t i = 0;
    while (i + 1 < count_ && t >= phases_[i].end) ++i;
    return phases_[i];
  }
  /// @param v m/s; negative: that at which the phase before ends
  void add(double duration, double v, double a, double j) {
    if (!(duration > 0)) return;
    FeedPhase& p = phases_[count_++];
    p = {0, duration, 0, std::fmax(v, 0), a, j};
    if (count_ == 1) return;
    const FeedPhase& before = phases_[count_ - 2];
    p.begin = before.end, p.end = p.begin + duration, p.s = before.path(p.begin);
    if (v < 0) p.v = before.feed(p.begin);
  }

  double length_, steady_from_ = 0, steady_to_ = 0;
  std::array<FeedPhase, 7> phases_{};
  std::size_t count_ = 0;
};

} // namespace gumshoe::chain
