/// The general chain of machine axes: against matrix products written out here, published five-axis transforms, first-
/// order theory and differences; and what is said of wrong descriptions.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <random>

#include "base/error.h"
#include "chain/machine.h"
#include "math/dual.h"

using namespace gumshoe;
using namespace gumshoe::chain;

namespace {

struct Draw {
  std::mt19937_64 engine{230};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

// Homogeneous matrices, plainly.
using M4 = std::array<std::array<double, 4>, 4>;
M4 product(const M4& a, const M4& b) {
  M4 c{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}
M4 D(int axis, double value) { ///< 0 to 2: shift along X, Y, Z; 3 to 5: turn about X, Y, Z
  M4 m{};
  for (std::size_t i = 0; i < 4; ++i) m[i][i] = 1;
  if (axis < 3) {
    m[static_cast<std::size_t>(axis)][3] = value;
    return m;
  }
  const auto i = static_cast<std::size_t>((axis - 2) % 3), j = static_cast<std::size_t>((axis - 1) % 3);
  m[i][i] = m[j][j] = std::cos(value);
  m[i][j] = -std::sin(value);
  m[j][i] = std::sin(value);
  return m;
}
M4 chain_of(std::initializer_list<M4> factors) {
  M4 m = D(0, 0);
  for (const M4& f : factors) m = product(m, f);
  return m;
}
double entry(const Pose<double>& p, std::size_t i, std::size_t j) {
  const Vector3<double> column = j == 0 ? p.turn.x : j == 1 ? p.turn.y : j == 2 ? p.turn.z : p.shift;
  return i == 0 ? column.x : i == 1 ? column.y : column.z;
}
double distance(const Pose<double>& p, const M4& m) {
  double d = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) d = std::max(d, std::fabs(entry(p, i, j) - m[i][j]));
  return d;
}

/// One axis with errors, by turning the design axis onto its line and back: for Z, about Y and then about X.
M4 plain_motion(const Axis& axis, double command, const double* e) {
  const int d = axis.direction, u = (d + 1) % 3, v = (d + 2) % 3;
  // Direction ~ along d: 1, along u: tan E_v, along v: -tan E_u.
  const double toward_u = std::tan(e[E_A0 + v]), toward_v = -std::tan(e[E_A0 + u]);
  const double about_v = std::atan(toward_u), about_u = -std::atan2(toward_v, std::hypot(1, toward_u));
  // Turning d about v leads to u, then about u, carried along: away from v. Checked by the tests of pure squareness.
  const M4 onto = product(D(3 + v, about_v), D(3 + u, about_u)), back = product(D(3 + u, -about_u), D(3 + v, -about_v));
  const double travel = axis.sense * command;
  const std::array<double, 3> p{axis.point.x, axis.point.y, axis.point.z};
  M4 at = D(0, 0), from = D(0, 0), errors = D(0, 0), moved = D(0, 0);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double offset = axis.rotary ? e[E_X0 + i] : 0;
    at = product(at, D(i, p[k] + offset));
    from = product(from, D(i, -p[k] - offset));
    errors = product(D(i, e[E_X + i]), errors);
  }
  if (axis.rotary) {
    for (int i = 0; i < 3; ++i)
      if (i != d) errors = product(errors, D(3 + i, e[E_A + i]));
    moved = chain_of({onto, D(3 + d, travel + e[E_A0 + d] + e[E_A + d]), back});
    return chain_of({at, errors, moved, from});
  }
  moved = chain_of({onto, D(d, travel + e[E_X0 + d]), back});
  for (int i = 0; i < 3; ++i) errors = product(errors, D(3 + i, e[E_A + i]));
  return chain_of({moved, at, errors, from});
}

/// Every axis twice removed from the usual: three rotary, three linear, on both sides.
Machine odd_machine(Draw& draw, double size, std::vector<double>& errors, std::vector<double>& commands) {
  const auto point = [&] { return std::array<double, 3>{draw(-1, 1), draw(-1, 1), draw(-1, 1)}; };
  const Machine machine(MachineDescription{"odd", std::vector<AxisDescription>{{"Y", "", point()}, {"C", "", point()}},
                                           std::vector<AxisDescription>{{"Z", "", point()},
                                                                        {"A", "rotary", point()},
                                                                        {"X", "linear", point(), -1},
                                                                        {"B", "", point()},
                                                                        {"C2", "", point()}}});
  errors.assign(machine.axes().size() * error_kinds, 0.0);
  commands.clear();
  for (std::size_t i = 0; i < machine.axes().size(); ++i) {
    commands.push_back(draw(-2, 2));
    for (int k = 0; k < error_kinds; ++k)
      if (has_error(machine.axes()[i], k)) errors[i * error_kinds + static_cast<std::size_t>(k)] = size * draw(-1, 1);
  }
  return machine;
}

} // namespace

TEST_CASE("rotations are exact", "[machine][pose]") {
  Draw draw;
  for (int i = 0; i < 200; ++i) {
    const auto k = normalised(Vector3<double>{draw(-1, 1), draw(-1, 1), draw(-1, 1)});
    const double a = draw(-7, 7), b = draw(-1, 1);
    const auto R = rotation(k, a), back = transposed(R) * R, sum = rotation(k, a + b), twice = R * rotation(k, b);
    const auto same = [](const Vector3<double>& x, const Vector3<double>& y) {
      REQUIRE(std::fabs(x.x - y.x) < 2e-15); // a dozen roundings of numbers below 1
      REQUIRE(std::fabs(x.y - y.y) < 2e-15);
      REQUIRE(std::fabs(x.z - y.z) < 2e-15);
    };
    same(back.x, {1, 0, 0}), same(back.y, {0, 1, 0}), same(back.z, {0, 0, 1});
    same(sum.x, twice.x), same(sum.y, twice.y), same(sum.z, twice.z);
    same(R * k, k);
    same(cross(R.x, R.y), R.z); // no reflection
    const auto across = normalised(cross(k, Vector3<double>{0.3, -0.5, 0.8}));
    same(R * across, std::cos(a) * across + std::sin(a) * cross(k, across)); // the right hand
  }
}

TEST_CASE("nominal five-axis transforms as published", "[machine][references]") {
  Draw draw;
  for (int i = 0; i < 20; ++i) {
    const double x = draw(-1, 1), y = draw(-1, 1), z = draw(-1, 1), a = draw(-2, 2), b = draw(-2, 2), c = draw(-2, 2);
    const auto nominal = [](const Machine& m) { return std::vector<double>(m.axes().size() * error_kinds, 0.0); };
    { // Ibaraki 2018, table B, C: mcs_from_wcs = D_b(-B) D_c(-C)
      const Machine m(MachineDescription{"", std::vector<AxisDescription>{{"B"}, {"C"}},
                                         std::vector<AxisDescription>{{"X"}, {"Y"}, {"Z"}}});
      const double at[] = {b, c, x, y, z};
      CHECK(distance(m.bed_from_workpiece(at, nominal(m).data()), product(D(4, -b), D(5, -c))) < 2e-15);
      CHECK(distance(m.bed_from_tool(at, nominal(m).data()), chain_of({D(0, x), D(1, y), D(2, z)})) < 2e-15);
    }
    { // Wang 2013, RRTTT: P = t + Rx(a) Ry(b) (0, 0, z_r)
      const Machine m(*find_machine("RRTTT"));
      const double at[] = {x, y, z, a, b};
      const auto P = m.workpiece_from_tool(at, nominal(m).data()) * Vector3<double>{0, 0, -0.25};
      CHECK(std::fabs(P.x - (x - 0.25 * std::sin(b))) < 2e-15);
      CHECK(std::fabs(P.y - (y + 0.25 * std::sin(a) * std::cos(b))) < 2e-15);
      CHECK(std::fabs(P.z - (z - 0.25 * std::cos(a) * std::cos(b))) < 2e-15);
    }
    { // TTTRR: the table turns a point by +alpha, +gamma where A, C are commanded -alpha, -gamma
      auto description = *find_machine("TTTRR");
      (*description.workpiece_side)[0].point = {0, 0, -0.1}; // z_ag = 0.1 below
      const Machine m(description);
      const double at[] = {-a, -c, 0, 0, 0}, w = 0.3 + 0.1;
      const auto P = m.bed_from_workpiece(at, nominal(m).data()) * Vector3<double>{x, y, 0.3};
      const double u = x * std::cos(c) - y * std::sin(c), v = x * std::sin(c) + y * std::cos(c);
      CHECK(std::fabs(P.x - u) < 2e-15);
      CHECK(std::fabs(P.y - (v * std::cos(a) - w * std::sin(a))) < 2e-15);
      CHECK(std::fabs(P.z - (v * std::sin(a) + w * std::cos(a) - 0.1)) < 2e-15);
    }
    { // RTTTR: B in the head, A in the table
      const Machine m(*find_machine("RTTTR"));
      const double at[] = {a, x, y, z, b};
      CHECK(distance(m.workpiece_from_tool(at, nominal(m).data()),
                     chain_of({D(3, a), D(0, x), D(1, y), D(2, z), D(4, b)})) < 4e-15);
    }
  }
}

TEST_CASE("directions of actual axes are as stated", "[machine]") {
  const double e[] = {0.02, -0.03, 0.05}, none[] = {0, 0, 0};
  const auto a = actual_direction(0, e), b = actual_direction(1, e), c = actual_direction(2, e);
  CHECK(c.x / c.z == Approx(std::tan(-0.03)).epsilon(1e-14));
  CHECK(c.y / c.z == Approx(-std::tan(0.02)).epsilon(1e-14));
  CHECK(b.x / b.y == Approx(-std::tan(0.05)).epsilon(1e-14));
  CHECK(b.z / b.y == Approx(std::tan(0.02)).epsilon(1e-14));
  CHECK(a.y / a.x == Approx(std::tan(0.05)).epsilon(1e-14));
  CHECK(a.z / a.x == Approx(-std::tan(-0.03)).epsilon(1e-14));
  CHECK(dot(c, c) == Approx(1).epsilon(1e-15));
  CHECK(actual_direction(1, none).y == 1);
  // Squareness: a slide Y turned by +E_C0Y leans towards -X, Z turned by +E_B0Z towards +X.
  auto three = MachineDescription{"", std::vector<AxisDescription>{}, std::vector<AxisDescription>{{"Y"}, {"Z"}}};
  three.errors = {{"E_C0Y", 1e-5}, {"E_B0Z", 2e-5}, {"E_A0Z", 4e-5}};
  const Machine m(three);
  const double at[] = {1.0, 0.5};
  const auto tool = m.bed_from_tool(at, m.errors().data()).shift;
  CHECK(tool.x == Approx(-1e-5 + 0.5 * 2e-5).margin(1e-14)); // third powers of 1e-5
  CHECK(tool.y == Approx(1.0 - 0.5 * 4e-5).margin(1e-9));    // and squares, by the normalisation
}

TEST_CASE("the chain is the product of matrices written out", "[machine]") {
  Draw draw;
  for (const double size : {0.0, 1e-4, 0.1})
    for (int i = 0; i < 20; ++i) {
      std::vector<double> errors, commands;
      const Machine m = odd_machine(draw, size, errors, commands);
      M4 workpiece = D(0, 0), tool = D(0, 0);
      for (std::size_t k = 0; k < m.axes().size(); ++k) {
        M4& side = k < 2 ? workpiece : tool;
        side = product(side, plain_motion(m.axes()[k], commands[k], errors.data() + k * error_kinds));
      }
      // Coordinates up to some 10 m, hundreds of products.
      CHECK(distance(m.bed_from_workpiece(commands.data(), errors.data()), workpiece) < 2e-14);
      CHECK(distance(m.bed_from_tool(commands.data(), errors.data()), tool) < 2e-14);
      const auto loop = m.workpiece_from_tool(commands.data(), errors.data());
      CHECK(distance(m.bed_from_workpiece(commands.data(), errors.data()) * loop, tool) < 4e-14);
      CHECK(distance(inverse(loop) * loop, D(0, 0)) < 4e-14);
    }
}

TEST_CASE("small errors add up to first order", "[machine]") {
  // A small motion of component k, a twist about its axis' point, moves the tool's origin as if everything behind were
  // rigid: sum over axes of bed_from_k's turn times (shift + angle x lever). What is left is of second order.
  Draw draw;
  std::vector<double> errors, commands;
  const Machine m = odd_machine(draw, 1, errors, commands);
  const Vector3<double> tip{0.1, -0.2, -0.3};
  const auto left = [&](double size) {
    auto e = errors;
    for (double& x : e) x *= size;
    const std::vector<double> none(e.size(), 0.0);
    Pose<double> before; // bed_from_component, nominal
    Vector3<double> sum = m.bed_from_tool(commands.data(), none.data()) * tip;
    const Vector3<double> nominal = sum;
    for (std::size_t k = 2; k < m.axes().size(); ++k) {
      const Axis& axis = m.axes()[k];
      const double* x = e.data() + k * error_kinds;
      const Vector3<double> at = inverse(before) * nominal; // the tip, seen from the component before
      const Pose<double> own = motion(axis, commands[k], none.data());
      const Vector3<double> orientation{x[E_A0], x[E_B0], x[E_C0]}, tilt{x[E_A], x[E_B], x[E_C]};
      Vector3<double> moved{x[E_X], x[E_Y], x[E_Z]};
      const Vector3<double> reference = own * axis.point;
      moved = moved + cross(tilt, at - reference);
      if (axis.rotary) {
        // The line is displaced and tilted: undone before the motion, done after it.
        auto own_turn = orientation;
        (axis.direction == 0 ? own_turn.x : axis.direction == 1 ? own_turn.y : own_turn.z) = 0;
        const Vector3<double> zero = orientation - own_turn, offset{x[E_X0], x[E_Y0], x[E_Z0]};
        const Vector3<double> source = inverse(own) * at;
        moved = moved + offset - own.turn * offset + cross(own_turn, at - axis.point) -
                own.turn * cross(own_turn, source - axis.point) + cross(zero, at - axis.point);
      } else {
        const Vector3<double> along = own.shift; // travel turned by the orientation, and the zero position
        moved = moved + cross(orientation, along) + Vector3<double>{x[E_X0], x[E_Y0], x[E_Z0]};
      }
      sum = sum + before.turn * moved;
      before = before * own;
    }
    const auto d = m.bed_from_tool(commands.data(), e.data()) * tip - sum;
    return std::sqrt(dot(d, d));
  };
  CHECK(left(1e-3) < 1e-4); // errors of 1e-3 on levers of a few metres: a few 1e-5 at second order
  CHECK(left(1e-3) / left(1e-4) == Approx(100).epsilon(0.02));
  CHECK(left(1e-4) / left(1e-5) == Approx(100).epsilon(0.002));
}

TEST_CASE("derivatives by dual numbers agree with differences", "[machine]") {
  using G = Dual<double, 1>;
  Draw draw;
  std::vector<double> errors, commands;
  const Machine m = odd_machine(draw, 1e-3, errors, commands);
  const Vector3<double> tip{0.1, -0.2, -0.3};
  const auto place = [&](std::vector<double> at, std::size_t j, double h) {
    at[j] += h;
    return m.workpiece_from_tool(at.data(), at.data() + commands.size()) * tip;
  };
  std::vector<double> all = commands;
  all.insert(all.end(), errors.begin(), errors.end());
  for (std::size_t j = 0; j < all.size(); ++j) {
    CAPTURE(j);
    std::vector<G> x(all.begin(), all.end());
    x[j] = G::variable(all[j], 0);
    const auto dual = m.workpiece_from_tool(x.data(), x.data() + commands.size()) * Vector3<G>{0.1, -0.2, -0.3};
    const double h = 1e-5; // third derivatives below 10 m: 1e-9; rounding 1e-14 / h = 1e-9
    const auto up = place(all, j, h), down = place(all, j, -h);
    CHECK(std::fabs(dual.x.d[0] - (up.x - down.x) / (2 * h)) < 4e-9);
    CHECK(std::fabs(dual.y.d[0] - (up.y - down.y) / (2 * h)) < 4e-9);
    CHECK(std::fabs(dual.z.d[0] - (up.z - down.z) / (2 * h)) < 4e-9);
  }
}

TEST_CASE("lanes give the bits of the scalar chain", "[machine]") {
  Draw draw;
  std::vector<double> errors, commands;
  const Machine m = odd_machine(draw, 1e-3, errors, commands);
  const std::vector<Lanes> lane_errors(errors.begin(), errors.end());
  std::vector<Lanes> lane_commands(commands.begin(), commands.end());
  for (std::size_t lane = 0; lane < Lanes::size; ++lane) {
    auto one = commands;
    for (std::size_t j = 0; j < commands.size(); ++j) {
      double values[Lanes::size];
      for (std::size_t l = 0; l < Lanes::size; ++l) values[l] = commands[j] + 0.1 * static_cast<double>(l);
      lane_commands[j] = Lanes::load_unaligned(values);
      one[j] = values[lane];
    }
    const auto all = m.workpiece_from_tool(lane_commands.data(), lane_errors.data());
    const auto pose = m.workpiece_from_tool(one.data(), errors.data());
    CHECK(all.shift.x.get(lane) == pose.shift.x);
    CHECK(all.shift.z.get(lane) == pose.shift.z);
    CHECK(all.turn.y.x.get(lane) == pose.turn.y.x);
  }
}

TEST_CASE("a wrong description is told by place and reason", "[machine]") {
  using Axes = std::vector<AxisDescription>;
  const auto told = [](const MachineDescription& d, const std::string& place, const std::string& part) {
    const auto all = problems(d);
    REQUIRE(all.size() == 1);
    CHECK(all[0].place == place);
    CHECK((all[0].what + " (" + all[0].why + ") " + all[0].remedy).find(part) != std::string::npos);
    CHECK_THROWS_AS(Machine(d), InputError);
  };
  for (const MachineDescription& d : machines()) CHECK(problems(d).empty());
  told({"", Axes{{"X"}, {"A"}}, Axes{{"Y"}, {"Z"}, {"A"}}}, "tool_side[2]", "axis A is listed twice");
  told({"", Axes{{"X"}}, std::nullopt}, "tool_side", "spindle");
  told({"", std::nullopt, Axes{{"X"}}}, "workpiece_side", "workpiece");
  told({"", Axes{{"Q"}}, Axes{{"X"}}}, "workpiece_side[0]", "'Q' is not an axis");
  told({"", Axes{}, Axes{{"XY"}}}, "tool_side[0]", "is not an axis");
  told({"", Axes{}, Axes{{""}, {"X"}}}, "tool_side[0]", "is not an axis");
  told({"", Axes{}, Axes{{"X", "rotary"}}}, "tool_side[0].kind", "axis X is linear");
  told({"", Axes{}, Axes{{"C", "linear"}}}, "tool_side[0].kind", "axis C is rotary");
  told({"", Axes{}, Axes{{"C", "", {0, std::nan(""), 0}}}}, "tool_side[0].point", "not finite");
  told({"", Axes{}, Axes{{"C", "", {}, 2}}}, "tool_side[0].sense", "sense must be 1 or -1");
  told({"", Axes{}, Axes{}}, "", "no axes");
  const Axes xc{{"X"}, {"C"}};
  told({"", Axes{}, xc, {{"E_A0D", 0}}}, "errors.E_A0D", "no axis 'D'");
  told({"", Axes{}, xc, {{"E_Z0C", 0}}}, "errors.E_Z0C", "no offset along itself");
  told({"", Axes{}, xc, {{"E_Y0X", 0}}}, "errors.E_Y0X", "no offset and no orientation about itself");
  told({"", Axes{}, xc, {{"E_A0X", 0}}}, "errors.E_A0X", "about itself");
  told({"", Axes{}, xc, {{"S_XY", 0}}}, "errors.S_XY", "a name is E_");
  told({"", Axes{}, xc, {{"E_A0C", 0}, {"E_A0C", 1}}}, "errors.E_A0C", "twice");
  told({"", Axes{}, xc, {{"E_XC", std::nan("")}}}, "errors.E_XC", "not finite");
  told({"", Axes{}, xc, {{"E_a0C", 0}}}, "errors.E_a0C", "did you mean");
  CHECK(problems({"", Axes{{"X"}, {"X"}}, Axes{{"Q"}}, {{"E_Q", 0}}}).size() == 3);
  // Two parallel rotary axes are told apart by a number, and so are their errors.
  const Machine two({"", Axes{{"C"}}, Axes{{"C2"}}, {{"E_A0C2", 3}, {"E_CC", 5}}});
  CHECK(two.errors()[two.error("E_A0C2")->index()] == 3);
  CHECK(two.error("E_A0C2")->axis == two.axis("C2"));
  CHECK(two.error("E_CC")->axis == two.axis("C"));
  CHECK_FALSE(two.error("E_A0B").has_value());
}
