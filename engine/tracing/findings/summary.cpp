/// The two sentences for a machinist.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

std::string what_was_found(const Finding& f) {
  std::string size;
  if (!f.quantities.empty())
    size = fmt::format(" ({} {})", f.quantities[0].name,
                       shown_size(f.quantities[0].value, f.quantities[0].unit, f.quantities[0].si_unit));
  const auto depends_on = fmt::format("{}", fmt::join(f.depends_on, " and "));
  switch (f.kind) {
  case Kind::named:
    if (const std::string declared = "declared:"; f.name.starts_with(declared))
      return fmt::format("The readings contradict a value that the scenario declares: {}{}.",
                         f.name.substr(declared.size()), size);
    return fmt::format("The model lacks an effect of the machine: {}{}.", f.name, size);
  case Kind::equivalence_class:
    return fmt::format("The model lacks an effect of the machine. It is one of: {}. These data cannot "
                       "distinguish them.",
                       fmt::join(f.members, ", "));
  case Kind::scatter:
    return fmt::format("The readings scatter more than declared from one {} to the next{}.", depends_on, size);
  case Kind::not_in_catalogue:
    return fmt::format("An unknown effect changes the readings with {}.", depends_on);
  }
  return {};
}

/// "falls from 4.4 um to 1.2 um", as the figures that are shown say.
std::string change(double before, double after, const Rms& r) {
  const std::string from = shown_rms(before, r), to = shown_rms(after, r);
  if (from == to) return "stays at " + from;
  return fmt::format("{} from {} to {}", after < before ? "falls" : "rises", from, to);
}

std::string what_to_do(const Finding& f, const Rms& r) {
  if (f.kind == Kind::scatter) return "It cannot be corrected for; include it in the uncertainty budget.";
  if (f.kind == Kind::equivalence_class && !f.suggestion.empty()) return "To distinguish them, " + f.suggestion + ".";
  if (std::isfinite(r.holdout_after))
    return fmt::format("On held-out readings the error {} with it; noise alone gives {}.",
                       change(r.holdout_before, r.holdout_after, r), shown_rms(r.holdout_noise, r));
  return fmt::format("In the training data the error {} with it; no readings were held out to check.",
                     change(r.before, r.after, r));
}

/// Nothing was found: are the residuals, those of the held-out readings above all, as small as noise makes them?
std::string what_residuals_show(const Rms& r) {
  const auto noise = [&](double size, double low, double high) {
    return std::isfinite(high) ? fmt::format("{} to {} in 95 % of cases", shown_rms(low, r), shown_rms(high, r))
                               : shown_rms(size, r);
  };
  const auto exceeds = [&](const char* of, double size, const std::string& alone) {
    return fmt::format("No candidate explains the residuals, but those of the {} ({}) are larger than noise alone "
                       "gives ({}): the model or the declared noise lacks something that these data do not identify.",
                       of, shown_rms(size, r), alone);
  };
  const std::string in_sample = noise(r.noise, r.noise_low, r.noise_high);
  if (r.holdout_before > r.holdout_noise_high)
    return exceeds("held-out readings", r.holdout_before,
                   noise(r.holdout_noise, r.holdout_noise_low, r.holdout_noise_high));
  if (r.before > r.noise_high) return exceeds("training data", r.before, in_sample);
  return fmt::format("The measured values agree with the model: the residuals ({}) are no larger than noise alone "
                     "gives ({}).",
                     shown_rms(r.before, r), in_sample);
}

} // namespace

void summarise(Trace& out) {
  const Rms& r = out.rms;
  if (out.outcome == Outcome::insufficient_data) {
    out.plain = {"These data are not sufficient to judge what the model lacks."};
    if (!out.statements.empty()) out.plain.push_back("Why: " + out.statements.back() + ".");
  } else if (!out.findings.empty()) {
    out.plain = {what_was_found(out.findings.front()), what_to_do(out.findings.front(), r)};
  } else if (out.vetoed) {
    out.plain = {
        "An effect was found in the training data, but it does not improve the prediction of held-out readings.",
        "Nothing is added to the model. Measure more blocks to decide."};
  } else {
    out.plain = {what_residuals_show(r),
        "Effects smaller than the detection limits may still be present; the table lists those limits."};
  }
}

} // namespace gumshoe::tracing
