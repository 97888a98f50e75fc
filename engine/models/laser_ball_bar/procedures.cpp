#include "models/laser_ball_bar/procedures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::models::laser_ball_bar {

namespace {

using Vector = Vector3<double>;

Vector position(const Measured& m) { return {m.tool_x, m.tool_y, m.tool_z}; }

/// Direction of the best line through points, from the first towards the last: the main axis of their scatter.
Vector best_line(const std::vector<Vector>& points) {
  Vector mean;
  for (const Vector& p : points) mean = mean + 1.0 / static_cast<double>(points.size()) * p;
  Symmetric<double, 3> scatter{};
  for (const Vector& p : points) {
    const Vector d = p - mean;
    const double x[] = {d.x, d.y, d.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) scatter.at[i][j] += x[i] * x[j];
  }
  const auto system = eigen_system(scatter);
  const auto main = std::max_element(system.value, system.value + 3) - system.value;
  const Vector line{system.vector[main][0], system.vector[main][1], system.vector[main][2]};
  return dot(line, points.back() - points.front()) < 0 ? -line : line;
}

std::vector<Vector> along(double direction, const Points<double>& all, const std::vector<Measured>& found) {
  std::vector<Vector> out;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (all.at[r].c.motion == direction) out.push_back(position(found[r]));
  return out;
}
constexpr double along_X = 1, along_Z = 3; ///< the condition `motion`

/// Readings at constant feed, when the slides have settled there.
std::vector<std::size_t> steady(const Points<double>& all) {
  std::vector<std::size_t> out;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const auto& c = all.at[r].c;
    const chain::Contour contour = contour_of(c);
    if (const auto* move = contour.move())
      if (c.time >= move->steady_from() + c.settling && c.time <= move->steady_to()) out.push_back(r);
  }
  return out;
}

/// Mean and range of a measurand over readings.
struct Spread { double mean = 0, range = 0; };
template <class Of> Spread spread(const std::vector<std::size_t>& readings, const std::vector<Measured>& found, const Of& of) {
  double sum = 0, low = INFINITY, high = -INFINITY;
  for (const std::size_t r : readings) {
    const double x = of(found[r]);
    sum += x, low = std::fmin(low, x), high = std::fmax(high, x);
  }
  return {sum / static_cast<double>(readings.size()), high - low};
}
double contour_error(const Measured& m) { return m.contour_error; }

std::string check_one(const Points<double>& all, chain::ContourKind kind, const char* what) {
  for (const auto& at : all.at) {
    if (static_cast<int>(at.c.contour) != static_cast<int>(kind))
      return fmt::format("not every reading is of a {}; its condition contour must be {}", what, static_cast<int>(kind));
    auto first = all.at[0].c, same = at.c;
    first.time = same.time = 0;
    if (!std::ranges::equal(std::span(array_of(first), rows_of<Rows::Conditions>), std::span(array_of(same), rows_of<Rows::Conditions>)))
      return fmt::format("readings of one {} differ only in their time, but other conditions differ, too", what);
  }
  return "";
}
std::string check_steady(const Points<double>& all, chain::ContourKind kind, std::size_t fewest, const char* what) {
  if (std::string problem = check_one(all, kind, what); !problem.empty()) return problem;
  if (steady(all).size() < fewest)
    return fmt::format("fewer than {} readings lie in the stretch of constant feed, later than settling; is the feed reached?", fewest);
  return "";
}

/// Numbers of the readings in the order of time.
std::vector<std::size_t> by_time(const Points<double>& all) {
  std::vector<std::size_t> order(all.size());
  for (std::size_t r = 0; r < order.size(); ++r) order[r] = r;
  std::ranges::stable_sort(order, {}, [&](std::size_t r) { return all.at[r].c.time; });
  return order;
}
/// Distance of a point from the straight way between two others.
double from_way(const Vector& point, const Vector& a, const Vector& b) {
  const Vector way = b - a, d = point - a;
  const double whole = dot(way, way), share = whole > 0 ? std::clamp(dot(d, way) / whole, 0.0, 1.0) : 0;
  return length(d - share * way);
}
/// Corners that are passed between the first and the last reading, by the side that begins there.
std::vector<int> passed(const chain::Contour& contour, const Points<double>& all) {
  const auto order = by_time(all);
  std::vector<int> out;
  for (int k = contour.side(all.at[order.front()].c.time) + 1; k <= contour.side(all.at[order.back()].c.time); ++k)
    out.push_back(k);
  return out;
}

} // namespace

FrameRows::Measurands<double> MachineFrame::of(const Points<double>& all, const std::vector<Measured>& found) {
  const auto turn = bars_from_machine(all.at[0].q);
  const Vector z = turn * best_line(along(along_Z, all, found)), x = turn * best_line(along(along_X, all, found));
  const double drop = -dot(x, z);
  return {z.x, z.y, z.z, x.x, x.y, x.z, num::atan2(drop, num::sqrt(1 - drop * drop))};
}
std::string MachineFrame::check(const Points<double>& all) {
  for (const auto& line : {std::pair{along_Z, 'Z'}, {along_X, 'X'}})
    if (std::ranges::count_if(all.at, [&](const auto& at) { return at.c.motion == line.first; }) < 2)
      return fmt::format("a line along {} needs two points or more; their condition motion must be {:g}", line.second,
                         line.first);
  return "";
}

LineRows::Measurands<double> SteadyLine::of(const Points<double>& all, const std::vector<Measured>& found) {
  const auto readings = steady(all);
  const Spread normal = spread(readings, found, contour_error);
  return {normal.mean, normal.range, spread(readings, found, [](const Measured& m) { return m.following_error; }).mean};
}
std::string SteadyLine::check(const Points<double>& all) {
  return check_steady(all, chain::ContourKind::line, 1, "line");
}

CircleRows::Measurands<double> SteadyCircle::of(const Points<double>& all, const std::vector<Measured>& found) {
  const auto readings = steady(all);
  const auto& c = all.at[0].c;
  const chain::Contour contour = contour_of(c);
  const chain::ContourPlane plane(c.angle, c.elevation);
  // Both coordinates in the plane by 1, cos(phi) and sin(phi).
  Symmetric<double, 3> normal{};
  double u[3] = {}, v[3] = {};
  for (const std::size_t r : readings) {
    const double phi = c.sense * contour.angle(all.at[r].c.time), row[] = {1, num::cos(phi), num::sin(phi)};
    const Vector d = position(found[r]) - origin(all.at[r].q) - Vector{c.x, c.y, c.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) normal.at[i][j] += row[i] * row[j];
      u[i] += row[i] * dot(plane.along, d), v[i] += row[i] * dot(plane.left, d);
    }
  }
  solve_cholesky(normal, u), solve_cholesky(normal, v);
  // An ellipse is a circle that turns forth and one that turns back: their radii add up and cancel.
  const double forth_re = (u[1] + v[2]) / 2, forth_im = (v[1] - u[2]) / 2;
  const double back_re = (u[1] - v[2]) / 2, back_im = (v[1] + u[2]) / 2;
  const double forth = std::hypot(forth_re, forth_im), back = std::hypot(back_re, back_im);
  const double azimuth = (num::atan2(forth_im, forth_re) + num::atan2(back_im, back_re)) / 2 + c.angle;
  const double half_turns = std::round(azimuth / std::numbers::pi);
  const Spread radial = spread(readings, found, contour_error);
  return {radial.mean,         radial.range, forth + back,
          std::fabs(forth - back), 2 * std::fmin(forth, back), azimuth - half_turns * std::numbers::pi};
}
std::string SteadyCircle::check(const Points<double>& all) {
  return check_steady(all, chain::ContourKind::circle, 5, "circle");
}


PolygonRows::Measurands<double> Corners::of(const Points<double>& all, const std::vector<Measured>& found) {
  const chain::Contour contour = contour_of(all.at[0].c);
  const auto order = by_time(all);
  double worst = 0;
  for (const int k : passed(contour, all)) {
    const Vector corner = origin(all.at[0].q) + contour.corner(k);
    double nearest = INFINITY;
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
      nearest = std::fmin(nearest, from_way(corner, position(found[order[i]]), position(found[order[i + 1]])));
    worst = std::fmax(worst, nearest);
  }
  double most = 0, least = 0;
  for (const Measured& m : found) most = std::fmax(most, m.contour_error), least = std::fmin(least, m.contour_error);
  return {worst, most, -least};
}
std::string Corners::check(const Points<double>& all) {
  if (std::string problem = check_one(all, chain::ContourKind::polygon, "polygon"); !problem.empty()) return problem;
  if (passed(contour_of(all.at[0].c), all).empty())
    return "the readings pass no corner between two sides of the polygon (all are of one side)";
  return "";
}

} // namespace gumshoe::models::laser_ball_bar
