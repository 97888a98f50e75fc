/// Bounds of an insert's height against its heights.
#include <catch2/catch.hpp>

#include "references/drawn_tools.h"

using namespace gumshoe;
using namespace gumshoe::fixture;
using namespace gumshoe::models::tool_length;

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
      REQUIRE_FALSE(heights.bound().lines().below(true, from, to, fall, most - 1e-13));
      sharp += heights.bound().below(from, to, fall, most + 0.5e-6);
    }
    REQUIRE(heights.bound().highest() >= heights.highest().height * cosine - 1e-13);
  }
  REQUIRE(sharp > 60); // and the bound is good for something
}

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
               !pass.lines().below(true, from, from + 2 * half, fall, most + 0.5e-6);
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
    pass.lower_far(true, 0);
    if (n % 2) lower<double>(pass, true, 0.1e-6);
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
