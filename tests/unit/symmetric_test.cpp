#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "math/symmetric.h"

using namespace gumshoe;

namespace {

/// Q diag(values) Q' with a random rotation Q.
template <int N> Symmetric<double, N> made(const double (&values)[N], std::mt19937& engine) {
  std::normal_distribution<double> normal;
  double q[N][N];
  for (int i = 0; i < N; ++i) {
    for (double& x : q[i]) x = normal(engine);
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < i; ++j) {
        double along = 0;
        for (int k = 0; k < N; ++k) along += q[i][k] * q[j][k];
        for (int k = 0; k < N; ++k) q[i][k] -= along * q[j][k];
      }
    double length = 0;
    for (const double x : q[i]) length += x * x;
    for (double& x : q[i]) x /= std::sqrt(length);
  }
  Symmetric<double, N> m{};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < N; ++k) m.at[i][j] += values[k] * q[k][i] * q[k][j];
  return m;
}

} // namespace

TEST_CASE("eigenvalues of known matrices, small and zero ones too", "[unit][math]") {
  std::mt19937 engine(3);
  const double values[] = {3, 1e-3, 0, 2, 2, 1e-8, 0};
  for (int n = 0; n < 50; ++n) {
    const auto m = made(values, engine);
    const auto system = eigen_system(m);
    double sorted[7], known[7];
    for (int k = 0; k < 7; ++k) {
      sorted[k] = system.value[k], known[k] = values[k];
      for (int i = 0; i < 7; ++i) { // M v = lambda v
        double image = 0;
        for (int j = 0; j < 7; ++j) image += m.at[i][j] * system.vector[k][j];
        CHECK(std::fabs(image - system.value[k] * system.vector[k][i]) < 1e-14);
      }
    }
    std::sort(sorted, sorted + 7), std::sort(known, known + 7);
    for (int k = 0; k < 7; ++k) CHECK(std::fabs(sorted[k] - known[k]) < 1e-14); // 30 roundings of 3
  }
}

TEST_CASE("a lane's eigenvalues and solutions are those of the matrix alone", "[unit][math]") {
  std::mt19937 engine(4);
  Symmetric<Lanes, 5> together{};
  std::vector<Symmetric<double, 5>> alone;
  for (std::size_t l = 0; l < Lanes::size; ++l) {
    const double values[] = {1, 0.5, 0.2 * static_cast<double>(l), 0.1, 1e-3};
    alone.push_back(made(values, engine));
  }
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      double x[Lanes::size];
      for (std::size_t l = 0; l < Lanes::size; ++l) x[l] = alone[l].at[i][j];
      together.at[i][j] = Lanes::load_unaligned(x);
    }
  Lanes x[] = {1.0, 2.0, 3.0, 4.0, 5.0};
  const auto system = eigen_system(together);
  const Lanes pivot = solve_cholesky(together, x);
  for (std::size_t l = 0; l < Lanes::size; ++l) {
    double y[] = {1, 2, 3, 4, 5};
    const auto one = eigen_system(alone[l]);
    CHECK(solve_cholesky(alone[l], y) == pivot.get(l));
    for (int k = 0; k < 5; ++k) {
      CHECK(one.value[k] == system.value[k].get(l));
      CHECK(y[k] == x[k].get(l));
    }
    if (l == 0) continue; // singular
    for (int i = 0; i < 5; ++i) {
      double image = 0;
      for (int j = 0; j < 5; ++j) image += alone[l].at[i][j] * y[j];
      CHECK(std::fabs(image - (i + 1)) < 1e-11); // 5e3 x of size, 1e-16
    }
  }
}
