#pragma once
/// What each operation computes, for every scalar: double, lanes, dual numbers. The only place.
#include <cmath>

#include "formula/program.h"
#include "math/elementary.h"

namespace gumshoe::formula {

/// Calls `use` with the operation as a function of two values (of which a function of one ignores the second).
template <class T, class Use> void with_function(Operation operation, const Use& use) {
  namespace el = elementary;
  switch (operation) {
  case Operation::add:
    return use([](const T& a, const T& b) { return a + b; });
  case Operation::subtract:
    return use([](const T& a, const T& b) { return a - b; });
  case Operation::multiply:
    return use([](const T& a, const T& b) { return a * b; });
  case Operation::divide:
    return use([](const T& a, const T& b) { return a / b; });
  case Operation::negate:
    return use([](const T& a, const T&) { return -a; });
  case Operation::power:
    return use([](const T& a, const T& b) { return el::pow(a, b); });
  case Operation::sin:
    return use([](const T& a, const T&) { return el::sin(a); });
  case Operation::cos:
    return use([](const T& a, const T&) { return el::cos(a); });
  case Operation::tan:
    return use([](const T& a, const T&) { return el::tan(a); });
  case Operation::asin:
    return use([](const T& a, const T&) { return el::asin(a); });
  case Operation::acos:
    return use([](const T& a, const T&) { return el::acos(a); });
  case Operation::atan:
    return use([](const T& a, const T&) { return el::atan(a); });
  case Operation::atan2:
    return use([](const T& a, const T& b) { return el::atan2(a, b); });
  case Operation::sinh:
    return use([](const T& a, const T&) { return el::sinh(a); });
  case Operation::cosh:
    return use([](const T& a, const T&) { return el::cosh(a); });
  case Operation::tanh:
    return use([](const T& a, const T&) { return el::tanh(a); });
  case Operation::exp:
    return use([](const T& a, const T&) { return el::exp(a); });
  case Operation::log:
    return use([](const T& a, const T&) { return el::log(a); });
  case Operation::log10:
    return use([](const T& a, const T&) { return el::log10(a); });
  case Operation::sqrt:
    return use([](const T& a, const T&) { return el::sqrt(a); });
  case Operation::abs:
    return use([](const T& a, const T&) { return el::abs(a); });
  case Operation::min:
    return use([](const T& a, const T& b) { return el::min(a, b); });
  case Operation::max:
    return use([](const T& a, const T& b) { return el::max(a, b); });
  case Operation::hypot:
    return use([](const T& a, const T& b) { return el::hypot(a, b); });
  default:
    return;
  }
}

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
