#pragma once
/// Joint evaluations of the laser ball bars: the machine's frame from motions along Z and X, and what a line or a circle
/// shows at constant feed, and a polygon at its corners.
#include <string>
#include <vector>

#include "math/symmetric.h"
#include "models/block.h"
#include "models/laser_ball_bar/measurement.h"

namespace gumshoe::models::laser_ball_bar {

template <class T> using Points = Together<Rows, T>;
using Measured = Rows::Measurands<double>;

/// What the joint evaluations share: measurands of all readings, as measured or as true, go to J::of.
template <class J> struct OfMeasurands {
  template <class T> struct Memory {
    explicit Memory(const Points<double>&) {}
  };
  template <class T> static auto evaluate(const Points<T>& all, Memory<T>&, Outcome<T>& outcome) {
    std::vector<Rows::Measurands<T>> found;
    for (std::size_t r = 0; r < all.size(); ++r)
      found.push_back(laser_ball_bar::evaluate(all.at[r], all.read[r], outcome));
    return J::of(all, found);
  }
  template <class T, class Shown> static auto truth(const Points<T>& all, const std::vector<Shown>& shown, Outcome<T>&) {
    std::vector<Rows::Measurands<T>> found;
    for (const auto& s : shown) found.push_back(s.measurands);
    return J::of(all, found);
  }
  static std::vector<std::string> remarks(const Points<double>&) { return {}; }
};

struct FrameRows {
  GUMSHOE_NAMED(Measurands, Z_motion_x, Z_motion_y, Z_motion_z, X_motion_x, X_motion_y, X_motion_z, E_B0X);
};
struct LineRows {
  GUMSHOE_NAMED(Measurands, steady_offset, peak_to_valley, following_error);
};
struct CircleRows {
  GUMSHOE_NAMED(Measurands, steady_offset, peak_to_valley, major_axis, minor_axis, axis_difference, major_angle);
};

struct PolygonRows {
  GUMSHOE_NAMED(Measurands, corner_error, overshoot, undershoot);
};

/// Directions of Z and X by best lines, and the squareness between them: appendix A.
struct MachineFrame : OfMeasurands<MachineFrame> {
  template <class T> using Measurands = FrameRows::Measurands<T>;
  using Names = FrameRows::MeasurandsRow;
  static FrameRows::Measurands<double> of(const Points<double>& all, const std::vector<Measured>& found);
  static std::string check(const Points<double>& all);
};

struct SteadyLine : OfMeasurands<SteadyLine> {
  template <class T> using Measurands = LineRows::Measurands<T>;
  using Names = LineRows::MeasurandsRow;
  static LineRows::Measurands<double> of(const Points<double>& all, const std::vector<Measured>& found);
  static std::string check(const Points<double>& all);
};

struct SteadyCircle : OfMeasurands<SteadyCircle> {
  template <class T> using Measurands = CircleRows::Measurands<T>;
  using Names = CircleRows::MeasurandsRow;
  static CircleRows::Measurands<double> of(const Points<double>& all, const std::vector<Measured>& found);
  static std::string check(const Points<double>& all);
};

/// How a polygon's corners are passed.
struct Corners : OfMeasurands<Corners> {
  template <class T> using Measurands = PolygonRows::Measurands<T>;
  using Names = PolygonRows::MeasurandsRow;
  static PolygonRows::Measurands<double> of(const Points<double>& all, const std::vector<Measured>& found);
  static std::string check(const Points<double>& all);
};

} // namespace gumshoe::models::laser_ball_bar
