/// Laws of the trigger.
#include <catch2/catch.hpp>

#include "references/drawn_tools.h"

using namespace gumshoe;
using namespace gumshoe::fixture;
using namespace gumshoe::models::tool_length;

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
