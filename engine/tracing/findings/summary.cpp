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

std::string what_to_do(const Finding& f, const Rms& r) {
  if (f.kind == Kind::scatter) return "It cannot be corrected for; include it in the uncertainty budget.";
  if (f.kind == Kind::equivalence_class && !f.suggestion.empty()) return "To distinguish them, " + f.suggestion + ".";
  if (std::isfinite(r.holdout_after))
    return fmt::format("On held-out readings the error falls from {} to {} with it; noise alone gives {}.",
                       shown_rms(r.holdout_before, r), shown_rms(r.holdout_after, r), shown_rms(r.holdout_noise, r));
  return fmt::format("In the training data the error falls from {} to {} with it; no readings were held out to check.",
                     shown_rms(r.before, r), shown_rms(r.after, r));
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
    out.plain = {
        fmt::format("The measured values agree with the model: the residuals ({}) are no larger than noise alone ({}).",
                    shown_rms(r.before, r), shown_rms(r.noise, r)),
        "Effects smaller than the detection limits may still be present; the table lists those limits."};
  }
}

} // namespace gumshoe::tracing
