/// What it means, in words for a machinist.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/offsets.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/verdict_json.h"
#include "tracing/findings/what_was_found.h"

namespace gumshoe::tracing {
namespace {

/// Whether the hold-out blocks rejected it: a shape that they reject is reported, and not added.
bool is_rejected(const Trace& t, const Finding& f) { return t.vetoed && f.kind == Kind::not_in_catalogue; }

/// "An unknown effect of position was found in the training data, but ..."
std::string what_was_rejected(const Finding& f) {
  std::string what = briefly(f);
  what[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(what[0])));
  return what + " was found in the training data, but it does not improve the prediction of held-out readings.";
}

std::string what_else_was_found(const std::vector<Finding>& all) {
  std::string out;
  for (std::size_t i = 1; i < all.size(); ++i) out += (i == 1 ? "Also found: " : "; ") + briefly(all[i]);
  return out + ".";
}

/// "falls from 4.4 um to 1.2 um", as the figures that are shown say.
std::string change(double before, double after, const Rms& r) {
  const std::string from = shown_rms(before, r), to = shown_rms(after, r);
  if (from == to) return "stays at " + from;
  return fmt::format("{} from {} to {}", after < before ? "falls" : "rises", from, to);
}

std::string what_to_do(const std::vector<Finding>& found, const Rms& r, bool unconfirmed) {
  const Finding& f = found.front();
  const char* with = found.size() > 1 ? "with them" : "with it";
  if (f.kind == Kind::scatter && f.members.size() > 1)
    return "Until further readings distinguish them, include it in the uncertainty budget.";
  if (f.kind == Kind::scatter) return "It cannot be corrected for; include it in the uncertainty budget.";
  if (f.kind == Kind::equivalence_class && !f.suggestion.empty()) return "To distinguish them, " + f.suggestion + ".";
  if (std::isfinite(r.holdout_after)) {
    const bool bad = r.holdout_after_winsorised < r.holdout_after;
    const std::string noise = std::isfinite(r.holdout_noise)
                                  ? "noise alone gives " + shown_rms(r.holdout_noise, r)
                                  : "no noise shows in these readings, as of what was set and not measured";
    return fmt::format("On held-out readings the error {} {}{}; {}.{}",
                       change(r.holdout_before_winsorised, r.holdout_after_winsorised, r), with,
                       bad ? fmt::format(" (bad readings cut; the worst, {}, is off by {})", r.worst_point,
                                         shown_rms(r.worst_point_after, r))
                           : "",
                       noise,
                       unconfirmed
                           ? fmt::format(" The held-out readings neither confirm nor reject {}: measure another "
                                         "block before you correct for anything.",
                                         found.size() > 1 ? "them" : "it")
                           : "");
  }
  return fmt::format("In the training data the error {} {}; no readings were held out to check.",
                     change(r.before, r.after, r), with);
}

/// What becomes of the error of the one indication that a finding moves; none if it moves all.
std::vector<std::string> error_of_indication(const Trace& t, const Finding& f) {
  for (const IndicationError& e : t.of_indications) {
    if (e.name != indication_of(t, f) || !std::isfinite(e.holdout_after)) continue;
    Rms own;
    own.unit = e.unit;
    own.si_unit = e.si_unit;
    own.before = e.before;
    own.after = e.after;
    return {fmt::format("That of {} {}.", e.name, change(e.holdout_before, e.holdout_after, own))};
  }
  return {};
}

std::string in_95(double low, double high, const Rms& r) {
  return fmt::format("{} to {} in 95 % of cases", shown_rms(low, r), shown_rms(high, r));
}

/// The error that counts most: of readings that took no part, beyond what their noise allows.
bool held_out_exceeds(const Rms& r) { return r.holdout_after_winsorised > r.holdout_noise_high; }
std::string held_out_error(const Rms& r) {
  const bool alike = shown_rms(r.holdout_after, r) == shown_rms(r.holdout_noise_high, r);
  return fmt::format("Held-out readings differ from the model by {}, {} than noise alone gives ({}); the worst, {}, "
                     "by {}.",
                     shown_rms(r.holdout_after, r), alike ? "a little more" : "more",
                     in_95(r.holdout_noise_low, r.holdout_noise_high, r), r.worst_point,
                     shown_rms(r.worst_point_after, r));
}

/// Readings that are off by five standard deviations of the noise or more; empty: none.
std::string bad_readings(const Trace& t) {
  constexpr double deviations = 5; // normal noise exceeds them once in two million
  const auto far = [](const Outlier& o) { return o.weight <= criteria.winsor_limit / deviations; };
  const auto count = std::ranges::count_if(t.outliers, far);
  if (count == 0) return "";
  const Outlier& worst = *std::ranges::min_element(t.outliers, {}, &Outlier::weight);
  const std::string off =
      shown_size(std::fabs(worst.residual), display_unit(t.rms, worst.unit, worst.si_unit), worst.si_unit);
  return count == 1
             ? fmt::format("One reading is outlying: {}, by {}. Check it.", worst.reading, off)
             : fmt::format("{} readings are outlying; the worst, {}, by {}. Check them.", count, worst.reading, off);
}

/// Whether the residuals are larger than noise alone gives because of outlying readings: without these they are not.
bool outliers_enlarge(const Trace& t) {
  double squares = 0;
  for (const Outlier& o : t.outliers) squares += o.residual * o.residual;
  const auto fitted = static_cast<double>(std::ranges::count(t.rows, false, &Row::held_out));
  const double without = t.rms.before * t.rms.before - squares / std::max(1.0, fitted);
  return !t.outliers.empty() && without <= t.rms.noise_high * t.rms.noise_high;
}

/// Held-out readings that are off by four times the noise, and by three times as much as the others, where without them
/// the error is as noise gives it; 0: none, or more is left.
std::size_t far_held_out(const Trace& t) {
  constexpr double far = 4, of_others = 3;
  std::size_t count = 0, others = 0;
  double squares = 0, nearest = HUGE_VAL;
  for (const Row& row : t.rows) {
    if (!row.held_out || row.indication > 0 || !std::isfinite(row.after)) continue;
    const double size = std::fabs(row.after);
    if (size > far * t.rms.noise)
      ++count, nearest = std::min(nearest, size);
    else
      ++others, squares += size * size;
  }
  if (others <= count) return 0;
  const double rms = std::sqrt(squares / static_cast<double>(others));
  return rms <= t.rms.holdout_noise_high && nearest > of_others * rms ? count : 0;
}

/// A large part of the noise that the fit takes from group to group, and that may be chance.
std::string unsure_scatter(const Trace& t) {
  if (t.noise.scatter.empty() || !(t.noise.scatter_u >= criteria.told_scatter * t.rms.noise)) return "";
  std::string label = t.noise.scatter;
  for (std::size_t at = 0; (at = label.find(',', at)) != label.npos;) label.replace(at, 1, " and ");
  return fmt::format(" This noise holds a scatter of {} from one {} to the next, which may be chance: measure more of "
                     "them to know.",
                     shown_rms(t.noise.scatter_u, t.rms), label);
}

/// Nothing was found: are the residuals as small as noise makes them?
std::string what_residuals_show(const Trace& t) {
  const Rms& r = t.rms;
  constexpr const char* lacks = "the model or the declared noise lacks something that these data do not identify.";
  const std::string noise = std::isfinite(r.noise_high) ? in_95(r.noise_low, r.noise_high, r) : shown_rms(r.noise, r);
  constexpr const char* chance = "noise alone gives as much in one case of forty, or"; // beyond 97.5 %
  const std::string seldom =
      fmt::format("noise alone gives residuals like these in only {:.2g} % of cases: ", 100 * t.p_anything);
  const std::string bad = bad_readings(t);
  if (held_out_exceeds(r) && !bad.empty()) return "No candidate explains it. " + bad;
  if (const std::size_t far = held_out_exceeds(r) && t.of_indications.empty() ? far_held_out(t) : 0; far > 0)
    return far == 1 ? "It is that reading alone: check it. Without it they differ by no more than noise gives."
                    : fmt::format("It is {} readings that are far off: check them. Without them they differ by no more "
                                  "than noise gives.",
                                  far);
  constexpr double by_far = 1.5; // no chance of one in forty
  if (held_out_exceeds(r))
    return fmt::format("No candidate explains it: {}{}",
                       r.holdout_after_winsorised > by_far * r.holdout_noise_high ? "" : std::string(chance) + " ",
                       lacks);
  if (r.before > r.noise_high && t.p_anything > t.alpha && outliers_enlarge(t))
    return fmt::format(
        "The residuals of the training data ({}) are larger than noise alone gives ({}), because {} outlying; "
        "the worst, {}, by {}. Check it.",
        shown_rms(r.before, r), noise,
        t.outliers.size() == 1 ? "one reading is" : fmt::format("{} readings are", t.outliers.size()),
        t.outliers[0].reading, shown_rms(std::fabs(t.outliers[0].residual), r));
  if (r.before > r.noise_high) {
    const std::string how_often = t.p_anything <= t.alpha            ? seldom
                                  : r.before > by_far * r.noise_high ? ""
                                                                     : std::string(chance) + " ";
    return fmt::format("No candidate explains the residuals, but those of the training data ({}) are larger than noise "
                       "alone gives ({}): {}{}",
                       shown_rms(r.before, r), noise, how_often, lacks);
  }
  // Nothing agrees whose chance is small.
  if (t.p_anything <= t.alpha)
    return fmt::format("No candidate explains the residuals ({}), but {}{}", shown_rms(r.before, r), seldom, lacks);
  if (t.noise.correlation >= criteria.strong_correlation)
    return fmt::format("No candidate explains the residuals ({}). They are no larger than noise gives whose readings "
                       "resemble those before them (correlation {:.1f}): something varies slowly that is not known.",
                       shown_rms(r.before, r), t.noise.correlation);
  if (t.noise.declared && t.noise.chi_squared_p <= t.alpha)
    return fmt::format(
        "No candidate explains the residuals ({}). They are consistent with noise {:.3g} times as "
        "large as declared, but noise as declared gives residuals this large in only {:.2g} % of cases: {}",
        shown_rms(r.before, r), t.noise.scale, 100 * t.noise.chi_squared_p, lacks);
  return fmt::format("The measured values agree with the model: the residuals ({}) are no larger than noise alone "
                     "gives ({}).{}{}",
                     shown_rms(r.before, r), noise, unsure_scatter(t), bad.empty() ? "" : " " + bad);
}

std::string scatter_of_replicates(const Rms& r) {
  return fmt::format("{} (95 % interval {} to {})", shown_rms(r.replicate_floor, r),
                     shown_rms(r.replicate_floor_low, r), shown_rms(r.replicate_floor_high, r));
}

std::string what_repeats(const Trace& t) {
  const LackOfFit& lack = t.lack_of_fit;
  return fmt::format("A repeatable part of {} is left that {} explains; it depends on {}.", shown_rms(lack.size, t.rms),
                     t.findings.empty() ? "no effect of the catalogue" : "nothing found",
                     fmt::join(lack.depends_on, " and "));
}

std::string which_block_differs(const Trace& t) {
  const AnomalousBlock& b = t.anomalous_blocks.front();
  return fmt::format("{} differs from the others: its readings scatter by {}, those of the other blocks by {}.", b.name,
                     shown_rms(b.spread, t.rms), shown_rms(b.others, t.rms));
}

/// What a search that found nothing cannot exclude.
std::string what_may_be_there(const Trace& t) {
  if (!t.detection_limits.empty())
    return "Effects smaller than the detection limits may still be present; the table lists those limits.";
  return fmt::format("Effects that are small compared with the noise{} may still be present.",
                     std::isfinite(t.rms.noise) ? fmt::format(" ({})", shown_rms(t.rms.noise, t.rms)) : "");
}

constexpr const char* nothing_is_added = "Nothing is added to the model. Measure more blocks to decide.";

/// First what was found and what to do; then what is left all the same.
std::vector<std::string> verdict_in_words(const Trace& t) {
  const Rms& r = t.rms;
  const bool cause =
      !t.findings.empty() && (t.findings[0].kind == Kind::named || t.findings[0].kind == Kind::equivalence_class);
  std::vector<std::string> out;
  if (t.jumps_not_crossed && !cause) {
    out = {"More than noise is left, and the readings jump with sizes that were tried: the search may not have found "
           "the right size.",
           "Declare these sizes as other measurements give them, and trace again."};
    if (!t.findings.empty()) out.push_back(what_was_found(t.findings.front(), indication_of(t, t.findings.front())));
  } else if (!t.findings.empty()) {
    std::vector<Finding> stand;
    const Finding* rejected = nullptr;
    for (const Finding& f : t.findings)
      if (!is_rejected(t, f))
        stand.push_back(f);
      else if (!rejected)
        rejected = &f;
    if (!stand.empty()) {
      out = {what_was_found(stand.front(), indication_of(t, stand.front()))};
      if (stand.size() > 1) out.push_back(what_else_was_found(stand));
      out.push_back(what_to_do(stand, r, t.unconfirmed));
      if (stand.size() == 1) std::ranges::move(error_of_indication(t, stand.front()), std::back_inserter(out));
    }
    if (rejected) {
      out.push_back(what_was_rejected(*rejected));
      out.emplace_back(nothing_is_added);
    }
  } else if (t.vetoed)
    out = {"An effect was found in the training data, but it does not improve the prediction of held-out readings.",
           nothing_is_added};
  if (t.lack_of_fit.found) {
    out.push_back(what_repeats(t));
    if (t.findings.empty())
      out.push_back(fmt::format("Readings of equal conditions scatter by only {}: what repeats can be corrected for.",
                                scatter_of_replicates(r)));
  }
  if (const std::string bad = bad_readings(t); !t.findings.empty() && !bad.empty()) out.push_back(bad);
  if (!t.anomalous_blocks.empty()) {
    out.push_back(which_block_differs(t));
    if (t.findings.empty()) out.push_back("Find out what was different, or leave it out, and trace again.");
  }
  if (out.empty()) {
    out = {what_residuals_show(t)};
    for (std::string& one : fitted_by_label(t)) out.push_back(std::move(one) + '.');
    out.push_back(what_may_be_there(t));
  }
  return out;
}

} // namespace

void summarise(Trace& out) {
  if (out.outcome == Outcome::insufficient_data) {
    out.plain = {"These data are not sufficient to judge what the model lacks."};
    if (!out.statements.empty()) out.plain.push_back("Why: " + out.statements.back() + ".");
    return;
  }
  out.plain = verdict_in_words(out);
  if (held_out_exceeds(out.rms)) out.plain.insert(out.plain.begin(), held_out_error(out.rms));
}

} // namespace gumshoe::tracing
