/// The scalars that physics runs in: lanes and dual numbers.
#include <catch2/catch.hpp>

#include <bit>
#include <random>

#include "math/scalar.h"

using namespace gumshoe;

namespace {

std::vector<double> arguments() {
  std::mt19937_64 engine(5);
  std::vector<double> x{0.0, 1e-300, 1e-9, 0.785398163397448, 1.5707963267948966, 3.141592653589793, 100.0, 999.0};
  for (const double scale : {0.5, 3.0, 60.0, 1000.0})
    for (int i = 0; i < 2000; ++i) x.push_back(scale * (2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1));
  return x;
}

double ulp(double x) { return std::nextafter(std::fabs(x), HUGE_VAL) - std::fabs(x); }

} // namespace

// Beside a zero the reduced argument keeps about 118 bits of pi/2: 1e-30 absolute.
TEST_CASE("sine, cosine and exponential are good to about one unit in the last place", "[scalar]") {
  for (const double x : arguments()) {
    INFO(x);
    CHECK(std::fabs(num::sin(x) - std::sin(x)) <= 1.01 * ulp(std::sin(x)) + 1e-30);
    CHECK(std::fabs(num::cos(x) - std::cos(x)) <= 1.01 * ulp(std::cos(x)) + 1e-30);
    if (std::fabs(x) < 700) CHECK(std::fabs(num::exp(x) - std::exp(x)) <= 1.01 * ulp(std::exp(x)));
  }
}

TEST_CASE("a lane's bits do not depend on its neighbours", "[scalar]") {
  const auto xs = arguments();
  const std::vector<double> neighbours{0.0, 0.3, 1.2, 50.0, 900.0};
  for (std::size_t i = 0; i < xs.size(); i += 7)
    for (const double other : neighbours) {
      alignas(64) double in[Lanes::size];
      for (double& v : in) v = other;
      in[0] = xs[i];
      const Lanes x = Lanes::load_unaligned(in);
      const auto same = [&](double lane, double alone) {
        return std::bit_cast<std::uint64_t>(lane) == std::bit_cast<std::uint64_t>(alone);
      };
      CHECK(same(num::sin(x).get(0), num::sin(xs[i])));
      CHECK(same(num::cos(x).get(0), num::cos(xs[i])));
      CHECK(same(num::exp(x).get(0), num::exp(xs[i])));
      CHECK(same(num::atan2(x, Lanes(0.7)).get(0), num::atan2(xs[i], 0.7)));
    }
}

TEST_CASE("dual numbers: first and second derivatives of a known function", "[scalar][dual]") {
  // f = exp(-x) atan2(y, x) + sqrt(x) sin(y) / y
  const double x = 0.83, y = 1.7;
  using D = Dual<double, 2>;
  using D2 = Dual<D, 2>;
  D2 u(x), v(y);
  u.v = D::variable(x, 0), v.v = D::variable(y, 1);
  u.d[0] = D(1.0), v.d[1] = D(1.0);
  const D2 f = num::exp(-u) * num::atan2(v, u) + num::sqrt(u) * num::sin(v) / v;
  const double n = x * x + y * y, e = std::exp(-x), a = std::atan2(y, x), r = std::sqrt(x);
  const double fx = -e * a - e * y / n + 0.5 / r * std::sin(y) / y;
  const double fy = e * x / n + r * (std::cos(y) / y - std::sin(y) / (y * y));
  const double fxy =
      -e * x / n + e * (1 / n - 2 * x * x / (n * n)) + 0.5 / r * (std::cos(y) / y - std::sin(y) / (y * y));
  const double fxx = e * a + 2 * e * y / n + e * 2 * x * y / (n * n) - 0.25 / (r * x) * std::sin(y) / y;
  CHECK(num::value(f) == Approx(e * a + r * std::sin(y) / y).epsilon(1e-15));
  CHECK(f.v.d[0] == Approx(fx).epsilon(1e-14));
  CHECK(f.v.d[1] == Approx(fy).epsilon(1e-14));
  CHECK(f.d[0].d[1] == Approx(fxy).epsilon(1e-13));
  CHECK(f.d[1].d[0] == Approx(fxy).epsilon(1e-13));
  CHECK(f.d[0].d[0] == Approx(fxx).epsilon(1e-13));
}
