#pragma once
/// Values of a card's rows under their names.
///
/// GUMSHOE_NAMED(Quantities, rod_radius, fillet_radius) declares
///   template <class T> struct Quantities { T rod_radius, fillet_radius; };
///   struct QuantitiesRow { enum : std::size_t { rod_radius, fillet_radius }; ... };
/// in the order of the card's rows. The adapter of models compares the names with the card's when it is compiled, so a
/// member that is missing, misspelt or out of order is an error of the compiler.
#include <cstddef>
#include <string_view>

#include "math/scalar.h"

#define GUMSHOE_NAMED(NAME, ...)                                                                                       \
  template <class T> struct NAME { T __VA_ARGS__; };                                                                   \
  struct NAME##Row {                                                                                                   \
    enum : std::size_t { __VA_ARGS__ };                                                                                \
    static constexpr std::string_view names = #__VA_ARGS__;                                                            \
  }

namespace gumshoe::models {

/// Number of rows of Named.
template <template <class> class Named> inline constexpr std::size_t rows_of = sizeof(Named<double>) / sizeof(double);

/// The members of a named struct as an array, in the order of the card's rows.
template <template <class> class Named, class T> T* array_of(Named<T>& values) {
  static_assert(sizeof(Named<T>) == rows_of<Named> * sizeof(T));
  return reinterpret_cast<T*>(&values);
}
template <template <class> class Named, class T> const T* array_of(const Named<T>& values) {
  static_assert(sizeof(Named<T>) == rows_of<Named> * sizeof(T));
  return reinterpret_cast<const T*>(&values);
}

/// The values of an array under their names; `values` holds one T per row.
template <template <class> class Named, class T> Named<T> named(const T* values) {
  Named<T> out;
  for (std::size_t i = 0; i < rows_of<Named>; ++i) array_of(out)[i] = values[i];
  return out;
}

/// The same values as numbers of another kind, each made by `number`.
template <class To, template <class> class Named, class T, class Number>
Named<To> converted(const Named<T>& values, const Number& number) {
  Named<To> out;
  for (std::size_t i = 0; i < rows_of<Named>; ++i) array_of(out)[i] = number(array_of(values)[i]);
  return out;
}
/// Derivatives are dropped.
template <class To, template <class> class Named, class T> Named<To> converted(const Named<T>& values) {
  return converted<To>(values, [](const T& x) { return To(num::value(x)); });
}

/// Whether "a, b, c" are the names of a card's rows.
template <class Cards> constexpr bool names_match(std::string_view names, const Cards& cards) {
  for (const auto& card : cards) {
    if (!names.starts_with(card.name)) return false;
    names.remove_prefix(card.name.size());
    if (names.empty()) return &card == &cards[std::size(cards) - 1];
    if (!names.starts_with(", ")) return false;
    names.remove_prefix(2);
  }
  return false;
}

} // namespace gumshoe::models
