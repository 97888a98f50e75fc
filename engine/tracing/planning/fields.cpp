#include "tracing/planning/fields.h"

#include <cmath>

namespace gumshoe::tracing {

using analysis::Field;
using analysis::Fields;
using analysis::of;
using analysis::same;
using analysis::Value;
using enum analysis::In;

// clang-format off: a field is a line or two
namespace {

constexpr analysis::Shown in_json{.json = same};

using P = Planned;
constexpr Field<P> plan_list[] = {
    {"met", of<&P::met>, one, "1 if every goal is met", in_json},
    {"count", of<&P::count>, one, "further readings", in_json},
    {"cost", of<&P::cost>, one, "cost of readings and set-ups", in_json},
    {"d_optimal", of<&P::d_optimal>, one, "1: no goal was stated", in_json},
    {"gain", of<&P::gain>, one, "of a D-optimal plan: gain of ln det of the information on the free unknowns", in_json},
    {"allowed", of<&P::allowed>, one, "readings compared", in_json},
    {"noise", [](const P& p) -> Value { return std::string(name(p.noise)); }, one,
     "declared, estimated (from residuals) or unknown: uncertainties are then in units of the noise of a reading",
     in_json}};

using R = PlannedReading;
constexpr Field<R> reading_list[] = {
    {"setting", of<&R::setting>, one, "what tells it from other allowed readings", in_json},
    {"count", of<&R::count>, one, "how often it is taken", in_json},
    {"cost", of<&R::cost>, one, "cost of all of them", in_json},
    {"allowed", of<&R::allowed>, one, "position among the allowed readings", in_json}};

using G = GoalReached;
bool is_test(const G& g) { return g.kind == G::Kind::split || g.kind == G::Kind::detect; }
template <auto member>
constexpr auto of_test = [](const G& g) -> Value { return is_test(g) ? g.*member : std::nan(""); };
template <auto member> constexpr auto of_u = [](const G& g) -> Value { return is_test(g) ? std::nan("") : g.*member; };
constexpr Field<G> goal_list[] = {
    {"kind", [](const G& g) -> Value { return std::string(name(g.kind)); }, one,
     "split, detect, uncertainty or unknown", in_json},
    {"of", of<&G::of>, one, "effect or quantity", in_json},
    {"against", of<&G::against>, one, "of a split: the effect that must not explain it", in_json},
    {"met", of<&G::met>, one, "1 if it is met", in_json},
    {"possible", of<&G::possible>, one, "0: no number of allowed readings suffices", in_json},
    {"remark", of<&G::remark>, one, "why not", in_json},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"size", of_test<&G::size>, difference, "assumed size of the effect", in_json},
    {"power_wanted", of_test<&G::wanted>, one, "probability asked for", in_json},
    {"power_before", of_test<&G::before>, one, "probability with the readings there are", in_json},
    {"power_after", of_test<&G::after>, one, "probability with the plan", in_json},
    {"u_wanted", of_u<&G::wanted>, difference, "standard uncertainty asked for; 0: none", in_json},
    {"u_before", of_u<&G::before>, difference, "standard uncertainty with the readings there are", in_json},
    {"u_after", of_u<&G::after>, difference, "standard uncertainty with the plan", in_json}};

using V = Verified;
constexpr Field<V> verified_list[] = {
    {"of", of<&V::of>, one, "effect that the simulated readings hold", in_json},
    {"against", of<&V::against>, one, "effect that must not be named with it", in_json},
    {"sets", of<&V::sets>, one, "data sets", in_json},
    {"found", of<&V::found>, one, "data sets in which the trace was right", in_json}};

} // namespace

const Fields<P> plan_fields{"", "", plan_list};
const Fields<R> planned_reading_fields{"", "", reading_list};
const Fields<G> goal_fields{"", "", goal_list};
const Fields<V> verified_fields{"", "", verified_list};
// clang-format on

} // namespace gumshoe::tracing
