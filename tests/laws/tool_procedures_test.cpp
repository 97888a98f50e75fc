/// Procedures that use all readings of a mill together: the truth comes back, and the stated uncertainty covers it.
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "models/tool_length/trigger/trigger_curve.h"
#include "asked.h"
#include "laws/mill_fixture.h"
#include "laws/mill_rows.h"

using namespace gumshoe;
using tests::Draw;
using tests::Mill;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

namespace {

constexpr double pi = std::numbers::pi, um = 1e-6;

/// One tool at several start angles; eight samples a call, which may differ in their readouts.
struct Procedure {
  Mill tool;
  int evaluation = mill::characteristic_curve;
  std::vector<std::vector<double>> conditions; ///< [reading]
  std::vector<double> readouts;                ///< [reading][8]

  Procedure(const Mill& t, int readings, int e = mill::characteristic_curve) : tool(t), evaluation(e) {
    for (int i = 0; i < readings; ++i) {
      conditions.push_back(tool.condition);
      conditions.back()[Commanded::start_angle] += 2 * pi * i / readings;
    }
    readouts.resize(8 * conditions.size());
  }
  struct Answer {
    std::vector<std::array<double, 8>> rows;
    int status = 0;
    double operator[](int row) const { return rows[static_cast<std::size_t>(row)][0]; }
    double flute(int k, int row) const { return (*this)[tests::curve_rows + tests::flute_rows * k + row]; }
  };
  /// The truth; the readouts follow it.
  Answer simulate() {
    const auto found = ask(&propagation::ForwardModel::simulate);
    readouts = found.indications;
    return answer(found);
  }
  Answer evaluate() const { return answer(ask(&propagation::ForwardModel::evaluate)); }
  std::string problem() const {
    propagation::Points points;
    for (std::size_t r = 0; r < conditions.size(); ++r) points.push_back(tests::joined(tool.q, {readouts[8 * r]}));
    return forward().check_together(points);
  }

private:
  propagation::ForwardModel forward() const {
    return propagation::ForwardModel(*models::find("tool_length"), {}, static_cast<std::size_t>(evaluation),
                                     conditions);
  }
  propagation::BlockValues ask(propagation::BlockValues (propagation::ForwardModel::*use)(const propagation::Block&)
                                   const) const {
    const propagation::ForwardModel model = forward();
    std::vector<std::vector<std::vector<double>>> columns(conditions.size(), tests::columns_of(tool.q));
    propagation::Block block;
    block.clear(8);
    for (std::size_t r = 0; r < conditions.size(); ++r) {
      columns[r].emplace_back(&readouts[8 * r], &readouts[8 * r] + 8);
      tests::add(block, model, r, columns[r]);
    }
    return (model.*use)(block);
  }
  static Answer answer(const propagation::BlockValues& found) {
    Answer a;
    a.rows.resize(std::size(mill::curve_cards));
    for (std::size_t row = 0; row < found.measurands.size() / 8; ++row)
      std::copy_n(&found.measurands[8 * row], 8, a.rows[row].begin());
    a.status = *std::max_element(found.status.begin(), found.status.end());
    return a;
  }
};

double per_flute(const Mill& m) {
  return 2 * pi * m.condition[Commanded::feed] / m.condition[Commanded::spindle_speed] / m.q[Row::inserts];
}

/// The mill of Fang's Tables 3.3 and 3.4.
Mill thesis() {
  Mill m;
  m.q[Row::insert_radius] = 5e-3, m.q[Row::insert_thickness] = 3.2e-3;
  m.q[Row::insert_radial_angle] = -12 * Mill::deg, m.q[Row::insert_axial_angle] = 6 * Mill::deg;
  m.q[Row::offset] = 4.9e-3, m.q[Row::tool_length] = 0.176641, m.q[Row::wear_1 + 1] = 2 * um;
  m.condition = {1000 * Mill::rpm, 30e-3 / 60, 0, 5e-3, 0, -1};
  return m;
}

/// Normal deviates, so that a set of noise is the same on every machine.
double normal(Draw& draw) { return std::sqrt(-2 * std::log(1 - draw(0, 1))) * std::cos(2 * pi * draw(0, 1)); }

} // namespace

TEST_CASE("a characteristic curve gives the flutes back", "[laws][tool_length][procedures]") {
  Draw draw;
  int hidden = 0, solved = 0;
  std::array<int, 7> of{};
  for (int n = 0; n < 60; ++n) {
    Mill tool = Mill::random(draw);
    const int flutes = 1 + n % 6;
    tool.q[Row::inserts] = flutes;
    // equal flutes, flutes worn by less than what hides them, one worn by more
    for (int k = 0; k < flutes; ++k)
      tool.q[Row::wear_1 + static_cast<std::size_t>(k)] = n % 4 == 0             ? 3 * um
                                                         : n % 4 == 1 && k == 1 ? 3 * per_flute(tool)
                                                                                : draw(0, 0.8) * per_flute(tool);
    Procedure p(tool, 2 * flutes + 4 + n % 5); // coprime to the flutes or not
    const auto truth = p.simulate();
    if (truth.status != 0) continue; // an offset at which no insert meets the beam, or a start inside it
    const auto found = p.evaluate();
    INFO("case " << n << ", " << flutes << " flutes, " << p.conditions.size() << " readings");
    REQUIRE(found.status == 0);
    ++solved, ++of[static_cast<std::size_t>(flutes)];
    REQUIRE(std::fabs(found[tests::joint_effective_row] - truth[tests::joint_effective_row]) < 1e-9);
    REQUIRE(std::fabs(found[tests::joint_length_row] - truth[tests::joint_length_row]) < 1e-9);
    REQUIRE(found[tests::residual_row] < 1e-10);
    REQUIRE(found[tests::seen_flutes_row] == truth[tests::seen_flutes_row]);
    if (n % 4 != 0) // else every numbering is as good
      REQUIRE(std::fabs(std::remainder(found[tests::phase_row] - truth[tests::phase_row], 2 * pi)) < 1e-3);
    for (int k = 0; k < flutes; ++k) {
      REQUIRE(found.flute(k, tests::seen_row) == truth.flute(k, tests::seen_row));
      const double beyond = found.flute(k, tests::flute_length_row) - truth.flute(k, tests::flute_length_row);
      REQUIRE(beyond > -1e-9);
      if (truth.flute(k, tests::seen_row) == 1)
        REQUIRE(beyond < 1e-9);
      else
        ++hidden;
    }
  }
  REQUIRE(solved > 40);
  REQUIRE(hidden >= 5);
  REQUIRE(*std::min_element(of.begin() + 1, of.end()) >= 4);
}

TEST_CASE("of a hidden flute, the greatest length that changes no readout", "[laws][tool_length][procedures]") {
  Mill tool = thesis();
  tool.q[Row::wear_1 + 1] = 40 * um; // 15 um a flute
  Procedure p(tool, 12);
  p.simulate();
  const auto readouts = p.readouts;
  const auto found = p.evaluate();
  REQUIRE(found.status == 0);
  REQUIRE(found.flute(1, tests::seen_row) == 0);
  REQUIRE(found[tests::seen_flutes_row] == 1);
  const double allowed = found.flute(1, tests::flute_length_row);
  REQUIRE(found.flute(1, tests::wear_difference_row) == Approx(tool.q[Row::tool_length] - allowed).margin(1e-9));
  const auto changed = [&](double length) {
    p.tool.q[Row::wear_1 + 1] = tool.q[Row::tool_length] - length;
    p.simulate();
    double most = 0;
    for (std::size_t i = 0; i < readouts.size(); ++i) most = std::max(most, std::fabs(p.readouts[i] - readouts[i]));
    return most;
  };
  REQUIRE(changed(allowed - 1e-9) < 1e-12);
  REQUIRE(changed(allowed + 1e-9) > 1e-12);
}

TEST_CASE("what turns all readings alike changes the phase alone", "[laws][tool_length][procedures]") {
  Draw draw;
  const Mill tool = thesis();
  const double drop = tool.condition[Commanded::feed] / tool.condition[Commanded::spindle_speed];
  for (int n = 0; n < 5; ++n) {
    const double turned = draw(0, 2 * pi), raised = draw(0, 1e-3);
    Mill other = tool.where(Row::holder_angle, turned);
    other.condition[Commanded::start_height] += raised;
    Procedure a(other, 13);
    a.simulate();
    // evaluated as if nothing were turned or raised
    Procedure b(tool, 13);
    b.readouts = a.readouts;
    const auto found = b.evaluate();
    REQUIRE(found.status == 0);
    REQUIRE(std::fabs(found[tests::joint_length_row] - tool.q[Row::tool_length]) < 1e-9);
    REQUIRE(std::fabs(found.flute(1, tests::flute_length_row) - (tool.q[Row::tool_length] - 2 * um)) < 1e-9);
    REQUIRE(std::fabs(std::remainder(found[tests::phase_row] - turned - raised / drop, 2 * pi)) < 1e-3);
  }
}

TEST_CASE("peaks of many points are the flutes' highest triggers", "[laws][tool_length][procedures]") {
  Mill tool = thesis();
  // Beyond its lowest point's radius an insert passes with one hump, so each flute has one peak.
  tool.q[Row::offset] = 5.6e-3;
  const models::tool_length::InsertHeight heights(mill::insert(tests::named(tool.q), tool.event()), models::laser_setter::beam(tests::named(tool.q)));
  const models::tool_length::TriggerCurve curve(heights, tool.condition[Commanded::feed] / tool.condition[Commanded::spindle_speed]);
  REQUIRE(curve.at(0).to - curve.at(0).from == Approx(curve.period()));
  constexpr int readings = 3600;
  Procedure p(tool, readings, mill::peaks);
  p.simulate();
  const auto found = p.evaluate();
  REQUIRE(found.status == 0);
  // Before its peak the curve rises by no more than the descent between two angles.
  const double step = per_flute(tool) * 2 / readings;
  const auto at = [&](int k, int row) { return found[tests::peak_rows + tests::flute_rows * k + row]; };
  for (int k = 0; k < 2; ++k) {
    const double exact =
        tool.q[Row::tool_length] - tool.q[Row::wear_1 + static_cast<std::size_t>(k)] + heights.highest().height;
    REQUIRE(at(k, tests::flute_length_row) <= exact + 1e-12);
    REQUIRE(at(k, tests::flute_length_row) > exact - step);
  }
  REQUIRE(at(1, tests::wear_difference_row) == Approx(2 * um).margin(step));
  REQUIRE(found[tests::joint_effective_row] == at(0, tests::flute_length_row));
  REQUIRE(found[tests::joint_length_row] == found[tests::joint_effective_row]); // the least wear declared is none
}

TEST_CASE("a single readout is taken for the longest flute", "[tool_length][procedures]") {
  Mill tool = thesis();
  tool.q[Row::wear_1] = 1 * um;
  for (const int e : {mill::single, mill::slow}) {
    Procedure p(tool, 1, e);
    p.readouts.assign(8, tool.q[Row::laser_z] + 0.1766);
    REQUIRE(p.problem().empty());
    const auto found = p.evaluate();
    REQUIRE(std::fabs(found[tests::joint_effective_row] - 0.1766) < 1e-15);
    REQUIRE(std::fabs(found[tests::joint_length_row] - 0.1766 - 1 * um) < 1e-15);
    REQUIRE(Procedure(tool, 2, e).problem().find("this evaluation uses only one") != std::string::npos);
  }
}

TEST_CASE("readings that no curve goes through are refused", "[tool_length][procedures]") {
  const auto problem = [](const auto& change, int readings = 6) {
    Procedure p(thesis(), readings);
    change(p.conditions);
    return p.problem();
  };
  const auto says = [](const std::string& text, const char* words) { return text.find(words) != std::string::npos; };
  REQUIRE(problem([](auto&) {}).empty());
  REQUIRE(problem([](auto&) {}, 3).empty());
  REQUIRE(says(problem([](auto&) {}, 2), "2 readings for 3 unknowns: 2 flute heights and the phase"));
  REQUIRE(says(problem([](auto&) {}, 0), "no reading"));
  REQUIRE(says(problem([](auto& c) { std::swap(c[1], c[2]); }), "must increase"));
  REQUIRE(says(problem([](auto& c) { c[3] = c[2]; }), "must increase"));
  REQUIRE(says(problem([](auto& c) { c[5][Commanded::start_angle] = 7; }), "a turn or more after the first"));
  REQUIRE(says(problem([](auto& c) { c[4][Commanded::feed] *= 2; }), "feed differs between readings 1 and 5"));
  REQUIRE(says(problem([](auto& c) { c[4][Commanded::spindle_speed] *= 2; }), "spindle_speed differs"));
  REQUIRE(says(problem([](auto& c) { c[1][Commanded::start_height] = -1e-3; }), "start_height of reading 2"));
  Procedure far(thesis().where(Row::offset, 30e-3), 6);
  REQUIRE(says(far.problem(), "no flute covers"));
  REQUIRE(far.evaluate().status == static_cast<int>(Status::never_covered));
  // Heights may differ: they turn the phase by what is known.
  Procedure p(thesis(), 6);
  for (std::size_t r = 0; r < 6; ++r) p.conditions[r][Commanded::start_height] += 1e-5 * static_cast<double>(r * r);
  REQUIRE(p.problem().empty());
  const auto truth = p.simulate();
  const auto found = p.evaluate();
  REQUIRE(std::fabs(found[tests::joint_length_row] - truth[tests::joint_length_row]) < 1e-9);
  REQUIRE(std::fabs(found.flute(1, tests::flute_length_row) - truth.flute(1, tests::flute_length_row)) < 1e-9);
}

TEST_CASE("intervals of the fitted lengths cover at their rate", "[laws][tool_length][procedures][coverage]") {
  // Each set: a phase, readouts with noise, and 39 draws of the same noise about them. Were the errors of the draws
  // like that of the set, the truth would fall between their least and greatest in 38 of 40 cases.
  constexpr int sets = 140, draws = 39;
  constexpr double noise = 0.3 * um, rate = 38.0 / 40;
  Draw draw;
  int covered[3] = {};
  for (int s = 0; s < sets; ++s) {
    Procedure p(thesis().where(Row::holder_angle, draw(0, 2 * pi)), 12);
    const auto truth = p.simulate();
    const auto exact = p.readouts;
    std::vector<double> read(p.conditions.size());
    for (std::size_t r = 0; r < read.size(); ++r) read[r] = exact[8 * r] + noise * normal(draw);
    constexpr int first = tests::curve_rows, next = first + static_cast<int>(tests::flute_rows);
    constexpr int row[3] = {tests::joint_length_row, first, next};
    double low[3] = {1, 1, 1}, high[3] = {};
    for (int block = 0, left = draws; left > 0; ++block, left -= 8) {
      for (std::size_t r = 0; r < read.size(); ++r)
        for (std::size_t i = 0; i < 8; ++i) p.readouts[8 * r + i] = read[r] + noise * normal(draw);
      const auto found = p.evaluate();
      REQUIRE(found.status == 0);
      for (int m = 0; m < 3; ++m)
        for (int i = 0; i < std::min(left, 8); ++i) {
          const double x = found.rows[static_cast<std::size_t>(row[m])][static_cast<std::size_t>(i)];
          low[m] = std::min(low[m], x), high[m] = std::max(high[m], x);
        }
    }
    for (int m = 0; m < 3; ++m) covered[m] += low[m] <= truth[row[m]] && truth[row[m]] <= high[m];
  }
  const double tolerance = 4 * std::sqrt(rate * (1 - rate) / sets);
  for (const int c : covered) {
    INFO(covered[0] << ' ' << covered[1] << ' ' << covered[2] << " of " << sets);
    REQUIRE(std::fabs(static_cast<double>(c) / sets - rate) < tolerance);
  }
}
