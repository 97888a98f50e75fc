#include "tracing/trace.h"

namespace gumshoe::tracing {

const char* name(Kind kind) {
  switch (kind) {
  case Kind::named:
    return "named";
  case Kind::equivalence_class:
    return "class";
  case Kind::scatter:
    return "scatter";
  case Kind::not_in_catalogue:
    return "not_in_catalogue";
  }
  return "";
}

Trace trace(const scenario::Scenario& scenario, const Settings&) {
  throw InputError("tracing is being built", scenario.file, "");
}

} // namespace gumshoe::tracing
