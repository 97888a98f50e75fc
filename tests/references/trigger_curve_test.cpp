/// The tabulated trigger curve against the solver that follows each line.
#include <cmath>

#include <catch2/catch.hpp>

#include "models/tool_length/trigger/trigger_curve.h"
#include "laws/mill_fixture.h"

using namespace gumshoe;
using tests::Draw;
using tests::Mill;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

TEST_CASE("a tabulated trigger curve agrees with the search along each line", "[references][tool_length]") {
  Draw draw;
  int compared = 0, jumps = 0;
  for (int n = 0; n < 40; ++n) {
    const Mill tool = Mill::random(draw);
    const auto insert = mill::insert(tests::named(tool.q), tool.event());
    const auto beam = models::laser_setter::beam(tests::named(tool.q));
    const models::tool_length::InsertHeight heights(insert, beam);
    if (!heights.ever_covered()) continue;
    const double drop = tool.condition[Commanded::feed] / tool.condition[Commanded::spindle_speed];
    const models::tool_length::TriggerCurve curve(heights, drop);
    const models::tool_length::Flute<double> flute{insert, 0, 0};
    models::tool_length::TriggerSolver solver;
    INFO("tool " << n);
    for (int i = 0; i < 30; ++i) {
      const double angle = draw(0, 6), above = heights.highest().height + draw(0, 3) * curve.period();
      const auto found = solver.search({&flute, 1}, beam, {angle, above, drop});
      REQUIRE(found.status == Status::ok);
      const double x = above + drop * angle;
      const auto at = curve.at(x);
      // 1e-12 m in Zc at a fixed angle, and more of the height where the line runs along Zc.
      REQUIRE(std::fabs(at.height - found.height) < 1e-12 * (10 + std::fabs(at.slope)));
      REQUIRE(curve.at(x + 3 * curve.period()).height ==
              Approx(at.height).epsilon(0).margin(1e-14 * (10 + std::fabs(at.slope))));
      REQUIRE(at.from <= x);
      REQUIRE(x <= at.to);
      // It triggers where G first reaches x, not before.
      REQUIRE(curve.record(angle + found.turned + 1e-6) >= x - 1e-12);
      REQUIRE(curve.record(angle + found.turned - 1e-6) <= x + 1e-12);
      ++compared;
      if (at.to - at.from < 0.9 * curve.period() && at.from > -1e3) {
        const double below = curve.at(at.from - 1e-15).height, there = curve.at(at.from + 1e-15).height;
        REQUIRE(below >= there);
        REQUIRE(std::fabs(below - at.before) < 1e-8); // a root of the distance to the hump's end
        ++jumps;
      }
    }
  }
  REQUIRE(compared > 500);
  REQUIRE(jumps > 50);
}
