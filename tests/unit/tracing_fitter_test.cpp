/// The joint fit: readings that the model gives under an effect are explained to the last digit once it is freed.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

#include "unit/tracing_case.h"

using namespace tracing_case;

namespace {

/// Heights of half a metre in double precision, over the fit's arithmetic: nanometres would be a thousand times more.
constexpr double rounding = 1e-12;

/// Frees one candidate in noise-free readings and returns its size; what is left of all readings is rounding. (Steps
/// are judged beside the noise, and there is none: `converged` says nothing here.)
Vector recovered(Case& c, const std::string& name, double noise = 1) {
  const JointFit base = c.fitter->fit({}, noise);
  REQUIRE(base.valid);
  CHECK(base.residual.cwiseAbs().maxCoeff() > 1e-7); // something is missing
  const JointFit fit = c.fitter->fit({c.term(base, name)}, noise, &base);
  REQUIRE(fit.valid);
  CHECK(fit.residual.cwiseAbs().maxCoeff() < rounding);
  return fit.terms[0].size;
}

Points with(const Case& c, const std::string& name, double value, const std::string& rod = "") {
  Points at = c.simulator->estimates();
  for (std::size_t r = 0; r < at.size(); ++r)
    if (rod.empty() ||
        std::find(c.scenario.readings[r].labels.begin(), c.scenario.readings[r].labels.end(),
                  std::pair<std::string, std::string>{"rod", rod}) != c.scenario.readings[r].labels.end())
      at[r][c.quantity(name)] += value;
  return at;
}

} // namespace

TEST_CASE("sizes of freed effects are recovered exactly without noise", "[tracing]") {
  Case c(rods());
  SECTION("latency") {
    c.measure(with(c, "trigger_latency.delay", 1.5e-3));
    CHECK(recovered(c, "trigger_latency")[0] == Approx(1.5e-3).epsilon(1e-6));
  }
  SECTION("growth with time") {
    c.measure(with(c, "thermal_growth.rate", 5e-6 / 3600));
    CHECK(recovered(c, "thermal_growth")[0] == Approx(5e-6 / 3600).epsilon(1e-6));
  }
  SECTION("length of one rod") {
    c.measure(with(c, "rod_length", 12e-6, "2"));
    CHECK(recovered(c, "declared:rod_length[rod 2]")[0] == Approx(12e-6).epsilon(1e-6));
  }
  SECTION("the beam's own constants, too") {
    Points at = with(c, "trigger_latency.delay", -0.7e-3);
    for (std::size_t r = 0; r < at.size(); ++r) at[r][c.quantity("laser_z")] += r < 10 ? 3e-3 : -1e-3;
    c.measure(at);
    CHECK(recovered(c, "trigger_latency")[0] == Approx(-0.7e-3).epsilon(1e-6));
  }
}

TEST_CASE("reversal error is recovered where both directions share a constant", "[tracing]") {
  std::string text = rods();
  text.replace(text.find("[quantities.laser_z.by.setup]"),
               text.find("[quantities.beam_pitch]") - text.find("[quantities.laser_z.by.setup]"),
               "value = \"-510 mm\"\n");
  Case c(text);
  c.measure(with(c, "z_reversal.backlash", 4e-6));
  CHECK(recovered(c, "z_reversal")[0] == Approx(4e-6).epsilon(1e-6));
}

TEST_CASE("both components of a pair are recovered", "[tracing]") {
  // A rod off its axis rises along a pitched beam: by its displacement along the beam, so both components need yaws.
  std::string text = rods();
  const std::string yaw = "[quantities.beam_yaw]\nvalue = \"0.5 deg\"\n";
  text.replace(
      text.find(yaw), yaw.size(),
      "[quantities.holder_angle.by.setup]\n\"1\" = \"0 deg\"\n\"2\" = \"90 deg\"\n\"3\" = \"180 deg\"\n\"4\" = "
      "\"270 deg\"\n");
  text.replace(text.find("[quantities.laser_z.by.setup]"),
               text.find("[quantities.beam_pitch]") - text.find("[quantities.laser_z.by.setup]"),
               "value = \"-510 mm\"\n");
  const std::string pitch = "value = \"0.2836 deg\"\nu = \"0.002 deg\"\n";
  text.replace(text.find(pitch), pitch.size(), "value = \"10 deg\"\n");
  Case c(text);
  Points at = with(c, "rod_runout.x", 8e-6);
  for (auto& p : at) p[c.quantity("rod_runout.y")] = -5e-6;
  c.measure(at);
  const Vector size = recovered(c, "rod_runout");
  REQUIRE(size.size() == 2);
  CHECK(size[0] == Approx(8e-6).epsilon(1e-5));
  CHECK(size[1] == Approx(-5e-6).epsilon(1e-5));
}

TEST_CASE("a flute's wear is found where the model bends", "[tracing]") {
  // Two inserts touched at many start angles: wear of one acts only where that one touches first, which changes with
  // it.
  std::string rows;
  for (int i = 0; i < 48; ++i)
    rows += fmt::format("{{ start_angle = \"{} deg\", values = [\"-990 mm\"] }},\n", 7.5 * i);
  Case c("schema = 1\nmodel = { name = \"tool_length\" }\n"
         "[conditions]\nspindle_speed = \"1000 rpm\"\nfeed = \"30 mm/min\"\nstart_height = \"5 mm\"\n"
         "[quantities]\ntool_length = { estimated = true, value = \"176.6 mm\" }\nlaser_z = \"-1172.015 mm\"\n"
         "wear_2 = { value = \"0 um\", u = \"1 um\" }\n"
         "[indications.spindle_z]\nrows = [\n" +
         rows + "]\ncomponents = [ { distribution = \"normal\", u = \"0.5 um\", per = \"reading\" } ]\n");
  // Readouts jump where the other flute comes first: one wear that the fit reaches from zero.
  c.measure(with(c, "wear_2", 8e-6));
  CHECK(recovered(c, "declared:wear_2")[0] == Approx(8e-6).epsilon(1e-6));
}

TEST_CASE("where readings jump with a size its u is that of a straight line or more", "[tracing]") {
  // Two inserts, 0.8 um of feed from one to the other: a reading jumps by so much where the tool has grown by a part of
  // it, and hardly moves between. Over many angles and grown by t it is one line of slope t.
  constexpr int readings = 60;
  constexpr double u_reading = 2e-6;
  std::string rows;
  double squares = 0;
  for (int i = 0; i < readings; ++i) {
    rows += fmt::format("{{ start_angle = \"{} deg\", time = \"{} s\", values = [\"-990 mm\"] }},\n", (i * 137) % 360,
                        100 * i);
    squares += std::pow(100.0 * i - 50.0 * (readings - 1), 2);
  }
  Case c("schema = 1\nmodel = { name = \"tool_length\" }\n"
         "[conditions]\nspindle_speed = \"6000 rpm\"\nfeed = \"10 mm/min\"\nstart_height = \"5 mm\"\n"
         "[quantities]\ntool_length = { estimated = true, value = \"176.6 mm\" }\nlaser_z = \"-1172.015 mm\"\n"
         "[indications.spindle_z]\nrows = [\n" +
         rows + "]\ncomponents = [ { distribution = \"normal\", u = \"2 um\", per = \"reading\" } ]\n");
  const double line = u_reading / std::sqrt(squares);
  int plain = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Vector noise = u_reading * gumshoe::tracing::normals(readings, 1, seed, 9).col(0);
    c.measure(with(c, "thermal_growth.rate", 12e-6 / 3600), noise);
    const JointFit base = c.fitter->fit({}, 1);
    JointFit fit = c.fitter->fit({c.term(base, "thermal_growth")}, 1, &base);
    REQUIRE(fit.valid);
    c.fitter->widen_jumping(fit);
    const Index last = fit.design.fixed.cols() - 1;
    const double u = std::sqrt(fit.covariance(last, last)), s = std::sqrt(fit.variance);
    CAPTURE(seed, s, fit.covariance_model.correlation, fit.terms[0].size[0] * 3600e6);
    CHECK(std::fabs(fit.terms[0].size[0] - 12e-6 / 3600) < 4 * u);
    if (fit.covariance_model.correlation != 0) continue; // by chance: another noise, another u
    ++plain;
    CHECK(u > 0.98 * s * line); // the line's slope is t but for jumps at both ends of the steps
    CHECK(u < 1.5 * s * line);
  }
  CHECK(plain > 3);
}

TEST_CASE("columns of the linearised fit are differences of the simulation", "[tracing]") {
  Case c(rods());
  c.measure(with(c, "trigger_latency.delay", 1e-3));
  const JointFit base = c.fitter->fit({}, 1);
  const std::vector<Term> terms{c.term(base, "trigger_latency"), c.term(base, "declared:rod_length[rod 2]")};
  const JointFit fit = c.fitter->fit(terms, 1, &base);
  REQUIRE(fit.valid);
  // Central differences of a nearly linear model: rounding of the readings over the step.
  const auto difference = [&](const std::string& name, double step, const std::function<bool(std::size_t)>& moves) {
    Points up = fit.at, down = fit.at;
    for (std::size_t r = 0; r < up.size(); ++r)
      if (moves(r)) up[r][c.quantity(name)] += step, down[r][c.quantity(name)] -= step;
    Vector f, g;
    REQUIRE((c.simulator->simulate(up, f) && c.simulator->simulate(down, g)));
    return Matrix(in_sequence(c.observations, Matrix((f - g) / (2 * step))));
  };
  const auto agree = [&](const Vector& column, const Matrix& expected, double step) {
    CHECK((column - expected.col(0)).cwiseAbs().maxCoeff() < 1e-6 * expected.norm() + 1e-15 / step);
  };
  const auto label = [&](std::size_t r, const std::string& name) {
    return *std::find_if(c.scenario.readings[r].labels.begin(), c.scenario.readings[r].labels.end(),
                         [&](const auto& l) { return l.first == name; });
  };
  const Design& d = fit.design;
  REQUIRE(d.fixed_names.size() == 6);
  for (Index j = 0; j < 4; ++j) {
    const std::string setup = std::to_string(j + 1);
    CHECK(d.fixed_names[static_cast<std::size_t>(j)].find("laser_z[") == 0);
    agree(d.fixed.col(j), difference("laser_z", 1e-6, [&](std::size_t r) { return label(r, "setup").second == setup; }),
          1e-6);
  }
  agree(d.fixed.col(4), difference("trigger_latency.delay", 1e-5, [](std::size_t) { return true; }), 1e-5);
  agree(d.fixed.col(5), difference("rod_length", 1e-6, [&](std::size_t r) { return label(r, "rod").second == "2"; }),
        1e-6);
  // Declared draws, one standard uncertainty each. That of rod 2 is released: it has a term. Rod 1's still binds.
  std::vector<std::string> names = d.random_names;
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"beam_pitch", "rod_length[rod 1]"});
  for (std::size_t i = 0; i < d.random_names.size(); ++i) {
    const bool rod = d.random_names[i] != "beam_pitch";
    const double u = rod ? 1e-6 : 0.002 * scenario_fixture::degree, step = rod ? 1e-6 : 1e-5;
    const Matrix expected = u * difference(rod ? "rod_length" : "beam_pitch", step,
                                           [&](std::size_t r) { return !rod || label(r, "rod").second == "1"; });
    agree(d.random.col(static_cast<Index>(i)), expected, step / u);
  }
}

TEST_CASE("the order of rows in the file does not change a bit of the fit", "[tracing]") {
  Case a(rods());
  std::mt19937_64 chance(3);
  std::normal_distribution<double> normal;
  Vector noise(40);
  for (Index i = 0; i < noise.size(); ++i) noise[i] = 3e-7 * normal(chance);
  a.measure(with(a, "trigger_latency.delay", 1e-3), noise);
  scenario::Scenario shuffled = a.scenario;
  std::vector<std::size_t> order(shuffled.readings.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), chance);
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.readings[i] = a.scenario.readings[order[i]];
    shuffled.trace.order[i] = a.scenario.trace.order[order[i]];
  }
  Case b(shuffled);
  // The same readings, place by place.
  const Observations &o = a.observations, &p = b.observations;
  for (std::size_t i = 0; i < o.readings; ++i) {
    REQUIRE(o.sequence[i] == order[p.sequence[i]]);
    CHECK(o.measured[o.sequence[i]] == p.measured[p.sequence[i]]);
    CHECK(o.held_out[o.sequence[i]] == p.held_out[p.sequence[i]]);
  }
  const auto same = [](const Matrix& x, const Matrix& y) {
    return x.rows() == y.rows() && x.cols() == y.cols() &&
           std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
  };
  // Groups are numbered as they are met in the order of measurement, so that shapes have the same columns.
  REQUIRE(o.labels.size() == p.labels.size());
  for (std::size_t l = 0; l < o.labels.size(); ++l) CHECK(o.labels[l].groups == p.labels[l].groups);
  CHECK(o.blocks.groups == p.blocks.groups);
  const auto sa = shapes(o, 60), sb = shapes(p, 60);
  REQUIRE(sa.size() == sb.size());
  for (std::size_t i = 0; i < sa.size(); ++i) {
    CHECK(sa[i].name == sb[i].name);
    CHECK(same(sa[i].columns, sb[i].columns));
  }
  const JointFit x0 = a.fitter->fit({}, 0), y0 = b.fitter->fit({}, 0);
  CHECK(x0.design.random_names == y0.design.random_names);
  CHECK(same(x0.residual, y0.residual));
  CHECK(same(x0.design.random, y0.design.random));
  const JointFit x = a.fitter->fit({a.term(x0, "trigger_latency")}, 0, &x0),
                 y = b.fitter->fit({b.term(y0, "trigger_latency")}, 0, &y0);
  CHECK(same(x.residual, y.residual));
  CHECK(same(x.terms[0].size, y.terms[0].size));
  CHECK(same(x.covariance, y.covariance));
  CHECK(x.noise == y.noise);
  const auto ca = a.candidates(x), cb = b.candidates(y);
  REQUIRE(ca.size() == cb.size());
  for (std::size_t i = 0; i < ca.size(); ++i) {
    CHECK(ca[i].name == cb[i].name);
    CHECK(same(ca[i].columns, cb[i].columns));
    CHECK(ca[i].depends_on == cb[i].depends_on);
  }
}

TEST_CASE("no signature comes from the measured response", "[tracing]") {
  // At the same point any readings, pure noise too, give bit for bit the same signatures.
  Case a(rods());
  const Points at = a.simulator->estimates();
  a.measure(at);
  const JointFit fit = a.fitter->fit({}, 1);
  std::mt19937_64 chance(9);
  std::normal_distribution<double> normal;
  Vector noise(40);
  for (Index i = 0; i < noise.size(); ++i) noise[i] = 1e-3 * normal(chance);
  Case b(a.scenario);
  b.measure(at, noise);
  const auto ca = a.candidates(fit), cb = b.candidates(fit);
  const auto sa = shapes(a.observations, 60), sb = shapes(b.observations, 60);
  REQUIRE(ca.size() > 20);
  REQUIRE(ca.size() == cb.size());
  for (std::size_t i = 0; i < ca.size(); ++i) CHECK(ca[i].columns == cb[i].columns);
  REQUIRE(sa.size() == sb.size());
  for (std::size_t i = 0; i < sa.size(); ++i) CHECK(sa[i].columns == sb[i].columns);
  // And none of them explains noise: the largest squared correlation of a signature with it, given the constants, is
  // that of a few directions among 36.
  std::vector<const Candidate*> pointers;
  for (const auto& c : cb) pointers.push_back(&c);
  const JointFit noisy = b.fitter->fit({}, 1);
  const Scan scan(noisy.design, b.fitter->rows(), pointers, 1);
  const Statistics s = scan.run(scan.whitened(scan.plain()).take(noisy.residual));
  const double freedom = static_cast<double>(scan.degrees_of_freedom());
  const double share = 1 - std::exp(-s.ratio.maxCoeff() / freedom);
  // R^2 of one direction is Beta(1/2, 35/2); of at most 200 candidates, two directions each: chance below 1e-4 of
  // (1 - x)^(34/2) per candidate.
  CHECK(share < 1 - std::pow(1e-4 / 200, 2.0 / (freedom - 2)));
}
