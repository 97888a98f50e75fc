/// Effects of slides on a machine with three of them and a touching tip, without rotary axes.
#include <catch2/catch.hpp>

#include <vector>

#include "effects/act.h"

using namespace gumshoe;

namespace {

constexpr double um = 1e-6;

/// A touch along X at 30 mm/min; Y came from below, Z from above.
chain::ProbingEvent<double> touch() {
  chain::ProbingEvent<double> event;
  event.time = 1800;
  event.x = {.position = 0.4, .direction = 1, .feed = 0.5e-3};
  event.y = {.position = -0.2, .direction = 1};
  event.z = {.position = 0.1, .direction = -1};
  event.approach = event.approach_in_probe = {1, 0, 0};
  return event;
}

chain::ProbingEvent<double> with(std::string_view name, const std::vector<double>& values) {
  chain::ProbingEvent<double> event = touch();
  std::size_t effect = 0;
  while (effects::cards()[effect]->name != name) ++effect;
  REQUIRE(effects::cards()[effect]->quantities.size() == values.size());
  const effects::Active active[] = {{effect, 0}};
  effects::act<double>(active, values.data(), event);
  return event;
}

/// What the control reads more than without the effect.
Vector3<double> shift(std::string_view name, const std::vector<double>& values) {
  const Vector3<double> actual{0.4, -0.2, 0.1};
  const auto event = with(name, values);
  const Vector3<double> read = chain::reading_of(actual, event), back = chain::actual_of(read, event) - actual;
  CHECK(dot(back, back) < 1e-30);
  return read - chain::reading_of(actual, touch());
}

void check(const Vector3<double>& found, const Vector3<double>& expected) {
  // A double holds 6e-17 m of readings of 0.4 m; the expected shifts leave out 1 + scale, 1e-5 of them.
  for (const auto& [a, b] : {std::pair{found.x, expected.x}, {found.y, expected.y}, {found.z, expected.z}})
    CHECK(a == Approx(b).epsilon(2e-5).margin(2e-16));
}

} // namespace

TEST_CASE("each slide lags half its reversal value behind, on the side from which it came", "[laws][effects]") {
  check(shift("x_reversal", {4 * um}), {2 * um, 0, 0});
  check(shift("y_reversal", {4 * um}), {0, 2 * um, 0});
  check(shift("z_reversal", {4 * um}), {0, 0, -2 * um});
}

TEST_CASE("each slide that goes too far reads less of its travel", "[laws][effects]") {
  check(shift("x_scale", {10 * um}), {-4 * um, 0, 0});
  check(shift("y_scale", {10 * um}), {0, 2 * um, 0});
  check(shift("z_scale", {10 * um}), {0, 0, -1 * um});
}

TEST_CASE("a bowed guideway moves the two other slides by the square of its position", "[laws][effects]") {
  check(shift("x_straightness", {50 * um, 100 * um}), {0, -8 * um, -16 * um});
  check(shift("y_straightness", {50 * um, 100 * um}), {-2 * um, 0, -4 * um});
  check(shift("z_straightness", {50 * um, 100 * um}), {-0.5 * um, -1 * um, 0});
}

TEST_CASE("latency and pretravel act along the slide that approaches", "[laws][effects]") {
  check(shift("trigger_latency", {2e-3}), {1 * um, 0, 0});
  check(shift("pretravel", {5 * um}), {5 * um, 0, 0});
  check(shift("pretravel_bending", {5 * um}), {5 * um, 0, 0});
}

TEST_CASE("drift along X and Y, growth along Z", "[laws][effects]") {
  check(shift("thermal_drift", {2 * um / 3600, 4 * um / 3600, 0, 0, 600}), {-1 * um, -2 * um, 0});
  check(shift("thermal_growth", {2 * um / 3600, 0, 600}), {0, 0, 1 * um});
}

TEST_CASE("reversal of X and Y is offered to models that know the sides, and to no other", "[contracts][effects]") {
  constexpr Stage knowing[] = {Stage::slides, Stage::slide_directions}, not_knowing[] = {Stage::motion, Stage::slides};
  ModelCard model{};
  for (const char* name : {"x_reversal", "y_reversal"}) {
    model.stages = knowing;
    CHECK(effects::applies(model, *effects::find(name)));
    model.stages = not_knowing;
    CHECK_FALSE(effects::applies(model, *effects::find(name)));
  }
}

TEST_CASE("stages have their names, in the order in which effects act", "[contracts][effects]") {
  for (std::size_t i = 0; i < std::size(stage_table); ++i) CHECK(static_cast<std::size_t>(stage_table[i].stage) == i);
  CHECK(name(Stage::slide_directions) == "slide_directions");
  CHECK(name(Stage::trigger) == stage_table[std::size(stage_table) - 1].name);
}
