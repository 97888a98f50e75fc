/// Triggers and trigger curves in SIMD lanes: the bits of each alone, on every instruction set.
#include <algorithm>
#include <cstring>
#include <memory>

#include <catch2/catch.hpp>

#include "kernel_variants.h"
#include "models/tool_length/trigger/curve_table.h"
#include "models/tool_length/trigger/insert_walk_kernels.h"
#include "models/tool_length/trigger/trigger_curve.h"
#include "references/drawn_tools.h"

GUMSHOE_VARIANTS(gumshoe::models::tool_length::WalkKernels, insert_walk)
GUMSHOE_VARIANTS(gumshoe::models::tool_length::CurveTableKernels, curve_table)

using namespace gumshoe;
using namespace gumshoe::fixture;
using namespace gumshoe::models::tool_length;

namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(const InsertTrigger& a, const InsertTrigger& b) {
  return a.status == b.status && a.insert == b.insert && same_bits(a.turned, b.turned) &&
         same_bits(a.height, b.height) && same_bits(a.slope, b.slope);
}

} // namespace

TEST_CASE("mills that are solved together have the triggers of each alone", "[references][tool_length]") {
  Draw draw;
  std::vector<Tool> tools;
  for (int n = 0; n < 900; ++n) tools.push_back(n % 3 == 2 ? leaning_mill(draw) : draw.tool(n));
  std::vector<TriggerQuestion> questions;
  for (const Tool& t : tools) questions.push_back({t.flutes, t.beam, t.motion});
  const std::size_t n = tools.size();
  for (const auto& [set, kernels] : insert_walk_variants()) {
    INFO(name(set));
    std::vector<InsertTrigger> answers(n);
    const auto found = std::make_unique<bool[]>(n);
    kernels->walk(questions.data(), n, answers.data(), found.get());
    std::size_t in_lanes = 0, of_several_inserts = 0, inside = 0;
    for (std::size_t i = 0; i < n; ++i) {
      INFO("tool " << i);
      TriggerSolver solver;
      const auto& flutes = tools[i].flutes;
      const auto alone = solver.walk(flutes, tools[i].beam, tools[i].motion);
      REQUIRE(found[i] == alone.has_value());
      if (!found[i]) continue;
      of_several_inserts += !std::ranges::all_of(flutes, [&](const auto& f) { return f.insert == flutes[0].insert; });
      ++in_lanes, inside += answers[i].status == Status::already_covered;
      REQUIRE(same_bits(answers[i], *alone));
    }
    REQUIRE(in_lanes > 400);
    REQUIRE(of_several_inserts > 30);
    REQUIRE(inside > 3);
  }
  // What lanes leave out is solved alone, in the same order.
  const std::size_t some = 60;
  std::vector<InsertTrigger> all(some);
  TriggerSolver together, alone;
  together.solve(std::span(questions).first(some), all.data());
  for (std::size_t i = 0; i < some; ++i)
    REQUIRE(same_bits(all[i], alone.solve(tools[i].flutes, tools[i].beam, tools[i].motion)));
}

TEST_CASE("usual mills of one geometry each are solved in lanes", "[references][tool_length]") {
  // The thesis' tool: a lane that is solved alone takes five times as long, so hardly any may be.
  Draw draw;
  std::vector<Tool> tools(400);
  std::vector<TriggerQuestion> questions;
  for (std::size_t n = 0; n < tools.size(); ++n) {
    Tool& t = tools[n];
    const Insert<double> insert{
        10 * mm + draw(-1, 1) * 5e-6,   5 * mm + draw(-1, 1) * 5e-6,  3.2 * mm, 15 * deg + draw(-1, 1) * 2e-3,
        -12 * deg + draw(-1, 1) * 2e-3, 6 * deg + draw(-1, 1) * 2e-3, 0,        -4.9 * mm + draw(-1, 1) * 4e-5};
    const int size = static_cast<int>(n % 4) + 1;
    for (int k = 0; k < size; ++k) t.flutes.push_back({insert, 2 * pi * k / size, draw(0, 4) * 1e-6});
    t.motion = {draw(0, 6), 5 * mm, 30e-3 / 60 / (1000 * 2 * pi / 60), 0};
    questions.push_back({t.flutes, t.beam, t.motion});
  }
  std::vector<InsertTrigger> answers(tools.size());
  const auto found = std::make_unique<bool[]>(tools.size());
  walk_kernels().walk(questions.data(), tools.size(), answers.data(), found.get());
  REQUIRE(std::count(found.get(), found.get() + tools.size(), true) > 390);
}

TEST_CASE("mills that run out, each insert as it then stands, are solved in lanes with the bits of each alone",
          "[references][tool_length]") {
  Draw draw;
  std::vector<Tool> tools(400);
  std::vector<TriggerQuestion> questions;
  for (std::size_t n = 0; n < tools.size(); ++n) {
    Tool& t = tools[n];
    const int size = n < 200 ? 4 : 3;
    for (int k = 0; k < size; ++k) {
      const double along = 2 * pi * k / size, tilt = draw(0, 2e-4);
      const Insert<double> insert{10 * mm + draw(-1, 1) * 5e-6,
                                  5 * mm + draw(-1, 1) * 5e-6,
                                  3.2 * mm,
                                  15 * deg,
                                  -12 * deg + tilt * cos(along),
                                  6 * deg + tilt * sin(along),
                                  draw(-1, 1) * 5e-6,
                                  -4.9 * mm + draw(-1, 1) * 4e-5};
      // Every other tool has two of one kind, opposite each other.
      t.flutes.push_back({n % 80 < 40 && k == 2 ? t.flutes[0].insert : insert, along, draw(0, 4) * 1e-6});
    }
    t.motion = {draw(0, 6), 5 * mm, 30e-3 / 60 / (1000 * 2 * pi / 60), 0};
    questions.push_back({t.flutes, t.beam, t.motion});
  }
  const std::size_t n = tools.size();
  for (const auto& [set, kernels] : insert_walk_variants()) {
    INFO(name(set));
    std::vector<InsertTrigger> answers(n);
    const auto found = std::make_unique<bool[]>(n);
    kernels->walk(questions.data(), n, answers.data(), found.get());
    REQUIRE(std::count(found.get(), found.get() + n, true) > 390);
    for (std::size_t i = 0; i < n; ++i) {
      INFO("tool " << i);
      const auto alone = TriggerSolver().walk(tools[i].flutes, tools[i].beam, tools[i].motion);
      REQUIRE(found[i] == alone.has_value());
      if (found[i]) REQUIRE(same_bits(answers[i], *alone));
    }
  }
}

TEST_CASE("trigger curves have equal bits in lanes, alone and on every instruction set", "[references][tool_length]") {
  Draw draw;
  int read = 0;
  for (int n = 0; n < 24; ++n) {
    const Tool t = draw.tool(2 * n);
    const InsertHeight heights(t.flutes[0].insert, t.beam);
    if (!heights.ever_covered()) continue;
    const TriggerCurve curve(heights, t.motion.drop);
    constexpr std::size_t size = 37; // no multiple of lanes
    std::vector<double> x, angle;
    for (std::size_t i = 0; i < size; ++i) x.push_back(draw(-3, 3) * curve.period()), angle.push_back(draw(-9, 9));
    std::vector<double> rows[6];
    for (auto& row : rows) row.resize(size);
    for (const auto& [set, kernels] : curve_table_variants()) {
      INFO(name(set));
      kernels->at(curve.table(), size, x.data(),
                  {rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data(), rows[4].data()});
      kernels->record(curve.table(), size, angle.data(), rows[5].data());
      for (std::size_t i = 0; i < size; ++i) {
        const auto alone = curve.at(x[i]);
        REQUIRE(same_bits(rows[0][i], alone.height));
        REQUIRE(same_bits(rows[1][i], alone.slope));
        REQUIRE(same_bits(rows[2][i], alone.from));
        REQUIRE(same_bits(rows[3][i], alone.to));
        REQUIRE(same_bits(rows[4][i], alone.before));
        REQUIRE(same_bits(rows[5][i], curve.record(angle[i])));
        ++read;
      }
    }
  }
  REQUIRE(read > 500);
}

TEST_CASE("a scan of the phase has the bits of curves read one by one, on every instruction set",
          "[references][tool_length]") {
  Draw draw;
  int compared = 0;
  for (int n = 0; n < 24; ++n) {
    const Tool t = draw.tool(2 * n);
    const std::size_t flutes = std::min<std::size_t>(t.flutes.size(), 4), readings = flutes + 3;
    std::vector<TriggerCurve> curves_of;
    curves_of.reserve(flutes);
    for (std::size_t k = 0; k < flutes; ++k) {
      const InsertHeight heights(t.flutes[k].insert, t.beam);
      if (heights.ever_covered()) curves_of.emplace_back(heights, t.motion.drop);
    }
    if (curves_of.size() < flutes) continue;
    const double period = curves_of[0].period(), margin = 0.01 * period;
    std::vector<const CurveTable*> tables;
    std::vector<double> lines, heights, phases;
    for (std::size_t k = 0; k < flutes; ++k)
      for (std::size_t i = 0; i < readings; ++i)
        tables.push_back(&curves_of[k].table()), lines.push_back(draw(-1, 1) * period);
    for (std::size_t i = 0; i < readings; ++i) heights.push_back(curves_of[0].highest() - draw(0, 1) * period);
    constexpr std::size_t size = 21; // no multiple of lanes
    for (std::size_t s = 0; s < size; ++s) phases.push_back(draw(0, 1) * period);
    const CurveScan scan{readings, flutes, t.motion.drop, tables.data(), lines.data(), heights.data()};
    for (const auto& [set, kernels] : curve_table_variants()) {
      INFO(name(set));
      std::vector<double> begins(flutes * size), squares(size);
      kernels->longest(scan, margin, size, phases.data(), begins.data(), squares.data());
      for (std::size_t s = 0; s < size; ++s) {
        double sum = 0;
        for (std::size_t k = 0; k < flutes; ++k) {
          double begin = -1e300;
          for (std::size_t i = 0; i < readings; ++i) {
            const double line = lines[k * readings + i];
            const double angle = (line + phases[s] - heights[i] - margin) / t.motion.drop;
            begin = std::max(begin, curves_of[k].record(angle) - line);
          }
          REQUIRE(same_bits(begins[k * size + s], begin));
        }
        for (std::size_t i = 0; i < readings; ++i) {
          double highest = -1e300;
          for (std::size_t k = 0; k < flutes; ++k) {
            const double begin = begins[k * size + s], line = lines[k * readings + i];
            highest = std::max(highest, (phases[s] - begin) + curves_of[k].at(line + begin).height);
          }
          sum += (highest - heights[i]) * (highest - heights[i]);
        }
        REQUIRE(same_bits(squares[s], sum));
        ++compared;
      }
    }
  }
  REQUIRE(compared > 500);
}
