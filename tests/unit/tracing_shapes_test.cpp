/// Shapes without a cause span what their names say; what a signature depends on.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include <Eigen/QR>
#include <fmt/format.h>

#include "base/units.h"
#include "tracing/candidates/courses.h"
#include "tracing/candidates/smooth_basis.h"
#include "unit/tracing_case.h"
#include "unit/tracing_dense.h"

using namespace tracing_case;

namespace {

constexpr std::size_t count = 48;

Covariate covariate(const std::string& name, const std::string& si, std::vector<double> value) {
  const std::set<double> levels(value.begin(), value.end());
  return {name, si, si, std::move(value), {levels.begin(), levels.end()}, si == "rad"};
}

/// Feed up and down, an angle all round, load on two levels, time; order reversed, to tell sequence and rows apart.
Observations made() {
  Observations o;
  o.readings = count;
  o.indications = 1;
  o.names = {"z"};
  std::vector<double> feed, angle, load, time;
  Grouping setup{"setup", {"setup"}, {}, {"setup 1", "setup 2", "setup 3"}, {{"1"}, {"2"}, {"3"}}};
  for (std::size_t r = 0; r < count; ++r) {
    o.sequence.push_back(count - 1 - r);
    const auto i = static_cast<double>(r);
    feed.push_back(1 + std::fmod(3 * i, 8));
    angle.push_back(2 * std::numbers::pi * std::fmod(5 * i, 48) / 48);
    load.push_back(static_cast<int>(i * i) % 7 < 3 ? 10 : 20);
    time.push_back(100 - i);
    setup.group.push_back(r % 3);
  }
  o.covariates = {covariate("feed", "m/s", feed), covariate("angle", "rad", angle), covariate("load", "N", load),
                  covariate("time", "s", time)};
  o.covariates.back().course = true;
  o.labels = {setup};
  return o;
}

const Candidate& named(const std::vector<Candidate>& all, const std::string& name, const std::string& shape = "") {
  for (const Candidate& a : all)
    if (a.name == name && (shape.empty() || a.shape == shape)) return a;
  throw InputError("no shape " + name);
}

/// What a function of a covariate has outside a span, as a share of it.
double outside(const Matrix& basis, const Observations& o, std::size_t covariate,
               const std::function<double(double)>& function) {
  Vector y(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i)
    y[static_cast<Index>(i)] = function(o.covariates[covariate].value[o.sequence[i]]);
  return tracing_dense::outside(basis, y).norm() / y.norm();
}

Matrix with_constant(const Matrix& basis) { return tracing_dense::joined(Matrix::Ones(basis.rows(), 1), basis); }

} // namespace

/// The courses that are found in readings that follow this and nothing else: the columns' gain is their squared cosine
/// with it, but for a constant.
std::vector<Candidate> courses_of(const Observations& o, const Vector& readings) {
  std::vector<Index> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  const Vector about = readings.array() - readings.mean();
  return courses(o, rows, [&](const Matrix& columns, Index, double) {
    const Matrix centred = columns.rowwise() - columns.colwise().mean();
    return Vector((centred.transpose() * about).array().square() / centred.colwise().squaredNorm().transpose().array());
  });
}

TEST_CASE("a step is found between the readings between which it was made", "[tracing]") {
  const Observations o = made();
  for (const Index from : {4, 11, 40, 43}) {
    Vector step = Vector::Zero(static_cast<Index>(count));
    step.tail(step.size() - from).setOnes();
    const auto found = courses_of(o, step);
    // Time is the only course: drift, step, bend, while, those three of a part, pulse, shift.
    REQUIRE(found.size() == 9);
    step.array() -= step.mean();
    CHECK(found[1].name ==
          "step:time after reading " + std::to_string(o.sequence[static_cast<std::size_t>(from - 1)] + 1));
    CHECK((found[1].columns.array() - found[1].columns.mean() - step.array()).matrix().norm() < 1e-12);
  }
}

TEST_CASE("a step of one part is found between two of its readings", "[tracing]") {
  const Observations o = made();
  REQUIRE(part_labels(o).size() == 1);
  const Grouping& label = *part_labels(o)[0];
  for (std::size_t group = 0; group < label.groups.size(); ++group) {
    std::vector<std::size_t> own; // places of its readings
    for (std::size_t i = 0; i < count; ++i)
      if (label.group[o.sequence[i]] == group) own.push_back(i);
    REQUIRE(own.size() > 4);
    for (const std::size_t before : {std::size_t{2}, own.size() / 2, own.size() - 2}) { // readings before it
      Vector step = Vector::Zero(static_cast<Index>(count));
      for (std::size_t i = before; i < own.size(); ++i) step[static_cast<Index>(own[i])] = 1;
      const auto found = courses_of(o, step);
      const std::string reading = std::to_string(o.sequence[own[before - 1]] + 1);
      const Candidate& one = named(found, "step:time with " + label.groups[group] + " after reading " + reading);
      CHECK((one.columns - step).norm() == 0);
      CHECK(one.depends_on == std::vector<std::string>{"time", label.name});
      CHECK(one.rare());
      CHECK(one.searched == static_cast<double>(count - 3 * label.groups.size())); // two before and two after, in each
    }
  }
}

TEST_CASE("a bend, of all readings or of one part, is found at the reading after which it begins", "[tracing]") {
  const Observations o = made(); // a reading a second
  const Grouping& label = *part_labels(o)[0];
  for (const bool part : {false, true}) {
    std::vector<Index> own;
    for (std::size_t i = 0; i < count; ++i)
      if (!part || label.group[o.sequence[i]] == 2) own.push_back(static_cast<Index>(i));
    for (const std::size_t after : {std::size_t{4}, own.size() / 2, own.size() - 5}) {
      Vector bend = Vector::Zero(static_cast<Index>(count));
      for (std::size_t i = after; i < own.size(); ++i) bend[own[i]] = static_cast<double>(own[i] - own[after]);
      const auto found = courses_of(o, bend);
      const Candidate& one =
          named(found, fmt::format("bend:time{} after reading {}", part ? " with " + label.groups[2] : "",
                                   o.sequence[static_cast<std::size_t>(own[after])] + 1));
      CHECK((one.columns / one.columns.maxCoeff() - bend / bend.maxCoeff()).norm() < 1e-12);
      CHECK(one.rare() == part);
    }
  }
}

/// Readings that differ from the one of these places to the one before the other.
std::string while_name(const Observations& o, const std::vector<std::size_t>& own, std::size_t from,
                       std::size_t until) {
  return fmt::format("from reading {} to reading {}", o.sequence[own[from]] + 1, o.sequence[own[until - 1]] + 1);
}

TEST_CASE("a while is found between the readings between which it lasted, however fine the first grid", "[tracing]") {
  const Observations o = made();
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  for (const auto& [from, until] : {std::pair<std::size_t, std::size_t>{1, 3}, {5, 20}, {13, 15}, {22, 45}, {8, 47}}) {
    Vector y = Vector::Zero(static_cast<Index>(count));
    y.segment(static_cast<Index>(from), static_cast<Index>(until - from)).setOnes();
    const auto found = courses_of(o, y);
    const Candidate& one = named(found, "while:time " + while_name(o, all, from, until));
    CHECK((one.columns - y).norm() == 0);
    CHECK(one.depends_on == std::vector<std::string>{"time"});
    // Pairs of the places after the first reading, at least two apart.
    CHECK(one.searched == (count - 2) * (count - 3) / 2.0);
  }
}

TEST_CASE("a while of one part is found between its readings, and between blocks where there are blocks", "[tracing]") {
  Observations o = made();
  const Grouping& label = *part_labels(o)[0];
  std::vector<std::size_t> own; // places of the readings of a part
  for (std::size_t i = 0; i < count; ++i)
    if (label.group[o.sequence[i]] == 1) own.push_back(i);
  const auto of_own = [&](std::size_t from, std::size_t until) {
    Vector y = Vector::Zero(static_cast<Index>(count));
    for (std::size_t i = from; i < until; ++i) y[static_cast<Index>(own[i])] = 1;
    return y;
  };
  const std::string name = "while:time with " + label.groups[1] + " ";
  for (const auto& [from, until] : {std::pair<std::size_t, std::size_t>{1, 3}, {4, 9}, {10, 15}}) {
    const auto found = courses_of(o, of_own(from, until));
    const Candidate& one = named(found, name + while_name(o, own, from, until));
    CHECK((one.columns - of_own(from, until)).norm() == 0);
    CHECK(one.rare());
    CHECK(one.searched == 3 * 14 * 13 / 2.0); // sixteen readings of each of three
  }
  o.blocks = {"day", {"day"}, {}, {"day 1", "day 2", "day 3", "day 4"}, {{"1"}, {"2"}, {"3"}, {"4"}}};
  for (std::size_t r = 0; r < count; ++r) o.blocks.group.push_back(3 - r / 12);
  const auto found = courses_of(o, of_own(4, 8)); // the second day
  const Candidate& one = named(found, name + while_name(o, own, 4, 8));
  CHECK(one.searched == 3 * 3); // the second, the third, or both
  // Of all readings, one block that differs has that name already.
  CHECK(std::ranges::any_of(
      found, [](const Candidate& a) { return a.name.starts_with("while:time from") && a.searched == 1; }));
}

TEST_CASE("what came and went is found with its place and length", "[tracing]") {
  const Observations o = made(); // a reading a second, from 53 s on
  for (const auto& [middle, width] : {std::pair{20.3, 2.6}, {7.9, 4.1}, {40.2, 7.3}, {23.0, 6.0}}) {
    Vector pulse(static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const double from_middle = (static_cast<double>(i) - middle) / width;
      pulse[static_cast<Index>(i)] = std::exp(-0.5 * from_middle * from_middle);
    }
    const auto found = courses_of(o, pulse);
    const auto reading = o.sequence[static_cast<std::size_t>(std::lround(middle))] + 1;
    const Candidate& one = named(found, "pulse:time about reading " + std::to_string(reading));
    // What it explains is a ten-thousandth short: the column is a hundredth off.
    CHECK((one.columns - pulse).norm() < 1e-2 * pulse.norm());
    CHECK(one.depends_on == std::vector<std::string>{"time"});
    CHECK(one.searched > 40);
  }
}

TEST_CASE("what came and stayed is found with its place and length", "[tracing]") {
  const Observations o = made();
  for (const auto& [middle, width] : {std::pair{20.3, 2.6}, {15.9, 4.1}, {33.2, 6.0}}) {
    Vector shift(static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i)
      shift[static_cast<Index>(i)] = 0.5 * std::erfc(-(static_cast<double>(i) - middle) / width / std::sqrt(2.0));
    const auto found = courses_of(o, shift);
    const auto reading = o.sequence[static_cast<std::size_t>(std::lround(middle))] + 1;
    const Candidate& one = named(found, "shift:time about reading " + std::to_string(reading));
    CHECK((one.columns - shift).norm() < 1e-2 * shift.norm());
    CHECK(one.searched > 40);
  }
}

TEST_CASE("two angles that were commanded apart have waves of the angle between them", "[tracing]") {
  Observations o = made();
  std::vector<double> turned, along;
  for (std::size_t r = 0; r < count; ++r) {
    turned.push_back(static_cast<double>(r / 12) * 0.9);
    along.push_back(o.covariates[1].value[r] + 0.3);
  }
  o.covariates[1].commanded = true;
  o.covariates.push_back(covariate("part", "rad", turned));
  o.covariates.back().commanded = true;
  o.covariates.push_back(covariate("along", "rad", along)); // goes along with the first: nothing is between them
  o.covariates.back().commanded = true;
  const auto all = shapes(o, 60);
  const Matrix five = with_constant(named(all, "harmonic:5xangle-part").columns);
  Vector y(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = o.sequence[i];
    y[static_cast<Index>(i)] = std::cos(5 * (o.covariates[1].value[r] - turned[r]) + 0.7);
  }
  CHECK((y - five * five.colPivHouseholderQr().solve(y)).norm() < 1e-12 * y.norm());
  CHECK_THROWS(named(all, "harmonic:1xangle-along"));
  CHECK_THROWS(named(all, "harmonic:1xpart-along")); // the same once more
}

TEST_CASE("two labels that come back together have a table, and a step in each cell", "[tracing]") {
  Observations o = made();
  Grouping pair{"machine,operator", {"machine", "operator"}, {}, {}, {}};
  for (std::size_t r = 0; r < count; ++r) pair.group.push_back(r * r / 7 % 4);
  for (const char* machine : {"M1", "M2"})
    for (const char* operator_ : {"anna", "ben"}) {
      pair.groups.push_back(std::string("machine ") + machine + ", operator " + operator_);
      pair.values.push_back({machine, operator_});
    }
  CHECK_THROWS(named(shapes(o, 60), "table:machine*operator"));
  o.label_pairs = {pair};
  const auto all = shapes(o, 60);
  const Candidate& step = named(all, "step:machine M2, operator anna");
  CHECK(step.depends_on == pair.labels);
  const Candidate& table = named(all, "table:machine*operator");
  CHECK(table.depends_on == pair.labels);
  const std::set<std::size_t> met(pair.group.begin(), pair.group.end());
  CHECK(table.columns.cols() + 1 == static_cast<Index>(met.size()));
  for (const std::size_t cell : met) { // any value in each cell
    Vector y(static_cast<Index>(count));
    for (std::size_t i = 0; i < count; ++i) y[static_cast<Index>(i)] = pair.group[o.sequence[i]] == cell ? 1 : 0;
    if (cell == 2) CHECK(step.columns == y);
    CHECK(tracing_dense::outside(with_constant(table.columns), y).norm() < 1e-12);
  }
  CHECK_THROWS(named(shapes(o, met.size() - 1), "table:machine*operator")); // too many cells
}

TEST_CASE("shapes span what they say", "[tracing]") {
  const Observations o = made();
  const auto all = shapes(o, 60);
  for (const Candidate& a : all) {
    CHECK(a.columns.rows() == static_cast<Index>(count));
    CHECK(a.columns.allFinite());
    CHECK(a.amplitudes.size() == static_cast<std::size_t>(a.columns.cols()));
    CHECK(!a.depends_on.empty());
    CHECK(!a.physical());
  }
  const auto spans = [&](const std::string& name, std::size_t c, auto f, const std::string& shape = "") {
    INFO(name);
    CHECK(outside(with_constant(named(all, name, shape).columns), o, c, f) < 1e-12);
  };
  spans("polynomial:feed", 0, [](double x) { return 3 - 2 * x; });
  spans("polynomial:feed^2", 0, [](double x) { return 1 + 4 * x * x; });
  spans("polynomial:feed^3", 0, [](double x) { return x * x * x; });
  spans("polynomial:1/feed", 0, [](double x) { return 5 / x; });
  spans(
      "polynomial:feed^2", 0, [](double x) { return (x - 4.5) * (x - 4.5); }, "zero in the middle");
  spans("polynomial:load", 2, [](double x) { return x; });
  for (int h = 1; h <= 4; ++h) // any phase
    spans("harmonic:" + std::to_string(h) + "xangle", 1, [&](double x) { return std::cos(h * x + 0.7); });
  // A step of a label: one there, nought elsewhere, by sequence.
  const Matrix step = named(all, "step:setup 2").columns;
  for (std::size_t i = 0; i < count; ++i) CHECK(step(static_cast<Index>(i), 0) == (o.sequence[i] % 3 == 1 ? 1 : 0));
  // The direction of motion: feed rises or falls from one reading to the next, as they were taken.
  const Matrix way = named(all, "hysteresis:feed").columns;
  for (std::size_t i = 1; i < count; ++i)
    CHECK(way(static_cast<Index>(i), 0) ==
          (o.covariates[0].value[o.sequence[i]] > o.covariates[0].value[o.sequence[i - 1]] ? 1 : -1));
  // Where a condition says the same, but for a few turning points, that is what was recorded.
  Observations recorded = o;
  std::vector<double> direction(count, 1);
  for (std::size_t i = 0; i < count; ++i) direction[o.sequence[i]] = way(static_cast<Index>(i), 0);
  direction[o.sequence[5]] *= -1;
  recorded.covariates.push_back(covariate("direction", "1", direction));
  const auto plain = [](const Candidate& a) { return a.name == "hysteresis:feed" && a.shape.empty(); };
  CHECK(std::ranges::count_if(all, plain) == 1);
  CHECK(std::ranges::count_if(shapes(recorded, 60), plain) == 0);
  // A product is that of the centred factors.
  const Matrix product = named(all, "product:feed*load").columns;
  Matrix basis(static_cast<Index>(count), 4);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = o.covariates[0].value[o.sequence[i]], y = o.covariates[2].value[o.sequence[i]];
    basis.row(static_cast<Index>(i)) << 1, x, y, x * y;
  }
  CHECK(tracing_dense::outside(basis, product).norm() < 1e-12 * product.norm());
}

TEST_CASE("the omnibus bases hold any smooth dependence", "[tracing]") {
  const Observations o = made();
  // Two levels: any function of them. Thirteen: every cubic. An angle all round: waves of any phase.
  const Matrix load = with_constant(smooth_basis(o, o.covariates[2], 5));
  CHECK(outside(load, o, 2, [](double x) { return std::sin(x); }) < 1e-12);
  const Matrix feed = with_constant(smooth_basis(o, o.covariates[0], 5));
  CHECK(feed.cols() == 6);
  CHECK(outside(feed, o, 0, [](double x) { return 2 - x + 0.3 * x * x - 0.1 * x * x * x; }) < 1e-10);
  CHECK(outside(feed, o, 0, [](double x) { return std::exp(-x / 5); }) < 0.01);
  const Matrix angle = with_constant(smooth_basis(o, o.covariates[1], 5));
  for (int h = 1; h <= 3; ++h) CHECK(outside(angle, o, 1, [&](double x) { return std::sin(h * x - 0.3); }) < 1e-12);
  // No column is a combination of the others and the constant.
  for (const Matrix& basis : {load, feed, angle}) CHECK(tracing_dense::rank(basis) == basis.cols());
  // A label's omnibus: any value per group.
  const auto all = shapes(o, 60);
  const Matrix setups = with_constant(named(all, "omnibus:setup").columns);
  Vector y(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i)
    y[static_cast<Index>(i)] = std::sqrt(2.0 + static_cast<double>(o.sequence[i] % 3));
  CHECK(tracing_dense::outside(setups, y).norm() < 1e-12);
}

TEST_CASE("a shape is that of one indication", "[tracing]") {
  Observations o = made();
  o.indications = 2;
  o.names = {"X", "Y"};
  for (const Candidate& a : shapes(o, 60)) {
    REQUIRE(a.columns.rows() == static_cast<Index>(2 * count));
    const bool x = a.name.ends_with(" of X");
    CHECK((x || a.name.ends_with(" of Y")));
    CHECK(a.columns(Eigen::seq(x ? 1 : 0, Eigen::last, 2), Eigen::all).norm() == 0);
  }
}

TEST_CASE("a signature is told by the conditions on which it depends", "[tracing]") {
  const Observations o = made();
  const auto depends = [&](const std::function<double(std::size_t)>& f) {
    Matrix column(static_cast<Index>(count), 1);
    for (std::size_t i = 0; i < count; ++i) column(static_cast<Index>(i), 0) = f(o.sequence[i]);
    return dependence(o, column);
  };
  using Names = std::vector<std::string>;
  const auto& c = o.covariates;
  CHECK(depends([&](std::size_t r) { return c[0].value[r] * c[0].value[r]; }) == Names{"feed"});
  CHECK(depends([&](std::size_t r) { return std::sin(c[1].value[r]); }) == Names{"angle"});
  CHECK(depends([&](std::size_t r) { return c[2].value[r]; }) == Names{"load"});
  CHECK(depends([&](std::size_t r) { return r % 3 == 1 ? 1.0 : 0.0; }) == Names{"setup"});
  CHECK(depends([&](std::size_t) { return 4.0; }).empty());
  const Names both = depends([&](std::size_t r) { return c[0].value[r] + 3 * std::sin(c[1].value[r]); });
  CHECK(both == Names{"feed", "angle"});
}

TEST_CASE("a reversal that grows along a slide is a shape, and what follows from other conditions divides no table",
          "[tracing]") {
  Observations o;
  o.readings = count;
  o.indications = 1;
  o.names = {"d"};
  std::vector<double> place, screw, direction;
  for (std::size_t r = 0; r < count; ++r) {
    o.sequence.push_back(r);
    const auto i = static_cast<double>(r % 8);
    place.push_back(0.1 + 0.02 * i);
    screw.push_back(0.5 * static_cast<double>((3 * (r % 8)) % 8));
    direction.push_back(r / 8 % 2 == 0 ? 1 : -1);
  }
  o.covariates = {covariate("x", "m", place), covariate("screw", "1", screw), covariate("direction", "1", direction)};
  const auto all = shapes(o, 60);
  for (const auto& [from, shape] :
       {std::pair{0.1, "zero at the lowest x"}, {0.24, "zero at the highest x"}, {0.0, "zero at x = 0"}}) {
    Vector y(static_cast<Index>(count));
    for (std::size_t r = 0; r < count; ++r) y[static_cast<Index>(r)] = direction[r] * (place[r] - from);
    CHECK(tracing_dense::outside(named(all, "product:x*direction", shape).columns, y).norm() < 1e-12 * y.norm());
  }
  // Rayleigh's loop closes where the way turns back.
  const Matrix loop = named(all, "product:x*direction", "closing at both ends").columns;
  for (std::size_t r = 0; r < count; ++r) {
    const double z = (place[r] - 0.17) / 0.07;
    CHECK(loop(static_cast<Index>(r), 0) == Approx(direction[r] * (1 - z * z)).margin(1e-12));
  }
  // The screw's angle follows from x.
  std::set<std::string> tables;
  for (const Candidate& a : all)
    if (a.name.starts_with("table:")) tables.insert(a.name);
  CHECK(tables == std::set<std::string>{"table:x", "table:x*direction"});
}
