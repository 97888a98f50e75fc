#include "tracing/judgement/shape_order.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/in_place_of_scatter.h"

namespace gumshoe::tracing {
namespace {

void straighten(const Evidence& e, std::vector<Trial>& tried) {
  const Candidate& best = e.candidates()[tried[0].candidate];
  const bool curve = best.family == Family::omnibus && best.depends_on.size() == 1,
             of_two = best.depends_on.size() == 2;
  if (!curve && !of_two) return;
  const auto simple = std::ranges::find_if(tried, [&](const Trial& t) {
    const Candidate& one = e.candidates()[t.candidate];
    if (one.columns.cols() != 1 || one.depends_on.size() != 1) return false;
    return curve ? one.depends_on == best.depends_on
                 : one.form == Form::fixed && std::ranges::count(best.depends_on, one.depends_on[0]) > 0;
  });
  if (simple == tried.end()) return;
  const double lead = tried[0].score - simple->score;
  if (!shape_excludes(lead, [&] { return e.chance_of_lead(tried[0].candidate, simple->candidate, lead); }))
    std::rotate(tried.begin(), simple, simple + 1);
}

void leave_declared_noise(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  if (!c.fitter.noise_declared() || scatters_as_declared(c, tried[0].fit)) return;
  const auto simple = std::ranges::find_if(tried, [&](const Trial& t) {
    return e.candidates()[t.candidate].columns.cols() == 1 && scatters_as_declared(c, t.fit) && !e.of_few(t.fit);
  });
  if (simple != tried.end()) std::rotate(tried.begin(), simple, simple + 1);
}

} // namespace

void order_shapes(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  straighten(e, tried);
  leave_declared_noise(c, e, tried);
}

std::string rivals_of(const Evidence& e, std::size_t a, const std::vector<Trial>& tried) {
  const Candidate& own = e.candidates()[a];
  const double ratio = std::ranges::find(tried, a, &Trial::candidate)->ratio;
  std::vector<std::string> out;
  for (const Trial& t : tried) {
    const Candidate& other = e.candidates()[t.candidate];
    if (t.candidate != a && own.columns.cols() == 1 && other.columns.cols() == 1 &&
        other.depends_on != own.depends_on && std::fabs(t.ratio - ratio) <= criteria.equal_shapes)
      out.push_back(with_shape(other));
  }
  return out.empty() ? "" : fmt::format("these data cannot distinguish it from {}", fmt::join(out, ", "));
}

} // namespace gumshoe::tracing
