/// The walk through the inserts' windows against the general search.
#include <catch2/catch.hpp>

#include "references/drawn_tools.h"
#include "references/mill_brute_force.h"

using namespace gumshoe;
using namespace gumshoe::fixture;
using namespace gumshoe::models::tool_length;

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
