/// Elementary functions over their whole range against the C library; derivatives against differences.
#include <catch2/catch.hpp>

#include <bit>
#include <functional>
#include <random>

#include "math/elementary.h"

using namespace gumshoe;
namespace el = gumshoe::elementary;

namespace {

double ulp(double x) { return std::nextafter(std::fabs(x), HUGE_VAL) - std::fabs(x); }

/// Uniform in size and in order of magnitude, of both signs, with the awkward values.
std::vector<double> arguments(double low_exponent, double high_exponent) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> exponent(low_exponent, high_exponent), unit(-1, 1);
  std::vector<double> x{0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 10.0, 1000.0, 0.4375, 0.6875, 1.1875, 2.4375};
  for (int i = 0; i < 4000; ++i) x.push_back(std::copysign(std::pow(10.0, exponent(engine)), unit(engine)));
  for (int i = 0; i < 4000; ++i) x.push_back(2 * unit(engine));
  return x;
}

using One = double (*)(double);
struct Case {
  const char* name;
  One ours, theirs;
  double low, high; ///< orders of magnitude of the argument
  double units;     ///< error allowed, in units of the last place
};

} // namespace

TEST_CASE("functions of one argument agree with the C library to a few units in the last place", "[elementary]") {
  // log10: the C library's own error is up to 2 there; ours rounds 64 bits once.
  const Case cases[] = {{"sin", el::sin, std::sin, -8, 8, 1.5},     {"cos", el::cos, std::cos, -8, 8, 1.5},
                        {"tan", el::tan, std::tan, -8, 8, 4},       {"asin", el::asin, std::asin, -12, 0.1, 4},
                        {"acos", el::acos, std::acos, -12, 0.1, 4}, {"atan", el::atan, std::atan, -12, 12, 2},
                        {"sinh", el::sinh, std::sinh, -12, 2.8, 4}, {"cosh", el::cosh, std::cosh, -12, 2.8, 3},
                        {"tanh", el::tanh, std::tanh, -12, 3, 4},   {"exp", el::exp, std::exp, -12, 2.84, 1.5},
                        {"log", el::log, std::log, -300, 300, 1.5}, {"log10", el::log10, std::log10, -300, 300, 2.6},
                        {"sqrt", el::sqrt, std::sqrt, -300, 300, 0}};
  for (const Case& c : cases)
    for (const double x : arguments(c.low, c.high)) {
      const double ours = c.ours(x), theirs = c.theirs(x);
      if (std::isnan(theirs)) {
        if (!std::isnan(ours)) FAIL_CHECK(c.name << "(" << x << ") = " << ours);
      } else if (std::isinf(theirs)) {
        if (ours != theirs) FAIL_CHECK(c.name << "(" << x << ") = " << ours);
      } else if (!(std::fabs(ours - theirs) <= c.units * ulp(theirs) + 1e-30)) {
        // near a zero, sin and cos keep about 118 bits of pi/2: 1e-30 absolute
        FAIL_CHECK(c.name << "(" << x << ") is off by " << std::fabs(ours - theirs) / ulp(theirs) << " ulp");
      }
    }
}

TEST_CASE("a logarithm of a power of ten is a whole number", "[elementary]") {
  for (int k = -300; k <= 300; ++k) CHECK(el::log10(std::stod("1e" + std::to_string(k))) == k);
}

TEST_CASE("powers agree with the C library over the whole range", "[elementary]") {
  std::mt19937_64 engine(12);
  std::uniform_real_distribution<double> exponent(-300, 300), size(-3, 2), unit(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 2 ? std::pow(10.0, exponent(engine)) : 1 + 0.5 * unit(engine);
    const double y = i % 3 ? std::copysign(std::pow(10.0, size(engine)), unit(engine)) : std::round(20 * unit(engine));
    const double theirs = std::pow(x, y), ours = el::pow(x, y);
    if (theirs > 1e307 || theirs < 1e-306) continue; // the ends of the range are cut, see exp_whole_lane
    if (!(std::fabs(ours - theirs) <= 4 * ulp(theirs))) FAIL_CHECK(x << "^" << y << ": " << ours << " not " << theirs);
  }
  const double inf = HUGE_VAL;
  const double special[] = {0.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5, 3.0, -3.0, inf, -2.5, 1e200, 4.0};
  for (const double x : special)
    for (const double y : special) {
      if ((x == 0 && std::signbit(x)) || std::isinf(y)) continue; // no exponent is infinite in a formula with a value
      INFO(x << "^" << y);
      const double theirs = std::pow(x, y), ours = el::pow(x, y);
      if (std::isnan(theirs))
        CHECK(std::isnan(ours));
      else if (std::isfinite(theirs))
        CHECK(ours == Approx(theirs).epsilon(1e-15));
      else
        CHECK(ours == theirs);
    }
}

TEST_CASE("functions of two arguments agree with the C library", "[elementary]") {
  const auto xs = arguments(-10, 10), ys = arguments(-12, 9);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const double x = xs[i], y = ys[(i * 7 + 3) % ys.size()];
    INFO(x << ", " << y);
    const double angle = std::atan2(y, x), length = std::hypot(x, y);
    if (!(std::fabs(el::atan2(y, x) - angle) <= 3 * ulp(angle))) FAIL_CHECK("atan2");
    if (!(std::fabs(el::hypot(x, y) - length) <= 3 * ulp(length))) FAIL_CHECK("hypot");
    if (el::min(x, y) != std::fmin(x, y) || el::max(x, y) != std::fmax(x, y)) FAIL_CHECK("min or max");
  }
  CHECK(std::isnan(el::min(1.0, std::nan(""))));
  CHECK(std::isnan(el::max(std::nan(""), 1.0)));
  CHECK(el::hypot(0.0, 0.0) == 0);
}

TEST_CASE("no value stays no value", "[elementary]") {
  const double nan = std::nan("");
  for (const One f :
       {One(el::sin), One(el::cos), One(el::tan), One(el::asin), One(el::acos), One(el::atan), One(el::sinh),
        One(el::cosh), One(el::tanh), One(el::exp), One(el::log), One(el::log10), One(el::sqrt), One(el::abs)})
    CHECK(std::isnan(f(nan)));
  CHECK(std::isnan(el::pow(nan, 2)));
  CHECK(std::isnan(el::pow(2, nan)));
  CHECK(std::isinf(el::exp(710)));
  CHECK(std::isnan(el::log(-1)));
  CHECK(el::log(0) == -HUGE_VAL);
}

TEST_CASE("a lane's bits do not depend on its neighbours, in any function", "[elementary]") {
  const auto xs = arguments(-6, 7);
  using Wide = Lanes (*)(const Lanes&);
  struct Both {
    One one;
    Wide wide;
  };
  const Both both[] = {{el::sin, el::sin},   {el::cos, el::cos},   {el::tan, el::tan},   {el::asin, el::asin},
                       {el::acos, el::acos}, {el::atan, el::atan}, {el::sinh, el::sinh}, {el::cosh, el::cosh},
                       {el::tanh, el::tanh}, {el::exp, el::exp},   {el::log, el::log},   {el::log10, el::log10}};
  for (const Both& f : both)
    for (std::size_t i = 0; i < xs.size(); i += 5)
      for (const double other : {0.0, 0.3, 1e7, -40.0}) {
        alignas(64) double in[Lanes::size];
        for (double& v : in) v = other;
        in[0] = xs[i];
        if (std::bit_cast<std::uint64_t>(f.wide(Lanes::load_aligned(in)).get(0)) !=
            std::bit_cast<std::uint64_t>(f.one(xs[i])))
          FAIL_CHECK(xs[i] << " beside " << other);
      }
}

TEST_CASE("derivatives of every function agree with differences", "[elementary][dual]") {
  using D = Dual<double, 2>;
  using D2 = Dual<D, 2>;
  const auto agree = [](const char* name, const std::function<D2(const D2&, const D2&)>& f, double x, double y) {
    INFO(name << " at " << x << ", " << y);
    const auto at = [&](double u, double v) { return f(D2(u), D2(v)).v.v; };
    const auto slope = [&](double u, double v) { // first derivatives, checked themselves below
      D2 a(u), b(v);
      a.v = D::variable(u, 0), b.v = D::variable(v, 1);
      const D2 r = f(a, b);
      return std::pair(r.v.d[0], r.v.d[1]);
    };
    D2 a(x), b(y);
    a.v = D::variable(x, 0), b.v = D::variable(y, 1);
    a.d[0] = D(1.0), b.d[1] = D(1.0);
    const D2 r = f(a, b);
    // Central differences: h^2 times the third derivative (order 10 here) plus 1e-16/h.
    const double h = 1e-5;
    CHECK(r.v.d[0] == Approx((at(x + h, y) - at(x - h, y)) / (2 * h)).epsilon(1e-7).margin(1e-8));
    CHECK(r.v.d[1] == Approx((at(x, y + h) - at(x, y - h)) / (2 * h)).epsilon(1e-7).margin(1e-8));
    CHECK(r.d[0].d[0] == Approx((slope(x + h, y).first - slope(x - h, y).first) / (2 * h)).epsilon(1e-7).margin(1e-8));
    CHECK(r.d[0].d[1] == Approx((slope(x, y + h).first - slope(x, y - h).first) / (2 * h)).epsilon(1e-7).margin(1e-8));
    CHECK(r.d[1].d[1] ==
          Approx((slope(x, y + h).second - slope(x, y - h).second) / (2 * h)).epsilon(1e-7).margin(1e-8));
  };
#define ONE(name)                                                                                                      \
  agree(                                                                                                               \
      #name, [](const D2& x, const D2&) { return el::name(x); }, 0.37, 0.0)
  ONE(sin);
  ONE(cos);
  ONE(tan);
  ONE(asin);
  ONE(acos);
  ONE(atan);
  ONE(sinh);
  ONE(cosh);
  ONE(tanh);
  ONE(exp);
  ONE(log);
  ONE(log10);
  ONE(sqrt);
  ONE(abs);
#undef ONE
  agree(
      "abs", [](const D2& x, const D2&) { return el::abs(x); }, -0.37, 0.0);
#define TWO(name)                                                                                                      \
  agree(                                                                                                               \
      #name, [](const D2& x, const D2& y) { return el::name(x, y); }, 0.83, 1.7)
  TWO(atan2);
  TWO(pow);
  TWO(hypot);
  TWO(min);
  TWO(max);
#undef TWO
}
