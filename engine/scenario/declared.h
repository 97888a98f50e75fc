#pragma once
/// Names and units that a scenario itself declares, for models that have no card of their own (expressions, commands).
#include <string>
#include <utility>
#include <vector>

#include "base/symbol.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

struct Declared {
  std::vector<Symbol> quantities, conditions, indications;
  /// Indications and conditions that are plain numbers because nothing states the unit of their column, with its name.
  std::vector<std::pair<std::string, std::string>> columns_without_unit = {};
};

/// The keys of [quantities], [conditions] (and conditions that are columns of data files) and [indications]. A unit is that
/// of a column in [data],
/// the key `unit` of the entry, or the first one among its numbers ("5 mm", u = "2 um"); "1" if all are bare. Asking
/// makes no key of the entries known.
Declared declared_symbols(Table& top, Problems& problems);

} // namespace gumshoe::scenario
