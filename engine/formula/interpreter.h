#pragma once
/// What each operation computes, for every scalar: double, lanes, dual numbers. The only place.
#include <cmath>

#include "formula/program.h"
#include "math/elementary.h"

namespace gumshoe::formula {

/// Calls `use` with the operation as a function of two values (of which a function of one ignores the second).
template <class T, class Use> void with_function(Operation operation, const Use& use) {
  namespace el = elementary;
#define GUMSHOE_OF_ONE(f)                                                                                              \
  case Operation::f:                                                                                                   \
    return use([](const T& a, const T&) { return el::f(a); });
#define GUMSHOE_OF_TWO(f)                                                                                              \
  case Operation::f:                                                                                                   \
    return use([](const T& a, const T& b) { return el::f(a, b); });
  // clang-format off: one line each
  switch (operation) {
  case Operation::add: return use([](const T& a, const T& b) { return a + b; });
  case Operation::subtract: return use([](const T& a, const T& b) { return a - b; });
  case Operation::multiply: return use([](const T& a, const T& b) { return a * b; });
  case Operation::divide: return use([](const T& a, const T& b) { return a / b; });
  case Operation::negate: return use([](const T& a, const T&) { return -a; });
  case Operation::power: return use([](const T& a, const T& b) { return el::pow(a, b); });
  GUMSHOE_OF_ONE(sin) GUMSHOE_OF_ONE(cos) GUMSHOE_OF_ONE(tan)
  GUMSHOE_OF_ONE(asin) GUMSHOE_OF_ONE(acos) GUMSHOE_OF_ONE(atan) GUMSHOE_OF_TWO(atan2)
  GUMSHOE_OF_ONE(sinh) GUMSHOE_OF_ONE(cosh) GUMSHOE_OF_ONE(tanh)
  GUMSHOE_OF_ONE(exp) GUMSHOE_OF_ONE(log) GUMSHOE_OF_ONE(log10) GUMSHOE_OF_ONE(sqrt)
  GUMSHOE_OF_ONE(abs) GUMSHOE_OF_TWO(min) GUMSHOE_OF_TWO(max) GUMSHOE_OF_TWO(hypot)
  default: return;
  }
  // clang-format on
#undef GUMSHOE_OF_ONE
#undef GUMSHOE_OF_TWO
}

/// One operation on two values; an operation of one operand ignores b.
template <class T> T apply(Operation operation, const T& a, const T& b) {
  T result = a;
  with_function<T>(operation, [&](const auto& f) { result = f(a, b); });
  return result;
}

/// Where the value is right but has no derivative, or where none of the formulas for derivatives hold.
inline bool kink(Operation operation, double a, double b) {
  switch (operation) {
  case Operation::abs:
  case Operation::sqrt:
    return a == 0;
  case Operation::min:
  case Operation::max:
    return a == b;
  case Operation::asin:
  case Operation::acos:
    return std::fabs(a) == 1;
  case Operation::hypot:
  case Operation::atan2:
    return a == 0 && b == 0;
  case Operation::power:
    return a <= 0;
  default:
    return false;
  }
}

/// Values of the inputs at one point.
template <class T> struct Inputs {
  const T* quantities = nullptr;
  const double* conditions = nullptr;
  const T* indications = nullptr;
};

template <class T> struct Values {
  std::vector<T> steps;
  bool kink = false;
};

/// The values of all steps at one point. `kink`: some step has a value but no derivative there.
template <class T> Values<T> interpret(const Program& program, const Inputs<T>& in) {
  Values<T> out;
  out.steps.reserve(program.steps.size());
  for (const Step& s : program.steps) {
    switch (s.source) {
    case Source::constant:
      out.steps.push_back(T(s.value));
      break;
    case Source::quantity:
      out.steps.push_back(in.quantities[s.a]);
      break;
    case Source::condition:
      out.steps.push_back(T(in.conditions[s.a]));
      break;
    case Source::indication:
      out.steps.push_back(in.indications[s.a]);
      break;
    case Source::step: {
      const T &a = out.steps[s.a], &b = out.steps[s.b];
      out.kink |= kink(s.operation, num::value(a), num::value(b));
      out.steps.push_back(apply<T>(s.operation, a, b));
    }
    }
  }
  return out;
}

} // namespace gumshoe::formula
