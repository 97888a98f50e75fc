#pragma once
/// The parts of a turn in which one insert can trigger, and a rigorous search there for its first trigger.
///
/// An insert passes the beam in one or two *windows* of angle: outside them it covers the share at no height above
/// `highest - below`. Inside, where it can be proved that only the cutting edge shows in the beam, the height is that
/// of insert_chord.h, whose bound on every other angle is what the search walks by: nothing is skipped unproved.
#include <array>

#include "models/tool_length/trigger/insert_lines.h"

namespace gumshoe::models::tool_length {

class InsertPass {
public:
  /// Angle at which the lowest point of the cutting edge is nearest to the beam's axis: near the top of a hump of k.
  /// For start values.
  struct Crest {
    double angle;
    double y;     ///< of the lowest point
    double k;     ///< height k
    double blunt; ///< radius of curvature
    bool rises;   ///< the lowest point comes from the side of -y
  };
  struct Window {
    double from, to; ///< angles
    double highest;  ///< no height k inside is above it
    Crest crest;
  };

  InsertPass(const InsertBody<double>& body, const DiscShare& disc);
  /// The windows for heights k from `highest()` down to `below` less; false where no proof is had.
  bool open(double below);
  /// Lowers the windows' own `highest` to about `margin` above their crests where that can be proved.
  void lower(double margin);
  /// Lowers windows whose crests lie further than `far` below `highest()` to near their crests where that is proved:
  /// once for a geometry, whatever the windows.
  void lower_far(double far);
  /// No height k at any angle is above it.
  double highest() const { return highest_; }
  double below() const { return below_; }
  /// Approximate limit of the distance of a hump's top below `highest()`.
  double slack() const { return slack_; }
  int size() const { return size_; }
  const Window& window(int i) const { return window_[static_cast<std::size_t>(i)]; }

  enum class Found { none, crossed, inside, unproved };
  struct Crossing {
    Found found = Found::none;
    double turned = 0;
    double slope = 0; ///< dk / d(angle) there
    int facing = 0;   ///< as shows()
  };
  /// The first angle turned from `first` to `last` with k(angle) >= level - fall turned in a window, where the angle is
  /// turned - shift; `inside` if that holds at `first` itself.
  Crossing first_crossing(const Window& w, double level, double fall, double shift, double first, double last) const;

  const InsertLines& lines() const { return lines_; }
  /// True only if k(angle) + fall (angle - from) < limit at all angles from `from` to `to`: by tangents, or by Phi.
  bool below(double from, double to, double fall, double limit) const;

private:
  /// Bound on the second derivative of Phi by the angle, in a turn; infinite where there is none.
  double curve(const RakeChord& c) const;
  /// By Phi alone, of the share less an area `more`.
  Crossing walk(const Window& w, double level, double fall, double shift, double first, double last,
                double more = 0) const;
  /// Part of the insert visible within the beam's width below it, at all angles of an interval.
  struct Shows {
    int facing = 0;   ///< 1 or -1 as the cutting edge's normal points along the beam or against it; 0: nothing proved
    double flank = 0; ///< area between the cutting edge and the flank below it, at most; 0: only the edge shows
  };
  Shows shows(double from, double to) const;
  bool cleared(const Window& w, double from, double to, int facing, double fall, double limit) const;
  void add(double from, double to, bool rises);
  Crest crest_at(double angle, bool rises) const;
  /// No height k from `from` to `to` is above `highest`.
  struct Top {
    bool tried = false;
    double from = 0, to = -1, highest = 0;
  };
  Top top_of(const Crest& crest) const;
  InsertLines lines_;
  RakeBody body_;
  DiscShare disc_;
  double shrink_share_, spread_, normal_spread_, tilt_;
  double nz_low_, nz_high_, blunt_;
  double highest_, slack_, below_ = -1;
  double amplitude_, phase_, point_, point_error_;
  std::array<Crest, 2> crest_;
  std::array<Window, 2> window_;
  std::array<Top, 2> top_;
  int size_ = 0;
};

} // namespace gumshoe::models::tool_length
