/// Formulas of a scenario: what is refused and where, dimensions, values, derivatives, equal bits.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>

#include "asked.h"
#include "kernel_variants.h"
#include "models/expression/expression.h"
#include "propagation/experiment.h"
#include "unit/scenario_fixture.h"

GUMSHOE_VARIANTS(gumshoe::models::Kernels, expression)
GUMSHOE_VARIANTS(gumshoe::models::KeepingKernels, expression_keeping)

using namespace gumshoe;
using namespace gumshoe::models;
using scenario_fixture::complaint;
using scenario_fixture::read_text;

namespace {

const std::string start = "schema = 1\n[model]\nname = \"expression\"\n";
const std::string inputs = "[quantities]\nL = { value = \"10 mm\", u = \"1 um\" }\nphi = { value = \"30 deg\", u = "
                           "\"1 deg\" }\nt = { value = \"2 s\", u = \"0.1 s\" }\nn = { value = 3, u = 0.1 }\n";

/// The complaint about one measurand y on line 5 of s.toml.
std::string about(const std::string& formula) {
  return complaint(start + "[model.measurands]\ny = \"" + formula + "\"\n" + inputs);
}
bool fine(const std::string& formula) { return about(formula).empty(); }

/// The formula's text begins in column 6.
std::string at(int column, const std::string& rest) {
  return "s.toml:5:" + std::to_string(column) + ": error: model.measurands.y: " + rest;
}

MadeModel model_of(const std::vector<std::string>& names, const std::vector<std::string>& formulas) {
  formula::Statement s;
  for (const auto& name : names) s.quantities.push_back({name, "1", "1", ""});
  for (const auto& text : formulas) {
    formula::Stated f;
    f.formula.name = "y" + std::to_string(s.measurands.size());
    f.formula.text = text;
    s.measurands.push_back(f);
  }
  std::vector<std::string> notes;
  return expression::make(std::move(s), notes);
}

double value_of(const std::string& formula, const std::vector<double>& x) {
  const auto model = model_of({"a", "b", "c"}, {formula});
  const std::vector<Gradient> q(x.begin(), x.end());
  std::vector<Gradient> y;
  propagation::ForwardModel(*model).measurands(0, q, y);
  return y[0].v;
}

} // namespace

TEST_CASE("formulas mean what mathematics means", "[expression]") {
  const std::vector<double> x{1.7, -0.6, 2.5};
  const double a = x[0], b = x[1], c = x[2];
  const auto is = [&](const std::string& formula, double value) {
    INFO(formula);
    CHECK(value_of(formula, x) == Approx(value).epsilon(1e-14));
  };
  is("a - b - c", (a - b) - c);
  is("a / b / c", (a / b) / c);
  is("a - (b - c)", a - (b - c));
  is("a + b * c", a + b * c);
  is("-a^2", -(a * a));
  is("2^3^2", 512);
  is("2^-2", 0.25);
  is("a^-3", 1 / (a * a * a));
  is("-a * -b", a * b);
  is("a * (b + c) / 2e0", a * (b + c) / 2);
  is(".5e1*a", 5 * a);
  is("pow(a, c)", std::pow(a, c));
  is("a^0.5 - sqrt(a)", 0);
  is("ln(a) - log(a) + log10(1000)", 3);
  is("atan2(a, b)", std::atan2(a, b));
  is("hypot(a, min(b, c)) + max(a, c)", std::hypot(a, b) + c);
  is("sin(pi / 6) + log(e)", 1.5);
  is("tanh(a) * cosh(a) - sinh(a)", 0);
  is("acos(cos(a)) + asin(sin(b)) + atan(tan(b))", a + 2 * b);
  is("(-2)^3 + (-2)^2", -4);
  is("exp(abs(b)) + tan(b)", std::exp(0.6) + std::tan(b));
}

TEST_CASE("a mistake in a formula is shown at its character", "[expression]") {
  CHECK(about("L * (phi + ") == at(17, "a number, a name or '(' is expected, not the end of the formula."));
  CHECK(about("L * (phi + 1").starts_with(at(10, "this '(' is never closed")));
  CHECK(about("L * phi)").starts_with(at(13, "this ')' has no matching '('")));
  CHECK(about("LL * phi") == at(6, "'LL' is not a quantity, condition, indication or intermediate. Did you mean 'L'?"));
  CHECK(about("n + snn(phi)") == at(10, "'snn' is not a function. Did you mean 'sin'?"));
  CHECK(about("n + atan2(phi)") == at(10, "atan2 takes 2 arguments, not 1."));
  CHECK(about("n + sin()") == at(10, "sin takes 1 argument, not 0."));
  CHECK(about("").starts_with(at(6, "the formula is empty")));
  CHECK(about("5 mm").starts_with(at(8, "an operator is missing before 'mm'")));
  CHECK(about("n × 2").starts_with(at(8, "'×' is not allowed in a formula. Use *.")));
  CHECK(about("n ** 2").starts_with(at(8, "'**' is not allowed in a formula. Use ^.")));
  CHECK(about("n × n ?").find("5:8:") != std::string::npos);
  CHECK(about("n + * 2").starts_with(at(10, "a number, a name or '(' is expected, not '*'")));
  CHECK(about("1e999 * n").starts_with(at(6, "this is not a number")));
  CHECK(about("n, 2").starts_with(at(7, "',' is allowed only in a function's arguments")));
}

TEST_CASE("a formula may be long but not deep", "[expression]") {
  CHECK(about(std::string(100000, '(') + "n").find("nested too deeply") != std::string::npos);
  CHECK(about(std::string(100000, '-') + "n").find("nested too deeply") != std::string::npos);
  std::string power = "n";
  for (int i = 0; i < 100000; ++i) power += "^n";
  CHECK(about(power).find("nested too deeply") != std::string::npos);
  std::string sum = "n";
  for (int i = 0; i < 100000; ++i) sum += "+n";
  CHECK(fine(sum));
}

TEST_CASE("names mean one thing and formulas do not go round in a circle", "[expression]") {
  const std::string circle = start +
                             "[model.intermediates]\nu = \"v + n\"\nv = \"w * 2\"\nw = \"u\"\n[model.measurands]\ny "
                             "= \"u\"\n" +
                             inputs;
  CHECK(complaint(circle).starts_with(
      "s.toml:7:6: error: model.intermediates.w: 'u' depends on itself (u -> v -> w -> u)"));
  const std::string twice = start + "[model.intermediates]\nn = \"t\"\n[model.measurands]\ny = \"n\"\n" + inputs;
  CHECK(complaint(twice).starts_with("s.toml:5:6: error: model.intermediates.n: 'n' is already a quantity"));
  // In any order, and a chain longer than the program's stack would hold.
  std::string chain = start + "[model.measurands]\ny = \"i0\"\n[model.intermediates]\n";
  for (int i = 0; i < 20000; ++i) chain += "i" + std::to_string(i) + " = \"i" + std::to_string(i + 1) + " + 1\"\n";
  CHECK(complaint(chain + "i20000 = \"n\"\n" + inputs).empty());
}

TEST_CASE("dimensions must fit, and are named where they do not", "[expression][dimensions]") {
  CHECK(about("L + phi") == at(8, "a length plus an angle (the terms of a sum must have the same dimension)."));
  CHECK(about("n * (L - t)") == at(13, "a length minus a time (the terms of a sum must have the same dimension)."));
  CHECK(about("exp(L / t)") ==
        at(10, "exp of a speed (it takes a plain number). Divide it by another quantity of its kind."));
  CHECK(about("sin(L)").starts_with(at(10, "sin of a length (it takes an angle or a plain number)")));
  CHECK(about("n^L").starts_with(at(8, "the exponent is a length")));
  CHECK(about("L^n").starts_with(at(8, "the exponent of a length varies")));
  CHECK(about("max(L, t)").starts_with(at(6, "max of a length and a time")));
  CHECK(about("phi + 1").starts_with(at(12, "a bare number is combined with an angle (1 deg or 1 rad?)")));
  CHECK(about("2 * 3 - phi").starts_with(at(6, "a bare number is combined with an angle")));
  CHECK(about("sqrt(L)").starts_with(at(6, "the measurand is a quantity in m^0.5")));
  for (const char* good :
       {"L + L * phi", "phi + pi / 2", "phi + 0", "max(L, 0)", "sin(phi) + n", "L^2 / L", "sqrt(L * L) + L",
        "L^(1/3) * L^(2/3) + L", "phi + atan2(L, 2 * L)", "exp(phi) + log(n)", "phi + L / (3 * L)", "phi / t * t + phi",
        "L * phi^2 + L", "n^n", "2^n", "hypot(L, 2 * L) - abs(L)"})
    if (const std::string said = about(good); !said.empty()) FAIL_CHECK(good << ": " << said);
}

TEST_CASE("a measurand's unit is stated, or that of its first operand, or the SI's", "[expression][dimensions]") {
  const auto s = read_text(start +
                           "[model.measurands]\nd = \"b - L\"\nv = \"L / t\"\na = \"phi + atan(n)\"\n"
                           "s = { formula = \"L * sin(phi)\", unit = \"um\" }\nR = \"U / I\"\nw = \"phi / t\"\n"
                           "arc = \"phi * L\"\nwarm = \"T - T0\"\n" +
                           inputs + "b = \"1 m\"\nU = \"1 V\"\nI = \"2 mA\"\nT = \"21 degC\"\nT0 = \"20 degC\"\n");
  const char* units[] = {"m", "m/s", "deg", "um", "ohm", "rad/s", "mm", "K"};
  REQUIRE(s.made->card->measurands.size() == std::size(units));
  for (std::size_t i = 0; i < std::size(units); ++i) CHECK(s.made->card->measurands[i].unit == units[i]);
  CHECK(complaint(start + "[model.measurands]\ny = { formula = \"L / t\", unit = \"mm\" }\n" + inputs) ==
        "s.toml:5:33: error: model.measurands.y.unit: 'mm' is not a speed (the formula gives this). Use m/s.");
  // A turn is 2 pi: an angular speed is no frequency.
  CHECK_FALSE(complaint(start + "[model.measurands]\ny = { formula = \"phi / t\", unit = \"Hz\" }\n" + inputs).empty());
}

TEST_CASE("derivatives are exact", "[expression][dual]") {
  // y0 = a^3 sin(b) / c: all first and second derivatives in closed form.
  const auto model = model_of({"a", "b", "c"}, {"a^3 * sin(b) / c", "abs(a - 1.3) + sqrt(b)"});
  const double a = 1.3, b = 0.4, c = 2.2;
  std::vector<Curvature> q{Curvature(a), Curvature(b), Curvature(c)};
  for (int i = 0; i < 3; ++i) {
    auto& x = q[static_cast<std::size_t>(i)];
    x.v = Gradient::variable(x.v.v, i);
    x.d[static_cast<std::size_t>(i)] = Gradient(1.0);
  }
  std::vector<Curvature> y;
  const auto outcome = propagation::ForwardModel(*model).measurands(0, q, y);
  CHECK(outcome.status == 0);
  CHECK(outcome.kink); // abs at 0
  const double s = std::sin(b), k = std::cos(b);
  CHECK(y[0].v.v == Approx(a * a * a * s / c).epsilon(1e-15));
  CHECK(y[0].v.d[0] == Approx(3 * a * a * s / c).epsilon(1e-14));
  CHECK(y[0].v.d[1] == Approx(a * a * a * k / c).epsilon(1e-14));
  CHECK(y[0].v.d[2] == Approx(-a * a * a * s / (c * c)).epsilon(1e-14));
  CHECK(y[0].d[0].d[0] == Approx(6 * a * s / c).epsilon(1e-13));
  CHECK(y[0].d[0].d[1] == Approx(3 * a * a * k / c).epsilon(1e-13));
  CHECK(y[0].d[1].d[2] == Approx(-a * a * a * k / (c * c)).epsilon(1e-13));
  CHECK(y[0].d[2].d[2] == Approx(2 * a * a * a * s / (c * c * c)).epsilon(1e-13));
}

TEST_CASE("every instruction set gives the same bits, equal to those of a point", "[expression]") {
  const std::vector<std::string> formulas{"a * b + c",
                                          "sin(a) * cos(1e3 * b) + tan(c)",
                                          "asin(sin(a)) + acos(cos(b)) + atan(c) + atan2(a, b)",
                                          "exp(a) + log(abs(b)) + log10(abs(c))",
                                          "sinh(a) - cosh(b) * tanh(c)",
                                          "abs(a)^b + a^7 - abs(c)^0.3",
                                          "hypot(a, b) / min(b, c) - max(a, c)",
                                          "sqrt(a - 0.5) + 1 / (b - b)",
                                          "sqrt(a) * log(b)",
                                          "k * sin(k) + a",
                                          "k^0.3",
                                          "c",
                                          "1"};
  const auto model = model_of({"a", "b", "c", "k"}, formulas);
  const std::size_t n = 600, m = formulas.size(); // not a multiple of a chunk
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> wide(-4, 4);
  std::vector<std::vector<double>> x(3, std::vector<double>(n));
  for (auto& column : x)
    for (double& v : column) v = wide(engine);
  const double k = 1.234;
  x.push_back({k});
  const propagation::ForwardModel forward(*model);
  const auto block = tests::block_of(forward, n, x);
  const auto run = [&](const Kernels& kernels, std::vector<std::uint8_t>& status) {
    std::vector<double> out(m * n);
    std::vector<double*> rows;
    for (std::size_t i = 0; i < m; ++i) rows.push_back(&out[i * n]);
    status.assign(n, 0);
    kernels.evaluate(forward.call(block, nullptr, rows.data(), status.data()));
    return out;
  };
  std::vector<std::uint8_t> status, other_status;
  const auto plain = run(*expression_variants()[0].kernels, status);
  const auto same = [](double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
  };
  for (std::size_t i = 0; i < n; ++i) CHECK(status[i] == code(Status::not_finite)); // 1 / (b - b)
  for (const auto& [set, kernels] : expression_variants()) {
    INFO(name(set));
    const auto other = run(*kernels, other_status);
    CHECK(other_status == status);
    for (std::size_t i = 0; i < m * n; ++i)
      if (!same(plain[i], other[i])) FAIL_CHECK(formulas[i / n] << ": " << plain[i] << " and " << other[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Gradient> y;
    forward.measurands(0, {x[0][i], x[1][i], x[2][i], k}, y);
    for (std::size_t j = 0; j < m; ++j)
      if (!same(y[j].v, plain[j * n + i]))
        FAIL_CHECK(formulas[j] << " at a point: " << y[j].v << " and " << plain[j * n + i]);
  }
}

TEST_CASE("an evaluation that goes on from kept values has the bits of a whole one", "[expression]") {
  // Every kind of step: shared by outputs, an output itself, uniform, of an unchanged and of a changed column, a kink.
  const std::vector<std::string> formulas{"a * b + sin(c)", "a * b",      "sin(c) / (b - b)", "k * sin(k)", "c",
                                          "exp(a) + k",     "log(b) * a", "sqrt(c) + k^0.3",  "1"};
  const auto model = model_of({"a", "b", "c", "k"}, formulas);
  const std::size_t m = formulas.size();
  const propagation::ForwardModel forward(*model);
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> wide(-4, 4);
  const auto drawn = [&](std::size_t n) {
    std::vector<double> column(n);
    for (double& v : column) v = wide(engine);
    return column;
  };
  const auto bits = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  };
  for (const std::size_t n : {std::size_t{8}, std::size_t{600}, std::size_t{60'000}}) // kept, or too many to be kept
    for (const auto& [set, keeping] : expression_keeping_variants()) {
      INFO(n << " samples, " << name(set));
      std::vector<std::vector<double>> x{drawn(n), drawn(n), drawn(n), {1.234}};
      auto block = tests::block_of(forward, n, x);
      std::vector<double> rows(m * n), whole(m * n);
      std::vector<std::uint8_t> status, whole_status;
      std::vector<double*> to;
      const auto call = [&](std::vector<double>& out, std::vector<std::uint8_t>& s) {
        to.clear();
        for (std::size_t i = 0; i < m; ++i) to.push_back(&out[i * n]);
        s.assign(n, 0);
        return forward.call(block, nullptr, to.data(), s.data());
      };
      Kept kept;
      keeping->keep(call(rows, status), kept);
      model->kernels()->evaluate(call(whole, whole_status));
      CHECK((kept.samples == n) == (n < 60'000));
      CHECK(bits(rows, whole));
      CHECK(status == whole_status);
      for (const auto& changed : std::vector<std::vector<std::size_t>>{{}, {0}, {1}, {2}, {3}, {0, 2}, {0, 1, 2, 3}}) {
        const auto before = block.quantities;
        std::vector<std::vector<double>> other;
        other.reserve(changed.size());
        for (const std::size_t q : changed) {
          other.push_back(drawn(x[q].size()));
          block.quantities[q].data = other.back().data();
        }
        keeping->go_on(call(rows, status), kept);
        model->kernels()->evaluate(call(whole, whole_status));
        CHECK(bits(rows, whole));
        CHECK(status == whole_status);
        block.quantities = before;
      }
    }
}

TEST_CASE("a run of changed columns has the bits of a whole run", "[expression]") {
  const std::string given =
      "[quantities]\na = { value = 1, u = 0.1 }\nb = { value = 2, u = 0.1 }\nc = { value = 3, u = "
      "0.1 }\n";
  const std::string conditions = "[conditions]\nx = 0\n";
  for (const auto& text : {
           start + "[model.measurands]\ny = \"sin(a) * b + c\"\nz = \"b / c\"\n" + given,
           start + "[model.measurands]\ny = \"sin(a) * b + c * r + x * b\"\n" + conditions +
               "[indications.r]\nrows = [ { x = 1, values = [4] }, { x = 2, values = [5] } ]\nrepeatability = { s = "
               "0.1 "
               "}\n" +
               given,
           start +
               "method = \"virtual_experiment\"\n[model.measurands]\ny = \"r / a + b\"\n[model.indications]\nr = "
               "\"(c - b) * a\"\n[indications.r]\nrepeatability = { s = 0.1 }\n" +
               given,
       }) {
    INFO(text);
    const scenario::Scenario s = read_text(text);
    const propagation::Experiment e(s);
    const std::size_t n = 64, d = e.plan().variates.size(), rows = e.outputs().size();
    std::mt19937_64 engine(6);
    std::normal_distribution<double> normal(2, 0.3);
    std::vector<double> a(d * n), b(d * n);
    for (auto* values : {&a, &b})
      for (double& x : *values) x = normal(engine);
    std::vector<const double*> variates;
    for (std::size_t v = 0; v < d; ++v) variates.push_back(&a[v * n]);
    propagation::Workspace going_on, fresh;
    std::vector<double> kept(rows * n), y(rows * n), whole(rows * n);
    std::vector<std::uint8_t> status(n), whole_status(n);
    e.run_and_keep(variates, n, going_on, kept.data(), status.data());
    e.run(variates, n, fresh, whole.data(), whole_status.data());
    CHECK(kept == whole);
    for (std::size_t v = 0; v < d; ++v) {
      std::vector<std::size_t> changed;
      for (std::size_t c = 0; c < e.plan().columns.size(); ++c)
        if (std::ranges::count(e.plan().columns[c].variates, v)) changed.push_back(c);
      variates[v] = &b[v * n];
      e.run_changed(variates, changed, n, going_on, y.data(), status.data());
      e.run(variates, n, fresh, whole.data(), whole_status.data());
      CHECK(y == whole);
      CHECK(status == whole_status);
      variates[v] = &a[v * n];
    }
  }
}

TEST_CASE("a sample without a finite value is marked, the others are not", "[expression]") {
  const auto model = model_of({"a"}, {"log(a)"});
  const std::vector<std::vector<double>> a{{1, 0, -1, 2, 3, 4, 5, HUGE_VAL}};
  const propagation::ForwardModel forward(*model);
  CHECK(forward.evaluate(tests::block_of(forward, 8, a)).status ==
        std::vector<std::uint8_t>{0, code(Status::not_finite), code(Status::not_finite), 0, 0, 0, 0,
                                  code(Status::not_finite)});
}

TEST_CASE("readouts simulated from conditions, with exact derivatives, and no measurand", "[expression]") {
  const auto s = read_text(start + "[model.indications]\ny = \"b1 * (1 - exp(-b2 * x))\"\n[conditions]\nx = 2\n"
                                   "[quantities]\nb1 = 240\nb2 = 5e-4\n[indications.y]\nreadings = [10.07]\n");
  REQUIRE(s.made->simulate_gradient);
  CHECK(s.made->card->measurands.empty());
  const double x = 2, b1 = 240, b2 = 5e-4;
  const propagation::ForwardModel forward(*s.made, {}, 0, {{x}});
  std::vector<Gradient> found;
  CHECK(forward.indications(0, {Gradient::variable(b1, 0), Gradient::variable(b2, 1), Gradient(0.0)}, found).status ==
        0);
  const Gradient& y = found[0];
  CHECK(y.v == Approx(b1 * -std::expm1(-b2 * x)).epsilon(1e-12)); // 1 - exp cancels three digits
  CHECK(y.d[0] == Approx(-std::expm1(-b2 * x)).epsilon(1e-12));
  CHECK(y.d[1] == Approx(b1 * x * std::exp(-b2 * x)).epsilon(1e-14));
}
