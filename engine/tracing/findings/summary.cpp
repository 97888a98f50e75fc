/// What it means, in words for a machinist.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "tracing/criteria.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/verdict_json.h"

namespace gumshoe::tracing {
namespace {

constexpr std::string_view declared = "declared:";
bool declares(const Finding& f) { return f.name.starts_with(declared); }

/// Sizes of one kind with the first, as those of a vector: the best known of many, in their order.
std::vector<const SizedQuantity*> sizes_told(const Finding& f) {
  constexpr std::size_t most = 3;
  std::vector<const SizedQuantity*> out;
  for (const SizedQuantity& q : f.quantities)
    if (q.si_unit == f.quantities[0].si_unit) out.push_back(&q);
  const auto times_u = [](const SizedQuantity* q) { return q->u > 0 ? std::fabs(q->value) / q->u : 0; };
  while (out.size() > most) out.erase(std::ranges::min_element(out, std::ranges::less{}, times_u));
  return out;
}

/// " (amplitude 1.5 um)", " (tilt_x 0.1 mrad, tilt_y -0.3 mrad)"; empty without a size
std::string size_of(const Finding& f) {
  if (f.quantities.empty()) return "";
  const SizedQuantity& q = f.quantities[0];
  if (!declares(f)) {
    std::vector<std::string> all;
    for (const SizedQuantity* one : sizes_told(f))
      all.push_back(fmt::format("{} {}", one->name, shown_size(one->value, one->unit, one->si_unit)));
    return fmt::format(" ({})", fmt::join(all, ", "));
  }
  const ShownSize s = shown(q); // to the digits that u leaves: it may differ little from what was declared
  return fmt::format(" ({} {}{})", q.name, analysis::fixed(s.value, analysis::decimals_for(s.u)),
                     units::suffix(s.unit));
}

/// "reading 27" of "step:time after reading 27", asked for as "step:" and " after "; empty of any other shape.
std::string reading_of(const std::string& shape, const std::string& kind, const std::string& where) {
  const auto at = shape.find(where);
  return shape.starts_with(kind) && at != std::string::npos ? shape.substr(at + where.size()) : "";
}
/// The reading after which the readings differ by a constant.
std::string instant_of(const std::string& shape) { return reading_of(shape, "step:", " after "); }
/// "tool T3" of "step:time with tool T3 after reading 27", which alone differs from then on; empty of any other shape.
std::string part_of_step(const std::string& shape) {
  const auto with = shape.find(" with "), after = shape.find(" after ");
  if (!shape.starts_with("step:") || with == std::string::npos || after == std::string::npos || after < with) return "";
  return shape.substr(with + 6, after - with - 6);
}
/// The reading about which something came and went.
std::string pulse_of(const std::string& shape) { return reading_of(shape, "pulse:", " about "); }
/// The reading about which they went over to other values.
std::string shift_of(const std::string& shape) { return reading_of(shape, "shift:", " about "); }

/// "tool T3", which alone changes with the first condition; empty of any other shape.
std::string part_alone(const Finding& f) {
  if (f.depends_on.size() != 2) return {};
  const std::string product = fmt::format("product:{}*{} ", f.depends_on[0], f.depends_on[1]);
  if (!f.described_by.starts_with(product)) return {};
  return f.depends_on[1] + " " + f.described_by.substr(product.size());
}

/// The indication that a shape moves, where there are several; empty: all, or the only one.
std::string indication_of(const Trace& t, const Finding& f) {
  for (const IndicationError& e : t.of_indications)
    if (f.described_by.ends_with(" of " + e.name)) return e.name;
  return {};
}

/// What may be there in place of scatter: the other members of its finding, if it has any. In place of that of single
/// readings these are sizes with which readings jump.
std::string in_its_place(const Finding& f) {
  if (f.members.size() < 2) return {};
  if (f.members[0] == "scatter:reading")
    return fmt::format("they jump with {}", fmt::join(f.members.begin() + 1, f.members.end(), " or "));
  const std::string &shape = f.members[1], on = shape.substr(shape.find(':') + 1);
  if (const std::string reading = instant_of(shape); !reading.empty()) return "something changed after " + reading;
  if (shape.starts_with("step:")) return on + " differs from the others, which agree";
  if (const std::string reading = pulse_of(shape); !reading.empty()) return "something came and went about " + reading;
  if (const std::string reading = shift_of(shape); !reading.empty()) return "something changed about " + reading;
  return shape == on ? on + " is there" : "the readings follow " + on;
}

/// "the declared value of reference_drift"; an effect by its name.
std::string told(const std::string& member) {
  return member.starts_with(declared) ? fmt::format("the declared value of {}", member.substr(declared.size()))
                                      : member;
}
std::string told(const std::vector<std::string>& members) {
  std::vector<std::string> all;
  for (const std::string& one : members) all.push_back(told(one));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// A hysteresis without a condition that is the direction depends on one condition, and on from where it was reached.
std::string reversed_condition(const Finding& f) {
  const bool one = f.described_by.starts_with("hysteresis:") && f.depends_on.size() == 1;
  return one ? f.depends_on[0] : "";
}

/// @param of  indication_of
std::string what_was_found(const Finding& f, const std::string& of) {
  const std::string readings = of.empty() ? "the readings" : "the readings of " + of;
  const std::string size = size_of(f);
  const auto depends_on = fmt::format("{}", fmt::join(f.depends_on, " and "));
  switch (f.kind) {
  case Kind::named:
    if (declares(f))
      return fmt::format("The readings contradict a value that {}: {}{}.",
                         f.by_default ? "the model takes where the scenario states none" : "the scenario declares",
                         f.name.substr(declared.size()), size);
    if (!f.implausible.empty())
      return fmt::format("A part of the error looks like {}{}, but this size is {}: likely an alias of another effect.",
                         f.name, size, f.implausible);
    return fmt::format("The model lacks an effect of the machine: {}{}{}.", f.name, size,
                       f.fits_better.empty() ? "" : ", or " + f.fits_better + ", which fits better");
  case Kind::equivalence_class:
    return fmt::format("The model lacks an effect of the machine. It is one of: {}. These data cannot "
                       "distinguish them.",
                       told(f.members));
  case Kind::scatter:
    return fmt::format("The readings scatter {}{}{}.",
                       f.depends_on == std::vector<std::string>{"reading"}
                           ? "more than declared"
                           : fmt::format("from one {} to the next more than within one", depends_on),
                       size,
                       f.members.size() < 2 ? "" : ", or " + in_its_place(f) + ": these data cannot distinguish them");
  case Kind::not_in_catalogue:
    if (f.described_by.starts_with("table:"))
      return fmt::format("A part of the error repeats that no effect of the catalogue explains; it depends on {}.",
                         depends_on);
    if (const std::string condition = reversed_condition(f); !condition.empty())
      return fmt::format(
          "The readings differ between rising and falling {}, and no effect of the catalogue explains it.", condition);
    if (const std::string part = part_of_step(f.described_by); !part.empty())
      return fmt::format("Something changed with {} after {}: from then on {} with it differ by a constant.", part,
                         instant_of(f.described_by), readings);
    if (const std::string reading = instant_of(f.described_by); !reading.empty())
      return fmt::format("Something changed after {}: from then on {} differ by a constant.", reading, readings);
    if (const std::string pulse = pulse_of(f.described_by); !pulse.empty())
      return fmt::format("Something came and went about {}: for a while {} differ.", pulse, readings);
    if (const std::string reading = shift_of(f.described_by); !reading.empty())
      return fmt::format("Something changed about {}, not at once: after that {} differ by a constant.", reading,
                         readings);
    if (const std::string part = part_alone(f); !part.empty())
      return fmt::format("An unknown effect changes the readings of {} alone with {}.", part, f.depends_on[0]);
    if (const std::string step = "step:";
        f.described_by.starts_with(step) && f.described_by.find(f.depends_on[0] + " ") != std::string::npos)
      return fmt::format("{} differs from the others by a constant.", f.described_by.substr(step.size()));
    return fmt::format("An unknown effect changes {} {}with {}.", readings,
                       f.described_by.starts_with("wave:") ? "periodically " : "", depends_on);
  }
  return {};
}

} // namespace

std::string briefly(const Finding& f) {
  const auto depends_on = fmt::format("{}", fmt::join(f.depends_on, " and "));
  switch (f.kind) {
  case Kind::named:
    return told(f.name) + size_of(f);
  case Kind::equivalence_class:
    return fmt::format("one of {}", told(f.members));
  case Kind::scatter:
    return fmt::format("scatter from one {} to the next{}{}", depends_on, size_of(f),
                       f.members.size() < 2 ? "" : ", or " + in_its_place(f));
  case Kind::not_in_catalogue:
    if (const std::string condition = reversed_condition(f); !condition.empty())
      return "a difference between rising and falling " + condition;
    if (const std::string reading = instant_of(f.described_by); !reading.empty()) {
      const std::string part = part_of_step(f.described_by);
      return fmt::format("a step{} after {}", part.empty() ? "" : " of " + part, reading);
    }
    if (const std::string reading = pulse_of(f.described_by); !reading.empty()) return "a pulse about " + reading;
    if (const std::string reading = shift_of(f.described_by); !reading.empty())
      return "a gradual step about " + reading;
    if (const std::string part = part_alone(f); !part.empty())
      return fmt::format("an unknown effect of {} on {} alone", f.depends_on[0], part);
    return "an unknown effect of " + depends_on;
  }
  return {};
}

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
    return fmt::format("On held-out readings the error {} {}{}; noise alone gives {}.{}",
                       change(r.holdout_before_winsorised, r.holdout_after_winsorised, r), with,
                       bad ? fmt::format(" (bad readings cut; the worst, {}, is off by {})", r.worst_point,
                                         shown_rms(r.worst_point_after, r))
                           : "",
                       shown_rms(r.holdout_noise, r),
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
      shown_size(std::fabs(worst.residual), units::error_unit(worst.unit, worst.si_unit), worst.si_unit);
  return count == 1
             ? fmt::format("One reading is outlying: {}, by {}. Check it.", worst.reading, off)
             : fmt::format("{} readings are outlying; the worst, {}, by {}. Check them.", count, worst.reading, off);
}

/// Nothing was found: are the residuals as small as noise makes them?
std::string what_residuals_show(const Trace& t) {
  const Rms& r = t.rms;
  constexpr const char* lacks = "the model or the declared noise lacks something that these data do not identify.";
  const std::string noise = std::isfinite(r.noise_high) ? in_95(r.noise_low, r.noise_high, r) : shown_rms(r.noise, r);
  constexpr const char* chance = "noise alone gives as much in one case of forty, or"; // beyond 97.5 %
  const std::string bad = bad_readings(t);
  if (held_out_exceeds(r) && !bad.empty()) return "No candidate explains it. " + bad;
  constexpr double by_far = 1.5; // no chance of one in forty
  if (held_out_exceeds(r))
    return fmt::format("No candidate explains it: {}{}",
                       r.holdout_after_winsorised > by_far * r.holdout_noise_high ? "" : std::string(chance) + " ",
                       lacks);
  if (r.before > r.noise_high && t.p_anything > t.alpha && !t.outliers.empty())
    return fmt::format(
        "The residuals of the training data ({}) are larger than noise alone gives ({}), because {} outlying; "
        "the worst, {}, by {}. Check it.",
        shown_rms(r.before, r), noise,
        t.outliers.size() == 1 ? "one reading is" : fmt::format("{} readings are", t.outliers.size()),
        t.outliers[0].reading, shown_rms(std::fabs(t.outliers[0].residual), r));
  if (r.before > r.noise_high)
    return fmt::format("No candidate explains the residuals, but those of the training data ({}) are larger than noise "
                       "alone gives ({}): {} {}",
                       shown_rms(r.before, r), noise, chance, lacks);
  // Nothing agrees whose chance is small.
  if (t.p_anything <= t.alpha)
    return fmt::format("No candidate explains the residuals ({}), but noise alone gives residuals like these in only "
                       "{:.2g} % of cases: {}",
                       shown_rms(r.before, r), 100 * t.p_anything, lacks);
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
                     "gives ({}).{}",
                     shown_rms(r.before, r), noise, bad.empty() ? "" : " " + bad);
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
  if (out.empty())
    out = {what_residuals_show(t),
           "Effects smaller than the detection limits may still be present; the table lists those limits."};
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
