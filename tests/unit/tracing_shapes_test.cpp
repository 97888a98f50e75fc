/// Shapes without a cause span what their names say; what a signature depends on.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include <Eigen/QR>

#include "base/units.h"
#include "tracing/candidates/smooth_basis.h"
#include "unit/tracing_case.h"
#include "unit/tracing_dense.h"
#include "unit/tracing_made_design.h"

using namespace tracing_case;
using namespace tracing_design;

namespace {

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
