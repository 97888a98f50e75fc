#pragma once
/// Test functions of sensitivity analysis as experiments: a function, the distributions of its inputs, and perhaps
/// their correlation.
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "models/made_card.h"
#include "models/model.h"
#include "propagation/experiment.h"

namespace gumshoe::sobol_models {

using quantities::Distribution;
using quantities::Family;

inline Distribution rectangular(double low, double high) { return {Family::rectangular, {low, high}, {}, {}}; }
inline Distribution normal(double u) { return {Family::normal, {0, u}, {}, {}}; }

/// F{}(x, y): measurands y from inputs x; a NaN is a failed sample.
template <class F> void evaluate(const models::BlockCall& c) {
  for (std::size_t r = 0; r < c.readings; ++r) {
    const models::Column* quantities = c.quantities + r * F::inputs;
    for (std::size_t i = 0; i < c.samples; ++i) {
      std::array<double, F::inputs> x;
      std::array<double, F::outputs> y;
      for (std::size_t q = 0; q < F::inputs; ++q) x[q] = quantities[q].data[i * quantities[q].stride];
      F{}(x, y);
      for (std::size_t m = 0; m < F::outputs; ++m) c.measurands[r * F::outputs + m][i] = y[m];
    }
  }
}

template <class F> const models::Kernels* kernels() {
  static const models::Kernels table{nullptr, evaluate<F>};
  return &table;
}

template <class F> models::MadeModel made() {
  struct Owner {
    explicit Owner(const models::CardTexts& texts) : card(texts) {}
    models::MadeCard card;
    models::Model model{};
  };
  models::CardTexts texts{"toy", "toy", "", "", {}, {}, {}, {}};
  for (std::size_t q = 0; q < F::inputs; ++q) texts.quantities.push_back({"x" + std::to_string(q + 1), "1", "1", ""});
  for (std::size_t m = 0; m < F::outputs; ++m) texts.measurands.push_back({"y" + std::to_string(m + 1), "1", "1", ""});
  const auto owner = std::make_shared<Owner>(texts);
  owner->model.card = &owner->card.card();
  owner->model.kernels = kernels<F>;
  owner->model.check = [](const models::PointCall<double>&) { return std::string(); };
  owner->model.solve_reads = [](std::size_t) { return true; };
  return {owner, &owner->model};
}

/// A scenario and its experiment, which refers to it.
struct Toy {
  scenario::Scenario scenario;
  std::unique_ptr<propagation::Experiment> experiment;
};

template <class F>
std::unique_ptr<Toy> experiment(const std::vector<Distribution>& inputs, std::uint64_t seed,
                                const std::vector<quantities::Correlation>& correlations = {},
                                bool second_order = false) {
  auto toy = std::make_unique<Toy>();
  auto& s = toy->scenario;
  s.made = made<F>();
  s.model = "toy";
  s.evaluation = "full";
  s.run.seed = seed;
  s.correlations = correlations;
  s.analysis.sensitivity.second_order = second_order;
  for (std::size_t q = 0; q < F::inputs; ++q)
    s.quantities.push_back({"x" + std::to_string(q + 1), "1", "1", {{{}, 0, {{"c", inputs[q], 'B', HUGE_VAL, {}, ""}}, ""}}});
  s.readings.push_back({{}, {}, {}, 1});
  toy->experiment = std::make_unique<propagation::Experiment>(s);
  return toy;
}

struct Ishigami {
  static constexpr std::size_t inputs = 3, outputs = 1;
  void operator()(const auto& x, auto& y) const {
    const double s = std::sin(x[1]);
    y[0] = std::sin(x[0]) * (1 + 0.1 * x[2] * x[2] * x[2] * x[2]) + 7 * s * s;
  }
  static std::vector<Distribution> distributions() {
    return std::vector(3, rectangular(-std::numbers::pi, std::numbers::pi));
  }
};

/// Sobol's g with a = 0, 1, 4.5, 9, 99, 99, 99, 99.
struct G {
  static constexpr std::size_t inputs = 8, outputs = 1;
  static constexpr std::array<double, 8> a{0, 1, 4.5, 9, 99, 99, 99, 99};
  void operator()(const auto& x, auto& y) const {
    y[0] = 1;
    for (std::size_t i = 0; i < 8; ++i) y[0] *= (std::fabs(4 * x[i] - 2) + a[i]) / (1 + a[i]);
  }
  static std::vector<Distribution> distributions() { return std::vector(8, rectangular(0, 1)); }
};

struct Product {
  static constexpr std::size_t inputs = 2, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = x[0] * x[1]; }
  static std::vector<Distribution> distributions() { return {normal(1), normal(2)}; }
};

/// A lognormal of sigma^2 = 1.49, kurtosis 600.
struct HeavyTails {
  static constexpr std::size_t inputs = 2, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = std::exp(x[0] + 0.7 * x[1]); }
  static std::vector<Distribution> distributions() { return {normal(1), normal(1)}; }
};

struct Borgonovo {
  static constexpr std::size_t inputs = 3, outputs = 1;
  void operator()(const auto& x, auto& y) const { y[0] = x[0] * x[1] + x[2]; }
  static std::vector<Distribution> distributions() { return std::vector(3, rectangular(0, 1)); }
};

/// x1 + x2 + x3 and, as a second output, x1 - x3.
struct Sum {
  static constexpr std::size_t inputs = 3, outputs = 2;
  void operator()(const auto& x, auto& y) const {
    y[0] = x[0] + x[1] + x[2];
    y[1] = x[0] - x[2];
  }
  static std::vector<Distribution> distributions() { return {normal(1), normal(1), normal(2)}; }
};

/// Seeds of the tests: fixed, or fresh ones and more of them under `scripts/check --long`.
struct Seeds {
  std::uint64_t first = 1;
  std::size_t repetitions;
  explicit Seeds(std::size_t quick, std::size_t thorough) : repetitions(quick) {
    if (const char* text = std::getenv("GUMSHOE_LONG_SEED"); text && *text) {
      first = std::strtoull(text, nullptr, 10) * 1'000'000 + 1;
      repetitions = thorough;
    }
  }
};

} // namespace gumshoe::sobol_models
