// Order statistics, sums and regions of columns that are read part by part: the bits of those of values in memory.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "analysis/circular.h"
#include "analysis/complete.h"
#include "analysis/joint.h"
#include "analysis/leaves.h"
#include "analysis/ordered_column.h"
#include "analysis/summary.h"
#include "analysis/tails.h"
#include "random/streams.h"

using namespace gumshoe;
using namespace gumshoe::analysis;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
using Values = std::vector<double>;

Values uniforms(std::uint64_t key, std::size_t n) {
  Values x(n);
  random::uniforms({key}, 0, n, x.data());
  return x;
}

/// As a file gives them.
Column read_in_parts(const Values& x) {
  return {x.size(), [&x](std::size_t first, std::span<double> out) { std::copy_n(&x[first], out.size(), out.begin()); },
          1064};
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

struct Shape {
  const char* name;
  double (*of)(double u, std::size_t i);
  bool sorted = false;
};

/// What makes bins, brackets or comparisons go wrong.
const Shape shapes[] = {
    {"uniform", [](double u, std::size_t) { return u; }},
    {"evenly spread",
     [](double, std::size_t i) { return std::fmod(0.6180339887498949 * static_cast<double>(i), 1.0); }},
    {"one mode about zero", [](double u, std::size_t) { return std::log(u / (1 - u)); }},
    {"close values", [](double u, std::size_t) { return 0.1 + 1e-9 * std::log(u / (1 - u)); }},
    {"heavy tails", [](double u, std::size_t) { return std::tan(std::numbers::pi * (u - 0.5)); }},
    {"one heavy tail", [](double u, std::size_t) { return 1 / u; }},
    {"a limit at zero", [](double u, std::size_t) { return -std::log(u); }},
    {"equal", [](double, std::size_t) { return 4.25; }},
    {"three values", [](double u, std::size_t) { return std::floor(3 * u) - 1; }},
    {"a grid", [](double u, std::size_t) { return std::floor(200 * u * u) / 128; }},
    {"a third missing", [](double u, std::size_t i) { return i % 3 == 1 ? missing : u * u; }},
    {"the first missing", [](double u, std::size_t i) { return i < 70'000 && i % 4'000 != 0 ? missing : -u; }},
    {"infinite at times", [](double u, std::size_t) { return u < 1e-3    ? -inf
                                                             : u > 0.999 ? inf
                                                                         : u; }},
    {"infinite above", [](double u, std::size_t) { return u > 0.9 ? inf : u; }},
    {"a crowd and one far out", [](double u, std::size_t i) { return i == 77 ? 1e300 : 1 + 1e-13 * u; }},
    {"two crowds", [](double u, std::size_t) { return u < 0.03   ? -1e6 + u
                                                      : u > 0.98 ? 1e-6 * u
                                                                 : u; }},
    {"denormal", [](double u, std::size_t) { return 1e-310 * (u - 0.4); }},
    {"rising", [](double u, std::size_t) { return u * u; }, true},
    {"what the pilot takes is large",
     [](double u, std::size_t i) { return u + (i % (13 * pilot_run) < pilot_run ? 10 : 0); }},
};

Values values_of(const Shape& shape, std::uint64_t key, std::size_t n) {
  Values x = uniforms(key, n);
  for (std::size_t i = 0; i < n; ++i) x[i] = shape.of(x[i], i);
  if (shape.sorted) std::ranges::sort(x);
  return x;
}

Values sorted_of(const Values& x) {
  Values sorted;
  std::ranges::copy_if(x, std::back_inserter(sorted), [](double v) { return !std::isnan(v); });
  std::ranges::sort(sorted);
  return sorted;
}

/// The first of the shortest, by trying all.
std::size_t shortest_of(const Values& sorted, std::size_t span, double turn) {
  const std::size_t n = sorted.size();
  double least = inf;
  std::size_t best = 0;
  for (std::size_t r = 0; r < (turn > 0 ? n : n - span); ++r)
    if (const double l = (r + span < n ? sorted[r + span] : sorted[r + span - n] + turn) - sorted[r]; l < least)
      least = l, best = r;
  return best;
}

void check_same(const Summary& a, const Summary& b) {
  CHECK(a.valid == b.valid);
  CHECK(a.failed == b.failed);
  const auto check = [&](const char* what, double x, double y) {
    INFO(what << ": " << x << ", " << y);
    CHECK(same(x, y));
  };
  check("estimate", a.estimate, b.estimate);
  check("its error", a.estimate_se, b.estimate_se);
  check("u", a.standard_uncertainty, b.standard_uncertainty);
  check("its error", a.standard_uncertainty_se, b.standard_uncertainty_se);
  check("skewness", a.skewness, b.skewness);
  check("kurtosis", a.kurtosis, b.kurtosis);
  check("half-width", a.monte_carlo_expanded, b.monte_carlo_expanded);
  check("length's error", a.shortest_length_se, b.shortest_length_se);
  check("tail index", a.hill_index, b.hill_index);
  for (const auto& [x, y] : {std::pair{a.symmetric, b.symmetric}, std::pair{a.shortest, b.shortest}}) {
    check("low", x.low, y.low);
    check("high", x.high, y.high);
    check("low's error", x.low_se, y.low_se);
    check("high's error", x.high_se, y.high_se);
    check("low's bound", x.low_rank, y.low_rank);
    check("high's bound", x.high_rank, y.high_rank);
  }
  CHECK(std::ranges::equal(a.bin_edges, b.bin_edges, same));
  CHECK(std::ranges::equal(a.density, b.density, same));
  CHECK(a.warning == b.warning);
  CHECK(a.tail_remark == b.tail_remark);
  CHECK(a.estimate_is_median == b.estimate_is_median);
}

} // namespace

TEST_CASE("ranks in bounded memory are those of the sorted values", "[summary][bounded]") {
  std::uint64_t key = 100;
  for (const Shape& shape : shapes)
    for (const std::size_t n : {2, 700, 65'537, 150'000}) {
      const Values x = values_of(shape, ++key, n), sorted = sorted_of(x);
      if (sorted.size() < 2) continue;
      const std::size_t m = sorted.size();
      INFO(shape.name << ", " << n);
      const Column column = read_in_parts(x);
      const RankRange ends[] = {{0, m / 20}, {m - 1 - m / 20, m - 1}}, middle[] = {{m / 2, m / 2}};
      for (const OrderedColumn::Limits limits : {OrderedColumn::Limits{400, 64}, {5'000, 1'000}, {}}) {
        const OrderedColumn ordered(column, m, ends, 2, limits), body(column, m, middle, 1, limits);
        bool equal = ordered.size == m;
        for (std::size_t k = 0; k <= 40; ++k) equal = equal && ordered[k * (m - 1) / 40] == sorted[k * (m - 1) / 40];
        CHECK(equal);
        CHECK(body[m / 2] == sorted[m / 2]);
        for (const std::size_t span : {m / 3, m * 95 / 100, m - 1}) {
          INFO("span " << span);
          CHECK(ordered.shortest(span) == shortest_of(sorted, span, 0));
        }
      }
      const std::size_t ranks[] = {0, m / 3, m / 3, m - 1};
      CHECK(values_of_ranks(column, m, ranks, 2) == Values{sorted[0], sorted[m / 3], sorted[m / 3], sorted[m - 1]});
    }
}

TEST_CASE("a summary in bounded memory has the bits of one in memory", "[summary][bounded]") {
  std::uint64_t key = 1000;
  for (const Shape& shape : shapes)
    for (const std::size_t n : {1, 2, 30, 999, 1024, 5'000, 65'535, 65'536, 65'537, 131'073, 200'003}) {
      if (n == 200'003 && &shape - shapes > 3) continue; // long ones of a few shapes
      const Values x = values_of(shape, ++key, n);
      for (const double p : {0.95, 0.5, 0.999}) {
        if (p != 0.95 && n != 5'000 && n != 65'537) continue;
        INFO(shape.name << ", " << n << " values, p = " << p);
        Summary expected = summarise({}, x, p);
        check_tails(x, expected);
        for (const OrderedColumn::Limits ordered : {OrderedColumn::Limits{400, 64}, {5'000, 1'000}}) {
          KeptOrder order;
          const Column column = read_in_parts(x);
          Summary found = summarise({}, column, p, 2, &order, {0, ordered});
          check_tails(column, found, 2, &order);
          check_same(found, expected);
        }
        Summary alone = summarise({}, read_in_parts(x), p);
        check_tails(read_in_parts(x), alone);
        check_same(alone, expected);
      }
    }
}

TEST_CASE("a summary with failed samples bounds its ends in bounded memory", "[summary][bounded]") {
  for (const std::size_t every : {20, 50, 333, 40'000}) {
    Values x = values_of(shapes[2], 2000 + every, 90'000);
    for (std::size_t i = 7; i < x.size(); i += every) x[i] = missing;
    const Column column = read_in_parts(x);
    KeptOrder order;
    check_same(summarise({}, column, 0.95, 1, &order, {0, {500, 64}}), summarise({}, x, 0.95));
  }
}

TEST_CASE("sums of a column that is read have the bits of one in memory", "[summary][bounded]") {
  for (const std::size_t n : {1, 1'023, 1'024, 1'025, 8'193, 65'536, 65'537, 300'001}) {
    const Values x = values_of(shapes[4], n, n);
    const Moments in_memory = moments(x), read = moments(read_in_parts(x), 2);
    CHECK(same(in_memory.mean, read.mean));
    CHECK(same(in_memory.variance, read.variance));
    CHECK(same(in_memory.kurtosis, read.kurtosis));
    // All leaves at once, as they stand in the definition.
    std::vector<double> leaves;
    const auto leaf = [](std::span<const double> some) {
      double sum = 0;
      for (const double v : some) sum += v;
      return sum;
    };
    for (std::size_t at = 0; at < n; at += leaf_values)
      leaves.push_back(leaf(std::span(x).subspan(at, std::min(leaf_values, n - at))));
    CHECK(same(leaf_sum<double>(Column(x), 2, leaf), pairwise(std::span(leaves))));
  }
}

TEST_CASE("complete samples are those that copying would keep", "[summary][bounded]") {
  for (const std::size_t n : {1, 1'024, 5'000, 66'000, 140'000}) {
    Values x = uniforms(n, n), y = uniforms(n + 1, n), kept;
    for (std::size_t i = 0; i < n; ++i) {
      if (x[i] < 0.2 || (i > 3'000 && i < 10'000)) x[i] = missing; // whole leaves, too
      if (y[i] < 0.1) y[i] = missing;
      if (!std::isnan(x[i]) && !std::isnan(y[i])) kept.push_back(y[i]);
    }
    const Complete complete(
        {read_in_parts(x), Column(y)}, [](double v) { return !std::isnan(v); }, 2);
    REQUIRE(complete.size() == kept.size());
    const Column column = complete.column(1);
    for (const std::size_t first : {std::size_t{0}, kept.size() / 3, kept.size() - kept.size() / 7}) {
      Values out(kept.size() - first);
      column.copy(first, out);
      CHECK(std::ranges::equal(out, std::span(kept).subspan(first)));
    }
  }
}

TEST_CASE("a joint region of columns that are read is that of copies", "[joint][bounded]") {
  for (const bool failed : {false, true}) {
    const std::size_t n = 80'000;
    std::vector<Values> all, kept(3);
    std::vector<Column> columns;
    for (std::uint64_t a = 0; a < 3; ++a) all.push_back(values_of(shapes[2], 300 + a, n));
    for (std::size_t i = 0; i < n; ++i) {
      all[2][i] += all[0][i];
      if (failed && i % 7 == 3) all[i % 3][i] = missing;
      if (std::ranges::none_of(all, [&](const Values& y) { return std::isnan(y[i]); }))
        for (std::size_t a = 0; a < 3; ++a) kept[a].push_back(all[a][i]);
    }
    for (const Values& y : all) columns.push_back(read_in_parts(y));
    const JointRegion found = joint_region(columns, 0.95, 2);
    const JointRegion expected = joint_region({kept[0], kept[1], kept[2]}, 0.95);
    CHECK(found.estimate == expected.estimate);
    CHECK(found.covariance == expected.covariance);
    CHECK(found.correlation == expected.correlation);
    CHECK(same(found.k_p, expected.k_p));
    CHECK(same(found.k_p_se, expected.k_p_se));
    CHECK(same(found.k_q, expected.k_q));
  }
}

TEST_CASE("the shortest arc in bounded memory is the first of the shortest", "[joint][bounded]") {
  const double turn = 2 * std::numbers::pi;
  std::uint64_t key = 5000;
  for (const double spread : {0.01, 1.0, 6.2, 40.0})
    for (const std::size_t n : {3, 1'000, 30'000}) {
      Values x = uniforms(++key, n);
      for (double& v : x) v = std::remainder(spread * (v - 0.5), turn);
      const Values sorted = sorted_of(x);
      const RankRange ends[] = {{0, n / 30}, {n - 1 - n / 30, n - 1}};
      const Column column = read_in_parts(x);
      const OrderedColumn ordered(column, n, ends, 2, {100, 64});
      for (const std::size_t span : {n / 2, n * 95 / 100})
        CHECK(ordered.shortest(span, turn) == shortest_of(sorted, span, turn));
      const CircularSummary read = circular_summary(column, 0.95, 2), whole = circular_summary(x, 0.95);
      CHECK(same(read.low, whole.low));
      CHECK(same(read.high, whole.high));
      CHECK(same(read.mean_direction, whole.mean_direction));
      CHECK(same(read.standard_deviation_se, whole.standard_deviation_se));
    }
}
