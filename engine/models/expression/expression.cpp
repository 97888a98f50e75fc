#include "models/expression/expression.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/units.h"
#include "models/expression/dimensions.h"
#include "models/expression/interpreter.h"
#include "models/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(expression)
GUMSHOE_DECLARE_KERNELS(expression_evaluating)

namespace gumshoe::models::expression {

namespace {

const Expression& of(const void* context) { return *static_cast<const Expression*>(context); }

template <class T> Inputs<T> inputs(const PointCall<T>& call) {
  return {call.quantities, call.conditions, call.indications};
}

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const Program& program = of(call.context).evaluate;
  const auto values = interpret<T>(program, inputs(call));
  PointOutcome outcome{0, values.kink};
  for (std::size_t m = 0; m < program.outputs.size(); ++m) {
    call.measurands[m] = values.steps[program.outputs[m]];
    if (!std::isfinite(num::value(call.measurands[m]))) outcome.status = code(Status::not_finite);
  }
  return outcome;
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  const Expression& expression = of(call.context);
  const auto values = interpret<T>(expression.simulate, inputs(call));
  PointOutcome outcome{0, values.kink};
  for (std::size_t k = 0; k < expression.model.card->indications.size(); ++k) {
    call.simulated[k] = values.steps[expression.simulate.outputs[k]];
    if (!std::isfinite(num::value(call.simulated[k]))) outcome.status = code(Status::not_finite);
  }
  return outcome;
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const Expression& expression = of(call.context);
  const auto values = interpret<double>(expression.explain, inputs(call));
  std::vector<Intermediate> out;
  for (std::size_t i = 0; i < expression.explained.size(); ++i) {
    const Symbol& s = expression.explained[i];
    out.push_back({s.name, s.unit, units::from_si(values.steps[expression.explain.outputs[i]], s.unit, s.si_unit)});
  }
  return out;
}

std::string why_not_finite(Operation operation, double a, double b) {
  switch (operation) {
  case Operation::divide:
    return b == 0 ? "division by zero" : "the quotient is too large for a number";
  case Operation::log:
  case Operation::log10:
    return a == 0 ? "the logarithm of zero" : "the logarithm of a negative number";
  case Operation::sqrt:
    return "the square root of a negative number";
  case Operation::asin:
  case Operation::acos:
    return fmt::format("{} of {:.6g}, which is outside [-1, 1]", word(operation), a);
  case Operation::power:
    return a == 0  ? "a negative power of zero"
           : a < 0 ? "a broken power of a negative number"
                   : "the power is too large for a number";
  default:
    return fmt::format("the result of '{}' is too large for a number", word(operation));
  }
}

/// The first step without a finite value, as a problem at its operator; what its operands are made of is said.
void require_finite(const Expression& e, const Program& program, const Inputs<double>& in) {
  const auto values = interpret<double>(program, in);
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const Step& s = program.steps[i];
    if (s.source != Source::step || std::isfinite(values.steps[i])) continue;
    const Formula& f = e.formulas[s.origin.formula];
    // The names within the operator's second operand (or its only one).
    const Node& at = f.nodes[s.origin.node];
    std::string named;
    std::vector<std::size_t> open{at.operation == Operation::divide ? at.b : s.origin.node};
    std::set<std::string> seen;
    while (!open.empty() && seen.size() < 4) {
      const Node& n = f.nodes[open.back()];
      open.pop_back();
      if (n.operation == Operation::name && seen.insert(n.name).second)
        for (std::size_t c = 0; c < e.statement.quantities.size(); ++c)
          if (const Symbol& q = e.statement.quantities[c]; q.name == n.name)
            named +=
                fmt::format("{}{} = {:.6g}{}", named.empty() ? "" : ", ", q.name,
                            units::from_si(in.quantities[c], q.unit, q.si_unit), q.unit == "1" ? "" : " " + q.unit);
      if (is_leaf(n.operation)) continue;
      if (is_binary(n.operation)) open.push_back(n.b);
      open.push_back(n.a);
    }
    const double a = values.steps[s.a], b = values.steps[s.b];
    throw InputError({f.problem(at.at, why_not_finite(s.operation, a, b) + " at the estimates", named)});
  }
}

std::string check(const PointCall<double>& call) {
  const Expression& e = of(call.context);
  if (!e.statement.virtual_experiment) require_finite(e, e.evaluate, inputs(call));
  require_finite(e, e.simulate, inputs(call));
  return {};
}

bool solve_reads(std::size_t) { return true; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(expression); }
const Kernels* evaluating_kernels() { return GUMSHOE_BEST_KERNELS(expression_evaluating); }

class Maker {
public:
  Maker(Statement statement, std::vector<std::string>& notes) : e_(std::make_shared<Expression>()), notes_(notes) {
    e_->statement = std::move(statement);
    for (const auto* list : {&e_->statement.intermediates, &e_->statement.measurands, &e_->statement.simulated})
      for (const Stated& s : *list) e_->formulas.push_back(s.formula);
    first_measurand_ = e_->statement.intermediates.size();
    first_simulated_ = first_measurand_ + e_->statement.measurands.size();
  }

  MadeModel make() {
    for (Formula& f : e_->formulas) {
      try {
        parse(f);
      } catch (const InputError& error) {
        problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
        f.nodes.clear();
      }
    }
    const Names names(e_->statement, e_->formulas, problems_);
    for (const Formula& f : e_->formulas) names.check(f, problems_);
    raise();
    names.order(range(0, e_->formulas.size()), false, problems_);
    raise();
    // An indication without readouts has the unit that its formula gives.
    const bool unread = std::ranges::any_of(e_->statement.indications, [](const Symbol& s) { return s.unit.empty(); });
    const auto all = names.order(range(0, e_->formulas.size()), unread, problems_);
    raise();
    settle_units(kinds_of(e_->formulas, all, names, unread, problems_));
    raise();
    note_unused(names);
    compile(names);
    raise();
    finish_card();
    return {e_, &e_->model};
  }

private:
  void raise() const {
    if (!problems_.empty()) throw InputError(problems_);
  }
  static std::vector<std::size_t> range(std::size_t first, std::size_t last) {
    std::vector<std::size_t> out;
    for (std::size_t i = first; i < last; ++i) out.push_back(i);
    return out;
  }

  void note_unused(const Names& names) {
    std::set<const Symbol*> used;
    std::set<std::size_t> formulas;
    for (const Formula& f : e_->formulas)
      for (const Node& n : f.nodes)
        if (const Meaning* m = n.operation == Operation::name ? names.find(n.name, false) : nullptr) {
          if (m->symbol)
            used.insert(m->symbol);
          else
            formulas.insert(m->index);
        }
    for (const Symbol& q : e_->statement.quantities)
      if (!used.contains(&q)) notes_.push_back(fmt::format("quantities.{}: no formula uses it", q.name));
    for (std::size_t i = 0; i < first_measurand_; ++i)
      if (!formulas.contains(i)) notes_.push_back(fmt::format("{}: no formula uses it", e_->formulas[i].name));
  }

  /// Units in which results are shown; stated ones must fit.
  void settle_units(const std::vector<Kind>& kinds) {
    if (!problems_.empty()) return;
    for (std::size_t i = 0; i < e_->formulas.size(); ++i) {
      const Formula& f = e_->formulas[i];
      const std::string name = f.name.substr(f.name.rfind('.') + 1);
      const Dimension& is = kinds[i].dimension;
      if (i >= first_simulated_) {
        simulated_fits(f, name, is, kinds[i].unit);
        continue;
      }
      Symbol s{name, kinds[i].unit, "", f.text};
      if (i >= first_measurand_) {
        const Stated& stated = e_->statement.measurands[i - first_measurand_];
        for (const Symbol& q : e_->statement.quantities)
          if (q.name == name && !Dimension::of(q.unit).like(is))
            problems_.push_back(f.problem(
                0, fmt::format("the formula gives {}", is.words()),
                fmt::format("the quantity of this name, the true value, is {}", Dimension::of(q.unit).words())));
        if (!stated.unit.empty()) {
          s.unit = stated.unit;
          if (!fits(stated, is)) continue;
        } else if (!is.has_unit()) {
          problems_.push_back(
              f.problem(0, fmt::format("the measurand is {}", is.words()), "no unit has broken exponents"));
          continue;
        }
      }
      if (s.unit.empty()) s.unit = is.has_unit() ? is.si_unit() : "1"; // of an intermediate: its SI value
      s.si_unit = units::si_unit_of(s.unit);
      e_->explained.push_back(s);
    }
  }

  bool fits(const Stated& stated, const Dimension& is) {
    try {
      const Dimension wanted = Dimension::of(stated.unit);
      // rad/s is no frequency: a turn is 2 pi.
      if (wanted.like(is) && (wanted.has_angle() || !is.has_angle() || is.is_angle())) return true;
      problems_.push_back({stated.unit_place,
                           fmt::format("{}.unit: '{}' is not {}", stated.formula.name, stated.unit, is.words()),
                           "what the formula gives", is.has_unit() ? fmt::format("{}?", is.si_unit()) : ""});
    } catch (const InputError& error) {
      for (Problem p : error.problems()) {
        p.where = stated.unit_place;
        p.what = fmt::format("{}.unit: {}", stated.formula.name, p.what);
        problems_.push_back(std::move(p));
      }
    }
    return false;
  }

  /// An indication's formula must give what its readouts are.
  void simulated_fits(const Formula& f, const std::string& name, const Dimension& is, const std::string& unit) {
    for (Symbol& s : e_->statement.indications) {
      if (s.name != name) continue;
      if (s.unit.empty()) { // no readouts that would tell
        s.unit = !unit.empty() ? unit : is.has_unit() ? is.si_unit() : "1";
        s.si_unit = units::si_unit_of(s.unit);
        continue;
      }
      const Dimension wanted = Dimension::of(s.unit);
      if (!wanted.like(is))
        problems_.push_back(f.problem(0, fmt::format("the formula gives {}", is.words()),
                                      fmt::format("the readouts are {}", wanted.words())));
    }
  }

  bool is_measurand(std::size_t formula) const { return formula >= first_measurand_ && formula < first_simulated_; }

  /// The quantity of a measurand's name: its true value, from which readouts are simulated.
  const Meaning* truth(const Names& names, std::size_t formula) const {
    const std::string& name = e_->formulas[formula].name;
    const Meaning* m = names.find(name.substr(name.rfind('.') + 1), false);
    return m && m->source == Source::quantity ? m : nullptr;
  }

  /// Steps of the formulas `roots`, in a program of their own.
  Program compiled(const Names& names, const std::vector<std::size_t>& roots, bool simulating) {
    Builder builder;
    std::map<std::size_t, Builder::Value> results;
    std::vector<std::size_t> wanted;
    for (const std::size_t r : roots) {
      const Meaning* true_value = simulating && is_measurand(r) ? truth(names, r) : nullptr;
      if (true_value)
        results[r] = builder.input(true_value->source, true_value->index);
      else
        wanted.push_back(r);
    }
    for (const std::size_t formula : names.order(wanted, simulating, problems_)) {
      const Formula& f = e_->formulas[formula];
      std::vector<Builder::Value> values;
      for (std::size_t i = 0; i < f.nodes.size(); ++i) {
        const Node& n = f.nodes[i];
        if (n.operation == Operation::number) {
          values.push_back(builder.constant(n.value));
        } else if (n.operation == Operation::name) {
          const Meaning* m = names.find(n.name, simulating);
          values.push_back(!m                          ? builder.constant(*find_constant(n.name))
                           : m->source == Source::step ? results.at(m->index)
                                                       : builder.input(m->source, m->index));
        } else {
          values.push_back(builder.operation(n.operation, values[n.a], values[n.b], {formula, i}));
        }
      }
      results[formula] = values.back();
    }
    std::vector<Builder::Value> outputs;
    for (const std::size_t r : roots)
      if (results.contains(r)) outputs.push_back(results[r]);
    return builder.finish(outputs);
  }

  void compile(const Names& names) {
    e_->evaluate = compiled(names, range(first_measurand_, first_simulated_), false);
    e_->explain = compiled(names, range(0, first_simulated_), false);
    std::vector<std::size_t> roots;
    for (const Symbol& s : e_->statement.indications)
      if (const Meaning* m = names.find(s.name, true); m && m->source == Source::step) roots.push_back(m->index);
    simulates_ = !roots.empty() && roots.size() == e_->statement.indications.size();
    if (!simulates_) return;
    for (std::size_t i = first_measurand_; i < first_simulated_; ++i) roots.push_back(i);
    e_->simulate = compiled(names, roots, true);
  }

  void finish_card() {
    CardTexts texts;
    texts.name = "expression";
    texts.title = "Formulas of the scenario";
    texts.quantities = e_->statement.quantities;
    texts.conditions = e_->statement.conditions;
    texts.indications = e_->statement.indications;
    for (std::size_t i = first_measurand_; i < first_simulated_; ++i) texts.measurands.push_back(e_->explained[i]);
    for (const Formula& f : e_->formulas)
      texts.summary +=
          fmt::format("{}{} = {}", texts.summary.empty() ? "" : "\n  ", f.name.substr(f.name.rfind('.') + 1), f.text);
    e_->card = std::make_unique<MadeCard>(texts);
    Model& model = e_->model;
    model.card = &e_->card->card();
    model.kernels = simulates_ ? &kernels : &evaluating_kernels;
    model.evaluate_gradient = &evaluate_point<Gradient>;
    model.evaluate_curvature = &evaluate_point<Curvature>;
    model.simulate_gradient = simulates_ ? &simulate_point<Gradient> : nullptr;
    model.explain = &explain;
    model.check = &check;
    model.solve_reads = &solve_reads;
    model.context = e_.get();
  }

  std::shared_ptr<Expression> e_;
  std::vector<std::string>& notes_;
  std::vector<Problem> problems_;
  std::size_t first_measurand_ = 0, first_simulated_ = 0;
  bool simulates_ = false;
};

} // namespace

MadeModel make(Statement statement, std::vector<std::string>& notes) {
  return Maker(std::move(statement), notes).make();
}

} // namespace gumshoe::models::expression
