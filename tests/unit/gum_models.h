#pragma once
/// Measurement models for tests, written once as a template, and scenarios built around them by hand.
#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "analysis/analyse.h"
#include "analysis/gum.h"
#include "analysis/summary.h"
#include "math/scalar.h"
#include "models/made_card.h"
#include "propagation/propagate.h"

namespace gum_models {

using namespace gumshoe;
using quantities::Family;

/// `Physics` has names of inputs and outputs and `template <class T> static void f(const T* x, T* y)`.
template <class Physics> class Made {
public:
  Made() : card_(texts()), model_{} {
    model_.card = &card_.card();
    model_.kernels = &kernels;
    model_.evaluate_gradient = &point<models::Gradient>;
    model_.evaluate_curvature = &point<models::Curvature>;
    model_.explain = [](const models::PointCall<double>&) { return std::vector<models::Intermediate>{}; };
    model_.check = [](const models::PointCall<double>&) { return std::string(); };
    model_.solve_reads = [](std::size_t) { return true; };
  }
  const models::Model& model() const { return model_; }

private:
  static models::CardTexts texts() {
    models::CardTexts t;
    t.name = t.title = "test";
    for (const char* name : Physics::inputs) t.quantities.push_back({name, "1", "1", "", 0, {-1e300, 1e300}});
    const char* unit = Physics::unit;
    for (const char* name : Physics::outputs) t.measurands.push_back({name, unit, unit, "", 0, {-1e300, 1e300}});
    return t;
  }
  template <class T> static models::PointOutcome point(const models::PointCall<T>& c) {
    Physics::f(c.quantities, c.measurands);
    return {};
  }
  static void evaluate(const models::BlockCall& c) {
    constexpr std::size_t in = std::size(Physics::inputs), out = std::size(Physics::outputs);
    for (std::size_t r = 0; r < c.readings; ++r)
      for (std::size_t i = 0; i < c.samples; ++i) {
        double x[in], y[out];
        for (std::size_t q = 0; q < in; ++q) x[q] = c.quantities[r * in + q].data[i * c.quantities[r * in + q].stride];
        Physics::f(x, y);
        for (std::size_t m = 0; m < out; ++m) c.measurands[r * out + m][i] = y[m];
      }
  }
  static const models::Kernels* kernels() {
    static const models::Kernels k{nullptr, &evaluate};
    return &k;
  }
  models::MadeCard card_;
  models::Model model_;
};

/// Deviation of one component.
inline quantities::Component component(Family family, std::array<double, 4> p, double dof = HUGE_VAL) {
  quantities::Component c;
  c.name = "c1";
  c.distribution = {family, p, nullptr, nullptr};
  c.degrees_of_freedom = dof;
  c.evaluation = std::isfinite(dof) ? 'A' : 'B';
  return c;
}
inline quantities::Component normal(double u, double dof = HUGE_VAL) { return component(Family::normal, {0, u}, dof); }
inline quantities::Component rectangular(double half) { return component(Family::rectangular, {-half, half}); }
inline quantities::Component student(double scale, double dof) { return component(Family::t, {0, scale, dof}, dof); }

struct Input {
  double value = 0;
  std::vector<quantities::Component> components;
};

template <class Physics> scenario::Scenario scenario_of(const std::vector<Input>& inputs, std::uint64_t samples) {
  const auto made = std::make_shared<const Made<Physics>>();
  scenario::Scenario s;
  s.model = "test";
  s.evaluation = "full";
  s.made = models::MadeModel(made, &made->model());
  for (std::size_t i = 0; i < inputs.size(); ++i)
    s.quantities.push_back({Physics::inputs[i], "1", "1", {{{}, inputs[i].value, inputs[i].components, ""}}});
  s.readings.resize(1);
  s.run.samples = samples;
  return s;
}

/// Samples in memory.
struct Memory : propagation::Sink {
  std::vector<std::vector<double>> rows;
  std::vector<std::uint8_t> status;
  explicit Memory(std::size_t n) : rows(n) {}
  void write(const propagation::ResultBlock& b) override {
    for (std::size_t r = 0; r < rows.size(); ++r)
      rows[r].insert(rows[r].end(), &b.outputs[r * b.samples], &b.outputs[r * b.samples] + b.samples);
    status.insert(status.end(), b.status.begin(), b.status.end());
  }
};

inline analysis::Results analysed(const scenario::Scenario& s) {
  const propagation::Experiment e(s);
  Memory memory(e.outputs().size());
  propagation::propagate(e, memory, {});
  const auto status = [&](std::size_t first, std::span<std::uint8_t> out) {
    std::copy_n(memory.status.begin() + static_cast<std::ptrdiff_t>(first), out.size(), out.begin());
  };
  return analysis::analyse(
      e, {[&](std::size_t o) { return analysis::Column(memory.rows[o]); }, memory.status.size(), status}, 2);
}

/// 4 standard errors of u from M samples of that kurtosis, relative.
inline double four_se(double samples, double kurtosis = 3) { return 4 * std::sqrt((kurtosis - 1) / (4 * samples)); }

} // namespace gum_models
