#include "tracing/scenario_out/sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"

namespace gumshoe::tracing {
namespace {

/// To the place that `u` asks for.
std::string number(double si, double u, const std::string& unit, const std::string& si_unit, units::Kind kind) {
  const double shown = units::from_si(u, unit, si_unit, units::Kind::difference);
  return analysis::fixed(units::from_si(si, unit, si_unit, kind), shown > 0 ? analysis::decimals_for(shown) : 6);
}

} // namespace

std::string source_of(const Finding& f, const Amplitude& a, const scenario::Scenario& scenario) {
  std::string out = fmt::format("{}, p = {:.2g}", name(f.kind), f.p_value);
  if (f.kind == Kind::equivalence_class)
    out += fmt::format(" of {}, which these data cannot distinguish; the first is written, with u enlarged by the "
                       "difference between them",
                       fmt::join(f.members, ", "));
  for (const SizedQuantity& q : f.quantities) {
    if (q.scenario_name != a.scenario_name) continue;
    const bool shift = q.name.starts_with("shift of ");
    const auto kind = shift || a.quantity == Amplitude::npos || scenario.quantities[a.quantity].unit != q.unit
                          ? units::Kind::difference
                          : units::Kind::point;
    out += fmt::format("; 95 % interval{} [{}, {}]{}, {}", shift ? " of the shift" : "",
                       number(q.low95, q.u, q.unit, q.si_unit, kind), number(q.high95, q.u, q.unit, q.si_unit, kind),
                       units::suffix(q.unit),
                       f.quantities.size() == 1 ? "which allows for the search, whereas u comes from the fit and "
                                                  "does not"
                                                : "of the fit, like u");
  }
  return out;
}

} // namespace gumshoe::tracing
