#include "cli/trace_rounds.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text_file.h"
#include "cli/command.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/what_was_found.h"
#include "tracing/scenario_out/traced_scenario.h"

namespace gumshoe::cli {
namespace {

Round round_of(const tracing::Trace& t) {
  Round out{{}, {}, t.rms, t.vetoed, t.candidates};
  for (const tracing::Finding& f : t.findings) {
    out.added.push_back(f.name);
    out.told.push_back(f.kind == tracing::Kind::not_in_catalogue ? tracing::briefly(f) : f.name);
  }
  return out;
}

/// Whether a round found nothing but shapes that the one before had found and could not write: they follow the order of
/// the rows, which no scenario holds, and would be found for ever.
bool only_again(const tracing::Trace& found, const std::set<std::string>& before) {
  return !found.findings.empty() && found.corrections.empty() &&
         std::ranges::all_of(found.findings, [&](const tracing::Finding& f) {
           return f.kind == tracing::Kind::not_in_catalogue && before.contains(f.described_by);
         });
}

/// The scenario read from its text; what is wrong with it goes to `statements`.
std::optional<scenario::Scenario> readable(const std::string& text, const store::Claim& place,
                                           std::vector<std::string>& statements) {
  store::Draft trial;
  const std::string written = trial.add(place, text);
  try {
    scenario::Scenario s = scenario::read(written, catalogue());
    s.file = place.path();
    return s;
  } catch (const InputError& error) {
    // A disk that fails says nothing of the text.
    if (std::ranges::any_of(error.problems(), [](const Problem& p) { return p.what.ends_with(unreadable_file); }))
      throw;
    for (const Problem& p : error.problems())
      statements.push_back("no traced scenario is written, because it could not be read: " + p.what +
                           (p.why.empty() ? "" : " (" + p.why + ")"));
  }
  return std::nullopt;
}

} // namespace

Rounds trace_rounds(const scenario::Scenario& s, const tracing::Settings& settings, const store::Claim& place,
                    int most) {
  const std::string folder = std::filesystem::path(place.path()).parent_path().string();
  Rounds out;
  std::optional<scenario::Scenario> at;
  std::set<std::string> shapes; ///< found in the round before, and not written
  while (static_cast<int>(out.table.size()) < most) {
    const tracing::Trace found = tracing::trace(at ? *at : s, settings);
    if (out.table.empty()) out.first = found;
    out.table.push_back(round_of(found));
    if (only_again(found, shapes)) {
      Round& last = out.table.back();
      last.added.clear();
      last.told.clear();
      last.rms.after = last.rms.before;
      last.rms.holdout_after = last.rms.holdout_before;
      out.first.statements.push_back(
          fmt::format("{} follows the order of the rows, which the traced scenario does not "
                      "hold: it is part of its noise; record what "
                      "it depends on as a condition, such as direction = {{ column = \"...\", sense = true }}",
                      found.findings.front().described_by));
      break;
    }
    shapes.clear();
    for (const tracing::Finding& f : found.findings)
      if (std::ranges::find(found.corrections, f.described_by, &tracing::Correction::shape) == found.corrections.end())
        shapes.insert(f.described_by);
    const std::string text = tracing::traced_scenario(at ? *at : s, found, folder);
    if (text.empty()) break;
    auto next = readable(text, place, out.first.statements);
    if (!next) break;
    out.text = text;
    next->trace.draws = s.trace.draws; // as the command line says
    next->trace.seed = s.trace.seed;
    at = std::move(next);
    if (found.findings.empty() || found.vetoed) break;
  }
  return out;
}

std::string table(const std::vector<Round>& rounds) {
  // What is held out has a noise of its own: the fit has not taken its part of these readings.
  std::string out = fmt::format("{:<5}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}   added\n", "round",
                                "before", "after", "noise", "floor", "held out", "after", "noise");
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    const tracing::Rms& r = rounds[k].rms;
    const auto show = [&](double si) { // all in one unit
      return std::isfinite(si) ? tracing::shown_rms(si, rounds.front().rms) : "-";
    };
    const std::string added = rounds[k].vetoed          ? "nothing: the held-out readings are not predicted better"
                              : rounds[k].added.empty() ? "nothing"
                                                        : fmt::format("{}", fmt::join(rounds[k].told, "; "));
    out += fmt::format("{:<5}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}  {:>11}   {}\n", k + 1, show(r.before),
                       show(r.after), show(r.noise), show(r.replicate_floor), show(r.holdout_before),
                       show(r.holdout_after), show(r.holdout_noise), added);
  }
  return out;
}

} // namespace gumshoe::cli
