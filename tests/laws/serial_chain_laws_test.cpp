/// A target on a serial chain: closed forms of a planar arm, a published robot, the machine's own chain, sphere
/// probing, gravity on an arm, derivatives against differences, and the bits of blocks.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "asked.h"
#include "models/serial_chain/serial_chain.h"
#include "models/sphere_probing/sphere_probing.h"

using namespace gumshoe;
using models::Gradient;
namespace serial = models::serial_chain;
namespace probing = models::probing;

namespace {

constexpr double deg = 3.14159265358979323846 / 180;

struct Draw {
  std::mt19937_64 engine{18};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

using Axes = std::vector<chain::AxisDescription>;

chain::AxisDescription joint(const char* name, const chain::Link& link) {
  chain::AxisDescription axis{name};
  axis.link = link;
  return axis;
}
chain::AxisDescription inclined(const char* name, const std::array<double, 3>& point,
                                const std::array<double, 3>& direction) {
  chain::AxisDescription axis{name, "", point};
  axis.direction = direction;
  return axis;
}

/// The model at one reading, with every quantity by its name.
struct Case {
  models::MadeModel model;
  std::vector<double> q, conditions;
  explicit Case(const chain::MachineDescription& d, serial::Measured measured = serial::Measured::position)
      : model(serial::make(d, measured)), conditions(model->card->conditions.size(), 0.0) {
    for (const auto& card : model->card->quantities) q.push_back(card.default_value);
  }
  std::size_t row(std::string_view name) const {
    for (std::size_t j = 0; j < q.size(); ++j)
      if (model->card->quantities[j].name == name) return j;
    FAIL("no quantity " << name);
    return 0;
  }
  double& operator[](std::string_view name) { return q[row(name)]; }
  propagation::ForwardModel forward() const { return propagation::ForwardModel(*model, {}, 0, {conditions}); }

  /// Indications, with their derivative by one quantity.
  std::vector<Gradient> simulated(std::size_t variable = 0) const {
    std::vector<Gradient> point(q.begin(), q.end()), out;
    point[variable] = Gradient::variable(q[variable], 0);
    point.resize(q.size() + model->card->indications.size());
    REQUIRE(forward().indications(0, point, out).status == 0);
    return out;
  }
  /// All measurands of a reading.
  std::vector<double> evaluated(const std::vector<double>& read) const {
    const auto joined = tests::joined(q, read);
    std::vector<Gradient> point(joined.begin(), joined.end()), out;
    REQUIRE(forward().measurands(0, point, out).status == 0);
    std::vector<double> values;
    for (const Gradient& g : out) values.push_back(g.v);
    return values;
  }
  Vector3<double> place() const {
    const auto s = simulated();
    return {s[0].v, s[1].v, s[2].v};
  }
};

void check_place(const Vector3<double>& a, const Vector3<double>& b, double tolerance) {
  CHECK(std::fabs(a.x - b.x) < tolerance);
  CHECK(std::fabs(a.y - b.y) < tolerance);
  CHECK(std::fabs(a.z - b.z) < tolerance);
}

/// Links of both conventions, a linear joint, an inclined rotary axis, a slide: everything at once, on both sides.
chain::MachineDescription odd() {
  return {"odd", Axes{{"Y", "", {0.1, 0.2, 0.3}}, inclined("C", {0.2, -0.1, 0.05}, {0.2, -0.3, 1})},
          Axes{{"Z"},
               inclined("B", {0.1, 0, 0.4}, {0, 1, 1}),
               joint("J1", {0.1, 80 * deg, 0.2, 10 * deg}),
               joint("J2", {-0.3, -20 * deg, 0.1, -30 * deg, true}),
               [] {
                 auto slide = joint("J3", {0.05, 90 * deg, 0.1, 0});
                 slide.kind = "linear";
                 return slide;
               }()}};
}

Case anywhere(Draw& draw, serial::Measured measured) {
  Case c(odd(), measured);
  for (std::size_t j = 0; j < c.q.size(); ++j) {
    const auto& card = c.model->card->quantities[j];
    const bool small = j >= serial::first_of_axes;
    c.q[j] = card.name.starts_with("compliance") ? draw(0, 1e-3)
             : card.name.starts_with("mass")     ? draw(0, 20)
             : card.name.starts_with("centre")   ? draw(-0.3, 0.3)
             : card.name.starts_with("gravity")  ? draw(-9.8, 9.8)
                                                 : (small ? 1e-2 : 0.7) * draw(-1, 1);
  }
  for (double& x : c.conditions) x = draw(-0.9, 0.9);
  c.conditions.back() = draw(0, 5); // payload
  return c;
}

} // namespace

TEST_CASE("a planar arm of two links in closed form", "[laws][serial_chain]") {
  Draw draw;
  Case c({"", Axes{}, Axes{joint("J1", {0.4}), joint("J2", {0.3})}});
  for (int i = 0; i < 20; ++i) {
    const double a = draw(-3, 3), b = draw(-3, 3);
    c.conditions = {a, b, 0};
    c["delta_a_J1"] = 1e-3, c["delta_theta_J2"] = 0.01, c["scale_J1"] = 1e-4, c["cosine_J2"] = 2e-3,
    c["sine_J2"] = -1e-3;
    const double first = a * (1 + 1e-4), second = b + 0.01 + 2e-3 * std::cos(b) - 1e-3 * std::sin(b);
    check_place(c.place(),
                {0.401 * std::cos(first) + 0.3 * std::cos(first + second),
                 0.401 * std::sin(first) + 0.3 * std::sin(first + second), 0},
                2e-15);
  }
}

TEST_CASE("the PUMA 560 as published", "[laws][serial_chain][references]") {
  // Corke, Robotics Toolbox for MATLAB, wiki page "Arm robot examples": the table, and fkine at zero, to the digits
  // printed.
  Case c({"", Axes{},
          Axes{joint("J1", {0, 90 * deg, 0}), joint("J2", {0.4318}), joint("J3", {0.0203, -90 * deg, 0.15005}),
               joint("J4", {0, 90 * deg, 0.4318}), joint("J5", {0, -90 * deg}), joint("J6", {})}});
  check_place(c.place(), {0.4521, -0.15, 0.4318}, 5.1e-5);
}

TEST_CASE("both conventions of links are one robot", "[laws][serial_chain]") {
  // The modified link i has a and alpha of the standard link i - 1; the last twist goes to the target.
  Draw draw;
  const double a[] = {0.1, -0.4, 0.2}, alpha[] = {80 * deg, -30 * deg, 50 * deg}, d[] = {0.2, 0.1, -0.3},
               theta[] = {0.3, -0.2, 0.1};
  const auto link = [&](int i, bool modified) {
    const int from = modified ? i - 1 : i;
    return chain::Link{from < 0 ? 0 : a[from], from < 0 ? 0 : alpha[from], d[i], theta[i], modified};
  };
  Case standard(
      {"", Axes{}, Axes{joint("J1", link(0, false)), joint("J2", link(1, false)), joint("J3", link(2, false))}});
  Case modified({"", Axes{}, Axes{joint("J1", link(0, true)), joint("J2", link(1, true)), joint("J3", link(2, true))}});
  standard["target_x"] = 0.05, standard["target_y"] = -0.02, standard["target_z"] = 0.1;
  modified["target_x"] = 0.05 + a[2];
  modified["target_y"] = -0.02 * std::cos(alpha[2]) - 0.1 * std::sin(alpha[2]);
  modified["target_z"] = -0.02 * std::sin(alpha[2]) + 0.1 * std::cos(alpha[2]);
  for (int i = 0; i < 20; ++i) {
    standard.conditions = modified.conditions = {draw(-3, 3), draw(-3, 3), draw(-3, 3), 0};
    check_place(standard.place(), modified.place(), 2e-15);
  }
}

TEST_CASE("a five-axis machine is the chain of the machine, and that of sphere probing", "[laws][serial_chain]") {
  Draw draw;
  for (const auto& d : chain::machines()) {
    Case c(d);
    const chain::Machine machine(d);
    std::vector<double> errors(machine.axes().size() * chain::error_kinds, 0.0);
    for (std::size_t j = 0; j < c.q.size(); ++j)
      if (const auto place = machine.error(c.model->card->quantities[j].name))
        errors[place->index()] = c.q[j] = draw(-1, 1) * 1e-2;
    c["target_x"] = 0.1, c["target_y"] = -0.2, c["target_z"] = -0.15;
    for (double& x : c.conditions) x = draw(-0.9, 0.9);
    c.conditions.back() = 0;
    check_place(c.place(),
                machine.workpiece_from_tool(c.conditions.data(), errors.data()) * Vector3<double>{0.1, -0.2, -0.15},
                2e-15);

    // At the commands that sphere probing simulates, the target stands at the sphere.
    const auto probe = probing::make(d);
    std::vector<Gradient> point, read;
    for (const auto& card : probe->card->quantities) {
      const auto place = machine.error(card.name);
      point.emplace_back(place ? errors[place->index()] : card.default_value);
    }
    const double points[] = {0.1, -0.2, -0.15, 0.07, 0.03, -0.05};
    for (std::size_t j = 0; j < 6; ++j) point[j] = points[j];
    point.resize(point.size() + 3);
    std::vector<double> angles;
    for (const auto& card : probe->card->conditions) angles.push_back(c.conditions[machine.axis(card.name)]);
    const propagation::ForwardModel forward(*probe, {}, 0, {angles});
    REQUIRE(forward.indications(0, point, read).status == 0);
    for (std::size_t k = 0; k < 3; ++k) c.conditions[machine.axis(probe->card->indications[k].name)] = read[k].v;
    check_place(c.place(), {0.07, 0.03, -0.05}, 5e-15);
  }
}

TEST_CASE("an inclined axis turns about its line and has its errors along it", "[laws][serial_chain][machine]") {
  // A head at 45 deg: half a turn takes the tool from vertical to horizontal.
  Case c({"", Axes{}, Axes{inclined("B", {0, 0, 0.1}, {0, 1, 1})}});
  c["target_z"] = -0.2; // 0.3 below the point on the axis
  c.conditions = {180 * deg, 0};
  check_place(c.place(), {0, -0.3, 0.1}, 1e-16 * 10);
  // An offset across the line moves that line: half a turn doubles it. Y turned with the axis is the line's own.
  c["E_X0B"] = 1e-3, c["E_Z0B"] = 2e-3; // Z of the letter, turned by -45 deg about X: (0, -1, 1) / sqrt 2 * -1
  const double half = 2 * 2e-3 / std::sqrt(2.0);
  check_place(c.place(), {2e-3, -0.3 - half, 0.1 + half}, 1e-15);
}

TEST_CASE("gravity twists an arm by its torque", "[laws][serial_chain]") {
  // A rotary joint about Y carries 2 kg at 0.5 m and 3 kg at 1 m: the torque at angle b below the horizontal is
  // (2 * 0.5 + 3 * 1) g cos b. A slide along Z sinks by the whole weight.
  Case c({"", Axes{}, Axes{{"Z"}, {"B"}}});
  c["target_x"] = 1, c["mass_B"] = 2, c["centre_x_B"] = 0.5, c["compliance_B"] = 1e-5, c["compliance_Z"] = 1e-7,
  c["mass_Z"] = 7;
  for (const double b : {0.0, 0.4, -1.2}) {
    c.conditions = {0.3, b, 3};
    const double twisted = b + 1e-5 * 4 * 9.80665 * std::cos(b);
    check_place(c.place(), {std::cos(twisted), 0, 0.3 - 1e-7 * 12 * 9.80665 - std::sin(twisted)}, 2e-16 * 4);
  }
  // The opposite sense of commands leaves the load where it is.
  Case turned({"", Axes{}, Axes{{"Z"}, {"B", "", {}, -1}}});
  for (std::size_t j = 0; j < c.q.size(); ++j) turned.q[j] = c.q[j];
  turned.conditions = {0.3, -0.4, 3};
  c.conditions = {0.3, 0.4, 3};
  check_place(turned.place(), c.place(), 1e-16);
}

TEST_CASE("at simulated readings the chain deviates by nothing", "[laws][serial_chain]") {
  Draw draw;
  for (const auto measured : {serial::Measured::position, serial::Measured::distance})
    for (int i = 0; i < 20; ++i) {
      const Case c = anywhere(draw, measured);
      std::vector<double> read;
      for (const Gradient& g : c.simulated()) read.push_back(g.v);
      const auto y = c.evaluated(read);
      for (std::size_t k = 3; k < y.size(); ++k) CHECK(std::fabs(y[k]) < 1e-14);
      if (measured == serial::Measured::distance) {
        Case at(odd());
        at.q = c.q, at.conditions = c.conditions;
        CHECK(std::fabs(length(at.place()) - read[0]) < 1e-15);
      }
    }
}

TEST_CASE("derivatives of the chain are those of differences", "[laws][serial_chain]") {
  Draw draw;
  for (const auto measured : {serial::Measured::position, serial::Measured::distance}) {
    Case c = anywhere(draw, measured);
    for (std::size_t j = 0; j < c.q.size(); ++j) {
      const auto exact = c.simulated(j);
      double largest = 1;
      for (const Gradient& g : exact) largest = std::max(largest, std::fabs(g.d[0]));
      const double at = c.q[j], step = 1e-5 / largest; // the target moves by about 10 um
      c.q[j] = at + step;
      const auto more = c.simulated();
      c.q[j] = at - step;
      const auto less = c.simulated();
      c.q[j] = at;
      for (std::size_t k = 0; k < exact.size(); ++k) {
        CAPTURE(c.model->card->quantities[j].name, k);
        // 10 um squared over the least distance of 0.1 m squared; rounding of a metre over 10 um is less.
        CHECK(std::fabs(exact[k].d[0] - (more[k].v - less[k].v) / (2 * step)) < 1e-8 * largest);
      }
    }
  }
}

TEST_CASE("blocks of the chain give the bits of points", "[laws][serial_chain]") {
  Draw draw;
  for (const bool loaded : {true, false}) {
    Case c = anywhere(draw, serial::Measured::position);
    if (!loaded)
      for (std::size_t j = 0; j < c.q.size(); ++j)
        if (c.model->card->quantities[j].name.starts_with("compliance")) c.q[j] = 0;
    constexpr std::size_t n = 16;
    std::vector<std::vector<double>> values;
    for (std::size_t j = 0; j < c.q.size(); ++j) { // every third quantity is drawn
      values.emplace_back(n, c.q[j]);
      for (double& v : values.back()) v = j % 3 == 0 ? c.q[j] * draw(0.5, 1.5) : c.q[j];
    }
    const auto forward = c.forward();
    auto columns = values;
    for (std::size_t j = 0; j < columns.size(); ++j)
      if (j % 3 != 0) columns[j].resize(1);
    columns.resize(columns.size() + 3, {0.0});
    const auto there = forward.simulate(tests::block_of(forward, n, columns));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < c.q.size(); ++j) c.q[j] = values[j][i];
      const auto point = c.place();
      CHECK(there.indications[0 * n + i] == point.x);
      CHECK(there.indications[1 * n + i] == point.y);
      CHECK(there.indications[2 * n + i] == point.z);
    }
  }
}
