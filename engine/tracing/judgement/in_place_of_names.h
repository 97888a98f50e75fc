#pragma once
/// One shape in place of a named effect and of a shape that was found with it.
#include <optional>

#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

struct InPlaceOfNames {
  std::size_t named = 0, rest = 0; ///< findings whose place it takes
  Candidate shape;                 ///< as made; the fit's last term holds it without what named sizes could do
  JointFit fit;                    ///< with the shape, without the terms of both findings
};

/// An unknown effect that looks in part like a known one is named after it, and a shape takes the rest. Neither is
/// there where one plain shape of no more sizes explains more than the two. Where the shape depends on everything that
/// the effect depends on, any dependence on these conditions may be there: the effect must count in addition to that.
std::optional<InPlaceOfNames> in_place_of_names(const TraceContext& context, const Search& search);

} // namespace gumshoe::tracing
