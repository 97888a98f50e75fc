/// Each effect of a turning tool against the size and sign that its card states.
#include <catch2/catch.hpp>

#include "laws/mill_fixture.h"

using namespace gumshoe;
using tests::Draw;
using tests::Mill;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

namespace {

constexpr double pi = std::numbers::pi, mm = Mill::mm, um = Mill::um, ms = Mill::ms, deg = Mill::deg, rpm = Mill::rpm;

/// Readings to rounding: heights come from angles of some 100 rad times 5e-6 m/rad, lengths below 1 m.
constexpr double rounding = 2e-14;

} // namespace

TEST_CASE("a delay of the feed turns the curve by 6 N dt degrees", "[effects][tool_length]") {
  const Mill m;
  for (const double dt : {3 * ms, -20 * ms, 0.25}) {
    const Mill turned = m.under(Commanded::start_angle, m.condition[Commanded::start_angle] + 6 * 1000 * dt * deg);
    REQUIRE(std::fabs(m.with("feed_start_delay", {dt}).reading() - turned.reading()) < rounding);
    REQUIRE(std::fabs(m.reading() - turned.reading()) > 1e-9); // not for nothing
  }
}

TEST_CASE("an error of the spindle speed is another speed", "[effects][tool_length]") {
  const Mill m;
  for (const double e : {0.01, -0.002})
    REQUIRE(std::fabs(m.with("spindle_speed_error", {e}).reading() -
                      m.under(Commanded::spindle_speed, m.condition[Commanded::spindle_speed] * (1 + e)).reading()) < rounding);
  // A delay is turned through at the true speed.
  REQUIRE(m.with("spindle_speed_error", {0.01}).with("feed_start_delay", {0.1}).event().tool.turns_before_feed ==
          Approx(1010 * rpm * 0.1).epsilon(1e-14));
}

TEST_CASE("what truly moves the tool's centre moves it at the start, too", "[effects][tool_length]") {
  // Tool longer by g: the reading of a feed from g lower, g higher. Axis lower by s than its scale says: likewise.
  const Mill m;
  const double h = m.condition[Commanded::start_height];
  const auto raised = [&](double by) { return m.under(Commanded::start_height, h - by).reading() + by; };
  const double t = m.condition[Commanded::time];
  REQUIRE(std::fabs(m.with("reclamp", {3 * um}).reading() - raised(3 * um)) < rounding);
  REQUIRE(std::fabs(m.with("rod_expansion", {11.5e-6, 5}).reading() - raised(0.150 * 11.5e-6 * 5)) < rounding);
  REQUIRE(std::fabs(m.with("thermal_growth", {2 * um / 3600, 0}).reading() - raised(2 * um / 3600 * t)) < rounding);
  REQUIRE(std::fabs(m.with("z_reversal", {4 * um}).reading() - raised(-2 * um)) < rounding);
  const auto spindle = [&](double a, double b) {
    return 0.01 * (a + b * (1 - std::exp(-t / 600))); // a tenth of 10 000 rpm
  };
  REQUIRE(std::fabs(m.with("spindle_axial_shift", {40 * um, 90 * um, 600}).reading() -
                    raised(spindle(40 * um, 90 * um))) < rounding);
  // Four times as much at twice the speed.
  const Mill fast = m.under(Commanded::spindle_speed, 2000 * rpm);
  REQUIRE(fast.with("spindle_axial_shift", {40 * um, 0}).event().z.error ==
          Approx(4 * m.with("spindle_axial_shift", {40 * um, 0}).event().z.error).epsilon(1e-14));
  // Scale: the axis stands E Z farther, at the start by the start's Z, and falls 1 + E as fast.
  const double E = 20e-6, start = -0.5 + 0.150 + h;
  const Mill scaled = m.under(Commanded::start_height, h + E * start).under(Commanded::feed, m.condition[Commanded::feed] * (1 + E));
  REQUIRE(std::fabs(m.with("z_scale", {E}).reading() * (1 + E) - scaled.reading()) < rounding);
}

TEST_CASE("latency lowers the reading and leaves height and phase", "[effects][tool_length]") {
  const Mill m, late = m.with("trigger_latency", {2 * ms});
  REQUIRE(late.height() == m.height());
  REQUIRE(late.reading() - m.reading() == Approx(-30 * mm / 60 * 2 * ms).epsilon(1e-9));
}

TEST_CASE("eccentricity along one flute's azimuth is that flute's radius, and a cosine for the others",
          "[effects][tool_length]") {
  const double e = 12 * um;
  const Mill m = Mill().where(Row::inserts, 2);
  const Mill seats = m.with("insert_seat_error", {e, -e});
  for (int i = 0; i < 36; ++i) {
    const double angle = 10 * deg * i;
    REQUIRE(std::fabs(m.with("tool_runout", {e, 0}).under(Commanded::start_angle, angle).reading() -
                      seats.under(Commanded::start_angle, angle).reading()) < rounding);
  }
  const Mill five = m.where(Row::inserts, 5).with("tool_runout", {3 * um, 4 * um});
  const auto event = five.event();
  for (int k = 0; k < 5; ++k) {
    const auto f = mill::flute(tests::named(five.q), event, k);
    const double azimuth = 2 * pi * k / 5 - std::atan2(4, 3);
    REQUIRE(f.insert.tool_radius - 10 * mm == Approx(5 * um * std::cos(azimuth)).margin(1e-17));
    REQUIRE(f.insert.seat == Approx(-5 * um * std::sin(azimuth)).margin(1e-17));
    REQUIRE(f.raise == 0);
    REQUIRE(f.insert.radial_angle == five.q[Row::insert_radial_angle]);
  }
}

TEST_CASE("a tilted tool's inserts are the same bodies, turned", "[effects][tool_length]") {
  // Points of both circles of every insert, turned one by one, lie on the circles of the flute that run_out gives.
  Draw draw;
  double moved = 0;
  for (int n = 0; n < 30; ++n) {
    const Mill straight = Mill::random(draw);
    const double x = draw(-0.1, 0.1), y = draw(-0.1, 0.1), ex = draw(-0.5, 0.5) * mm, ey = draw(-0.5, 0.5) * mm;
    const Mill tilted = straight.with("tool_runout", {ex, ey, x, y});
    const models::laser_setter::Beam<double> level{0, 0, 2e-4, 0.5};
    for (int k = 0; k < straight.q[Row::inserts]; ++k) {
      auto before = mill::flute(tests::named(straight.q), straight.event(), k);
      auto after = mill::flute(tests::named(tilted.q), tilted.event(), k);
      REQUIRE(after.azimuth == before.azimuth);
      const auto a = models::tool_length::insert_body(before.insert, level), b = models::tool_length::insert_body(after.insert, level);
      const double c = std::cos(before.azimuth), s = std::sin(before.azimuth);
      const auto in_tool = [&](const auto& v, double raise) {
        return std::array<double, 3>{c * v.x - s * v.y, s * v.x + c * v.y, v.z + raise};
      };
      const auto distance = [](const auto& p, const auto& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      };
      for (const bool back : {false, true}) {
        const auto &centre = back ? a.back : a.rake, &new_centre = back ? b.back : b.rake;
        const double radius = back ? a.back_radius : a.rake_radius;
        const auto middle = in_tool(new_centre, after.raise), other = in_tool(back ? b.rake : b.back, after.raise);
        for (double w = 0; w < 6; w += 1) {
          auto v = centre;
          v.x += radius * (std::cos(w) * a.a.x + std::sin(w) * a.b.x);
          v.y += radius * (std::cos(w) * a.a.y + std::sin(w) * a.b.y);
          v.z += radius * (std::cos(w) * a.a.z + std::sin(w) * a.b.z);
          const auto p = in_tool(v, before.raise);
          const double py = p[1] * std::cos(x) - p[2] * std::sin(x), pz = p[1] * std::sin(x) + p[2] * std::cos(x);
          const std::array<double, 3> turned{p[0] * std::cos(y) + pz * std::sin(y) + ex, py + ey,
                                             pz * std::cos(y) - p[0] * std::sin(y)};
          moved = std::max(moved, distance(turned, p));
          // On the sphere about the centre, and as far from the other centre as a right angle makes it.
          REQUIRE(std::fabs(distance(turned, middle) - radius) < 1e-15);
          REQUIRE(std::fabs(distance(turned, other) - std::hypot(radius, distance(middle, other))) < 1e-15);
        }
      }
    }
  }
  REQUIRE(moved > 1 * mm);
}

/// Errors of single inserts, the quantity that they are if all inserts share them, and a size.
const std::tuple<const char*, std::size_t, double> insert_errors[] = {
    {"insert_radius_error", Row::insert_radius, 20 * um},
    {"insert_seat_error", Row::tool_radius, -15 * um},
    {"insert_pitch_error", Row::holder_angle, 0.4 * deg},
    {"insert_radial_angle_error", Row::insert_radial_angle, 0.3 * deg},
    {"insert_axial_angle_error", Row::insert_axial_angle, -0.2 * deg}};

TEST_CASE("errors that all inserts share are the tool's own quantities", "[effects][tool_length]") {
  Draw draw;
  int compared = 0;
  for (int n = 0; n < 12; ++n) {
    const Mill m = Mill::random(draw);
    for (const auto& [name, quantity, value] : insert_errors) {
      const Mill other = m.where(quantity, m.q[static_cast<std::size_t>(quantity)] + value);
      if (!other.triggers()) continue;
      ++compared;
      REQUIRE(std::fabs(m.with(name, std::vector<double>(12, value)).reading() - other.reading()) < rounding);
    }
  }
  REQUIRE(compared > 40);
}

TEST_CASE("an insert alone has its own error", "[effects][tool_length]") {
  // Flute 2 worn away far beyond the descent from flute to flute: only flute 1 is seen, with its own errors.
  Mill m = Mill().where(Row::wear_1 + 1, 0.2 * mm);
  for (const auto& [name, quantity, value] : insert_errors) {
    INFO(name);
    const double own = m.where(quantity, m.q[static_cast<std::size_t>(quantity)] + value).reading();
    REQUIRE(std::fabs(m.with(name, {value, 0}).reading() - own) < rounding);
    REQUIRE(std::fabs(m.reading() - own) > 1000 * rounding);
    REQUIRE(m.with(name, {0, value}).reading() == m.reading());
  }
}

TEST_CASE("a lagging feed, once steady, is a delayed one", "[effects][tool_length]") {
  const Mill m; // 0.5 mm at 0.5 mm/s: 1 s, a transient of exp(-100)
  const double tau = 10 * ms, v = 30 * mm / 60;
  const Mill lag = m.with("servo_lag", {tau});
  REQUIRE(std::fabs(lag.reading() - m.with("feed_start_delay", {tau}).reading()) < rounding);
  // The command is v tau ahead.
  REQUIRE(m.with("servo_lag", {tau, 1}).reading() - lag.reading() == Approx(-v * tau).epsilon(1e-9));
}

TEST_CASE("a lagging feed from a low start, against all angles one after another", "[effects][tool_length]") {
  Draw draw;
  int solved = 0, transient = 0;
  for (int n = 0; n < 40; ++n) {
    Mill m = Mill::random(draw);
    models::tool_length::TriggerSolver solver;
    double highest = -1;
    for (int k = 0; k < m.q[Row::inserts]; ++k) {
      const auto f = mill::flute(tests::named(m.q), m.event(), k);
      const auto& heights = solver.heights(f.insert, models::laser_setter::beam(tests::named(m.q)));
      if (heights.ever_covered()) highest = std::max(highest, heights.highest().height - f.raise);
    }
    if (highest == -1) continue;
    const double tau = draw(5, 200) * ms, speed = m.condition[Commanded::spindle_speed], feed = m.condition[Commanded::feed];
    m = m.under(Commanded::start_height, highest + draw(0, 2) * feed * tau + 1 * um).with("servo_lag", {tau});
    const auto o = m.simulated();
    if (o.trigger.height.status != Status::ok) continue;
    ++solved;
    const double t = o.trigger.turned / speed;
    transient += std::exp(-t / tau) > 0.01;
    const auto height = [&](double at) { // by another form of the same law
      return m.condition[Commanded::start_height] - feed * at - feed * tau * std::expm1(-at / tau);
    };
    REQUIRE(std::fabs(height(t) - o.trigger.height.value) < 1e-15);
    // How far above its trigger height any flute stands.
    const auto above = [&](double at) {
      double least = 1;
      for (int k = 0; k < m.q[Row::inserts]; ++k) {
        const auto f = mill::flute(tests::named(m.q), m.event(), k);
        const auto node =
            solver.heights(f.insert, models::laser_setter::beam(tests::named(m.q)))
                .at(m.q[Row::holder_angle] + m.condition[Commanded::start_angle] + f.azimuth + speed * at, std::nan(""));
        if (node.covered) least = std::min(least, height(at) + f.raise - node.height);
      }
      return least;
    };
    // Zc rises by up to the tool's radius per rad, the tool sinks by micrometres: an angle right to 1e-9 rad leaves 1e-11
    // here and 1e-14 in the trigger height.
    REQUIRE(std::fabs(above(t)) < 1e-11);
    const double step = 0.25 * deg / speed, first = std::max(0.0, t - 4 * pi / speed);
    for (double at = first; at < t - 1e-9; at += step) REQUIRE(above(at) > 0);
  }
  REQUIRE(solved > 25);
  REQUIRE(transient > 15);
}

TEST_CASE("latency within the transient of a lag", "[effects][tool_length]") {
  // 40 ms after the feed began, with a time constant of 60 ms; latched 25 ms later.
  const Mill slow = Mill().under(Commanded::start_height, 0.005 * mm).with("servo_lag", {60 * ms});
  const auto o = slow.simulated();
  REQUIRE(o.trigger.height.status == Status::ok);
  const double v = 30 * mm / 60, tau = 60 * ms, t = o.trigger.turned / (1000 * rpm), d = 25 * ms;
  const auto behind = [&](double at) { return v * tau * (1 - std::exp(-at / tau)); };
  REQUIRE(slow.with("trigger_latency", {d}).reading() - o.spindle_z ==
          Approx(-(v * d - behind(t + d) + behind(t))).epsilon(1e-8));
  const Mill command = Mill().under(Commanded::start_height, 0.005 * mm).with("servo_lag", {60 * ms, 1});
  REQUIRE(command.with("trigger_latency", {d}).reading() - o.spindle_z == Approx(-(v * d + behind(t))).epsilon(1e-8));
}

TEST_CASE("a sampled receiver is late by less than a period", "[effects][tool_length]") {
  const double T = 3 * ms, v = 30 * mm / 60;
  Draw draw;
  double sum = 0, least = 1, most = 0;
  const int n = 150;
  for (int i = 0; i < n; ++i) {
    const Mill m = Mill().under(Commanded::start_angle, draw(0, 2 * pi)), sampled = m.with("sampling_rate", {T, draw(0, 1)});
    const double late = (m.reading() - sampled.reading()) / v;
    REQUIRE(sampled.height() == m.height());
    REQUIRE(late > -1e-9 * T);
    REQUIRE(late < T * (1 + 1e-9));
    sum += late, least = std::min(least, late), most = std::max(most, late);
    // It is read at a whole number of periods from the phase, wherever the trigger was.
    const double read = (m.q[Row::laser_z] + m.q[Row::tool_length] + 0.5 * mm - sampled.reading()) / v;
    const double periods = read / T - sampled.effects[1];
    REQUIRE(std::fabs(periods - std::round(periods)) < 1e-8);
  }
  // Mean of a rectangle, with its standard error T / sqrt(12 n).
  REQUIRE(std::fabs(sum / n - T / 2) < 5 * T / std::sqrt(12.0 * n));
  REQUIRE(least < 0.05 * T);
  REQUIRE(most > 0.95 * T);
}

TEST_CASE("confirmation over n revolutions lowers by n times the descent", "[effects][tool_length]") {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    const Mill m = Mill::random(draw);
    if (!m.triggers()) continue;
    const double n = std::floor(draw(1, 5)), speed = m.condition[Commanded::spindle_speed], v = m.condition[Commanded::feed];
    REQUIRE(m.reading() - m.with("revolution_confirm", {n}).reading() == Approx(n * v * 2 * pi / speed).epsilon(1e-8));
    // By definition: the first covered moment not before n revolutions after the trigger.
    models::tool_length::TriggerSolver solver;
    const auto o = m.simulated();
    std::vector<models::tool_length::Flute<double>> flutes;
    for (int k = 0; k < m.q[Row::inserts]; ++k) flutes.push_back(mill::flute(tests::named(m.q), m.event(), k));
    const double accepted = o.trigger.turned + 2 * pi * n;
    const auto again = solver.solve(flutes, models::laser_setter::beam(tests::named(m.q)),
                                    {m.q[Row::holder_angle] + m.condition[Commanded::start_angle],
                                     m.condition[Commanded::start_height], v / speed, accepted});
    REQUIRE(again.status == Status::ok);
    REQUIRE(std::fabs(again.turned - accepted) < 1e-9);
  }
}
