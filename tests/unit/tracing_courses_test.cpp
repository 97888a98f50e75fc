/// Courses in time are found where they are: steps, bends and whiles, of all readings or of one part, pulses and
/// shifts.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "tracing/candidates/courses.h"
#include "unit/tracing_made_design.h"

using namespace tracing_design;

namespace {

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

} // namespace

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
  // The while of all readings is longer than one block, which has its own shape.
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
