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

/// " of z"; empty where there is one indication.
std::string of_indication(const TraceContext& c, const Candidate& a) {
  return a.name.substr(without_indication(a.name, c.observations).size());
}

/// Puts the first of those tried that is simpler, and of the same indication, before the best, unless the
/// lead of the best excludes it.
template <class Simpler>
void prefer(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried, const Simpler& simpler) {
  const std::string indication = of_indication(c, e.candidates()[tried[0].candidate]);
  const auto one = std::ranges::find_if(tried, [&](const Trial& t) {
    const Candidate& a = e.candidates()[t.candidate];
    return simpler(a) && of_indication(c, a) == indication;
  });
  if (one == tried.end()) return;
  const double lead = tried[0].score - one->score;
  if (!shape_excludes(lead, [&] { return e.chance_of_lead(tried[0].candidate, one->candidate, lead); }))
    std::rotate(tried.begin(), one, one + 1);
}

void straighten(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  const Candidate& best = e.candidates()[tried[0].candidate];
  const bool curve = best.family == Family::omnibus && best.depends_on.size() == 1,
             of_two = best.depends_on.size() == 2;
  if (!curve && !of_two) return;
  const bool of_labels = std::ranges::find(c.observations.label_pairs, best.depends_on, &Grouping::labels) !=
                         c.observations.label_pairs.end();
  prefer(c, e, tried, [&](const Candidate& one) {
    const bool wave = one.form == Form::wave;
    const bool of_one_label = of_labels && one.family == Family::omnibus;
    if (!(one.columns.cols() == 1 || (curve && wave) || of_one_label) || one.depends_on.size() != 1) return false;
    return curve ? one.depends_on == best.depends_on
                 : one.form == Form::fixed && std::ranges::count(best.depends_on, one.depends_on[0]) > 0;
  });
}

/// Power of a polynomial of one condition; 0: another shape.
int power(const Candidate& a) {
  if (a.depends_on.size() != 1 || !a.name.starts_with("polynomial:" + a.depends_on[0])) return 0;
  const std::string rest = a.name.substr(std::string("polynomial:").size() + a.depends_on[0].size());
  return rest.starts_with("^3") ? 3 : rest.starts_with("^2") ? 2 : 1;
}

void lower_power(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  const Candidate& best = e.candidates()[tried[0].candidate];
  for (int p = 1; p < power(e.candidates()[tried[0].candidate]); ++p)
    prefer(c, e, tried, [&](const Candidate& one) { return power(one) == p && one.depends_on == best.depends_on; });
  if (power(e.candidates()[tried[0].candidate]) == 3) // what begins to wear goes on straight
    prefer(c, e, tried,
           [&](const Candidate& one) { return one.name.starts_with("bend:") && one.depends_on == best.depends_on; });
}

/// Blocks follow one another: where they differ, or one does, that may be a drift.
void drift_before_blocks(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  const Observations& o = c.observations;
  if (e.candidates()[tried[0].candidate].depends_on != std::vector{o.blocks.name}) return;
  prefer(c, e, tried, [&](const Candidate& one) {
    return power(one) == 1 && std::ranges::any_of(o.covariates, [&](const Covariate& x) {
             return x.course && x.name == one.depends_on[0];
           });
  });
}

/// Whether one block differs, or one pass of it.
bool of_one_block(const Candidate& a, const Observations& o) {
  return !a.physical() && a.columns.cols() == 1 && a.depends_on.back() == o.blocks.name &&
         (a.name.starts_with("step:") || a.rare());
}

void leave_declared_noise(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried) {
  if (!c.fitter.noise_declared() || scatters_as_declared(c, tried[0].fit)) return;
  const auto simple = std::ranges::find_if(tried, [&](const Trial& t) {
    return e.candidates()[t.candidate].columns.cols() == 1 && scatters_as_declared(c, t.fit) && !e.of_few(t.fit);
  });
  if (simple != tried.end()) std::rotate(tried.begin(), simple, simple + 1);
}

/// Whether two shapes differ by a constant, or their sum is one, at all readings: the first block, and all after it.
bool same_everywhere(const Matrix& a, const Matrix& b) {
  constexpr double rounding = 1e-9;
  const auto constant = [&](const Matrix& x) { return x.maxCoeff() - x.minCoeff() < rounding; };
  return constant(a - b) || constant(a + b);
}

/// The step that lasts which the fitted readings, but not all, cannot tell from a shape of one block, or of one pass:
/// the last block says the same as a step that begins with it, and of aligned blocks any does. There are more instants
/// than blocks, so that the step need not pass by itself.
std::optional<std::size_t> same_that_lasts(const TraceContext& c, const Evidence& e, std::size_t a) {
  if (!of_one_block(e.candidates()[a], c.observations)) return std::nullopt;
  constexpr double rounding = 1e-9;
  for (std::size_t b = 0; b < e.candidates().size(); ++b)
    if (is_lasting_step(e.candidates()[b], c.observations) && std::fabs(e.correlation(a, b)) > 1 - rounding &&
        !same_everywhere(e.candidates()[a].columns, e.candidates()[b].columns))
      return b;
  return std::nullopt;
}

/// Puts steps that last before the same in one block; the first of all also if it does not pass by itself.
void settle_steps(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried, bool steps_last) {
  for (std::size_t i = 0; steps_last && i < tried.size(); ++i) {
    const auto lasts = same_that_lasts(c, e, tried[i].candidate);
    if (!lasts) continue;
    const auto here = tried.begin() + index(i),
               known = std::find_if(here, tried.end(), [&](const Trial&t) { return t.candidate == *lasts; });
    if (known != tried.end()) {
      std::rotate(here, known, known + 1);
    } else if (i == 0) {
      if (Trial one = e.trial(*lasts); one.fit.valid) tried.insert(here, std::move(one));
    }
  }
  if (steps_last) return;
  const auto block = std::ranges::find_if(tried, [&](const Trial& t) {
    const auto lasts = same_that_lasts(c, e, t.candidate);
    return lasts && (t.candidate == tried[0].candidate || *lasts == tried[0].candidate);
  });
  if (block == tried.end()) return;
  const auto refuted = *same_that_lasts(c, e, block->candidate);
  std::rotate(tried.begin(), block, block + 1);
  std::erase_if(tried, [&](const Trial& t) { return t.candidate == refuted; });
}

/// Whether a pulse is more than half of its height in the last of the fitted readings.
bool goes_on(const TraceContext& c, const Candidate& pulse) {
  const Vector fitted = pulse.columns(c.fitter.rows(), 0).cwiseAbs();
  const Index k = index(c.observations.indications);
  return fitted.tail(k).maxCoeff() > 0.5 * fitted.maxCoeff();
}

/// A step in place of a pulse that is not over in what is fitted, or of a gradual change, unless their lead excludes
/// it: between sessions nobody sees whether something changed at once.
std::optional<Trial> step_in_place_of(const TraceContext& c, const Evidence& e, std::size_t course) {
  const Candidate& best = e.candidates()[course];
  if (!best.name.starts_with("shift:") && !(best.name.starts_with("pulse:") && goes_on(c, best))) return std::nullopt;
  std::optional<std::size_t> step;
  for (std::size_t b = 0; b < e.candidates().size(); ++b) {
    const Candidate& one = e.candidates()[b];
    if (is_lasting_step(one, c.observations) && one.depends_on == best.depends_on &&
        of_indication(c, one) == of_indication(c, best) && (!step || e.score(b) > e.score(*step)))
      step = b;
  }
  if (!step) return std::nullopt;
  Trial out = e.trial(*step);
  const double lead = e.trial(course).score - out.score;
  if (!out.fit.valid || shape_excludes(lead, [&] { return e.chance_of_lead(course, *step, lead); }))
    return std::nullopt;
  return out;
}

} // namespace

bool is_lasting_step(const Candidate& a, const Observations& o) {
  return a.name.starts_with("step:") &&
         std::ranges::any_of(o.covariates, [&](const Covariate& x) { return x.course && x.name == a.depends_on[0]; });
}

std::optional<Trial> lasting_in_place_of(const TraceContext& c, const Evidence& e, std::size_t shape) {
  if (const auto same = same_that_lasts(c, e, shape))
    if (Trial one = e.trial(*same); one.fit.valid) return one;
  return step_in_place_of(c, e, shape);
}

void order_shapes(const TraceContext& c, const Evidence& e, std::vector<Trial>& tried, bool steps_last) {
  straighten(c, e, tried);
  drift_before_blocks(c, e, tried);
  lower_power(c, e, tried);
  leave_declared_noise(c, e, tried);
  if (steps_last)
    if (auto step = step_in_place_of(c, e, tried[0].candidate)) {
      std::erase_if(tried, [&](const Trial& t) { return t.candidate == step->candidate; });
      tried.insert(tried.begin(), std::move(*step));
    }
  settle_steps(c, e, tried, steps_last);
}

bool is_one_of_several_forms(const Evidence& e, std::size_t a) {
  constexpr double rounding = 1e-6;
  const Candidate& own = e.candidates()[a];
  for (std::size_t b = 0; b < e.candidates().size(); ++b)
    if (const Candidate& other = e.candidates()[b];
        other.name == own.name && other.shape != own.shape &&
        std::fabs(e.score(b) - e.score(a)) <= rounding * std::fabs(e.score(a)))
      return true;
  return false;
}

namespace {

/// Cosine of two signatures about their means, in all readings, those of the hold-out blocks among them.
double cosine(const Candidate& a, const Candidate& b) {
  const Vector x = a.columns.col(0).array() - a.columns.col(0).mean(),
               y = b.columns.col(0).array() - b.columns.col(0).mean();
  return x.dot(y) / (x.norm() * y.norm());
}

constexpr double collinear = 1 - 1e-9; // but for rounding

/// Whether a shape is of the blocks, one of which differs.
bool of_blocks(const TraceContext& c, const Candidate& a) {
  return a.depends_on == std::vector<std::string>{c.observations.blocks.name};
}

} // namespace

std::vector<RivalShape> rivals_of(const TraceContext& c, const Evidence& e, std::size_t a,
                                  const std::vector<Trial>& tried) {
  const Candidate& own = e.candidates()[a];
  const double ratio = std::ranges::find(tried, a, &Trial::candidate)->ratio;
  std::vector<RivalShape> out;
  for (const Trial& t : tried) {
    const Candidate& other = e.candidates()[t.candidate];
    if (t.candidate == a || own.columns.cols() != 1 || other.columns.cols() != 1 ||
        other.depends_on == own.depends_on || !(std::fabs(t.ratio - ratio) <= criteria.equal_shapes))
      continue;
    // A short lag is hardly one: of the same condition it is no other cause.
    if (other.form == Form::lag && own.depends_on[0] == other.depends_on[0]) continue;
    const double alike = cosine(own, other);
    const bool edge = (of_blocks(c, own) && is_lasting_step(other, c.observations)) ||
                      (of_blocks(c, other) && is_lasting_step(own, c.observations));
    if (edge && std::fabs(alike) >= collinear) continue;
    out.push_back({with_shape(other), alike >= collinear});
  }
  return out;
}

} // namespace gumshoe::tracing
