/// NIST StRD nonlinear regression through the least-squares door, from both starts.
/// Certified values: NIST Statistical Reference Datasets (public domain), https://www.itl.nist.gov/div898/strd/.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "base/csv.h"
#include "math/least_squares.h"
#include "math/parameter_covariance.h"
#include "math/scalar.h"
#include "places.h"

using namespace gumshoe;

namespace {

using D = Dual<double, 8>;

D power(const D& a, const D& b) {
  const double v = std::pow(a.v, b.v);
  return chain_rule<double, 8>(v, b.v * v / a.v, a, std::log(a.v) * v, b);
}

struct Set {
  const char* name;
  std::function<D(const D* b, double x)> model;
  std::vector<double> starts[2];
  std::vector<double> certified, deviations;
  double sum_of_squares;
  double digits; ///< asked for
};

const std::vector<Set>& sets() {
  static const std::vector<Set> all{
      {"misra1a",
       [](const D* b, double x) { return b[0] * (1.0 - num::exp(-(b[1] * x))); },
       {{500, 1e-4}, {250, 5e-4}},
       {2.3894212918E+02, 5.5015643181E-04},
       {2.7070075241E+00, 7.2668688436E-06},
       1.2455138894E-01,
       8},
      {"mgh09",
       [](const D* b, double x) { return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]); },
       {{25, 39, 41.5, 39}, {.25, .39, .415, .39}},
       {1.9280693458E-01, 1.9128232873E-01, 1.2305650693E-01, 1.3606233068E-01},
       {1.1435312227E-02, 1.9633220911E-01, 8.0842031232E-02, 9.0025542308E-02},
       3.0750560385E-04,
       6},
      {"boxbod",
       [](const D* b, double x) { return b[0] * (1.0 - num::exp(-(b[1] * x))); },
       {{1, 1}, {100, .75}},
       {2.1380940889E+02, 5.4723748542E-01},
       {1.2354515176E+01, 1.0455993237E-01},
       1.1680088766E+03,
       6},
      {"rat42",
       [](const D* b, double x) { return b[0] / (1.0 + num::exp(b[1] - b[2] * x)); },
       {{100, 1, .1}, {75, 2.5, .07}},
       {7.2462237576E+01, 2.6180768402E+00, 6.7359200066E-02},
       {1.7340283401E+00, 8.8295217536E-02, 3.4465663377E-03},
       8.0565229338E+00,
       6},
      {"rat43",
       [](const D* b, double x) { return b[0] / power(1.0 + num::exp(b[1] - b[2] * x), 1.0 / b[3]); },
       {{100, 10, 1, 1}, {700, 5, .75, 1.3}},
       {6.9964151270E+02, 5.2771253025E+00, 7.5962938329E-01, 1.2792483859E+00},
       {1.6302297817E+01, 2.0828735829E+00, 1.9566123451E-01, 6.8761936385E-01},
       8.7864049080E+03,
       6},
      {"mgh10",
       [](const D* b, double x) { return b[0] * num::exp(b[1] / (x + b[2])); },
       {{2, 4e5, 2.5e4}, {.02, 4000, 250}},
       {5.6096364710E-03, 6.1813463463E+03, 3.4522363462E+02},
       {1.5687892471E-04, 2.3309021107E+01, 7.8486103508E-01},
       8.7945855171E+01,
       6},
  };
  return all;
}

struct Data {
  std::vector<double> y, x;
};
Data data_of(const char* name) {
  const Csv csv = read_csv(std::string(GUMSHOE_SOURCE_DIR) + "/scenarios/gauge/data/strd_" + name + ".csv");
  Data out;
  for (const auto& row : csv.rows) {
    out.y.push_back(csv.number(row[0]));
    out.x.push_back(csv.number(row[1]));
  }
  return out;
}

least_squares::Problem problem_of(const Set& set, const Data& data, int start) {
  least_squares::Problem problem;
  const std::size_t p = set.certified.size();
  problem.residuals = data.y.size();
  problem.parameters = p;
  problem.start = set.starts[start];
  problem.evaluate = [&set, &data, p](const double* b, double* r, double* jacobian) {
    for (std::size_t i = 0; i < data.y.size(); ++i) {
      D parameters[8];
      for (std::size_t j = 0; j < p; ++j) parameters[j] = D::variable(b[j], static_cast<int>(j));
      const D y = set.model(parameters, data.x[i]);
      r[i] = data.y[i] - y.v;
      for (std::size_t j = 0; jacobian && j < p; ++j) jacobian[i * p + j] = -y.d[j];
    }
    return true;
  };
  return problem;
}

/// Log relative error: the number of equal digits, at most the 11 that are certified.
double digits(double ours, double certified) {
  const double error = std::fabs(ours - certified) / std::fabs(certified);
  return error > 0 ? std::min(11.0, -std::log10(error)) : 11.0;
}

} // namespace

TEST_CASE("NIST StRD nonlinear sets reach their certified digits from both starts", "[references][least_squares]") {
  for (const Set& set : sets()) {
    const Data data = data_of(set.name);
    const std::size_t n = data.y.size(), p = set.certified.size();
    for (int start = 0; start < 2; ++start) {
      INFO(set.name << ", start " << start + 1);
      const auto problem = problem_of(set, data, start);
      const auto solution = least_squares::solve(problem);
      UNSCOPED_INFO(solution.report.reason << "; " << solution.report.solver);
      REQUIRE(solution.report.converged);
      const double squares = 2 * solution.report.cost_after, s2 = squares / static_cast<double>(n - p);
      const auto covariance = least_squares::parameter_covariance(solution.jacobian, n, p, solution.x);
      CHECK(covariance.rank == p);
      CHECK(digits(squares, set.sum_of_squares) >= set.digits);
      double least = 11, least_sd = 11;
      for (std::size_t j = 0; j < p; ++j) {
        least = std::min(least, digits(solution.x[j], set.certified[j]));
        least_sd = std::min(least_sd, digits(std::sqrt(s2 * covariance.matrix[j * p + j]), set.deviations[j]));
      }
      CHECK(least >= set.digits);
      CHECK(least_sd >= set.digits);
    }
  }
}

TEST_CASE("a solver that found no minimum says so", "[least_squares]") {
  SECTION("too few iterations") {
    const Set& set = sets()[4];
    const Data data = data_of(set.name);
    least_squares::Options options;
    options.iterations = 1;
    options.offset_tolerance = options.step_tolerance = 0; // the polish may not make up for it
    const auto solution = least_squares::solve(problem_of(set, data, 0), options);
    CHECK_FALSE(solution.report.converged);
    CHECK(std::isfinite(solution.report.cost_after));
  }
  SECTION("a minimum at infinity") {
    // 1 - exp(-b x) never reaches 1; every larger b is better until nothing changes.
    least_squares::Problem problem;
    problem.residuals = 3;
    problem.parameters = 1;
    problem.start = {1};
    problem.evaluate = [](const double* b, double* r, double* jacobian) {
      for (int i = 0; i < 3; ++i) {
        r[i] = 1 + 0.1 * i - (1 - std::exp(-b[0] * (i + 1)));
        if (jacobian) jacobian[i] = -(i + 1) * std::exp(-b[0] * (i + 1));
      }
      return true;
    };
    const auto solution = least_squares::solve(problem);
    CHECK_FALSE(solution.report.converged);
  }
  SECTION("residuals that are not defined at the start") {
    least_squares::Problem problem;
    problem.residuals = problem.parameters = 1;
    problem.start = {-1};
    problem.evaluate = [](const double* b, double* r, double* jacobian) {
      r[0] = std::log(b[0]);
      if (jacobian) jacobian[0] = 1 / b[0];
      return true;
    };
    const auto solution = least_squares::solve(problem);
    CHECK_FALSE(solution.report.converged);
    CHECK(solution.report.reason == "the residuals are undefined at the start values");
  }
}

TEST_CASE("bounds hold and are told", "[least_squares]") {
  // (b - 3)^2 with b at most 2, and a free parameter: the bound holds, the other is solved.
  least_squares::Problem problem;
  problem.residuals = problem.parameters = 2;
  problem.start = {1, 1};
  problem.low = {-HUGE_VAL, -HUGE_VAL};
  problem.high = {2, HUGE_VAL};
  problem.evaluate = [](const double* b, double* r, double* jacobian) {
    r[0] = b[0] - 3;
    r[1] = b[1] + b[0] - 7;
    if (jacobian) {
      const double slopes[] = {1, 0, 1, 1};
      std::copy_n(slopes, 4, jacobian);
    }
    return true;
  };
  const auto solution = least_squares::solve(problem);
  CHECK(solution.report.converged);
  CHECK(solution.x[0] == 2);
  CHECK(solution.x[1] == Approx(5).epsilon(1e-12));
  CHECK(solution.report.at_bound == std::vector<std::size_t>{0});
}
