/// One error rate over all that is tried: on noise alone small p values are as rare as they say.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tracing/judgement/assess.h"
#include "tracing/judgement/ranking.h"
#include "unit/tracing_dense.h"

using namespace tracing_dense;

namespace {

/// Five standard deviations of a binomial share, and the last step of p values in steps of 1 / (draws + 1).
double tolerance(double p, int sets, int draws) { return 5 * std::sqrt(p * (1 - p) / sets) + 1.0 / (draws + 1); }

/// A line, a wave, a label's steps: signatures of one and of several columns.
std::vector<Candidate> signatures(const Design& d) {
  const Index n = d.fixed.rows();
  std::vector<Candidate> out;
  for (int h = 1; h <= 4; ++h) {
    Matrix wave(n, h % 2 == 0 ? 2 : 1);
    for (Index i = 0; i < n; ++i) {
      wave(i, 0) = std::sin(0.26 * h * static_cast<double>(i));
      if (wave.cols() > 1) wave(i, 1) = std::cos(0.26 * h * static_cast<double>(i));
    }
    out.push_back(candidate(wave));
  }
  Vector line(n), late(n);
  for (Index i = 0; i < n; ++i) {
    line[i] = static_cast<double>(i);
    late[i] = 2 * i > n ? 1 : 0;
  }
  out.push_back(candidate(line));
  out.push_back(candidate(late));
  return out;
}

/// 24 readings about one constant, what is tried on them, and draws of their noise.
struct Made {
  Design design;
  std::vector<Candidate> tried;
  Scan scan;
  Whitened truth;

  Made(Index random, std::size_t groups, std::uint64_t seed)
      : design(about_a_constant(random, groups, seed)), tried(signatures(design)),
        scan(design, all_rows(design), pointers_to(tried), 1), truth(design, all_rows(design), {0}, {}) {}

private:
  static Design about_a_constant(Index random, std::size_t groups, std::uint64_t seed) {
    Design d = random_design(24, 1, 1, random, groups, seed);
    d.fixed.setOnes();
    return d;
  }
  static std::vector<const Candidate*> pointers_to(const std::vector<Candidate>& all) {
    std::vector<const Candidate*> out;
    for (const Candidate& a : all) out.push_back(&a);
    return out;
  }
};

} // namespace

TEST_CASE("p values of noise alone are uniform", "[tracing]") {
  constexpr int sets = 400, draws = 99;
  for (const std::size_t groups : {0, 6}) {
    const Made made(1, groups, 11);
    const Matrix noise = made.truth.draw(sets, 999);
    std::vector<double> anything;
    int signature = 0, single = 0, declared = 0, scatter = 0;
    for (Index j = 0; j < sets; ++j) {
      const Assessment a = assess(made.scan, noise.col(j), draws, static_cast<std::uint64_t>(j + 1), 0.05, 1);
      anything.push_back(a.p_anything);
      // A single signature below the threshold is what the search would take for significant.
      signature += *std::min_element(a.p.begin(), a.p.end()) <= a.threshold;
      single += a.p[4] <= 0.05;
      declared += a.p_noise <= 0.05;
      for (const double p : a.p_component) scatter += p <= 0.05;
      CHECK(a.p_anything <= a.p_noise_overall);
    }
    CAPTURE(groups);
    for (const double p : {0.05, 0.1, 0.25, 0.5, 0.75}) {
      const auto below = std::count_if(anything.begin(), anything.end(), [&](double x) { return x <= p; });
      CHECK(static_cast<double>(below) / sets == Approx(p).margin(tolerance(p, sets, draws)));
    }
    const double limit = 0.05 + tolerance(0.05, sets, draws);
    CHECK(signature <= limit * sets);
    CHECK(scatter <= limit * sets);
    CHECK(single <= limit * sets);
    CHECK(declared <= limit * sets);
  }
}

TEST_CASE("what is there is found by the same p values", "[tracing]") {
  const Made made(0, 6, 12);
  const Scan& scan = made.scan;
  const Vector noise = made.truth.draw(1, 5);
  // Ten standard deviations by its information: nothing else comes near it.
  const double size = 10 / std::sqrt(scan.information(0, 0, scan.plain()));
  const Assessment a = assess(scan, noise + size * made.tried[0].columns, 99, 1, 0.05, 1);
  CHECK(a.p_anything == Approx(0.01)); // none of 99
  CHECK(a.p_signature == Approx(0.01));
  CHECK(std::min_element(a.p.begin(), a.p.end()) - a.p.begin() == 0);
  CHECK(a.p[0] < a.threshold);
  // Noise eight times as large as declared shows, and is no signature: the logarithm of a median of 24 scatters by
  // about 1.25 / sqrt(24) = 0.26, so ln 8 is p = 0.001 (3.1 of them) and five more to spare.
  const Assessment b = assess(scan, 8 * noise, 99, 1, 0.05, 1);
  CHECK(b.p_noise < 1e-3);
  CHECK(b.p_anything == Approx(0.01));
  CHECK(b.p_signature == Approx(assess(scan, noise, 99, 1, 0.05, 1).p_signature));
  // And so does noise an eighth of it: no finding, but said.
  const Assessment small = assess(scan, noise / 8, 99, 1, 0.05, 1);
  CHECK(small.noise_small);
  CHECK(small.p_noise > 0.99);
}

TEST_CASE("the ranking says how much of a signature the fit leaves, and what absorbs it", "[tracing]") {
  const Made made(0, 6, 12);
  Design design = made.design;
  design.fixed_names = {"laser_z"};
  std::vector<Candidate> tried = made.tried;
  tried.push_back(candidate(3 * design.fixed)); // the fitted constant itself
  std::vector<const Candidate*> pointers;
  for (std::size_t a = 0; a < tried.size(); ++a) {
    tried[a].name = std::to_string(a);
    pointers.push_back(&tried[a]);
  }
  const Scan scan(design, all_rows(design), pointers, 1);
  const Assessment a = assess(scan, made.truth.draw(1, 5), 99, 1, 0.05, 1);
  const auto lines = ranking(scan, a, tried, design, {});
  REQUIRE(lines.size() == tried.size());
  for (const RankedCandidate& line : lines) {
    INFO(line.name);
    const bool constant = line.name == "6";
    CHECK(line.identifiable == scan.identifiable(std::stoul(line.name)));
    CHECK((line.identifiable < 1e-12) == constant);
    CHECK(line.absorbed_by == (constant ? "laser_z" : ""));
    CHECK((line.outcome == "not testable: absorbed by laser_z") == constant);
  }
}

TEST_CASE("a matched null is a gamma distribution", "[tracing]") {
  // Chi-squared of m degrees of freedom has mean m and variance 2 m; 5.991 is its 0.95 quantile for m = 2.
  const Null two{2, 4};
  CHECK(two.p(5.991464547107979) == Approx(0.05));
  CHECK(two.quantile(0.05) == Approx(5.991464547107979));
  CHECK(Null{1, 2}.p(3.841458820694124) == Approx(0.05));
  CHECK(two.p(0) == 1);
  CHECK(Null{0, 0}.p(7) == 1);
}
