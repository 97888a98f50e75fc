#pragma once
/// Small compiled models with closed-form sensitivities, and scenarios of them.
#include <memory>
#include <vector>

#include "math/scalar.h"
#include "models/made_card.h"
#include "models/model.h"
#include "propagation/propagate.h"
#include "scenario/scenario.h"

namespace screening_models {

using namespace gumshoe;
inline constexpr double pi = 3.14159265358979323846;

struct Ishigami {
  static constexpr std::size_t inputs = 3;
  template <class T> static T of(const T* x) {
    const T s = num::sin(x[1]), q = x[2] * x[2];
    return num::sin(x[0]) + 7.0 * s * s + 0.1 * q * q * num::sin(x[0]);
  }
};
struct GFunction { // a = 0, 9, 99
  static constexpr std::size_t inputs = 3;
  template <class T> static T of(const T* x) {
    const double a[] = {0, 9, 99};
    T y(1.0);
    for (int i = 0; i < 3; ++i) y = y * (num::abs(4.0 * x[i] - 2.0) + a[i]) / (1 + a[i]);
    return y;
  }
};
struct ProductAndSum { // x1 x2 + x3
  static constexpr std::size_t inputs = 3;
  template <class T> static T of(const T* x) { return x[0] * x[1] + x[2]; }
};
struct Linear { // 2 x1 - 3 x2 + 0 x3
  static constexpr std::size_t inputs = 3;
  template <class T> static T of(const T* x) { return 2.0 * x[0] - 3.0 * x[1] + 0.0 * x[2]; }
};

/// A model of one reading, no indications, one measurand "y".
template <class F> models::MadeModel make() {
  struct Own {
    std::unique_ptr<models::MadeCard> card;
    models::Model model;
  };
  models::CardTexts texts;
  texts.name = "toy";
  for (std::size_t i = 0; i < F::inputs; ++i)
    texts.quantities.push_back({"x" + std::to_string(i + 1), "1", "1", "", 0, {-1e300, 1e300}});
  texts.measurands.push_back({"y", "1", "1", "", 0, {-1e300, 1e300}});
  auto own = std::make_shared<Own>();
  own->card = std::make_unique<models::MadeCard>(texts);
  static const models::Kernels kernels{nullptr, [](const models::BlockCall& call) {
                                         for (std::size_t i = 0; i < call.samples; ++i) {
                                           double x[F::inputs];
                                           for (std::size_t q = 0; q < F::inputs; ++q)
                                             x[q] = call.quantities[q].data[i * call.quantities[q].stride];
                                           call.measurands[0][i] = F::of(x);
                                         }
                                       }};
  own->model.card = &own->card->card();
  own->model.kernels = [] { return &kernels; };
  own->model.evaluate_gradient = [](const models::PointCall<models::Gradient>& c) {
    c.measurands[0] = F::of(c.quantities);
    return models::PointOutcome{};
  };
  own->model.evaluate_curvature = [](const models::PointCall<models::Curvature>& c) {
    c.measurands[0] = F::of(c.quantities);
    return models::PointOutcome{};
  };
  own->model.simulate_gradient = nullptr;
  own->model.explain = [](const models::PointCall<double>&) { return std::vector<models::Intermediate>{}; };
  own->model.check = [](const models::PointCall<double>&) { return std::string{}; };
  own->model.solve_reads = [](std::size_t) { return true; };
  return {own, &own->model};
}

template <class F> scenario::Scenario scenario_of(const std::vector<quantities::Distribution>& inputs) {
  scenario::Scenario s;
  s.made = make<F>();
  s.model = "toy";
  s.evaluation = "full";
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    quantities::Component c;
    c.name = "c1";
    c.distribution = inputs[i];
    s.quantities.push_back({"x" + std::to_string(i + 1), "1", "1", {{{}, 0.0, {c}, ""}}});
  }
  s.readings.push_back({{}, {}, {}, 1});
  s.run.samples = 65'536;
  return s;
}

inline quantities::Distribution uniform(double low, double high) {
  return {quantities::Family::rectangular, {low, high}, nullptr, nullptr};
}
inline quantities::Distribution normal(double u) { return {quantities::Family::normal, {0, u}, nullptr, nullptr}; }

struct Memory : propagation::Sink {
  std::vector<double> values;
  void write(const propagation::ResultBlock& b) override {
    values.insert(values.end(), b.outputs.begin(), b.outputs.end());
  }
};
inline std::vector<double> run(const propagation::Experiment& e) {
  Memory memory;
  propagation::propagate(e, memory, {});
  return memory.values;
}

} // namespace screening_models
