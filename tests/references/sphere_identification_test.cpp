// What the thesis' approximations do to the identification: exact commands reduced with the small-angle product or the
// closed forms instead of the exact chain. Expected: recomputed independently with numpy for Fang 2022, Table 4.7.
#include <catch2/catch.hpp>

#include <cmath>

#include "math/symmetric.h"
#include "laws/sphere_rows.h"

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

namespace {

constexpr double um = 1e-6, deg = 3.14159265358979323846 / 180;

struct Pose33 {
  double B, C;
  bool II;
};

/// r of one length of 1 m alone; r is linear in the lengths in every variant.
Vector3<double> column(int variant, sphere::Links<double> links, int which, const Pose33& pose) {
  for (int i = 0; i < sphere::lengths; ++i) links.length[i] = i == which;
  return sphere::probe_from_origin(variant, links, pose.B, pose.C, pose.II);
}

/// Least squares for the lengths `kept` from the poses of one pattern; the others stay.
void solve(int variant, sphere::Links<double>& links, const std::vector<int>& kept, bool II,
           const std::vector<Pose33>& poses, const std::vector<Vector3<double>>& measured) {
  Symmetric<double, sphere::lengths> normal{};
  double right[sphere::lengths] = {};
  for (std::size_t p = 0; p < poses.size(); ++p) {
    if (poses[p].II != II) continue;
    const auto left = measured[p] - sphere::probe_from_origin(variant, links, poses[p].B, poses[p].C, II);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto a = column(variant, links, kept[i], poses[p]);
      right[i] += dot(a, left);
      for (std::size_t j = 0; j <= i; ++j) normal.at[i][j] += dot(a, column(variant, links, kept[j], poses[p]));
    }
  }
  REQUIRE(solve_cholesky(normal, right, static_cast<int>(kept.size())) > 1e-6);
  for (std::size_t i = 0; i < kept.size(); ++i) links.length[kept[i]] += right[i];
}

} // namespace

TEST_CASE("bias of the sequential method by the thesis' approximations", "[references][sphere_calibration]") {
  std::vector<double> q;
  for (const auto& card : models::find("sphere_calibration")->card->quantities) q.push_back(card.default_value);
  const auto truth = tests::links(q);
  std::vector<Pose33> poses;
  for (int C = 0; C <= 90; C += 5) poses.push_back({0, C * deg, false});
  for (int B = -20; B <= 45; B += 5) poses.push_back({B * deg, 90 * deg, true});
  std::vector<Vector3<double>> measured;
  for (const Pose33& pose : poses)
    measured.push_back(sphere::probe_from_origin(sphere::exact, truth, pose.B, pose.C, pose.II));
  const auto bias = [&](int variant, bool known_C = false) { // known_C: as if pattern I had shown the truth
    auto found = truth;                                      // orientations by the planes are exact: rotations are
    if (!known_C)
      solve(variant, found,
            {sphere::length_probe_x, sphere::length_probe_y, sphere::length_probe_z, sphere::length_C_x,
             sphere::length_C_y},
            false, poses, measured);
    solve(variant, found, {sphere::length_B_x, sphere::length_B_z}, true, poses, measured);
    return std::pair(found.length[sphere::length_B_x] - truth.length[sphere::length_B_x],
                     found.length[sphere::length_B_z] - truth.length[sphere::length_B_z]);
  };
  const auto exact = bias(sphere::exact), closed = bias(sphere::closed_form), small = bias(sphere::small_angle);
  const auto second = bias(sphere::small_angle, true);
  CAPTURE(closed.first, closed.second, small.first, small.second);
  CHECK(std::fabs(exact.first) < 1e-13);
  CHECK(std::fabs(exact.second) < 1e-13);
  CHECK(std::fabs(closed.first - 9.2 * um) < 0.05 * um);
  CHECK(std::fabs(closed.second - 9.0 * um) < 0.05 * um);
  CHECK(std::fabs(small.first + 0.82 * um) < 0.005 * um);
  CHECK(std::fabs(small.second + 10.35 * um) < 0.005 * um);
  CHECK(std::fabs(second.first - 22.9 * um) < 0.05 * um);
  CHECK(std::fabs(second.second + 16.0 * um) < 0.05 * um);
}
