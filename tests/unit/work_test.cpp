// Units of work: shared exactly and evenly, handed over in order, the same whoever does them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>

#include "base/error.h"
#include "propagation/shard.h"
#include "propagation/work.h"

using namespace gumshoe;
using propagation::Shard;
using propagation::Work;
using propagation::Workers;

namespace {

double tens(std::uint64_t i) { return 10.0 * static_cast<double>(i); }

/// Unit i gives 10 i and 10 i + 1.
Work numbers(std::uint64_t units, std::uint64_t together) {
  return {.name = "numbers",
          .units = units,
          .values = 2,
          .together = together,
          .compute = [](std::uint64_t first, std::uint64_t last, double* out) {
            for (std::uint64_t i = first; i < last; ++i) *out++ = tens(i), *out++ = tens(i) + 1;
          }};
}

} // namespace

TEST_CASE("shards have every unit of every work once, in order, and equal parts of the runs within the largest unit") {
  std::mt19937 random(17);
  for (int round = 0; round < 200; ++round) {
    std::vector<Work> works(1 + random() % 6);
    std::uint64_t total = 0, largest = 0;
    for (Work& work : works) {
      work = {
          .name = "", .units = random() % 50, .values = 1 + random() % 5, .runs = 1 + random() % 1000, .compute = {}};
      total += work.units * work.runs;
      largest = std::max(largest, work.runs);
    }
    const std::uint64_t of = 1 + random() % 20;
    std::vector<std::uint64_t> next(works.size(), 0);
    for (std::uint64_t k = 1; k <= of; ++k) {
      std::uint64_t runs = 0, values = 0;
      for (const auto& part : Shard{k, of}.portions(works)) {
        CHECK(part.first == next[part.work]);
        CHECK(part.last > part.first);
        next[part.work] = part.last;
        runs += (part.last - part.first) * works[part.work].runs;
        values += (part.last - part.first) * works[part.work].values;
      }
      const double fair = static_cast<double>(total) / static_cast<double>(of);
      CHECK(std::abs(static_cast<double>(runs) - fair) < static_cast<double>(largest) + 1);
      CHECK(propagation::values_of(Shard{k, of}.portions(works), works) == values);
    }
    for (std::size_t w = 0; w < works.size(); ++w) CHECK(next[w] == works[w].units);
  }
}

TEST_CASE("values come in order, whoever does the units") {
  std::vector<double> expected(2 * 103);
  for (std::size_t i = 0; i < 103; ++i) expected[2 * i] = tens(i), expected[2 * i + 1] = tens(i) + 1;
  for (const int threads : {1, 2, 7})
    for (const std::uint64_t together : {1, 8, 1000}) {
      Workers workers(threads);
      CHECK(workers.values(numbers(103, together)) == expected);
      std::atomic<int> elsewhere = 0;
      for (int k = 0; k < 3; ++k)
        workers.elsewhere.push_back([&](const Work& work, std::uint64_t first, std::uint64_t last) {
          ++elsewhere;
          std::vector<double> values((last - first) * work.values);
          work.compute(first, last, values.data());
          return values;
        });
      CHECK(workers.size() == static_cast<std::size_t>(threads) + 3);
      CHECK(workers.values(numbers(103, together)) == expected);
      CHECK(elsewhere > 0);
      std::uint64_t next = 20;
      workers.run(numbers(103, together), 20, 33, [&](std::uint64_t first, std::uint64_t last, const double* values) {
        CHECK(first == next);
        CHECK(values[0] == tens(first));
        next = last;
      });
      CHECK(next == 33);
    }
}

TEST_CASE("what is known is not done again, and a unit that fails leaves those before it") {
  Workers workers(2);
  Work work = numbers(50, 1);
  work.compute = [](std::uint64_t first, std::uint64_t, double* out) {
    if (first == 31) throw InputError("unit 31 fails");
    out[0] = out[1] = 0;
  };
  std::uint64_t taken = 0;
  CHECK_THROWS_WITH(workers.run(work, [&](std::uint64_t, std::uint64_t last, const double*) { taken = last; }),
                    Catch::Contains("unit 31 fails"));
  CHECK(taken == 31);
  workers.known = [](const Work& asked, const propagation::TakeUnits& take) {
    const std::vector<double> all(asked.units * asked.values, 7.0);
    if (asked.name == "numbers") take(0, asked.units, all.data());
    return asked.name == "numbers";
  };
  CHECK(workers.values(work) == std::vector<double>(100, 7.0));
  work.name = "others";
  CHECK_THROWS_AS(workers.values(work), InputError);
}
