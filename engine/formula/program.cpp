#include "formula/program.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "formula/interpreter.h"

namespace gumshoe::formula {
namespace {
constexpr int largest_product_power = 16;
constexpr std::uint32_t nowhere = 0xffffffff;
} // namespace

Builder::Value Builder::keep(Step step) {
  const Key key{step.source, step.operation, step.a, step.b, std::bit_cast<std::uint64_t>(step.value)};
  const auto [it, fresh] = known_.try_emplace(key, static_cast<Value>(steps_.size()));
  if (fresh) steps_.push_back(step);
  return it->second;
}

Builder::Value Builder::constant(double value) {
  Step s;
  s.source = Source::constant;
  s.value = value;
  return keep(s);
}

Builder::Value Builder::input(Source source, std::size_t column) {
  Step s;
  s.source = source;
  s.a = static_cast<std::uint32_t>(column);
  return keep(s);
}

Builder::Value Builder::whole_power(Value base, int exponent, const Origin& origin) {
  Value result = nowhere, square = base;
  for (int n = std::abs(exponent); n > 0; n /= 2) {
    if (n % 2) result = result == nowhere ? square : operation(Operation::multiply, result, square, origin);
    if (n > 1) square = operation(Operation::multiply, square, square, origin);
  }
  if (exponent == 0) return constant(1);
  return exponent > 0 ? result : operation(Operation::divide, constant(1), result, origin);
}

Builder::Value Builder::operation(Operation operation, Value a, Value b, const Origin& origin) {
  const bool fixed_b = steps_[b].source == Source::constant;
  if (operation == Operation::power && fixed_b && steps_[a].source != Source::constant) {
    const double exponent = steps_[b].value;
    if (std::fabs(exponent) <= largest_product_power && exponent == std::round(exponent))
      return whole_power(a, static_cast<int>(exponent), origin);
    if (exponent == 0.5) return this->operation(Operation::sqrt, a, a, origin);
  }
  if (fixed_b && steps_[a].source == Source::constant) {
    const double folded = apply<double>(operation, steps_[a].value, steps_[b].value);
    if (std::isfinite(folded)) return constant(folded); // what has no value stays, to be found at its place
  }
  Step s;
  s.operation = operation;
  const bool commutes = operation == Operation::add || operation == Operation::multiply;
  s.a = commutes ? std::min(a, b) : a;
  s.b = commutes ? std::max(a, b) : is_binary(operation) ? b : a;
  s.origin = origin;
  return keep(s);
}

Program Builder::finish(std::span<const Value> outputs) const {
  std::vector<bool> needed(steps_.size(), false);
  for (const Value v : outputs) needed[v] = true;
  for (std::size_t i = steps_.size(); i-- > 0;)
    if (needed[i] && steps_[i].source == Source::step) needed[steps_[i].a] = needed[steps_[i].b] = true;
  Program program;
  std::vector<std::uint32_t> moved(steps_.size(), nowhere);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (!needed[i]) continue;
    Step s = steps_[i];
    if (s.source == Source::step) s.a = moved[s.a], s.b = moved[s.b];
    moved[i] = static_cast<std::uint32_t>(program.steps.size());
    program.steps.push_back(s);
  }
  for (const Value v : outputs) program.outputs.push_back(moved[v]);

  // A register is free again after the last step that reads it; outputs keep theirs.
  std::vector<std::size_t> last(program.steps.size(), 0);
  for (std::size_t i = 0; i < program.steps.size(); ++i)
    if (program.steps[i].source == Source::step) last[program.steps[i].a] = last[program.steps[i].b] = i;
  for (const std::uint32_t o : program.outputs) last[o] = program.steps.size();
  std::vector<std::uint32_t> free;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    Step& s = program.steps[i];
    if (s.source != Source::step) continue;
    const auto release = [&](std::uint32_t operand) {
      if (program.steps[operand].source == Source::step && last[operand] == i)
        free.push_back(program.steps[operand].home);
    };
    release(s.a);
    if (s.b != s.a) release(s.b);
    if (free.empty()) free.push_back(program.registers++);
    s.home = free.back();
    free.pop_back();
  }
  return program;
}

} // namespace gumshoe::formula
