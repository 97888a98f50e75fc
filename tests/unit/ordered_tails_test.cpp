// Exact tails by a pilot bracket: against sorting, for any number of threads.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/ordered_tails.h"
#include "analysis/ranked.h"
#include "analysis/summary.h"
#include "random/streams.h"

using namespace gumshoe;
using namespace gumshoe::analysis;

namespace {

std::vector<double> uniforms(std::uint64_t key, std::size_t n) {
  std::vector<double> x(n);
  random::uniforms({key}, 0, n, x.data());
  return x;
}

/// Every rank that was promised is the sorted one.
void check_tails_of(const std::vector<double>& x, std::size_t tail) {
  std::vector<double> sorted;
  for (const double v : x)
    if (!std::isnan(v)) sorted.push_back(v);
  std::sort(sorted.begin(), sorted.end());
  for (const int threads : {1, 2, 7}) {
    const OrderedTails t = ordered_tails(x, sorted.size(), tail, threads);
    bool equal = t.size == sorted.size();
    for (std::size_t r = 0; r < tail; ++r)
      equal = equal && t[r] == sorted[r] && t[sorted.size() - 1 - r] == sorted[sorted.size() - 1 - r];
    CHECK(equal);
  }
}

} // namespace

TEST_CASE("tails are those of the sorted values", "[summary]") {
  const auto x = uniforms(5, 300'000);
  check_tails_of(x, 15'000);
  check_tails_of({x.begin(), x.begin() + 500}, 100); // too few for a pilot
  check_tails_of(x, 150'000);                        // everything
  auto ties = x;
  for (double& v : ties) v = std::floor(8 * v);
  check_tails_of(ties, 15'000);
  auto holes = x;
  for (std::size_t i = 0; i < holes.size(); i += 3) holes[i] = std::numeric_limits<double>::quiet_NaN();
  check_tails_of(holes, 10'000);
  // A bracket that must miss: the pilot takes runs at even distances, and just those are large.
  auto trap = x;
  const std::size_t step = (trap.size() + 16383) / 16384;
  for (std::size_t i = 0; i < trap.size(); ++i)
    if (i % (step * pilot_run) < pilot_run) trap[i] += 10;
  check_tails_of(trap, 15'000);
}

TEST_CASE("the shortest span is the first of the shortest", "[summary]") {
  const auto u = uniforms(7, 120'000);
  auto normal = u, ties = u, far = u;
  for (double& v : normal) v = std::log(v / (1 - v)); // one mode
  for (double& v : ties) v = std::floor(40 * v);
  for (double& v : far) v = 1 / (v - 0.5); // crowds into few bins
  const std::size_t some = 400;
  for (const auto& x : {u, normal, ties, far, {u.begin(), u.begin() + some}}) {
    auto sorted = x;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t span = sorted.size() * 95 / 100;
    std::size_t first = 0;
    for (std::size_t r = 1; r + span < sorted.size(); ++r)
      if (sorted[r + span] - sorted[r] < sorted[first + span] - sorted[first]) first = r;
    CHECK(ordered_tails(x, x.size(), x.size() / 18, 1).shortest(span) == first);
  }
}

TEST_CASE("ranks of values that are not kept are those of the sorted values", "[summary]") {
  auto x = uniforms(8, 300'001);
  const auto check = [&] {
    auto sorted = x;
    std::sort(sorted.begin(), sorted.end());
    const auto fill = [&](std::size_t first, std::span<double> out) { std::copy_n(&x[first], out.size(), out.begin()); };
    for (const std::size_t rank : {std::size_t{1}, x.size() / 3, x.size() * 95 / 100, x.size() - 2}) {
      const std::size_t ranks[] = {rank - 1, rank, rank, rank + 1};
      for (const int threads : {1, 2, 7})
        CHECK(ranked(x.size(), fill, ranks, threads) ==
              std::vector<double>{sorted[rank - 1], sorted[rank], sorted[rank], sorted[rank + 1]});
    }
  };
  check();
  // A bracket that must miss: just what the pilot takes is large.
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i % (x.size() / 8192 * pilot_run) < pilot_run) x[i] += 10;
  check();
  x.resize(100); // too few for a pilot
  check();
}

TEST_CASE("a summary has the same bits for any number of threads", "[summary]") {
  auto x = uniforms(6, 700'000);
  x[12345] = std::numeric_limits<double>::quiet_NaN();
  const propagation::Output output{"y", "y", 0, "1", "1"};
  const Summary one = summarise(output, x, 0.95, 1);
  for (const int threads : {2, 7}) {
    const Summary s = summarise(output, x, 0.95, threads);
    CHECK(s.estimate == one.estimate);
    CHECK(s.standard_uncertainty == one.standard_uncertainty);
    CHECK(s.kurtosis == one.kurtosis);
    CHECK(s.symmetric.low == one.symmetric.low);
    CHECK(s.shortest.high == one.shortest.high);
    CHECK(s.shortest.low_se == one.shortest.low_se);
    CHECK(s.density == one.density);
  }
  CHECK(one.failed == 1);
}
