/// Laws of the mill model with effects that hold whatever the numbers are.
#include <catch2/catch.hpp>

#include "asked.h"
#include "laws/mill_fixture.h"

using namespace gumshoe;
using tests::Draw;
using tests::Mill;
namespace mill = gumshoe::models::tool_length;

namespace {

std::vector<const EffectCard*> applicable() {
  std::vector<const EffectCard*> found;
  for (const EffectCard* card : effects::cards())
    if (effects::applies(*models::find("tool_length")->card, *card)) found.push_back(card);
  return found;
}

/// Values of a size that machines have; whole ones where the effect wants them.
std::vector<double> some(const EffectCard& card, Draw& draw) {
  std::vector<double> values;
  for (const QuantityCard& q : card.quantities) {
    const std::string unit(q.si_unit);
    const double size = unit == "m" ? 1e-5 : unit == "s" ? 5e-3 : unit == "rad" ? 2e-3 : unit == "m/s" ? 1e-9 : 0.01;
    if (card.name == "revolution_confirm")
      values.push_back(2);
    else if (unit == "K")
      values.push_back(draw(-5, 5));
    else if (card.name == "z_scale")
      values.push_back(draw(-2e-5, 2e-5));
    else if (q.name == "time_constant" && card.name != "servo_lag")
      values.push_back(draw(300, 3000));
    else if (unit == "1/K")
      values.push_back(draw(1e-6, 2e-5));
    else
      values.push_back(q.limits.low >= 0 ? draw(0.1, 1) * (q.limits.high == 1 && unit == "1" ? 1 : size)
                                         : draw(-size, size));
  }
  return values;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

} // namespace

TEST_CASE("a mill's effects at null change nothing, bit for bit", "[laws][effects][tool_length]") {
  Draw draw;
  REQUIRE(applicable().size() >= 19);
  for (int n = 0; n < 30; ++n) {
    const Mill plain = Mill::random(draw);
    const auto there = plain.simulated();
    Mill all = plain;
    const auto compare = [&](const Mill& m) {
      const auto o = m.simulated();
      REQUIRE(o.trigger.height.status == there.trigger.height.status);
      REQUIRE(same(o.spindle_z, there.spindle_z));
      REQUIRE(same(o.trigger.height.value, there.trigger.height.value));
      REQUIRE(same(o.effective_length, there.effective_length));
      const auto back = m.evaluated(-0.3), without = plain.evaluated(-0.3);
      REQUIRE(same(back.length, without.length));
    };
    for (const EffectCard* card : applicable()) {
      INFO(card->name);
      if (n < 5) compare(plain.with(std::string(card->name), {}));
      all = all.with(std::string(card->name), {});
    }
    compare(all);
    // Dual numbers go through the run-out's rotations: not a bit of the flutes is lost there either.
    std::vector<models::Gradient> q(all.q.begin(), all.q.end()), e(all.effects.begin(), all.effects.end());
    for (std::size_t i = 0; i < 4; ++i) e[e.size() - 1 - i] = models::Gradient::variable(e[e.size() - 1 - i].v, 0);
    std::vector<models::Gradient> condition(all.condition.begin(), all.condition.end());
    const auto event = mill::probing_event<models::Gradient>(q.data(), condition.data(), e.data(), all.active);
    for (int k = 0; k < all.q[mill::inserts]; ++k) {
      const auto dual = models::tool_length::converted<double>(mill::flute(q.data(), event, k));
      const auto flat = mill::flute(plain.q.data(), plain.event(), k);
      REQUIRE(dual.insert.tool_radius == flat.insert.tool_radius);
      REQUIRE(dual.insert.seat == flat.insert.seat);
      REQUIRE(dual.insert.radial_angle == flat.insert.radial_angle);
      REQUIRE(dual.insert.axial_angle == flat.insert.axial_angle);
      REQUIRE(dual.raise == flat.raise);
    }
  }
}

TEST_CASE("the mill's evaluation undoes its simulation, each effect alone and all together",
          "[laws][effects][tool_length]") {
  Draw draw;
  int compared = 0;
  const auto check = [&](const Mill& m) {
    const auto there = m.simulated();
    if (there.trigger.height.status != Status::ok) return;
    // The evaluation does not read the length, not even for what grows with it.
    const auto back = m.where(mill::length, 0.04).evaluated(there.spindle_z);
    REQUIRE(back.trigger.height.status == Status::ok);
    // Sums of numbers below 1 m.
    REQUIRE(std::fabs(back.length - m.q[mill::length]) < 1e-15);
    REQUIRE(std::fabs(back.trigger.height.value - there.trigger.height.value) < 1e-15);
    REQUIRE(std::fabs(back.effective_length - there.effective_length) < 1e-15);
    ++compared;
  };
  for (int n = 0; n < 25; ++n) {
    const Mill plain = Mill::random(draw);
    Mill all = plain;
    for (const EffectCard* card : applicable()) {
      INFO(card->name);
      const auto values = some(*card, draw);
      if (n < 8) check(plain.with(std::string(card->name), values));
      all = all.with(std::string(card->name), values);
    }
    INFO("all");
    check(all);
  }
  REQUIRE(compared > 120);
}

TEST_CASE("derivatives by the mill's quantities and effects agree with differences", "[laws][effects][tool_length]") {
  Draw draw;
  int first_compared = 0, second_compared = 0;
  for (int n = 0; n < 3; ++n) {
    Mill m = Mill::random(draw);
    for (const EffectCard* card : applicable())
      if (card->name != "sampling_rate") m = m.with(std::string(card->name), some(*card, draw));
    if (!m.triggers()) continue;
    const double z = m.reading();
    const propagation::ForwardModel forward(*models::find("tool_length"), tests::cards_of(m.active), 0, {m.condition});
    // All at once: quantities, then effects; derivatives of the length by eight of them, and their own.
    const auto at = [&](std::vector<double> x, const std::vector<std::size_t>& by) {
      std::vector<models::Gradient> v(x.begin(), x.end());
      for (std::size_t i = 0; i < by.size(); ++i) v[by[i]] = models::Gradient::variable(x[by[i]], static_cast<int>(i));
      v.emplace_back(z);
      std::vector<models::Gradient> y;
      const auto outcome = forward.measurands(0, v, y);
      return outcome.status == 0 ? y[mill::length_row] : models::Gradient(std::nan(""));
    };
    std::vector<double> x = m.q;
    x.insert(x.end(), m.effects.begin(), m.effects.end());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (i == mill::inserts || i == mill::length) continue;
      const std::size_t other = i == 0 ? 1 : i - 1;
      const auto here = at(x, {i, other});
      // Steps small against the beam and the descent of a turn; lengths are good to 1e-16 m.
      const double h = 1e-8 * (std::fabs(x[i]) > 0.05 ? 1.0 : 0.1);
      auto up = x, down = x;
      up[i] += h, down[i] -= h;
      const auto above = at(up, {i, other}), below = at(down, {i, other});
      INFO("case " << n << ", column " << i);
      const double difference = (above.v - below.v) / (up[i] - down[i]);
      const double bend = std::fabs(above.d[0] - below.d[0]);
      if (std::fabs(above.d[0] - below.d[0]) > 1e-3 * (std::fabs(here.d[0]) + 1e-3)) continue; // a jump between
      REQUIRE(std::fabs(here.d[0] - difference) < bend + 3e-15 / h + 1e-6 * std::fabs(difference));
      ++first_compared;
    }
    // Second derivatives: of the exact first ones.
    for (std::size_t i = 0; i < x.size(); i += 3) {
      if (i == mill::inserts || i == mill::length) continue;
      const std::size_t j = (i + 7) % x.size();
      if (j == mill::inserts || j == mill::length) continue;
      using D = models::Curvature;
      std::vector<D> v(x.begin(), x.end());
      v[i] = D::variable(models::Gradient(x[i]), 0);
      v[j].v = models::Gradient::variable(x[j], 0);
      v.emplace_back(z);
      std::vector<D> y;
      REQUIRE(forward.measurands(0, v, y).status == 0);
      const double exact = y[mill::length_row].d[0].d[0];
      const double h = 1e-7 * (std::fabs(x[j]) > 0.05 ? 1.0 : 0.1);
      auto up = x, down = x;
      up[j] += h, down[j] -= h;
      const double above = at(up, {i}).d[0], below = at(down, {i}).d[0], here = at(x, {i}).d[0];
      INFO("case " << n << ", columns " << i << " and " << j);
      if (std::fabs(above - 2 * here + below) > 1e-2 * std::fabs(above - below) + 1e-9) continue; // bent too much
      const double difference = (above - below) / (up[j] - down[j]);
      // First derivatives are good to 1e-11 of their size, by the crossings of the circle.
      REQUIRE(std::fabs(exact - difference) < 1e-3 * std::fabs(difference) + 1e-10 * (1 + std::fabs(here)) / h);
      ++second_compared;
    }
  }
  REQUIRE(first_compared > 200);
  REQUIRE(second_compared > 40);
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
  const auto o = mill::evaluate(solver, call);
  REQUIRE(std::fabs(o.length.v - m.q[mill::length]) < 1e-15);
  // The reading falls by feed times latency, so the length that is stated rises with it.
  const double v = m.condition[mill::feed];
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
           {m.with("servo_lag", {-1e-3}), "servo_lag"},
           {m.with("sampling_rate", {-1e-3}), "sampling_rate"},
           {m.with("revolution_confirm", {-1.0}), "revolution_confirm"},
           {m.with("trigger_latency", {std::nan("")}).with("feed_start_delay", {std::nan("")}), "finite"},
           {m.under(mill::feed, 0), "feed"},
           {m.under(mill::speed, 0), "spindle_speed"},
           {m.under(mill::direction, 1), "direction"},
           {m.where(mill::inserts, 2.5), "inserts"},
           {m.where(mill::inserts, 1e9), "inserts"},
           {m.where(mill::wear, 7e-3), "wear"}}) {
    INFO(words);
    CHECK_THAT(says(bad), Catch::Contains(words));
    CHECK(status(bad) == Status::out_of_domain);
    CHECK(bad.evaluated(-0.35).trigger.height.status == Status::out_of_domain);
  }
  // Errors of inserts that are not there do not matter.
  REQUIRE(says(m.with("insert_radius_error", {0, 0, -7e-3})).empty());
}
