/// Characteristic curves of a mill: what follows for readouts, start angles and worn teeth from the trigger's
/// definition alone, whatever the inserts, and the figures of reports/reproduction/tools.md.
#include <catch2/catch.hpp>

#include <numeric>
#include <random>

#include "models/tool_length/trigger/insert_trigger.h"

using namespace gumshoe;

namespace {

constexpr double pi = 3.14159265358979323846, deg = pi / 180, mm = 1e-3, um = 1e-6;

/// Equal inserts, evenly spread, each with its wear.
struct Tool {
  models::tool_length::Insert<double> insert{10 * mm, 6 * mm, 3.97 * mm, 15 * deg, -8 * deg, -5 * deg, 0, -4 * mm};
  models::laser_setter::Beam<double> beam{0, 0, 0.2 * mm, 0.5};
  std::vector<double> wear{0, 0};
  double turn = 30 * um; ///< descent per turn

  double drop() const { return turn / (2 * pi); }
  double per_tooth() const { return turn / static_cast<double>(wear.size()); }
};

/// Height and flute over start angles (rad) from one start height.
struct Readout {
  double height;
  int flute;
};
std::vector<Readout> readouts(const Tool& tool, double height, const std::vector<double>& angles) {
  std::vector<models::tool_length::Flute<double>> flutes;
  for (std::size_t k = 0; k < tool.wear.size(); ++k)
    flutes.push_back(
        {tool.insert, 2 * pi * static_cast<double>(k) / static_cast<double>(tool.wear.size()), tool.wear[k]});
  models::tool_length::TriggerSolver solver;
  std::vector<Readout> found;
  for (const double angle : angles) {
    const auto trigger = solver.solve(flutes, tool.beam, {angle, height, tool.drop(), 0});
    REQUIRE(trigger.status == Status::ok);
    found.push_back({trigger.height, trigger.insert});
  }
  return found;
}

/// Midpoints of `count` equal parts of `width`.
std::vector<double> midpoints(int count, double width) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back((i + 0.5) * width / count);
  return angles;
}

double peak_of(const Tool& tool) { return models::tool_length::InsertHeight(tool.insert, tool.beam).highest().height; }

struct Draw {
  std::mt19937_64 engine{20240611};
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};
Tool random_tool(Draw& draw, std::size_t teeth) {
  Tool t;
  auto& i = t.insert;
  i.tool_radius = draw(8, 20) * mm, i.radius = draw(2, 7) * mm, i.thickness = draw(2, 4) * mm;
  i.radial_angle = draw(-15, 5) * deg, i.axial_angle = draw(-8, 8) * deg;
  const double x = i.tool_radius - i.radius * std::cos(i.radial_angle), y = i.radius * std::sin(i.radial_angle);
  i.axis_y = -draw(0.9, 1.03) * std::hypot(x, y); // about the radius of the lowest point: one hump or two
  t.wear.assign(teeth, 0);
  t.turn = draw(1, 60) * um;
  return t;
}

} // namespace

// Equal teeth pass the highest point of Zc every pitch, each f_z lower than the last, so a trigger lies at most f_z
// below it. Starting further on is starting higher: the descending line then meets Zc later, and Z_t(s + x) <= Z_t(s) +
// drop x. Heights are exact to 1e-12 m.
TEST_CASE("readouts of equal teeth lie within one feed per tooth, and rise no faster than the tool descends",
          "[references][tool_length]") {
  Draw draw;
  for (int n = 0; n < 24; ++n) {
    const Tool tool = random_tool(draw, static_cast<std::size_t>(1 + n % 6));
    const double peak = peak_of(tool), fz = tool.per_tooth(), pitch = 2 * pi / static_cast<double>(tool.wear.size());
    const int count = 600;
    const auto z = readouts(tool, 0.5 * mm, midpoints(count, pitch));
    double mean = 0, square = 0, low = 1, high = -1;
    for (int i = 0; i < count; ++i) {
      const double h = z[static_cast<std::size_t>(i)].height,
                   next = z[static_cast<std::size_t>((i + 1) % count)].height;
      REQUIRE(h < peak + 1e-12);
      REQUIRE(h > peak - fz - 1e-12);
      REQUIRE(next < h + fz / count + 1e-12);
      const double e = (h - peak) / fz;
      mean += e / count, square += e * e / count;
      low = std::min(low, e), high = std::max(high, e);
    }
    // A curve that rises no faster than 1 and has the range w meets every height with a density of at least 1:
    // w^3 / 12 <= variance <= w^2 / 4 - w^3 / 6. Points miss at most one step at either end; the mean of a function of
    // variation 2 over `count` midpoints is off by less than 1 / count, that of its square by less than 2 / count.
    const double spread = square - mean * mean, off = 4.0 / count, w = high - low,
                 wide = std::min(1.0, w + 2.0 / count);
    REQUIRE(spread > w * w * w / 12 - off);
    REQUIRE(spread < wide * wide / 4 - wide * wide * wide / 6 + off);
  }
}

// The line that comes down passes the teeth in turn, f_z lower each time, and a tooth worn by W needs it W lower. So
// pass j catches the lines of phase below a_j = j f_z - W_j, but for those that an earlier pass has caught: its share
// of the start angles is the gain of a_j over all earlier ones, whatever the humps look like.
TEST_CASE("each tooth triggers at the share of start angles that its wear leaves it", "[references][tool_length]") {
  Draw draw;
  int hidden = 0, partly = 0;
  for (int n = 0; n < 24; ++n) {
    const int teeth = 2 + n % 4, count = 1500;
    Tool tool = random_tool(draw, static_cast<std::size_t>(teeth));
    for (double& w : tool.wear) w = draw(0, 1.6) * tool.per_tooth();
    std::vector<double> share(tool.wear.size(), 0.0), law(tool.wear.size(), 0.0);
    for (const Readout& r : readouts(tool, 0.5 * mm, midpoints(count, 2 * pi)))
      share[static_cast<std::size_t>(r.flute)] += 1.0 / count;
    double reached = -1e9;
    for (int j = 0; j < 4 * teeth; ++j) { // counter-clockwise, flute k is followed by flute k - 1
      const std::size_t k = static_cast<std::size_t>((4 * teeth - 1 - j) % teeth);
      const double a = j * tool.per_tooth() - tool.wear[k];
      if (j >= 3 * teeth) law[k] = std::max(0.0, a - reached) / tool.turn;
      reached = std::max(reached, a);
    }
    REQUIRE(std::accumulate(law.begin(), law.end(), 0.0) == Approx(1).margin(1e-12));
    for (std::size_t k = 0; k < share.size(); ++k) {
      INFO("case " << n << ", flute " << k + 1);
      REQUIRE(std::fabs(share[k] - law[k]) < 1.01 / count); // an interval's share of midpoints is off by less than one
      if (law[k] == 0) REQUIRE(share[k] == 0);
      hidden += law[k] == 0, partly += law[k] > 0 && law[k] < 0.8 / teeth;
    }
  }
  REQUIRE(hidden >= 5);
  REQUIRE(partly >= 5);
}

TEST_CASE("m start angles fall short of the peak by less than their distinct phases' share of a feed per tooth",
          "[references][tool_length]") {
  const Tool tool; // Table 3.1
  const double peak = peak_of(tool);
  const auto worst = [&](int m) { // over the unknown phase, in 200 steps: 0.2 um / m of height
    double most = 0;
    for (int p = 0; p < 200; ++p) {
      std::vector<double> angles;
      for (int i = 0; i < m; ++i) angles.push_back(2 * pi * (i + p / 200.0) / m);
      double best = -1;
      for (const Readout& r : readouts(tool, 0, angles)) best = std::max(best, r.height);
      most = std::max(most, peak - best);
    }
    REQUIRE(most < tool.per_tooth() * std::gcd(m, 2) / m + 1e-12);
    return most / um;
  };
  const double twelve = worst(12);
  // The facts' figures, one decimal, and what 200 steps miss.
  REQUIRE(worst(4) == Approx(4.6).margin(0.1));
  REQUIRE(worst(6) == Approx(2.3).margin(0.1));
  REQUIRE(twelve == Approx(1.7).margin(0.08));
  REQUIRE(worst(24) == Approx(0.8).margin(0.08));
  REQUIRE(worst(11) < twelve); // eleven phases against six
}

TEST_CASE("a micrometre of start height turns the curve by 360 N h / v", "[laws][tool_length]") {
  Tool tool;
  tool.wear[1] = 2 * um;
  std::vector<double> angles = midpoints(90, 2 * pi), turned = angles;
  for (double& a : turned) a -= 12 * deg; // 30 um a turn
  const auto low = readouts(tool, 0, angles), high = readouts(tool, 1 * um, turned);
  for (std::size_t i = 0; i < low.size(); ++i) {
    REQUIRE(std::fabs(low[i].height - high[i].height) < 2e-12); // the solver's error, twice
    REQUIRE(low[i].flute == high[i].flute);
  }
}
