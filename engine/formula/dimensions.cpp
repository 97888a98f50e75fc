#include "formula/dimensions.h"

#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "formula/interpreter.h"

namespace gumshoe::formula {
namespace {

/// Kind of one node, and its value if that is fixed.
struct Known : Kind {
  std::optional<double> value;
};

class Checker {
public:
  Checker(const std::vector<Formula>& formulas, const Names& names, bool simulating, std::vector<Problem>& problems)
      : formulas_(formulas), names_(names), simulating_(simulating), problems_(problems), results_(formulas.size()) {}

  void check(std::size_t index) {
    const Formula& f = formulas_[index];
    formula_ = &f;
    nodes_.clear();
    const std::size_t before = problems_.size();
    for (std::size_t i = 0; i < f.nodes.size() && problems_.size() == before; ++i) nodes_.push_back(kind(f.nodes[i]));
    if (problems_.size() != before) {
      broken_[index] = true;
      return;
    }
    if (skip_) {
      skip_ = false;
      broken_[index] = true;
      return;
    }
    results_[index] = nodes_.back();
    results_[index].unit = shown_unit(results_[index].dimension);
    results_[index].literal = results_[index].zero = false; // a named number says what it is
  }

  std::vector<Kind> results() const { return {results_.begin(), results_.end()}; }

private:
  void problem(std::size_t at, std::string what, std::string why = {}, std::string remedy = {}) {
    if (!skip_) problems_.push_back(formula_->problem(at, std::move(what), std::move(why), std::move(remedy)));
  }

  Known kind(const Node& n) {
    if (n.operation == Operation::number) return {{{}, true, n.value == 0, ""}, n.value};
    if (n.operation == Operation::name) return named(n);
    const Known &a = nodes_[n.a], &b = nodes_[n.b];
    Known out = result(n, a, b);
    out.literal = a.literal && b.literal;
    out.zero = out.literal && n.operation == Operation::negate && a.zero;
    if (a.value && b.value) out.value = apply<double>(n.operation, *a.value, *b.value);
    return out;
  }

  Known named(const Node& n) {
    const Meaning* m = names_.find(n.name, simulating_);
    if (!m) return {{{}, false, false, ""}, *find_constant(n.name)};
    if (m->source != Source::step) return {{Dimension::of(m->symbol->unit), false, false, m->symbol->unit}, {}};
    if (broken_.contains(m->index)) skip_ = true; // said where it broke
    return results_[m->index];
  }

  Known result(const Node& n, const Known& a, const Known& b) {
    Known out;
    switch (n.operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::min:
    case Operation::max:
    case Operation::hypot:
      out.dimension = alike(n, a, b);
      break;
    case Operation::atan2:
      alike(n, a, b);
      out.dimension = Dimension::angle();
      break;
    case Operation::multiply:
      out.dimension = a.dimension * b.dimension;
      break;
    case Operation::divide:
      out.dimension = a.dimension / b.dimension;
      break;
    case Operation::negate:
    case Operation::abs:
      out.dimension = a.dimension;
      break;
    case Operation::sqrt:
      out.dimension = a.dimension.power(0.5);
      break;
    case Operation::power:
      out.dimension = power(n, a, b);
      break;
    default:
      plain_argument(n, a);
      if (n.operation == Operation::asin || n.operation == Operation::acos || n.operation == Operation::atan)
        out.dimension = Dimension::angle();
    }
    return out;
  }

  Dimension alike(const Node& n, const Known& a, const Known& b) {
    if (a.zero) return b.dimension;
    if (b.zero) return a.dimension;
    if (!a.dimension.like(b.dimension)) {
      const bool sum = n.operation == Operation::add || n.operation == Operation::subtract;
      problem(n.at,
              sum ? fmt::format("{} {} {}", a.dimension.words(), n.operation == Operation::add ? "plus" : "minus",
                                b.dimension.words())
                  : fmt::format("{} of {} and {}", word(n.operation), a.dimension.words(), b.dimension.words()),
              sum ? "the terms of a sum must have the same dimension" : "both must have the same dimension");
      return a.dimension;
    }
    if (n.operation != Operation::atan2 && n.operation != Operation::hypot &&
        ((a.literal && b.dimension.is_angle()) || (b.literal && a.dimension.is_angle())))
      problem(formula_->start(a.literal ? n.a : n.b), "a bare number is combined with an angle", "1 deg or 1 rad?",
              "use a quantity with a unit, or pi");
    return a.dimension.joined(b.dimension);
  }

  Dimension power(const Node& n, const Known& a, const Known& b) {
    if (!b.dimension.plain()) {
      problem(formula_->start(n.b), fmt::format("the exponent is {}", b.dimension.words()),
              "an exponent must be a plain number");
      return {};
    }
    if (a.dimension.plain() && !(b.value && a.dimension.has_angle())) return {};
    if (!b.value) {
      problem(formula_->start(n.b), fmt::format("the exponent of {} varies", a.dimension.words()),
              "the result would have no fixed dimension", "divide the base by a reference value");
      return {};
    }
    return a.dimension.power(*b.value);
  }

  void plain_argument(const Node& n, const Known& a) {
    if (a.dimension.plain()) return;
    const bool angle = n.operation == Operation::sin || n.operation == Operation::cos || n.operation == Operation::tan;
    problem(formula_->start(n.a), fmt::format("{} of {}", word(n.operation), a.dimension.words()),
            angle ? "it takes an angle or a plain number" : "it takes a plain number",
            "divide it by another quantity of its kind");
  }

  /// The unit of the first operand of this dimension. A scale with its own zero (degC) shows no differences.
  std::string shown_unit(const Dimension& dimension) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Known& k = nodes_[i];
      if (k.unit.empty() || k.unit == "1" || !k.dimension.like(dimension) ||
          k.dimension.has_angle() != dimension.has_angle())
        continue;
      const std::string si = units::si_unit_of(k.unit);
      return units::from_si(0, k.unit, si) == 0 ? k.unit : si;
    }
    return "";
  }

  const std::vector<Formula>& formulas_;
  const Names& names_;
  bool simulating_;
  std::vector<Problem>& problems_;
  std::vector<Known> results_, nodes_;
  std::map<std::size_t, bool> broken_;
  const Formula* formula_ = nullptr;
  bool skip_ = false;
};

} // namespace

std::vector<Kind> kinds_of(const std::vector<Formula>& formulas, const std::vector<std::size_t>& order,
                           const Names& names, bool simulating, std::vector<Problem>& problems) {
  Checker checker(formulas, names, simulating, problems);
  for (const std::size_t i : order) checker.check(i);
  return checker.results();
}

} // namespace gumshoe::formula
