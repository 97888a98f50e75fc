/// Laws of the mill model with effects that hold whatever the numbers are.
#include <catch2/catch.hpp>

#include "asked.h"
#include "laws/mill_fixture.h"

using namespace gumshoe;
using tests::Draw;
using tests::Mill;
namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

TEST_CASE("dual numbers lose no bit of the flutes in the run-out's rotations", "[laws][effects][tool_length]") {
  Draw draw;
  for (int n = 0; n < 30; ++n) {
    const Mill plain = Mill::random(draw), m = plain.with("tool_runout", {});
    const std::vector<models::Gradient> q(m.q.begin(), m.q.end());
    std::vector<models::Gradient> e;
    for (const double x : m.effects) e.push_back(models::Gradient::variable(x, 0));
    const auto event = mill::probing_event(models::reading_of<mill::ToolLength>(m.call(q, e), false));
    for (int k = 0; k < m.q[Row::inserts]; ++k) {
      const auto dual = models::converted<double>(mill::flute(tests::named(q), event, k));
      const auto flat = mill::flute(tests::named(plain.q), plain.event(), k);
      REQUIRE(dual.insert.tool_radius == flat.insert.tool_radius);
      REQUIRE(dual.insert.seat == flat.insert.seat);
      REQUIRE(dual.insert.radial_angle == flat.insert.radial_angle);
      REQUIRE(dual.insert.axial_angle == flat.insert.axial_angle);
      REQUIRE(dual.raise == flat.raise);
    }
  }
}

TEST_CASE("the sampled receiver has the derivatives of its mean, and of its phase", "[effects][tool_length]") {
  const Mill m = Mill().with("sampling_rate", {3e-3, 0.3});
  const double z = m.reading();
  std::vector<models::Gradient> q(m.q.begin(), m.q.end()), e(m.effects.begin(), m.effects.end());
  for (int i = 0; i < 2; ++i)
    e[static_cast<std::size_t>(i)] = models::Gradient::variable(m.effects[static_cast<std::size_t>(i)], i);
  models::Gradient reading(z);
  models::tool_length::TriggerSolver solver;
  auto call = m.call(q, e);
  call.indications = &reading;
  const auto o = mill::evaluate(solver, models::reading_of<mill::ToolLength>(call, false), reading);
  REQUIRE(std::fabs(o.length.v - m.q[Row::tool_length]) < 1e-15);
  // The reading falls by feed times latency, so the length that is stated rises with it.
  const double v = m.condition[Commanded::feed];
  REQUIRE(o.length.d[0] == Approx(v / 2).epsilon(1e-12));
  REQUIRE(o.length.d[1] == Approx(v * 3e-3).epsilon(1e-12));
}

TEST_CASE("what a mill's effects make impossible is said", "[effects][tool_length]") {
  const auto says = [](const Mill& m) { return models::find("tool_length")->check(m.call(m.q, m.effects)); };
  const auto status = [](const Mill& m) { return m.simulated().trigger.height.status; };
  const Mill m;
  REQUIRE(says(m).empty());
  for (const auto& [bad, words] : std::initializer_list<std::pair<Mill, const char*>>{
           {m.with("insert_radius_error", {0, -7e-3}), "insert_radius"},
           {m.with("insert_seat_error", {-11e-3}), "tool_radius"},
           {m.with("insert_axial_angle_error", {1.8}), "insert_axial_angle"},
           {m.with("spindle_speed_error", {-1.5}), "spindle_speed"},
           {m.with("trigger_latency", {std::nan("")}).with("feed_start_delay", {std::nan("")}), "finite"},
           {m.under(Commanded::feed, 0), "feed"},
           {m.under(Commanded::spindle_speed, 0), "spindle_speed"},
           {m.under(Commanded::direction, 1), "direction"},
           {m.where(Row::inserts, 2.5), "inserts"},
           {m.where(Row::inserts, 1e9), "inserts"},
           {m.where(Row::wear_1, 7e-3), "wear"}}) {
    INFO(words);
    CHECK_THAT(says(bad), Catch::Contains(words));
    CHECK(status(bad) == Status::out_of_domain);
    CHECK(bad.evaluated(-0.35).trigger.height.status == Status::out_of_domain);
  }
  // What the limits of a card refuse before has a status, and no words of the model's own.
  for (const Mill& bad : {m.with("servo_lag", {-1e-3}), m.with("sampling_rate", {-1e-3}), m.with("revolution_confirm", {-1.0})})
    CHECK(status(bad) == Status::out_of_domain);
  // Errors of inserts that are not there do not matter.
  REQUIRE(says(m.with("insert_radius_error", {0, 0, -7e-3})).empty());
}
