/// Laws of the rod model that hold whatever the numbers are.
#include <catch2/catch.hpp>

#include <random>

#include "base/instruction_set.h"
#include "asked.h"
#include "models/rod_gauging/rod_gauging.h"

using namespace gumshoe;
namespace rod = gumshoe::models::rod_gauging;
using Row = rod::Rows::QuantitiesRow;

namespace {

constexpr double deg = std::numbers::pi / 180;

/// Random rods and beams, thin pins and tilts included.
struct Draw {
  std::mt19937_64 engine{20240214};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

std::vector<double> random_quantities(Draw& draw) {
  const double radius = std::pow(10.0, draw(-3.6, -2.0));
  return {radius,           radius * draw(0, 1), draw(60, 100) * deg,   draw(-180, 180) * deg,
          draw(0.1, 0.2),   draw(-3, 3),         draw(-180, 180) * deg, draw(-5, 5) * deg,
          draw(1e-4, 4e-4), draw(0.2, 0.6),      draw(-0.6, 0.1)};
}

/// One reading of n samples, simulated through the block kernel.
struct Run {
  std::vector<double> simulated, bottom, laser;
  std::vector<std::uint8_t> status;
  explicit Run(const std::vector<std::vector<double>>& q) {
    const std::size_t n = q[0].size();
    const propagation::ForwardModel forward(*models::find("rod_gauging"), {}, 0, {{0.01, 600, -1}});
    auto columns = q;
    columns.push_back({0.0}); // no readout
    auto found = forward.simulate(tests::block_of(forward, n, columns));
    simulated = std::move(found.indications), status = std::move(found.status);
    bottom.assign(found.measurands.begin(), found.measurands.begin() + static_cast<std::ptrdiff_t>(n));
    laser.assign(found.measurands.begin() + static_cast<std::ptrdiff_t>(n), found.measurands.end());
  }
};

std::vector<std::vector<double>> random_columns(std::size_t n) {
  Draw draw;
  std::vector<std::vector<double>> columns(models::rows_of<rod::Rows::Quantities>, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto q = random_quantities(draw);
    for (std::size_t j = 0; j < q.size(); ++j) columns[j][i] = q[j];
  }
  return columns;
}

} // namespace

TEST_CASE("lanes give the bits of the scalar solve", "[laws][rod_gauging]") {
  const auto q = random_columns(4096);
  const Run run(q);
  for (std::size_t i = 0; i < 4096; ++i) {
    const auto v = [&](std::size_t j) { return q[j][i]; };
    const auto one = models::rod_gauging::trigger_height(
        {v(Row::rod_radius), v(Row::fillet_radius), v(Row::bottom_elevation), v(Row::bottom_azimuth) + v(Row::holder_angle)},
        {v(Row::beam_yaw), v(Row::beam_pitch), v(Row::beam_radius), v(Row::trigger_fraction)});
    REQUIRE(static_cast<std::uint8_t>(one.status) == run.status[i]);
    if (run.status[i] == 0) REQUIRE(one.value == run.bottom[i]);
  }
}

TEST_CASE("the fast and the general solve agree", "[laws][shadow]") {
  const auto q = random_columns(4096);
  std::size_t fast = 0;
  for (std::size_t i = 0; i < 4096; ++i) {
    const auto v = [&](std::size_t j) { return q[j][i]; };
    const models::rod_gauging::Rod<double> r{v(Row::rod_radius), v(Row::fillet_radius), v(Row::bottom_elevation), v(Row::bottom_azimuth)};
    const models::laser_setter::Beam<double> b{v(Row::beam_yaw), v(Row::beam_pitch), v(Row::beam_radius), v(Row::trigger_fraction)};
    const auto chord = models::rod_gauging::solve_chord<double>(models::rod_gauging::shadow_edge(r, b), b.radius, b.fraction);
    if (chord.failed != 0) continue;
    ++fast;
    const auto general = models::rod_gauging::general_height(r, b);
    REQUIRE(general.status == Status::ok);
    // The stated error of the solver is 1e-12 m; the two share no quadrature and no iteration.
    REQUIRE(std::fabs(models::rod_gauging::bottom_height_of(chord.k, r, b) - general.value) < 1e-13);
  }
  REQUIRE(fast > 300);
}

TEST_CASE("symmetries of the shadow", "[laws][shadow]") {
  Draw draw;
  for (int i = 0; i < 300; ++i) {
    const auto q = random_quantities(draw);
    const models::rod_gauging::Rod<double> r{q[0], q[1], q[2], q[3]};
    const models::laser_setter::Beam<double> b{q[6], q[7], q[8], q[9]};
    const auto at = models::rod_gauging::trigger_height(r, b);
    const auto same = [&](const models::rod_gauging::Rod<double>& r2, const models::laser_setter::Beam<double>& b2) {
      const auto other = models::rod_gauging::trigger_height(r2, b2);
      REQUIRE(other.status == at.status);
      if (at.status == Status::ok) REQUIRE(std::fabs(other.value - at.value) < 1e-14);
    };
    auto turned = r;
    turned.bottom_azimuth += 0.7;
    auto turned_beam = b;
    turned_beam.yaw += 0.7;
    same(turned, turned_beam); // only the azimuth against the beam matters
    auto other_side = r;
    other_side.bottom_elevation = std::numbers::pi - r.bottom_elevation;
    other_side.bottom_azimuth += std::numbers::pi;
    same(other_side, b); // the same plane, its normal named from the other side
    auto against = b;
    against.yaw += std::numbers::pi;
    against.pitch = -b.pitch;
    same(r, against); // a shadow does not know which way the light runs
  }
}

TEST_CASE("a larger share needs a lower rod", "[laws][shadow]") {
  Draw draw;
  for (int i = 0; i < 200; ++i) {
    auto q = random_quantities(draw);
    const models::rod_gauging::Rod<double> r{q[0], q[1], q[2], q[3]};
    const auto low = models::rod_gauging::trigger_height(r, {q[6], q[7], q[8], 0.2}),
               high = models::rod_gauging::trigger_height(r, {q[6], q[7], q[8], 0.25});
    if (low.status == Status::ok && high.status == Status::ok) REQUIRE(high.value < low.value);
  }
}

TEST_CASE("wide pins and ball ends in closed form", "[references][shadow]") {
  // A ball end far larger than the beam is a circle of radius R against a disc of radius R_l: with the
  // lens at half the disc. Square end at pitch 0: a half plane, height 0 at fraction 1/2.
  const auto square = models::rod_gauging::general_height({5e-3, 0, std::numbers::pi / 2, 0}, {0, 0, 2e-4, 0.5});
  REQUIRE(std::fabs(square.value) < 1e-17);
  // Pin narrower than the beam, square: the strip |y| < a is covered down to z = h; in closed form
  // area = a sqrt(R^2-a^2) + R^2 asin(a/R) - 2 a h while the edge stays inside the disc.
  const double a = 1e-4, R = 2e-4, fraction = 0.4;
  const double area = a * std::sqrt(R * R - a * a) + R * R * std::asin(a / R);
  const double h = (area - fraction * std::numbers::pi * R * R) / (2 * a);
  REQUIRE(std::fabs(h) < std::sqrt(R * R - a * a));
  const auto pin = models::rod_gauging::trigger_height({a, 0, std::numbers::pi / 2, 0}, {0, 0, R, fraction});
  REQUIRE(std::fabs(pin.value - h) < 1e-15);
  // The strip holds 0.609 of the disc: less is reached, more never.
  const double most = 2 * area / (std::numbers::pi * R * R);
  REQUIRE(models::rod_gauging::trigger_height({a, 0, std::numbers::pi / 2, 0}, {0, 0, R, most - 1e-6}).status == Status::ok);
  REQUIRE(models::rod_gauging::trigger_height({a, 0, std::numbers::pi / 2, 0}, {0, 0, R, most + 1e-6}).status ==
          Status::never_covered);
}

TEST_CASE("the aligned square rod has a kink in pitch", "[rod_gauging]") {
  const auto at = models::rod_gauging::differentiable_height<models::Gradient>({5e-3, 0.0, std::numbers::pi / 2, 0.0},
                                                                 {0.0, models::Gradient::variable(0.0, 0), 2e-4, 0.5});
  REQUIRE(at.kink);
  const auto beside = models::rod_gauging::differentiable_height<models::Gradient>(
      {5e-3, 0.0, std::numbers::pi / 2, 0.0}, {0.0, models::Gradient::variable(1e-3, 0), 2e-4, 0.5});
  REQUIRE_FALSE(beside.kink);
  REQUIRE(beside.value.d[0] == Approx(5e-3).epsilon(1e-3)); // 5 mm times |pitch|
}
