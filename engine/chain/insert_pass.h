#pragma once
/// Where in a turn one insert can trigger at all, and a rigorous search there for its first trigger.
///
/// An insert passes the beam in one or two *windows* of angle: outside them it covers the share at no height above
/// `highest - below`. Inside, where it can be proved that only the cutting edge shows in the beam, the height is that
/// of insert_chord.h, whose bound on every other angle is what the search walks by: nothing is skipped unproved.
#include <array>

#include "chain/insert_chord.h"

namespace gumshoe::chain {

/// Angles from `from` to `to`.
struct PassWindow {
  double from = 0, to = 0;
  double highest = 0; ///< no height k inside is above it
  double crest = 0;   ///< about where the lowest point is nearest to the beam's axis
  double crest_y = 0; ///< y of the lowest point there
  double crest_k = 0; ///< about the height there
  double blunt = 0;   ///< about its radius of curvature
  bool rises = true;  ///< the lowest point moves towards +y at `from`
};

class InsertPass {
public:
  InsertPass(const InsertBody<double>& body, const DiscShare& disc);
  /// The windows for heights k from `highest()` down to `below` less; false where no proof is had.
  bool open(double below);
  /// No height k at any angle is above it.
  double highest() const { return highest_; }
  double below() const { return below_; }
  /// What a hump's top may at most lie below `highest()`, about.
  double slack() const { return slack_; }
  int size() const { return size_; }
  const PassWindow& window(int i) const { return window_[static_cast<std::size_t>(i)]; }

  enum class Found { none, crossed, inside, unproved };
  struct Crossing {
    Found found = Found::none;
    double turned = 0;
    double slope = 0; ///< dk / d(angle) there
  };
  /// The first angle turned from `first` to `last` with k(angle) >= level - fall turned in a window, where the angle is
  /// turned - shift; `inside` if that holds at `first` itself.
  Crossing first_crossing(const PassWindow& w, double level, double fall, double shift, double first,
                          double last) const;

private:
  Crossing walk(const PassWindow& w, double level, double fall, double shift, double first, double last) const;
  /// Only the cutting edge shows within the beam's width, at all angles of the interval inside a window.
  bool only_edge(double from, double to) const;
  void add(double from, double to, double crest, bool rises);
  RakeBody body_;
  DiscShare disc_;
  double shrink_share_, spread_, normal_spread_, tilt_;
  double nz_low_, nz_high_, blunt_;
  double highest_, slack_, below_ = -1;
  double amplitude_, phase_, point_, point_error_;
  std::array<PassWindow, 2> window_;
  int size_ = 0;
};

} // namespace gumshoe::chain
