/// Laws of the rod model that hold whatever the numbers are.
#include <catch2/catch.hpp>

#include <random>

#include "base/instruction_set.h"
#include "asked.h"
#include "models/rod_gauging/rod_gauging.h"

using namespace gumshoe;
namespace rod = gumshoe::models::rod_gauging;

namespace {

constexpr double deg = std::numbers::pi / 180;

/// Random rods and beams, thin pins and tilts included, and all effects at random sizes.
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

/// Those that a rod can carry.
std::vector<std::size_t> applicable() {
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < effects::cards().size(); ++e)
    if (effects::applies(*models::find("rod_gauging")->card, *effects::cards()[e])) found.push_back(e);
  REQUIRE(found.size() == 8);
  return found;
}
std::vector<effects::Active> all_effects() {
  std::vector<effects::Active> active;
  std::size_t at = 0;
  for (const std::size_t e : applicable()) {
    active.push_back({e, at});
    at += effects::cards()[e]->quantities.size();
  }
  return active;
}
std::vector<double> null_values() {
  std::vector<double> values;
  for (const std::size_t e : applicable())
    for (const QuantityCard& q : effects::cards()[e]->quantities) values.push_back(q.default_value);
  return values;
}

/// One reading of n samples through the block kernels.
struct Run {
  std::vector<double> simulated, bottom, laser;
  std::vector<std::uint8_t> status;
  Run(const std::vector<std::vector<double>>& q, const std::vector<double>& e,
      const std::vector<effects::Active>& active, const std::vector<double>* readings,
      std::vector<double> condition = {0.01, 600, -1}) {
    const std::size_t n = q[0].size();
    const propagation::ForwardModel forward(*models::find("rod_gauging"), tests::cards_of(active), 0, {condition});
    auto columns = tests::joined(q, tests::columns_of(e));
    columns.push_back(readings ? *readings : std::vector<double>{0.0});
    const auto block = tests::block_of(forward, n, columns);
    auto found = readings ? forward.evaluate(block) : forward.simulate(block);
    simulated = std::move(found.indications), status = std::move(found.status);
    bottom.assign(found.measurands.begin(), found.measurands.begin() + static_cast<std::ptrdiff_t>(n));
    laser.assign(found.measurands.begin() + static_cast<std::ptrdiff_t>(n), found.measurands.end());
  }
};

std::vector<std::vector<double>> random_columns(std::size_t n) {
  Draw draw;
  std::vector<std::vector<double>> columns(rod::count, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto q = random_quantities(draw);
    for (std::size_t j = 0; j < q.size(); ++j) columns[j][i] = q[j];
  }
  return columns;
}

} // namespace

TEST_CASE("evaluate undoes simulate, with every effect active", "[laws][rod_gauging]") {
  const auto q = random_columns(4096);
  Draw draw;
  std::vector<double> e;
  for (const std::size_t effect : applicable())
    for (const QuantityCard& quantity : effects::cards()[effect]->quantities)
      e.push_back(quantity.role == Role::shape ? quantity.default_value : draw(0.01, 0.05) * quantity.limits.high);
  const auto active = all_effects();
  const Run there(q, e, active, nullptr);
  const Run back(q, e, active, &there.simulated);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < 4096; ++i) {
    REQUIRE(there.status[i] == back.status[i]);
    if (there.status[i] != 0) continue;
    ++valid;
    // Sums of numbers below 1 m: a few roundings of 1.1e-16.
    REQUIRE(std::fabs(back.laser[i] - q[rod::laser_z][i]) < 2e-15);
    REQUIRE(back.bottom[i] == there.bottom[i]);
  }
  REQUIRE(valid > 2000);
}

TEST_CASE("effects at null change nothing, bit for bit", "[laws][effects]") {
  const auto q = random_columns(2048);
  const Run without(q, {}, {}, nullptr);
  const Run with(q, null_values(), all_effects(), nullptr);
  for (std::size_t i = 0; i < 2048; ++i) {
    REQUIRE(without.status[i] == with.status[i]);
    if (without.status[i] == 0) REQUIRE(without.simulated[i] == with.simulated[i]);
  }
}

TEST_CASE("lanes give the bits of the scalar solve", "[laws][rod_gauging]") {
  const auto q = random_columns(4096);
  const Run run(q, {}, {}, nullptr);
  for (std::size_t i = 0; i < 4096; ++i) {
    const auto v = [&](int j) { return q[static_cast<std::size_t>(j)][i]; };
    const auto one = models::rod_gauging::trigger_height(
        {v(rod::radius), v(rod::fillet), v(rod::elevation), v(rod::azimuth) + v(rod::holder_angle)},
        {v(rod::yaw), v(rod::pitch), v(rod::beam_radius), v(rod::fraction)});
    REQUIRE(static_cast<std::uint8_t>(one.status) == run.status[i]);
    if (run.status[i] == 0) REQUIRE(one.value == run.bottom[i]);
  }
}

TEST_CASE("the fast and the general solve agree", "[laws][shadow]") {
  const auto q = random_columns(4096);
  std::size_t fast = 0;
  for (std::size_t i = 0; i < 4096; ++i) {
    const auto v = [&](int j) { return q[static_cast<std::size_t>(j)][i]; };
    const models::rod_gauging::Rod<double> r{v(rod::radius), v(rod::fillet), v(rod::elevation), v(rod::azimuth)};
    const models::laser_setter::Beam<double> b{v(rod::yaw), v(rod::pitch), v(rod::beam_radius), v(rod::fraction)};
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

TEST_CASE("derivatives agree with differences, second ones with differences of first", "[laws][rod_gauging]") {
  const propagation::ForwardModel forward(*models::find("rod_gauging"), {}, 0, {{0.01, 600, -1}});
  Draw draw;
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    auto q = random_quantities(draw);
    const auto gradient_at = [&](const std::vector<double>& at, int first) {
      std::vector<models::Gradient> x(at.begin(), at.end());
      for (int j = first; j < std::min<int>(first + 8, rod::count); ++j)
        x[static_cast<std::size_t>(j)] = models::Gradient::variable(at[static_cast<std::size_t>(j)], j - first);
      x.emplace_back(0.0); // the readout
      std::vector<models::Gradient> y;
      const auto outcome = forward.measurands(0, x, y);
      return std::pair{y[0], outcome};
    };
    const auto [value, outcome] = gradient_at(q, 0);
    if (outcome.status != 0 || outcome.kink) continue;
    for (std::size_t j : {0u, 1u, 2u, 3u, 6u, 7u}) {
      // Central differences of an exact solver: error h^2 f'''/6 + 1e-16/h; h = 1e-5 of the quantity's scale.
      const double h = 1e-5 * (j < 2 ? q[0] : 1.0);
      auto up = q, down = q;
      up[j] += h, down[j] -= h;
      if (j == 1 && (down[1] < 0 || up[1] > q[0])) continue;
      const auto above = gradient_at(up, 0), below = gradient_at(down, 0);
      if (above.second.status != 0 || below.second.status != 0) continue;
      const double difference = (above.first.v - below.first.v) / (2 * h);
      const double scale = std::fabs(difference) + (j < 2 ? 1e-2 : 1e-5);
      INFO("case " << i << " quantity " << j << " dual " << value.d[j] << " difference " << difference);
      if (std::fabs(above.first.d[j] - below.first.d[j]) > 1e-2 * scale) continue; // a kink or a steep bend between
      CHECK(std::fabs(value.d[j] - difference) < 1e-3 * scale);
      ++compared;
    }
  }
  REQUIRE(compared > 150);
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
