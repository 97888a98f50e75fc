// The single socket method: turned points against the machines of engine/chain, solutions that undo the turn, what
// first order costs, uncertainties against closed forms, effects of stated size.
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "chain/machine.h"
#include "models/single_socket/single_socket.h"

using namespace gumshoe;
namespace socket = gumshoe::models::single_socket;
using chain::Angles, chain::Turn, chain::TurnedPoint;

namespace {

constexpr double deg = si::deg, mm = si::mm, um = si::um, arcsec = deg / 3600;
constexpr Turn turns[] = {Turn::RRTTT, Turn::TTTRR, Turn::RTTTR_head, Turn::RTTTR_table};

struct Draw {
  std::mt19937_64 engine{1999};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};
double distance(const Vector3<double>& a, const Vector3<double>& b) { return std::sqrt(dot(a - b, a - b)); }

/// A ball far from where its angles are undetermined.
TurnedPoint<double> somewhere(Turn turn, Draw& draw) {
  TurnedPoint<double> at{turn, {draw(-0.05, 0.05), draw(-0.05, 0.05), draw(-0.3, -0.2)}, 0, {}};
  if (turn == Turn::TTTRR)
    at.point = {draw(-0.1, 0.1), draw(0.1, 0.2), draw(0.1, 0.2)}, at.z_alpha_gamma = draw(0, 0.1);
  const double most = turn == Turn::TTTRR ? 20 * deg : 60 * deg;
  at.commanded.alpha = turn == Turn::RTTTR_head ? 0 : draw(-most, most);
  at.commanded.beta = turn == Turn::RRTTT || turn == Turn::RTTTR_head ? draw(-most, most) : 0;
  at.commanded.gamma = turn == Turn::TTTRR ? draw(-most, most) : 0;
  return at;
}
/// Errors of those angles that the machine has.
Angles<double> some_errors(Turn turn, double size) {
  return {turn == Turn::RTTTR_head ? 0 : size, turn == Turn::RRTTT || turn == Turn::RTTTR_head ? -0.7 * size : 0,
          turn == Turn::TTTRR ? 0.4 * size : 0};
}

/// Readings of `position`, one for each row of N, of a bar of 150 mm.
struct Bars {
  std::vector<socket::Station<double>> stations;
  std::vector<double> changes;
  explicit Bars(const std::vector<Vector3<double>>& directions, const Vector3<double>& error) {
    for (const auto& n : directions) {
      socket::Station<double> s;
      s.lever = 0.15 / std::sqrt(dot(n, n)) * n;
      s.nominal = 0.15;
      changes.push_back(std::sqrt(dot(s.lever + error, s.lever + error)) - 0.15);
      stations.push_back(s);
    }
  }
  Vector3<double> error(bool linear) const { return socket::position_of(stations, changes, linear).error; }
};
const std::vector<Vector3<double>> square{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

} // namespace

TEST_CASE("points turn as on the machines of the chain", "[laws][single_socket]") {
  // A table turns against its command (ISO 841), but the paper's angles are those of the table.
  Draw draw;
  constexpr struct {
    Turn turn;
    const char* machine;
    bool table;
  } cases[] = {{Turn::RRTTT, "RRTTT", false},
               {Turn::TTTRR, "TTTRR", true},
               {Turn::RTTTR_head, "RTTTR", false},
               {Turn::RTTTR_table, "RTTTR", true}};
  for (const auto& [turn, name, table] : cases) {
    const chain::Machine machine(*chain::find_machine(name));
    for (int n = 0; n < 20; ++n) {
      TurnedPoint<double> at = somewhere(turn, draw);
      at.z_alpha_gamma = 0; // the named machines' axes meet
      std::vector<double> commands(machine.axes().size());
      const auto set = [&](const char* axis, double angle) {
        if (angle != 0) commands[machine.axis(axis)] = table ? -angle : angle;
      };
      set("A", at.commanded.alpha), set("B", at.commanded.beta), set("C", at.commanded.gamma);
      const auto pose = table ? machine.bed_from_workpiece(commands.data(), machine.errors().data())
                              : machine.bed_from_tool(commands.data(), machine.errors().data());
      CAPTURE(name, n);
      CHECK(distance(pose * at.point, place(at, at.commanded)) < 1e-15);
    }
  }
}

TEST_CASE("angle errors undo the turn, and to first order up to their squares", "[laws][single_socket]") {
  Draw draw;
  for (const Turn turn : turns)
    for (int n = 0; n < 50; ++n) {
      const TurnedPoint<double> at = somewhere(turn, draw);
      for (const double size : {1e-5, 1e-3, 0.05}) {
        const auto error = some_errors(turn, size);
        const auto there = place(at, at.commanded + error);
        const auto exact = angle_errors(at, there), linear = linear_angle_errors(at, there);
        CAPTURE(int(turn), n, size);
        CHECK(std::fabs(exact.alpha - error.alpha) < 1e-14);
        CHECK(std::fabs(exact.beta - error.beta) < 1e-14);
        CHECK(std::fabs(exact.gamma - error.gamma) < 1e-14);
        // Levers are above 0.05 m of points within 0.4 m: curvatures below 20.
        CHECK(std::fabs(linear.alpha - error.alpha) < 20 * size * size + 1e-14);
        CHECK(std::fabs(linear.beta - error.beta) < 20 * size * size + 1e-14);
        CHECK(std::fabs(linear.gamma - error.gamma) < 20 * size * size + 1e-14);
      }
    }
}

TEST_CASE("eq (6) errs by tan(beta) d_beta^2 / 2, eq (7) is the tangent of d_alpha", "[laws][single_socket]") {
  const TurnedPoint<double> at{Turn::RRTTT, {0, 0, -0.25}, 0, {30 * deg, 60 * deg, 0}};
  const Angles<double> error{0.5 * deg, 0.1 * deg, 0};
  const auto found = linear_angle_errors(at, place(at, at.commanded + error));
  const double second = std::tan(60 * deg) / 2 * error.beta * error.beta;
  CHECK(std::fabs(found.beta - (error.beta - second)) < error.beta * error.beta * error.beta);
  CHECK(std::fabs(found.alpha - std::tan(error.alpha)) < 1e-15);
}

TEST_CASE("a bar's exact equation is that of the source plus (dl^2 - D^2) / 2; the linear one errs by D^2 / 2 l",
          "[laws][single_socket]") {
  // 0.27 mm and 1.7 mm along X: the bars along Y and Z see the sagitta, 0.24 um and 9.6 um.
  for (const double size : {0.27 * mm, 1.7 * mm}) {
    const Vector3<double> error{size, 0, 0};
    const Bars bars(square, error);
    CHECK(distance(bars.error(false), error) < 1e-17);
    const auto linear = bars.error(true);
    CHECK(std::fabs(linear.x - error.x) < 1e-17);
    CHECK(std::fabs(linear.y / (size * size / 0.3) - 1) < 1e-4);
    for (std::size_t i = 0; i < 3; ++i) {
      const double l = bars.stations[i].nominal, dl = bars.changes[i];
      CHECK(std::fabs(dot(bars.stations[i].lever, error) - (l * dl + (dl * dl - dot(error, error)) / 2)) < 1e-17);
    }
  }
}

TEST_CASE("a bar of stated length indicates also by how much the balls were commanded to another distance",
          "[laws][single_socket]") {
  const Vector3<double> error{30e-6, -20e-6, 50e-6};
  Bars bars({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, error);
  const double distances[] = {150.04 * mm, 149.97 * mm, 150.02 * mm, 149.9 * mm};
  for (std::size_t i = 0; i < bars.stations.size(); ++i) {
    socket::Station<double>& s = bars.stations[i];
    s.lever = distances[i] / s.nominal * s.lever;
    s.excess = distances[i] - s.nominal;
    bars.changes[i] = std::sqrt(dot(s.lever + error, s.lever + error)) - s.nominal;
    CHECK(std::fabs(socket::change_of_length(s, error) - bars.changes[i]) < 1e-16);
  }
  CHECK(distance(bars.error(false), error) < 1e-15);
  CHECK(distance(bars.error(true), error) < 4 * dot(error, error) / 0.3);
}

TEST_CASE("more stations than three: the truth comes back from any, noise from none", "[laws][single_socket]") {
  const Vector3<double> error{0.4 * mm, -0.3 * mm, 0.9 * mm};
  Bars bars({{1, 0, 0.1}, {0.2, 1, 0}, {0, -0.3, 1}, {-1, 1, 1}, {1, 1, -1}}, error);
  CHECK(distance(bars.error(false), error) < 1e-16);
  CHECK(socket::position_of(bars.stations, bars.changes, false).residual_rms < 1e-16);
  bars.changes[0] += um;
  const auto p = socket::position_of(bars.stations, bars.changes, false);
  // At the least sum of squares no direction of D changes it: the residuals are square to the bars' directions.
  Vector3<double> slope{};
  for (std::size_t i = 0; i < 5; ++i) {
    const auto now = bars.stations[i].lever + p.error;
    const double length = std::sqrt(dot(now, now));
    slope = slope + (bars.changes[i] - (length - 0.15)) / length * now;
  }
  CHECK(std::sqrt(dot(slope, slope)) < 1e-16);
  CHECK((p.residual_rms > 0.1 * um && p.residual_rms < um));
}

TEST_CASE("amplification: 1 for square directions, sec and cosec of a cone", "[laws][single_socket]") {
  // Three directions on a cone of half angle h: N'N has the eigenvalues 3 cos^2 h and twice 3/2 sin^2 h.
  CHECK(std::fabs(socket::position_of(Bars(square, {}).stations, {0., 0., 0.}, true).amplification - 1) < 1e-15);
  for (const double h : {10 * deg, 30 * deg, 80 * deg}) {
    std::vector<Vector3<double>> cone;
    for (const double a : {0., 120 * deg, 240 * deg})
      cone.push_back({std::cos(h), std::sin(h) * std::cos(a), std::sin(h) * std::sin(a)});
    const double expected = std::sqrt((1 / std::pow(std::cos(h), 2) + 4 / std::pow(std::sin(h), 2)) / 9);
    CHECK(std::fabs(socket::position_of(Bars(cone, {}).stations, {0., 0., 0.}, true).amplification / expected - 1) <
          1e-13);
  }
}

TEST_CASE("uncertainty of the angles of a head: sqrt(2) u(D) over the lever, times sec(beta) for alpha",
          "[laws][single_socket]") {
  // 1 um in each component before and after, a tool of 250 mm: 1.167 arcsec; at 40 deg 1.523 arcsec about X.
  using D = Dual<double, 3>;
  TurnedPoint<D> at{Turn::RRTTT, {D(0.), D(0.), D(-0.25)}, D(0.), {D(25 * deg), D(40 * deg), D(0.)}};
  auto v = place(at, at.commanded);
  v.x.d[0] = v.y.d[1] = v.z.d[2] = 1;
  for (const auto& found : {angle_errors(at, v), linear_angle_errors(at, v)}) {
    const auto u = [](const D& angle) {
      return std::sqrt(2.0) * um * std::hypot(angle.d[0], angle.d[1], angle.d[2]) / arcsec;
    };
    CHECK(std::fabs(u(found.alpha) - 1.1668 / std::cos(40 * deg)) < 1e-3);
  }
  CHECK(std::fabs(std::sqrt(2.0) * um / 0.25 / arcsec - 1.1668) < 1e-4);
}

TEST_CASE("any two rotary axes: places of the chain, errors that undo the turn, least closure",
          "[laws][single_socket]") {
  Draw draw;
  constexpr const char* names[] = {"A", "B", "C"};
  const auto point = [&] { return Vector3<double>{draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-0.1, 0.1)}; };
  for (int first = 0; first < 3; ++first)
    for (int second = 0; second < 3; ++second) {
      if (first == second) continue;
      const chain::TwoRotaryAxes axes{{first, 1, true, point()}, {second, 1, true, point()}};
      const auto described = [](const char* name, const Vector3<double>& p) {
        return chain::AxisDescription{name, "", {p.x, p.y, p.z}, 1};
      };
      const chain::Machine machine(
          {"two", std::vector{described(names[first], axes.first.point), described(names[second], axes.second.point)},
           std::vector<chain::AxisDescription>{}});
      const chain::TurnedByTwo<double> ball{axes, axes.second.point - axes.first.point};
      for (int n = 0; n < 20; ++n) {
        const Vector3<double> at{draw(0.1, 0.2), draw(0.1, 0.2), draw(0.1, 0.2)};
        Angles<double> by{draw(-0.3, 0.3), draw(-0.3, 0.3), draw(-0.3, 0.3)}, error{1e-3, -2e-3, 1.5e-3};
        by = chain::only<double>({first == 0 || second == 0, first == 1 || second == 1, first == 2 || second == 2}, by);
        error = chain::only<double>({first == 0 || second == 0, first == 1 || second == 1, first == 2 || second == 2},
                                    error);
        CAPTURE(first, second, n);
        const double commands[] = {angle_about(first, by), angle_about(second, by)};
        const auto pose = machine.bed_from_workpiece(commands, machine.errors().data());
        CHECK(distance(pose * (axes.second.point + at), axes.first.point + ball.place(at, by)) < 1e-15);
        if (ball.smallest_lever(at, by) < 0.05) continue;
        auto there = ball.place(at, by + error);
        const auto undone = ball.errors(at, by, there);
        CHECK(std::fabs(undone.alpha - error.alpha) + std::fabs(undone.beta - error.beta) +
                  std::fabs(undone.gamma - error.gamma) <
              1e-14);
        // 50 um off: what remains is square to both levers.
        there = there + Vector3<double>{30 * um, -30 * um, 30 * um};
        const auto nearest = by + ball.errors(at, by, there);
        const auto closure = there - ball.place(at, nearest);
        const auto [a, b] = ball.levers(at, nearest);
        CHECK(std::fabs(dot(a, closure)) + std::fabs(dot(b, closure)) < 1e-16);
      }
    }
}
