/// The mill's trigger against a brute-force twin, closed forms and the recomputed numbers of the thesis.
#include <catch2/catch.hpp>

#include <map>
#include <random>

#include "asked.h"
#include "references/mill_brute_force.h"

using namespace gumshoe;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

namespace {

constexpr double pi = 3.14159265358979323846, deg = pi / 180, mm = 1e-3, rpm = 2 * pi / 60;

using Values = std::vector<double>;

Values defaults() {
  Values q;
  for (const auto& card : models::find("tool_length")->card->quantities) q.push_back(card.default_value);
  return q;
}

/// Trigger height through the kernels; NaN and the status if there is none.
struct Outcome {
  double height;
  int status;
};
Outcome trigger_si(const Values& q, double speed, double feed, double angle, double height) {
  const propagation::ForwardModel forward(*models::find("tool_length"), {}, 0, {{speed, feed, angle, height, 0, -1}});
  const auto columns = tests::columns_of(tests::joined(q, {0.0}));
  const auto found = forward.simulate(tests::block_of(forward, 8, columns));
  return {found.measurands[8 * Stated::trigger_height], found.status[0]};
}
Outcome trigger(const Values& q, double angle_deg = 0, double height_mm = 0, double feed_mm_min = 30,
                double speed_rpm = 1000) {
  return trigger_si(q, speed_rpm * rpm, feed_mm_min * mm / 60, angle_deg * deg, height_mm * mm);
}

/// Highest and lowest over whole degrees of the start angle, mm, and where they first come.
struct Curve {
  double high = -1e9, low = 1e9;
  int at_high = 0, at_low = 0;
};
Curve curve(const Values& q, double height_mm = 0, double feed_mm_min = 30) {
  Curve c;
  for (int i = 0; i < 360; ++i) {
    const double z = trigger(q, i, height_mm, feed_mm_min).height / mm;
    if (z > c.high + 1e-9) c.high = z, c.at_high = i;
    if (z < c.low - 1e-9) c.low = z, c.at_low = i;
  }
  return c;
}

struct Draw {
  std::mt19937_64 engine{20240303};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

} // namespace

TEST_CASE("the trigger is the first moment at which the twin sees the share covered", "[references][tool_length]") {
  Draw draw;
  std::map<int, int> inserts;
  int solved = 0, beyond = 0, with_wear = 0;
  for (int n = 0; n < 40; ++n) {
    Values q = defaults();
    q[Row::tool_radius] = draw(6, 14) * mm;
    q[Row::insert_radius] = draw(1, 6) * mm;
    q[Row::insert_thickness] = draw(1, 5) * mm;
    q[Row::clearance_angle] = draw(0, 11) * deg;
    q[Row::insert_radial_angle] = draw(-15, 15) * deg;
    q[Row::insert_axial_angle] = draw(-10, 10) * deg;
    q[Row::inserts] = 1 + n % 6;
    for (int k = 0; k < 6; ++k) q[Row::wear_1 + k] = n % 2 ? draw(0, 0.02) * mm : 0;
    q[Row::holder_angle] = draw(-3, 3);
    const double lowest = q[Row::tool_radius] - q[Row::insert_radius]; // radius of the lowest point, about
    q[Row::offset] = n % 4 == 3 ? draw(1.0, 1.3) * lowest + 0.5 * mm : draw(0, 1) * lowest;
    q[Row::beam_radius] = draw(0.05, 0.4) * mm;
    q[Row::trigger_fraction] = draw(0.2, 0.8);
    if (n % 3 == 0) q[Row::beam_yaw] = draw(-1, 1) * deg, q[Row::beam_pitch] = draw(-1, 1) * deg;
    const double speed = draw(300, 3000) * rpm, feed = draw(3, 60) * mm / 60, angle = draw(0, 2 * pi);
    const double turn = 2 * pi * feed / speed;
    const chain::ProbingEvent<double> event;
    const models::tool_length::InsertHeight heights(mill::insert(tests::named(q), event), models::laser_setter::beam(tests::named(q)));
    if (!heights.ever_covered()) continue;
    const double start = heights.highest().height + draw(0.1, 1.5) * turn;
    const Outcome ours = trigger_si(q, speed, feed, angle, start);
    INFO("case " << n);
    if (ours.status != 0) {
      REQUIRE(ours.status == static_cast<int>(Status::already_covered));
      continue;
    }
    ++solved, ++inserts[static_cast<int>(q[Row::inserts])];
    beyond += q[Row::offset] > lowest, with_wear += n % 2;
    const double target = q[Row::trigger_fraction] * pi * q[Row::beam_radius] * q[Row::beam_radius];
    const double turned = (start - ours.height) / feed * speed;
    const auto most = [&](double s, double raised, int columns) {
      double area = 0;
      for (int k = 0; k < q[Row::inserts]; ++k) {
        const double psi = angle + q[Row::holder_angle] + s + 2 * pi * k / q[Row::inserts];
        area = std::max(area, tests::covered_by_strips(q.data(), psi,
                                                       start - feed / speed * s + q[Row::wear_1 + k] + raised, columns));
      }
      return area;
    };
    // At that moment the share is covered: the height is right to 1e-7 mm. 4000 strips are good for R_l^2 (pi / 4000)^2
    // of area, 1e-8 mm of height for these beams.
    REQUIRE(most(turned, -1e-7 * mm, 4000) > target);
    REQUIRE(most(turned, 1e-7 * mm, 4000) < target);
    // Before it, step by step, it is not; few strips first, many where these come close.
    const double step = 0.5 * deg;
    for (double s = 0; s < turned - 1e-6; s += step)
      if (most(s, 0, 24) > 0.99 * target) REQUIRE(most(s, 0, 4000) < target * (1 + 1e-6));
  }
  REQUIRE(solved >= 25);
  REQUIRE(inserts.size() == 6);
  REQUIRE(beyond >= 3);
  REQUIRE(with_wear >= 10);
}

TEST_CASE("a face-on insert covers a lens of two circles", "[references][tool_length]") {
  for (const double fraction : {0.2, 0.5, 0.8}) {
    Values q = defaults();
    q[Row::insert_radial_angle] = q[Row::insert_axial_angle] = 0;
    q[Row::offset] = q[Row::tool_radius] - q[Row::insert_radius];
    q[Row::trigger_fraction] = fraction;
    const double a = q[Row::insert_radius], b = q[Row::beam_radius];
    const auto lens = [&](double d) {
      return a * a * std::acos((d * d + a * a - b * b) / (2 * d * a)) +
             b * b * std::acos((d * d + b * b - a * a) / (2 * d * b)) -
             0.5 * std::sqrt((a + b - d) * (d + a - b) * (d - a + b) * (d + a + b));
    };
    double lo = a - b, hi = a + b;
    for (int i = 0; i < 100; ++i) (lens(0.5 * (lo + hi)) > fraction * pi * b * b ? lo : hi) = 0.5 * (lo + hi);
    const chain::ProbingEvent<double> event;
    const models::tool_length::InsertHeight heights(mill::insert(tests::named(q), event), models::laser_setter::beam(tests::named(q)));
    // The lens loses digits: its terms are of size a^2, its slope the chord 2 b.
    REQUIRE(std::fabs(heights.at(0.5 * pi, std::nan("")).height - (lo - a)) < 1e-16 * 20 * a * a / b + 1e-14);
  }
}

TEST_CASE("the thesis' examples as recomputed", "[references][tool_length]") {
  const Values q = defaults(); // Table 3.1
  // Printed to 1e-5 mm in the recomputation.
  const auto near = [](double x) { return Approx(x).margin(0.6e-5); };
  REQUIRE(trigger(q).height / mm == near(-0.00637));
  const Curve first = curve(q);
  REQUIRE(first.high == near(-0.00111));
  REQUIRE(first.at_high == 73);
  REQUIRE(first.low == near(-0.01290));
  REQUIRE(first.at_low == 98);
  const Curve higher = curve(q, 0.005);
  REQUIRE(higher.at_high == 13);
  REQUIRE(higher.at_low == 38);
  REQUIRE(curve(q, 0, 10).low == near(-0.00553));
}

TEST_CASE("peaks of a characteristic curve differ by the flutes' wear", "[references][tool_length]") {
  const auto peaks = [](const Values& q, double height_mm, double speed) { // over whole degrees
    std::vector<double> z, found;
    for (int i = 0; i < 360; ++i) z.push_back(trigger(q, i, height_mm, 30, speed).height / mm);
    for (std::size_t i = 0; i < 360; ++i) // the smooth humps; the curve jumps up from its lowest points
      if (z[i] > z[(i + 359) % 360] && z[i] >= z[(i + 1) % 360]) found.push_back(z[i]);
    std::sort(found.rbegin(), found.rend());
    return found;
  };
  // Each flute may pass with two humps, the second lower: the distance from the highest to the nearest peak that is
  // `wear` lower.
  const auto lower_by = [](const std::vector<double>& found, double wear) {
    double nearest = 1e9;
    for (const double z : found)
      if (std::fabs(found[0] - z - wear) < std::fabs(nearest - wear)) nearest = found[0] - z;
    return nearest;
  };
  // A whole degree misses a hump of curvature 4e-3 mm/rad^2 at most by 4e-3 (0.5 deg)^2 / 2 = 2e-7 mm.
  Values q = defaults();
  q[Row::wear_1 + 1] = 0.005 * mm;
  const auto second = peaks(q, 0, 1000);
  REQUIRE(lower_by(second, 0.005) == Approx(0.005).margin(1e-5));
  // Table 3.3, one tooth worn, set-up of Table 3.4.
  q = defaults();
  q[Row::insert_radius] = 5 * mm, q[Row::insert_thickness] = 3.2 * mm;
  q[Row::insert_radial_angle] = -12 * deg, q[Row::insert_axial_angle] = 6 * deg;
  q[Row::holder_angle] = 140 * deg, q[Row::offset] = 4.9 * mm, q[Row::wear_1 + 1] = 0.002 * mm;
  const auto experiment = peaks(q, 5, 1000);
  REQUIRE(176.641 + experiment[0] == Approx(176.6397).epsilon(0).margin(0.6e-4));
  REQUIRE(176.641 + experiment[0] - lower_by(experiment, 0.002) == Approx(176.6377).epsilon(0).margin(0.6e-4));
  // Example 3, offset not printed.
  q = defaults();
  q[Row::tool_radius] = 12 * mm, q[Row::insert_radius] = 5 * mm, q[Row::inserts] = 3, q[Row::offset] = 7 * mm;
  q[Row::wear_1 + 1] = 0.006 * mm, q[Row::wear_1 + 2] = 0.010 * mm;
  const auto third = peaks(q, 0, 500);
  REQUIRE(lower_by(third, 0.006) == Approx(0.006).margin(1e-5));
  REQUIRE(lower_by(third, 0.010) == Approx(0.010).margin(1e-5));
}

TEST_CASE("a trigger curve follows the laws of turning and wear", "[laws][tool_length]") {
  Values q = defaults();
  q[Row::inserts] = 3;
  const double base = trigger(q, 40, 0.5).height;
  // Angles of hundreds of radians, a descent of 5e-6 m per rad: rounding far below 1e-14 m.
  REQUIRE(std::fabs(trigger(q, 160, 0.5).height - base) < 1e-14);
  Values held = q;
  held[Row::holder_angle] = 40 * deg;
  REQUIRE(std::fabs(trigger(held, 0, 0.5).height - base) < 1e-14);
  Values worn = q;
  for (int k = 0; k < 3; ++k) worn[Row::wear_1 + k] = 0.004 * mm;
  REQUIRE(std::fabs(trigger(worn, 40, 0.496).height - (base - 0.004 * mm)) < 1e-14);
  // Flutes beyond `inserts` do not count.
  Values beyond = q;
  beyond[Row::wear_1 + 7] = 0.3 * mm;
  REQUIRE(trigger(beyond, 40, 0.5).height == base);
  // A flute worn by more than the descent from one to the next never shows.
  q[Row::inserts] = 2;
  Values hidden = q, more = q;
  hidden[Row::wear_1 + 1] = 0.1 * mm, more[Row::wear_1 + 1] = 0.2 * mm;
  for (int i = 0; i < 360; i += 15) REQUIRE(trigger(hidden, i, 0.5).height == trigger(more, i, 0.5).height);
}

TEST_CASE("the tool's impossible settings have statuses", "[tool_length]") {
  Values q = defaults();
  const auto status = [](Status s) { return static_cast<int>(s); };
  REQUIRE(trigger(q, 0, 0.5, 0).status == status(Status::out_of_domain));
  REQUIRE(trigger(q, 0, 0.5, 30, 0).status == status(Status::out_of_domain));
  Values far = q;
  far[Row::offset] = 30 * mm;
  REQUIRE(trigger(far, 0, 0.5).status == status(Status::never_covered));
  Values half = q;
  half[Row::inserts] = 2.5;
  REQUIRE(trigger(half, 0, 0.5).status == status(Status::out_of_domain));
  Values worn = q;
  worn[Row::wear_1] = 7 * mm;
  REQUIRE(trigger(worn, 0, 0.5).status == status(Status::out_of_domain));
  Values pointed = q;
  pointed[Row::clearance_angle] = 80 * deg;
  REQUIRE(trigger(pointed, 0, 0.5).status == status(Status::out_of_domain));
  int inside = 0;
  for (int i = 0; i < 360; ++i) inside += trigger(q, i, -0.5).status == status(Status::already_covered);
  REQUIRE(inside > 0);
  REQUIRE(inside < 360);
}

TEST_CASE("evaluate undoes simulate, and derivatives agree with differences", "[laws][tool_length]") {
  const auto* model = models::find("tool_length");
  Values q = defaults();
  q[Row::inserts] = 3;
  q[Row::beam_yaw] = 0.3 * deg, q[Row::beam_pitch] = -0.2 * deg;
  q[Row::wear_1] = 1e-6, q[Row::laser_z] = -0.4;
  Values condition{1000 * rpm, 30 * mm / 60, 0.7, 0.5 * mm, 0, -1};
  const propagation::ForwardModel forward(*model, {}, 0, {condition});
  const double height = trigger_si(q, condition[0], condition[1], condition[2], condition[3]).height;
  const double reading = q[Row::laser_z] + q[Row::tool_length] + height;
  for (std::size_t first = 0; first < tests::quantities; first += 8) {
    std::vector<models::Gradient> x, out;
    for (std::size_t i = 0; i < tests::quantities; ++i)
      x.push_back(i >= first && i < first + 8 ? models::Gradient::variable(q[i], static_cast<int>(i - first))
                                              : models::Gradient(q[static_cast<std::size_t>(i)]));
    x.emplace_back(reading);
    REQUIRE(forward.measurands(0, x, out).status == 0);
    // Sums of numbers below 1 m.
    REQUIRE(std::fabs(out[Stated::tool_length].v - q[Row::tool_length]) < 4e-16);
    REQUIRE(std::fabs(out[Stated::trigger_height].v - height) < 1e-15);
    for (std::size_t i = first; i < std::min(first + 8, tests::quantities); ++i) {
      if (i == Row::inserts) continue;
      const auto at = [&](double h) {
        Values moved = q;
        moved[static_cast<std::size_t>(i)] += h;
        return trigger_si(moved, condition[0], condition[1], condition[2], condition[3]).height;
      };
      const double h = 1e-7, difference = (at(h) - at(-h)) / (2 * h);
      INFO(model->card->quantities[static_cast<std::size_t>(i)].name);
      // Heights to 1e-15 m over steps of 1e-7, and the third derivative's share.
      REQUIRE(out[Stated::trigger_height].d[i - first] ==
              Approx(difference).epsilon(1e-4).margin(5e-7));
    }
  }
}
