#pragma once
/// A sphere calibration's machine with effects freed, one reading of it at a time.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "laws/sphere_rows.h"

namespace sphere_effects_case {

using namespace gumshoe;
namespace sphere = gumshoe::tests::sphere;
using tests::Row, tests::Commanded, tests::Found;

inline constexpr double pi = 3.14159265358979323846, deg = pi / 180, um = 1e-6, arcsec = deg / 3600;

struct Draw {
  std::mt19937_64 engine{4511};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  double sign() { return (*this)(0, 1) < 0.5 ? -1 : 1; }
};

inline std::vector<const EffectCard*> applicable() {
  std::vector<const EffectCard*> found;
  for (const EffectCard* card : effects::cards())
    if (effects::applies(*models::find("sphere_calibration")->card, *card)) found.push_back(card);
  return found;
}

/// Ten times what machines have.
inline std::vector<double> some(const EffectCard& card, Draw& draw) {
  std::vector<double> values;
  for (const QuantityCard& q : card.quantities) {
    const std::string_view unit = q.si_unit;
    const double size = unit == "m"     ? 1e-4
                        : unit == "rad" ? 5e-4
                        : unit == "1"   ? 2e-4
                        : unit == "m/s" ? 5e-8
                        : unit == "1/m" ? 1e-3
                        : unit == "s"   ? 5e-3
                                        : 0;
    REQUIRE(size > 0);
    values.push_back(q.role == Role::shape ? draw(300, 3000) : draw(-size, size));
    REQUIRE(q.limits.contain(values.back()));
  }
  return values;
}

/// One reading of one machine.
struct Grinder {
  std::vector<double> q, condition, e;
  std::vector<effects::Active> active;

  Grinder() : condition(tests::conditions, 0.0) {
    for (const auto& card : models::find("sphere_calibration")->card->quantities) q.push_back(card.default_value);
    for (std::size_t j = 0; j < tests::conditions; ++j)
      condition[j] = sphere::condition_cards[j].default_value;
  }
  static Grinder random(Draw& draw) {
    Grinder g;
    const auto fill = [&](std::size_t from, std::size_t to, double size) {
      for (std::size_t j = from; j <= to; ++j) g.q[j] = draw(-size, size);
    };
    fill(Row::probe_x, Row::probe_z, 0.5), fill(Row::E_X0B, Row::E_Y0C, 1e-3);
    fill(Row::E_A0B, Row::E_B0C, 1 * deg), fill(Row::link_B_x, Row::link_C_y, 0.3);
    fill(Row::sphere_distance, Row::sphere_z, 0.2);
    for (const auto radius : {Row::sphere_radius, Row::tip_radius}) g.q[radius] = std::fabs(g.q[radius]);
    fill(Row::E_AA, Row::E_CC, 0.05 * deg);
    fill(Row::E_XX, Row::E_ZZ, 5e-6), fill(Row::S_XY, Row::S_YZ, 5e-5);
    return g.under({{Commanded::A, draw(-pi, pi)},
                    {Commanded::B, draw(-2, 2)},
                    {Commanded::C, draw(-pi, pi)},
                    {Commanded::direction, draw.sign()},
                    {Commanded::time, draw(0, 7200)},
                    {Commanded::feed, draw(1e-4, 1e-3)},
                    {Commanded::B_direction, draw.sign()},
                    {Commanded::C_direction, draw.sign()},
                    {Commanded::B_clamped, draw(0, 1) < 0.5},
                    {Commanded::C_clamped, draw(0, 1) < 0.5}});
  }
  Grinder under(std::initializer_list<std::pair<std::size_t, double>> values) const {
    Grinder g = *this;
    for (const auto& [which, value] : values) g.condition[which] = value;
    return g;
  }
  Grinder where(std::size_t which, double value) const {
    Grinder g = *this;
    g.q[which] = value;
    return g;
  }
  /// Without values: at null.
  Grinder with(std::string_view name, std::vector<double> values = {}) const {
    Grinder g = *this;
    std::size_t index = 0;
    while (effects::cards()[index]->name != name) ++index;
    g.active.push_back({index, g.e.size()});
    for (const QuantityCard& card : effects::cards()[index]->quantities) {
      const auto i = static_cast<std::size_t>(&card - effects::cards()[index]->quantities.data());
      g.e.push_back(values.empty() ? card.default_value : values.at(i));
    }
    return g;
  }
  Grinder with_all(Draw& draw) const {
    Grinder g = *this;
    for (const EffectCard* card : applicable()) g = g.with(card->name, some(*card, draw));
    return g;
  }

  template <class T> sphere::Contact<T> contact(const std::vector<T>& values, int variant = sphere::exact) const {
    return sphere::contact(
        tests::reading<T>(variant, values.data(), condition, {active, values.data() + q.size()}));
  }
  std::vector<double> values() const {
    auto v = q;
    v.insert(v.end(), e.begin(), e.end());
    return v;
  }
  Vector3<double> commands(int variant = sphere::exact) const {
    return sphere::simulate(contact<double>(values(), variant));
  }
};

inline double distance(const Vector3<double>& a, const Vector3<double>& b) { return std::sqrt(dot(a - b, a - b)); }
inline bool same(const Vector3<double>& a, const Vector3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

} // namespace sphere_effects_case
