/// The walk through the inserts' windows against the general search, bounds against heights, and laws of the trigger.
#include <catch2/catch.hpp>

#include <random>

#include "models/tool_length/trigger/insert_trigger.h"
#include "references/mill_brute_force.h"

using namespace gumshoe;
using namespace gumshoe::models::tool_length;

namespace {

struct Tool {
  std::vector<Flute<double>> flutes;
  Beam<double> beam{0, 0, 0.2 * mm, 0.5};
  InsertMotion motion;
};

/// Tools as they are used and, every other one, stranger ones: narrow views, flanks that show, hidden teeth, drops of
/// nanometres to half a millimetre per turn.
class Draw {
public:
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Tool tool(int n) {
    Tool t;
    const bool strange = n % 2;
    Draw& u = *this;
    const double r = u(8, 20) * mm, radius = strange ? u(0.5, 6) * mm : u(4, 7) * mm, lowest = r - radius;
    Insert<double> insert{r,
                          radius,
                          u(0, 4) * mm,
                          strange ? u(0, 20) * deg : u(11, 20) * deg,
                          u(-15, 15) * deg,
                          strange ? u(-25, 25) * deg : u(-10, 5) * deg};
    insert.thickness = std::min(insert.thickness, 0.9 * radius / std::tan(insert.clearance + 1e-9));
    insert.axis_y = -(strange && n % 8 < 4 ? u(0, 1.2) * r : lowest * (1 + u(-0.2, 0.1)));
    t.beam.radius = u(0.05, 0.4) * mm;
    if (n % 4 > 1) t.beam.fraction = u(0.2, 0.8);
    if (n % 3 == 0) t.beam.yaw = u(-1, 1) * deg, t.beam.pitch = u(-1, 1) * deg;
    const int size = n % 12 + 1;
    for (int k = 0; k < size; ++k) {
      t.flutes.push_back({insert, 2 * pi * k / size, n % 5 ? u(0, 0.02) * mm : 0});
      if (n % 7 != 0) continue; // each its own
      Insert<double>& own = t.flutes.back().insert;
      own.radius += u(-5, 5) * 1e-6, own.tool_radius += u(-5, 5) * 1e-6, own.axial_angle += u(-0.01, 0.01);
      t.flutes.back().azimuth += u(-0.01, 0.01);
    }
    t.motion.drop = std::pow(10, strange ? u(-8, -4.1) : u(-6.5, -5));
    t.motion.start_angle = u(-4, 7);
    t.motion.start_height = n % 16 == 5 ? u(0, 2) : u(-0.02, 0.2) * mm;
    if (n % 9 == 4) t.motion.not_before = u(0, 20);
    return t;
  }

private:
  std::mt19937_64 engine_{4};
};

/// The most that two searches may differ in height: they solve for k to 1e-14 m.
constexpr double agreed = 1e-13;

} // namespace

TEST_CASE("the walk through the windows finds what the general search finds", "[references][tool_length]") {
  Draw draw;
  int walked = 0, usual = 0, trailing = 0, beyond = 0, covered = 0, differing = 0;
  for (int n = 0; n < 1200; ++n) {
    const Tool t = draw.tool(n);
    TriggerSolver solver;
    const auto walk = solver.walk(t.flutes, t.beam, t.motion);
    if (!walk) continue;
    ++walked, usual += n % 2 == 0, differing += n % 7 == 0;
    const InsertTrigger search = solver.search(t.flutes, t.beam, t.motion);
    INFO("tool " << n);
    REQUIRE(walk->status == search.status);
    REQUIRE(walk->insert == search.insert);
    if (walk->status == Status::already_covered) ++covered;
    if (walk->status != Status::ok) continue;
    REQUIRE(std::fabs(walk->height - search.height) < agreed);
    const Flute<double>& f = t.flutes[static_cast<std::size_t>(walk->insert)];
    const RakeView v(RakeBody(insert_body(f.insert, t.beam)), t.motion.start_angle + f.azimuth + walk->turned);
    trailing += v.cy1 < 0; // the insert was on its way back
    beyond += -f.insert.axis_y > f.insert.tool_radius - f.insert.radius;
  }
  // Most usual tools take the fast way; and the hard cases are among them.
  REQUIRE(usual > 540);
  REQUIRE(walked > 750);
  REQUIRE(trailing > 20);
  REQUIRE(beyond > 100);
  REQUIRE(covered > 20);
  REQUIRE(differing > 80);
}

TEST_CASE("no height is above its bound over an interval", "[laws][tool_length]") {
  Draw draw;
  int sharp = 0;
  for (int n = 0; n < 150; ++n) {
    const Tool t = draw.tool(n);
    const InsertHeight heights(t.flutes[0].insert, t.beam);
    if (!heights.ever_covered()) continue;
    const double cosine = heights.body().cos_pitch;
    for (int i = 0; i < 6; ++i) {
      const double half = std::pow(10, draw(-3.5, -0.5)), fall = i % 2 ? t.motion.drop : 0;
      const double from = heights.highest().angle + draw(-0.5, 0.5) - half, to = from + 2 * half;
      double most = -HUGE_VAL;
      for (int j = 0; j <= 40; ++j) {
        const double angle = from + 2 * half * j / 40;
        const HeightNode node = heights.at(angle, std::nan(""));
        if (node.covered) most = std::max(most, node.height * cosine + fall * (angle - from));
      }
      INFO("tool " << n << " from " << from << " to " << to);
      if (most == -HUGE_VAL) continue;
      // Heights are good to 1e-13 m.
      REQUIRE_FALSE(heights.bound().below(from, to, fall, most - 1e-13));
      REQUIRE_FALSE(heights.bound().lines().below(from, to, fall, most - 1e-13));
      sharp += heights.bound().below(from, to, fall, most + 0.5e-6);
    }
    REQUIRE(heights.bound().highest() >= heights.highest().height * cosine - 1e-13);
  }
  REQUIRE(sharp > 60); // and the bound is good for something
}

namespace {

/// Four-flute mills with positive axial angles and the axis well off the beam, so that flanks are in it.
Tool leaning_mill(Draw& u) {
  const double r = u(8, 16) * mm, radius = u(4, 6) * mm;
  const Insert<double> insert{
      r, radius, u(2, 4) * mm, u(11, 18) * deg, u(-15, 5) * deg, u(2, 9) * deg, 0, -(r - radius) * u(0.5, 0.95)};
  Tool t;
  for (int k = 0; k < 4; ++k) t.flutes.push_back({insert, 0.5 * pi * k, u(0, 1) * 1e-6});
  t.beam.radius = u(0.1, 0.3) * mm;
  t.motion = {u(0, 2 * pi), u(0.05, 2) * mm, std::pow(10, u(-7.5, -5.5)), 0};
  return t;
}

} // namespace

TEST_CASE("no height is above its bound where the flank shows", "[laws][tool_length]") {
  Draw draw;
  int shown = 0, sharp = 0;
  for (int n = 0; n < 1500; ++n) {
    const Tool t = leaning_mill(draw);
    const InsertBody<double> body = insert_body(t.flutes[0].insert, t.beam);
    const DiscShare disc(t.beam.radius, t.beam.fraction);
    InsertPass pass(body, disc);
    if (!pass.open(4 * pass.slack())) continue;
    const InsertHeight heights(t.flutes[0].insert, t.beam);
    for (int i = 0; i < pass.size(); ++i) {
      const double half = std::pow(10, draw(-4, -1.8)), fall = n % 2 ? t.motion.drop : 0;
      const double middle = draw(pass.window(i).from, pass.window(i).to), from = middle - half;
      const RakeChord chord = rake_chord(RakeView(RakeBody(body), middle), body.rake_radius, disc);
      const HeightNode seen = heights.at(middle, std::nan(""));
      if (!chord.solved || !seen.covered || chord.k > seen.height - 1e-11) continue;
      ++shown;
      double most = -HUGE_VAL;
      for (int j = 0; j <= 40; ++j) {
        const double angle = from + 2 * half * j / 40;
        const HeightNode node = heights.at(angle, std::nan(""));
        if (node.covered) most = std::max(most, node.height + fall * (angle - from));
      }
      INFO("mill " << n << " window " << i << " from " << from << " width " << 2 * half);
      REQUIRE_FALSE(pass.below(from, from + 2 * half, fall, most - 1e-13));
      sharp += pass.below(from, from + 2 * half, fall, most + 0.5e-6) &&
               !pass.lines().below(from, from + 2 * half, fall, most + 0.5e-6);
    }
  }
  REQUIRE(shown > 200);
  REQUIRE(sharp > 50);
}

TEST_CASE("no height in a window is above the highest said of it", "[laws][tool_length]") {
  Draw draw;
  int lowered = 0, sharp = 0;
  for (int n = 0; n < 600; ++n) {
    const Tool t = n % 3 ? leaning_mill(draw) : draw.tool(n);
    InsertPass pass(insert_body(t.flutes[0].insert, t.beam), DiscShare(t.beam.radius, t.beam.fraction));
    if (!pass.open(draw(0.5, 2) * pass.slack())) continue;
    const double cosine = std::cos(t.beam.pitch);
    pass.lower_far(0);
    if (n % 2) pass.lower(0.1e-6);
    const InsertHeight heights(t.flutes[0].insert, t.beam);
    for (int i = 0; i < pass.size(); ++i) {
      const InsertPass::Window& w = pass.window(i);
      double most = -HUGE_VAL;
      for (int j = 0; j <= 60; ++j) {
        const HeightNode node = heights.at(w.from + (w.to - w.from) * j / 60, std::nan(""));
        if (node.covered) most = std::max(most, node.height * cosine);
      }
      INFO("tool " << n << " window " << i);
      REQUIRE(most < w.highest + 1e-13);
      if (!(w.highest < pass.highest() - 1e-6)) continue;
      ++lowered;
      sharp += most > w.highest - 0.3 * (pass.highest() - w.highest);
    }
  }
  REQUIRE(lowered > 300);
  REQUIRE(sharp > 150);
}

TEST_CASE("the walk serves mills whose flanks show", "[references][tool_length]") {
  Draw draw;
  int walked = 0;
  for (int n = 0; n < 150; ++n) {
    const Tool t = leaning_mill(draw);
    TriggerSolver solver;
    const InsertTrigger search = solver.search(t.flutes, t.beam, t.motion),
                        found = solver.solve(t.flutes, t.beam, t.motion);
    INFO("mill " << n);
    REQUIRE(found.status == Status::ok);
    REQUIRE(found.status == search.status);
    REQUIRE(found.insert == search.insert);
    REQUIRE(std::fabs(found.height - search.height) < agreed);
    walked += solver.walk(t.flutes, t.beam, t.motion).has_value();
    // The search shares the bounds; heights alone, in the turn before the trigger, do not.
    if (n % 10 != 0) continue;
    const InsertHeight heights(t.flutes[0].insert, t.beam);
    for (const auto& f : t.flutes)
      for (int j = 1; j <= 2000; ++j) {
        const double turned = found.turned - 2 * pi * j / 2000;
        if (turned < 0) break;
        const HeightNode node = heights.at(t.motion.start_angle + f.azimuth + turned, std::nan(""));
        const double level = t.motion.start_height + f.raise - t.motion.drop * turned;
        if (node.covered) REQUIRE(node.height < level + agreed);
      }
  }
  REQUIRE(walked > 100); // without a bound on what the flank adds, half of them
}

TEST_CASE("where only the cutting edge shows its height is the insert's", "[references][tool_length]") {
  Draw draw;
  int compared = 0;
  for (int n = 0; n < 400; n += 2) {
    const Tool t = draw.tool(n);
    const Insert<double>& insert = t.flutes[0].insert;
    const InsertHeight heights(insert, t.beam);
    if (!heights.ever_covered()) continue;
    const RakeBody body(insert_body(insert, t.beam));
    const DiscShare disc(t.beam.radius, t.beam.fraction);
    const double angle = heights.highest().angle + draw(-0.1, 0.1);
    const HeightNode node = heights.at(angle, std::nan(""));
    const RakeChord chord = rake_chord(RakeView(body, angle), body.radius, disc);
    if (!chord.solved || !node.covered) continue;
    INFO("tool " << n);
    const double k = node.height * body.cos_pitch;
    if (chord.k < k - 1e-10) continue; // the flank shows too
    ++compared;
    REQUIRE(chord.k == Approx(k).epsilon(0).margin(1e-13));
    REQUIRE(chord.slope == Approx(node.slope * body.cos_pitch).epsilon(1e-7).margin(1e-8));
    const auto at = [&](double x) { return rake_chord(RakeView(body, x), body.radius, disc).k; };
    // Rounding 1e-17 over 2e-5 and a third derivative of some 0.1 m.
    REQUIRE(chord.slope == Approx((at(angle + 1e-5) - at(angle - 1e-5)) / 2e-5).epsilon(0).margin(5e-11));
  }
  REQUIRE(compared > 120);
}

TEST_CASE("a trigger depends on the line, not on where it starts", "[laws][tool_length]") {
  Draw draw;
  int compared = 0;
  for (int n = 0; n < 300; n += 2) {
    Tool t = draw.tool(n);
    if (n % 7 == 0) continue;
    for (auto& f : t.flutes) f.raise = 0;
    t.motion.start_height = 0.3 * mm, t.motion.not_before = 0;
    TriggerSolver solver;
    const InsertTrigger base = solver.solve(t.flutes, t.beam, t.motion);
    if (base.status != Status::ok) continue;
    ++compared;
    INFO("tool " << n);
    // Angles of thousands of radians times the drop, and roots to 1e-14 m.
    const auto same_height = [&](const std::vector<Flute<double>>& flutes, const InsertMotion& m, double more) {
      const InsertTrigger other = solver.solve(flutes, t.beam, m);
      REQUIRE(other.status == Status::ok);
      REQUIRE(std::fabs(other.height - base.height - more) < agreed);
    };
    InsertMotion m = t.motion;
    m.start_angle += 2 * pi / static_cast<double>(t.flutes.size());
    same_height(t.flutes, m, 0);
    m = t.motion;
    m.start_angle += 1.25, m.start_height += -1.25 * m.drop;
    same_height(t.flutes, m, 0);
    auto raised = t.flutes;
    for (auto& f : raised) f.raise = 7e-6;
    m = t.motion;
    m.start_height -= 7e-6;
    same_height(raised, m, -7e-6);
  }
  REQUIRE(compared > 100);
}

TEST_CASE("a tool triggers at the highest of its flutes' own heights", "[laws][tool_length]") {
  Draw draw;
  int compared = 0;
  for (int n = 0; n < 400; n += 2) {
    Tool t = draw.tool(n);
    t.motion.start_height = 0.3 * mm, t.motion.not_before = 0;
    TriggerSolver solver;
    const InsertTrigger all = solver.solve(t.flutes, t.beam, t.motion);
    if (all.status != Status::ok) continue;
    ++compared;
    INFO("tool " << n);
    const double level = t.motion.start_height + t.motion.drop * t.motion.start_angle, turn = 2 * pi * t.motion.drop;
    double highest = -HUGE_VAL;
    for (const auto& f : t.flutes) {
      const InsertTrigger one = solver.alone(f, t.beam, level, t.motion.drop);
      REQUIRE(one.status == Status::ok);
      REQUIRE(one.height == Approx(level - t.motion.drop * one.turned).epsilon(0).margin(1e-14));
      highest = std::max(highest, one.height);
      for (const int turns : {-3, 1, 40}) {
        const InsertTrigger later = solver.alone(f, t.beam, level + turns * turn, t.motion.drop);
        REQUIRE(std::fabs(later.height - one.height) < agreed);
        REQUIRE(std::fabs(later.turned - one.turned - 2 * pi * turns) * t.motion.drop < agreed);
      }
    }
    REQUIRE(std::fabs(highest - all.height) < agreed);
  }
  REQUIRE(compared > 140);
}

TEST_CASE("what a solver remembers changes no bit", "[laws][tool_length]") {
  Draw draw;
  TriggerSolver lasting;
  for (int n = 0; n < 120; ++n) {
    const Tool t = draw.tool(n / 2 * 2);
    for (int i = 0; i < 4; ++i) { // one geometry from several angles, heights and drops
      InsertMotion m = t.motion;
      m.start_angle += i, m.start_height += 1e-4 * (i / 2), m.drop *= i == 3 ? 1.5 : 1;
      const InsertTrigger again = lasting.solve(t.flutes, t.beam, m),
                          fresh = TriggerSolver().solve(t.flutes, t.beam, m);
      INFO("tool " << n);
      REQUIRE(again.status == fresh.status);
      REQUIRE(again.height == fresh.height);
      REQUIRE(again.turned == fresh.turned);
    }
    lasting.alone(t.flutes.back(), t.beam, 0, t.motion.drop);
  }
}

TEST_CASE("both ways see a characteristic curve jump at the same angle", "[references][tool_length]") {
  // Thesis tool, one tooth worn: the curve jumps where one hump gives way to the next.
  const Insert<double> insert{10 * mm, 5 * mm, 3.2 * mm, 15 * deg, -12 * deg, 6 * deg, 0, -4.9 * mm};
  const std::vector<Flute<double>> flutes{{insert, 0, 0}, {insert, pi, 2e-6}};
  const Beam<double> beam{0, 0, 0.2 * mm, 0.5};
  TriggerSolver solver;
  const auto height = [&](double angle, bool walk) {
    const InsertMotion m{angle, 0.3 * mm, 30e-3 / 60 / (1000 * 2 * pi / 60)};
    return walk ? solver.walk(flutes, beam, m).value().height : solver.search(flutes, beam, m).height;
  };
  int jumps = 0;
  for (int i = 0; i < 360; ++i) {
    // away from jumps the curve moves by 0.1 um per degree at most
    if (std::fabs(height((i + 1) * deg, true) - height(i * deg, true)) < 0.8e-6) continue;
    ++jumps;
    double where[2];
    for (const bool walk : {false, true}) {
      double lo = i * deg, hi = (i + 1) * deg;
      const double before = height(lo, walk), after = height(hi, walk);
      while (hi - lo > 1e-9 * deg) {
        const double middle = 0.5 * (lo + hi), h = height(middle, walk);
        (std::fabs(h - before) < std::fabs(h - after) ? lo : hi) = middle;
      }
      where[walk] = 0.5 * (lo + hi);
    }
    REQUIRE(std::fabs(where[0] - where[1]) < 1e-6 * deg);
  }
  REQUIRE(jumps >= 2);
}

TEST_CASE("inserts that differ, and drops large and tiny, agree with the twin", "[references][tool_length]") {
  namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;
  Draw draw;
  int solved = 0;
  for (int n = 0; n < 84; n += 7) { // each insert its own
    Tool t = draw.tool(n);
    const int size = static_cast<int>(t.flutes.size());
    // from a fifth of a micrometre per turn to half a millimetre
    t.motion.drop = std::pow(10, draw(-7.5, -4.1)), t.motion.not_before = 0;
    TriggerSolver solver;
    double highest = -HUGE_VAL;
    for (const auto& f : t.flutes) {
      const InsertHeight& heights = solver.heights(f.insert, t.beam);
      if (heights.ever_covered()) highest = std::max(highest, heights.highest().height - f.raise);
    }
    t.motion.start_height = highest + 2 * pi * t.motion.drop * draw(0.1, 0.6);
    const InsertTrigger found = solver.solve(t.flutes, t.beam, t.motion);
    if (found.status != Status::ok) continue;
    ++solved;
    INFO("tool " << n);
    std::vector<std::vector<double>> q;
    for (const auto& f : t.flutes) {
      const Insert<double>& i = f.insert;
      std::vector<double> values(tests::quantities, 0.0);
      values[Row::tool_radius] = i.tool_radius, values[Row::insert_radius] = i.radius;
      values[Row::insert_thickness] = i.thickness, values[Row::clearance_angle] = i.clearance;
      values[Row::insert_radial_angle] = i.radial_angle, values[Row::insert_axial_angle] = i.axial_angle;
      values[Row::offset] = -i.axis_y, values[Row::beam_yaw] = t.beam.yaw, values[Row::beam_pitch] = t.beam.pitch;
      values[Row::beam_radius] = t.beam.radius, values[Row::trigger_fraction] = t.beam.fraction;
      q.push_back(values);
    }
    const double target = t.beam.fraction * pi * t.beam.radius * t.beam.radius;
    const auto most = [&](double s, double raised, int columns) {
      double area = 0;
      for (int k = 0; k < size; ++k) {
        const Flute<double>& f = t.flutes[static_cast<std::size_t>(k)];
        area = std::max(
            area, tests::covered_by_strips(q[static_cast<std::size_t>(k)].data(), t.motion.start_angle + f.azimuth + s,
                                           t.motion.start_height - t.motion.drop * s + f.raise + raised, columns));
      }
      return area;
    };
    // 4000 strips are good for 1e-8 mm of height (tool_length_test.cpp).
    REQUIRE(most(found.turned, -1e-7 * mm, 4000) > target);
    REQUIRE(most(found.turned, 1e-7 * mm, 4000) < target);
    for (double s = 0; s < found.turned - 1e-6; s += 1 * deg)
      if (most(s, 0, 24) > 0.99 * target) REQUIRE(most(s, 0, 4000) < target * (1 + 1e-6));
  }
  REQUIRE(solved >= 9);
}
