#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "quantities/quantile_kernels.h"
#include "random/latin_hypercube.h"
#include "random/sobol.h"
#include "random/streams.h"

using namespace gumshoe;
using namespace gumshoe::random;

TEST_CASE("Philox4x32-10 gives the known answers of Random123", "[random]") {
  // Random123, kat_vectors: philox4x32 10
  using Four = std::array<std::uint32_t, 4>;
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("uniforms are the stated function of key and counter", "[random]") {
  const Stream stream{0x0123456789abcdef, 7, 3, 2};
  const std::uint64_t sample = (std::uint64_t{5} << 33) + 10; // the counter's high word is in use
  const auto words =
      philox({static_cast<std::uint32_t>(sample / 2), static_cast<std::uint32_t>(sample / 2 >> 32), 7, 3u << 16 | 2u},
             {0x89abcdef, 0x01234567});
  const std::uint64_t even = (std::uint64_t{words[1]} << 32 | words[0]) >> 12;
  const std::uint64_t odd = (std::uint64_t{words[3]} << 32 | words[2]) >> 12;
  CHECK(uniform(stream, sample) == (static_cast<double>(even) + 0.5) * 0x1p-52);
  CHECK(uniform(stream, sample + 1) == (static_cast<double>(odd) + 0.5) * 0x1p-52);
}

TEST_CASE("uniforms have equal bits on every instruction set and for every block", "[random]") {
  const Stream stream{hash64("quantity"), 0, 1, 0};
  std::vector<double> whole(4096);
  uniforms(stream, 64, whole.size(), whole.data());
  for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!available(set)) continue;
    INFO(name(set));
    for (const std::size_t block : {8, 64, 512}) {
      std::vector<double> parts(whole.size());
      for (std::size_t i = 0; i < parts.size(); i += block)
        quantities::kernels(set).uniforms(&stream, 64 + i, block, parts.data() + i);
      CHECK(parts == whole);
    }
  }
}

TEST_CASE("streams differ in every word of their key and counter, and are uniform", "[random]") {
  constexpr std::size_t n = 1 << 16;
  std::vector<double> reference(n), other(n);
  const Stream base{hash64("a", 1), 0, 0, 0};
  uniforms(base, 0, n, reference.data());
  double sum = 0;
  for (const double u : reference) sum += u;
  CHECK(std::abs(sum / n - 0.5) < 4.5 / std::sqrt(12.0 * n));
  for (const Stream& stream : {Stream{hash64("b", 1), 0, 0, 0}, Stream{hash64("a", 2), 0, 0, 0},
                               Stream{base.key, 1, 0, 0}, Stream{base.key, 0, 1, 0}, Stream{base.key, 0, 0, 1}}) {
    uniforms(stream, 0, n, other.data());
    double product = 0;
    for (std::size_t i = 0; i < n; ++i) product += (reference[i] - 0.5) * (other[i] - 0.5);
    CHECK(std::abs(product / n) < 4.5 / 12 / std::sqrt(double(n))); // a shared stream would give 1/12
  }
}

TEST_CASE("hash64 is fixed for ever", "[random]") {
  // FNV-1a of "" and "a" (Fowler, Noll, Vo), finished by mix64; splitmix64's first output for state 0.
  CHECK(mix64(0) == 0xe220a8397b1dcdafu);
  CHECK(hash64("") == mix64(0xcbf29ce484222325u));
  CHECK(hash64("a") == mix64(0xaf63dc4c8601ec8cu));
  CHECK(hash64("a", 1) != hash64("a", 2));
}

TEST_CASE("Latin hypercube hits each stratum once, whatever the blocks", "[random]") {
  for (const std::uint64_t total : {1u, 2u, 7u, 64u, 1000u, 4096u, 65537u}) {
    const Stream stream{hash64("latin", total), 0, 0, 0};
    const std::size_t padded = (total + 63) / 64 * 64;
    std::vector<double> whole(padded), parts(padded);
    latin_hypercube(stream, total, 0, padded, whole.data());
    std::set<std::uint64_t> strata;
    for (std::size_t i = 0; i < total; ++i) {
      REQUIRE(whole[i] > 0);
      REQUIRE(whole[i] < 1);
      strata.insert(static_cast<std::uint64_t>(whole[i] * static_cast<double>(total)));
    }
    CHECK(strata.size() == total);
    for (std::size_t i = 0; i < padded; i += 64) latin_hypercube(stream, total, i, 64, parts.data() + i);
    CHECK(parts == whole);
  }
}

TEST_CASE("Latin hypercubes have equal bits on every instruction set and for every block", "[random]") {
  // Sizes that fill their table, and others that leave nearly a row of it.
  for (const std::uint64_t total : {1u, 2u, 7u, 1000u, 1023u, 1024u, 1025u, 65536u, 65537u, 300'000'000u}) {
    const Stream stream{hash64("latin", total), 0, 0, 0};
    const random::Permutation strata = random::strata(stream, total);
    std::vector<double> whole(4096);
    latin_hypercube(stream, total, 64, whole.size(), whole.data());
    for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!available(set)) continue;
      INFO(name(set) << ", " << total);
      for (const std::size_t block : {8, 64, 4096}) {
        std::vector<double> parts(whole.size());
        for (std::size_t i = 0; i < parts.size(); i += block)
          quantities::kernels(set).latin_hypercube(&stream, &strata, 64 + i, block, parts.data() + i);
        CHECK((parts == whole));
      }
    }
  }
}

TEST_CASE("over all keys, two samples of a Latin hypercube lie in any two strata alike", "[random]") {
  // Chi-squared of the cells of two samples' strata, over 20,000 keys. A network of six rounds fails for small sizes.
  constexpr int keys = 20'000;
  for (const std::uint64_t n : {7u, 16u, 64u, 100u, 1000u, 65537u}) {
    const std::uint64_t parts = std::min<std::uint64_t>(n, 10),
                        across = static_cast<std::uint64_t>(std::sqrt(double(n)));
    std::vector<double> width(parts);
    for (std::uint64_t i = 0; i < n; ++i) ++width[i * parts / n];
    for (const auto& [a, b] :
         {std::pair<std::uint64_t, std::uint64_t>{0, 1}, {0, across}, {1, n - 1}, {n / 2, n - 2}}) {
      INFO(n << " strata, samples " << a << " and " << b);
      std::vector<double> counts(parts * parts);
      for (int k = 0; k < keys; ++k) {
        const random::Permutation p(n, mix64(static_cast<std::uint64_t>(k)));
        ++counts[p(a) * parts / n * parts + p(b) * parts / n];
      }
      double chi_squared = 0, freedom = -1;
      for (std::uint64_t i = 0; i < parts; ++i)
        for (std::uint64_t j = 0; j < parts; ++j) {
          const double expected = keys * width[i] * (width[j] - (i == j)) / (double(n) * double(n - 1));
          const double found = counts[i * parts + j];
          if (expected == 0) {
            CHECK(found == 0);
            continue;
          }
          chi_squared += (found - expected) * (found - expected) / expected;
          ++freedom;
        }
      CHECK(std::fabs(chi_squared - freedom) < 5 * std::sqrt(2 * freedom));
    }
  }
}

TEST_CASE("Latin hypercubes of different keys are unrelated", "[random]") {
  constexpr std::size_t n = 1 << 14;
  std::vector<double> a(n), b(n);
  latin_hypercube({hash64("a"), 0, 0, 0}, n, 0, n, a.data());
  latin_hypercube({hash64("b"), 0, 0, 0}, n, 0, n, b.data());
  double with_other = 0, with_index = 0;
  for (std::size_t i = 0; i < n; ++i) {
    with_other += (a[i] - 0.5) * (b[i] - 0.5);
    with_index += (a[i] - 0.5) * (static_cast<double>(i) / n - 0.5);
  }
  CHECK(std::abs(with_other / n) < 4.5 / 12 / std::sqrt(double(n)));
  CHECK(std::abs(with_index / n) < 4.5 / 12 / std::sqrt(double(n)));
}

TEST_CASE("the first Sobol' dimensions are those of the literature", "[random]") {
  // van der Corput, and Joe and Kuo's second and third dimensions, natural order
  const double expected[3][8] = {{0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875},
                                 {0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875},
                                 {0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125}};
  for (std::uint32_t d = 0; d < 3; ++d) {
    double points[64];
    SobolDimension{d}(0, 64, points);
    for (int i = 0; i < 8; ++i) CHECK(points[i] == Approx(expected[d][i]).margin(1e-15));
  }
}

TEST_CASE("scrambled Sobol' points: one per stratum, nested, independent of blocks", "[random]") {
  for (const std::uint32_t dimension : {0u, 5u, 731u, 3666u}) {
    for (const std::uint64_t key : {1u, 2u}) {
      const SobolDimension sobol(dimension, mix64(key));
      std::vector<double> whole(4096), parts(4096);
      sobol(0, whole.size(), whole.data());
      for (std::size_t n = 1; n <= whole.size(); n *= 2) {
        std::set<int> strata;
        for (std::size_t i = 0; i < n; ++i) strata.insert(static_cast<int>(whole[i] * static_cast<double>(n)));
        REQUIRE(strata.size() == n);
      }
      for (std::size_t i = 0; i < parts.size(); i += 64) sobol(i, 64, parts.data() + i);
      CHECK(parts == whole);
    }
  }
}

TEST_CASE("the scramble makes each Sobol' point uniform and independent of the other points' errors", "[random]") {
  // Over many keys the mean of 64 points of x^2 is unbiased, with far less spread than Monte Carlo
  // (sd of x^2: 0.298), and different keys give unrelated errors.
  constexpr int replications = 2000, n = 64;
  double sum = 0, squares = 0, lagged = 0, before = 0;
  for (int r = 0; r < replications; ++r) {
    double points[n], mean = 0;
    SobolDimension{3, mix64(static_cast<std::uint64_t>(r))}(0, n, points);
    for (const double x : points) mean += x * x / n;
    const double error = mean - 1.0 / 3;
    sum += error;
    squares += error * error;
    lagged += error * before;
    before = error;
  }
  const double sd = std::sqrt(squares / replications);
  CHECK(std::abs(sum / replications) < 4.5 * sd / std::sqrt(double(replications)));
  CHECK(std::abs(lagged / replications) < 4.5 * sd * sd / std::sqrt(double(replications)));
  CHECK(sd < 0.298 / 8 / 5);
  CHECK(sd > 1e-5); // without scramble all replications would be the same
}
