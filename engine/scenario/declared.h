#pragma once
/// Names and units that a scenario itself declares, for models that have no card of their own (expressions, commands).
#include <vector>

#include "base/symbol.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

struct Declared {
  std::vector<Symbol> quantities, conditions, indications;
};

/// The keys of [quantities], [conditions] (and conditions that are columns of data files) and [indications]. A unit is that
/// of a column in [data],
/// the key `unit` of the entry, or the first one among its numbers ("5 mm", u = "2 um"); "1" if all are bare. Asking
/// makes no key of the entries known.
Declared declared_symbols(Table& top, Problems& problems);

/// Unit of an entry, as above.
std::string declared_unit(const Node& node);

} // namespace gumshoe::scenario
