#include "models/expression/expression.h"

#include <cmath>

#include <fmt/format.h>

#include "base/kernel_choice.h"
#include "base/units.h"
#include "formula/finite.h"
#include "formula/interpreter.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::models::Kernels, expression)
GUMSHOE_DECLARE_KERNELS(gumshoe::models::Kernels, expression_evaluating)
GUMSHOE_DECLARE_KERNELS(gumshoe::models::KeepingKernels, expression_keeping)

namespace gumshoe::models::expression {

namespace {

const Expression& of(const void* context) { return *static_cast<const Expression*>(context); }

template <class T> formula::Inputs<T> inputs(const PointCall<T>& call) {
  return {call.quantities, call.conditions, call.indications};
}

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const formula::Program& program = of(call.context).formulas.evaluate;
  const auto values = formula::interpret<T>(program, inputs(call));
  PointOutcome outcome{0, values.kink};
  for (std::size_t m = 0; m < program.outputs.size(); ++m) {
    call.measurands[m] = values.steps[program.outputs[m]];
    if (!std::isfinite(num::value(call.measurands[m]))) outcome.status = code(Status::not_finite);
  }
  return outcome;
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  const Expression& expression = of(call.context);
  const auto values = formula::interpret<T>(expression.formulas.simulate, inputs(call));
  PointOutcome outcome{0, values.kink};
  for (std::size_t k = 0; k < expression.model.card->indications.size(); ++k) {
    call.simulated[k] = values.steps[expression.formulas.simulate.outputs[k]];
    if (!std::isfinite(num::value(call.simulated[k]))) outcome.status = code(Status::not_finite);
  }
  return outcome;
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const Expression& expression = of(call.context);
  const auto values = formula::interpret<double>(expression.formulas.explain, inputs(call));
  std::vector<Intermediate> out;
  for (std::size_t i = 0; i < expression.formulas.explained.size(); ++i) {
    const Symbol& s = expression.formulas.explained[i];
    out.push_back(
        {s.name, s.unit, units::from_si(values.steps[expression.formulas.explain.outputs[i]], s.unit, s.si_unit)});
  }
  return out;
}

std::string check(const PointCall<double>& call) {
  const Expression& e = of(call.context);
  if (!e.virtual_experiment) formula::require_finite(e.formulas, e.formulas.evaluate, inputs(call));
  formula::require_finite(e.formulas, e.formulas.simulate, inputs(call));
  return {};
}

bool solve_reads(std::size_t) { return true; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(expression); }
const Kernels* evaluating_kernels() { return GUMSHOE_BEST_KERNELS(expression_evaluating); }

CardTexts texts_of(const formula::Compiled& c) {
  CardTexts texts;
  texts.name = "expression";
  texts.title = "Formulas of the scenario";
  texts.quantities = c.statement.quantities;
  texts.conditions = c.statement.conditions;
  texts.indications = c.statement.indications;
  for (std::size_t i = c.first_measurand(); i < c.first_simulated(); ++i) texts.measurands.push_back(c.explained[i]);
  for (const formula::Formula& f : c.formulas) {
    texts.equations.emplace_back(fmt::format("{} = {}", f.short_name(), f.text), "");
    texts.summary += fmt::format("{}{} = {}", texts.summary.empty() ? "" : "\n  ", f.short_name(), f.text);
  }
  return texts;
}

} // namespace

MadeModel make(formula::Statement statement, std::vector<std::string>& notes, bool virtual_experiment) {
  const auto e = std::make_shared<Expression>();
  e->formulas = formula::compile(std::move(statement), notes);
  e->virtual_experiment = virtual_experiment;
  e->card = std::make_unique<MadeCard>(texts_of(e->formulas));
  const bool simulates = e->formulas.simulates();
  Model& model = e->model;
  model.card = &e->card->card();
  model.kernels = simulates ? &kernels : &evaluating_kernels;
  model.evaluate_gradient = &evaluate_point<Gradient>;
  model.evaluate_curvature = &evaluate_point<Curvature>;
  model.simulate_gradient = simulates ? &simulate_point<Gradient> : nullptr;
  model.explain = &explain;
  model.check = &check;
  model.solve_reads = &solve_reads;
  model.context = e.get();
  return {e, &e->model};
}

const KeepingKernels* keeping_kernels(const Model& model) {
  const bool stated = model.kernels == &kernels || model.kernels == &evaluating_kernels;
  return stated ? GUMSHOE_BEST_KERNELS(expression_keeping) : nullptr;
}

} // namespace gumshoe::models::expression
