#pragma once
/// Zc(psi): the highest height of the tool's centre at which an insert at spindle angle psi covers the trigger's share
/// of the beam. Geometry alone; the motion comes in insert_trigger.h.
#include <array>

#include "chain/insert_cover.h"

namespace gumshoe::chain {

struct HeightNode {
  double angle = 0;
  double height = 0; ///< of the tool's centre above the laser reference point, m
  double slope = 0;  ///< by the angle, m/rad
  bool covered = false;
  double most = 0; ///< not covered: the largest area reached at any height
};

class InsertHeight {
public:
  InsertHeight(const Insert<double>& insert, const Beam<double>& beam);

  /// Absolute error below 1e-13 m. `hint`: a height nearby, or NaN.
  HeightNode at(double angle, double hint) const;
  /// Evenly spread over one turn.
  int coarse_size() const { return size_; }
  const HeightNode& coarse(int i) const { return coarse_[static_cast<std::size_t>(i)]; }
  double coarse_step() const { return step_; }
  /// Below this width in angle Zc is taken to have one hump or valley at most.
  double resolution() const { return resolution_; }
  bool ever_covered() const { return ever_covered_; }
  /// The highest height over all angles; only if ever_covered().
  const HeightNode& highest() const { return highest_; }

  const InsertBody<double>& body() const { return body_; }
  double target() const { return target_; }

private:
  void search(const HeightNode& a, const HeightNode& b);
  void seek_narrow_cover();
  InsertBody<double> body_;
  double beam_radius_, target_;
  std::array<HeightNode, 721> coarse_;
  int size_ = 0;
  double step_ = 0, resolution_ = 0;
  bool ever_covered_ = false;
  HeightNode highest_;
};

/// Where d(height + drift angle)/d(angle) changes from + to -, between two nodes where it does.
HeightNode hump(const InsertHeight& heights, HeightNode a, HeightNode b, double drift);

} // namespace gumshoe::chain
