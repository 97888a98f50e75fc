#pragma once
/// What effects of single inserts share: a quantity per insert, added to one field of each.
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The same row under another name.
constexpr QuantityCard named(std::string_view name, QuantityCard row) {
  row.name = name;
  return row;
}

template <class T> void add_to_inserts(const T* q, chain::ProbingEvent<T>& event, T chain::InsertDeviation<T>::*field) {
  for (auto& insert : event.turning->insert) insert.*field = insert.*field + *q++;
}

} // namespace gumshoe::effects
