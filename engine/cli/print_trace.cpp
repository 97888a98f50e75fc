#include "cli/print_trace.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/error.h"
#include "base/units.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/verdict_json.h"

namespace gumshoe::cli {

namespace {

using namespace tracing;

constexpr std::size_t most_listed = 12; // candidates and detection limits; the result file has all

std::string with_unit(const std::string& text, const std::string& unit) { return text + units::suffix(unit); }

/// To the place that `u` asks for; without a u to four digits.
std::string rounded(double x, double u) {
  if (!std::isfinite(x)) return "-";
  return u > 0 && std::isfinite(u) ? analysis::fixed(x, analysis::decimals_for(u)) : fmt::format("{:.4g}", x);
}

std::string two_digits(double x) { return rounded(x, std::fabs(x)); }

std::string probability(double p) { return std::isfinite(p) ? fmt::format("{:.2g}", p) : "-"; }

std::string size_text(const SizedQuantity& q) {
  const ShownSize s = shown(q);
  std::string text = fmt::format("{} = {}, u = {}, 95 % [{}, {}]", q.name, with_unit(rounded(s.value, s.u), s.unit),
                                 with_unit(rounded(s.u, s.u), s.unit), rounded(s.low95, s.u), rounded(s.high95, s.u));
  for (const auto& [label, value] : q.labels) text += fmt::format(", {} {}", label, value);
  return text;
}

/// RmsFigures in the unit of the root mean squares, or in another.
struct RmsFigures {
  std::string unit, si_unit;
  RmsFigures(std::string u, std::string si) : unit(std::move(u)), si_unit(std::move(si)) {}
  explicit RmsFigures(const Rms& r) : unit(display_unit(r)), si_unit(r.si_unit) {}
  std::string show(double si) const {
    return std::isfinite(si) ? two_digits(units::from_si(si, unit, si_unit, units::Kind::difference)) : "-";
  }
  std::string with_unit(double si) const { return cli::with_unit(show(si), unit); }
};

void print_verdict(const Trace& t) {
  for (const std::string& sentence : t.plain) std::cout << sentence << '\n';
  if (t.findings.empty())
    std::cout << (t.outcome == Outcome::insufficient_data ? "verdict: these data cannot decide\n"
                  : t.lack_of_fit.found                   ? "verdict: lack of fit\n"
                  : !t.anomalous_blocks.empty()           ? "verdict: a block differs from the others\n"
                                                          : "verdict: nothing found\n");
  if (std::isfinite(t.p_anything))
    std::cout << fmt::format("p-value of the whole search: {} ({} draws, {} candidates; false-alarm rate {:g})\n",
                             probability(t.p_anything), t.draws, t.tried, t.alpha);
  if (t.vetoed) std::cout << "the hold-out blocks are not predicted better: nothing is added\n";
}

/// @param vetoed  by the hold-out blocks: a shape is reported and not added
void print_finding(const Finding& f, bool vetoed) {
  const char* words[] = {"", " (a class: these data cannot distinguish its members)", " (scatter by label)", ""};
  const bool rejected = vetoed && f.kind == tracing::Kind::not_in_catalogue;
  std::cout << fmt::format("found: {}{}{}, p = {}\n", f.name, words[static_cast<int>(f.kind)],
                           rejected ? " (rejected by the hold-out blocks and not added)" : "", probability(f.p_value));
  if (!f.depends_on.empty()) std::cout << fmt::format("  depends on {}\n", fmt::join(f.depends_on, ", "));
  if (f.alternatives.empty())
    for (const SizedQuantity& q : f.quantities) std::cout << "  " << size_text(q) << '\n';
  for (std::size_t i = 0; i < f.alternatives.size() && i < f.members.size(); ++i) {
    std::cout << fmt::format("  {} {}\n", i == 0 ? "either" : "or", f.members[i]);
    for (const SizedQuantity& q : f.alternatives[i]) std::cout << "    " << size_text(q) << '\n';
  }
  if (f.removed_share > 0)
    std::cout << fmt::format("  left out alone, it brings back {} of the mean square of the residuals\n",
                             analysis::share_text(f.removed_share));
  if (!f.suggestion.empty()) std::cout << "  to split them: " << f.suggestion << '\n';
  for (const std::string& remark : f.remarks) std::cout << "  remark: " << remark << '\n';
}

void print_rms(const Trace& t) {
  const Rms& r = t.rms;
  const RmsFigures figures(r);
  const auto show = [&](double si) { return figures.show(si); };
  const auto line = [&](const std::string& what, double before, double after, const std::string& noise) {
    if (std::isfinite(before) || std::isfinite(after))
      std::cout << fmt::format("{:<44}{:>10}{:>10}   {}\n", what, show(before), show(after), noise);
  };
  const auto noise = [&](double middle, double low, double high) {
    return std::isfinite(low) && std::isfinite(high)
               ? fmt::format("{} (95 %: {} to {})", show(middle), show(low), show(high))
               : show(middle);
  };
  std::cout << fmt::format("{:<44}{:>10}{:>10}   noise alone\n",
                           with_unit(figures.unit.empty() || figures.unit == "1" ? "residual standard deviation"
                                                                                 : "residual standard deviation,",
                                     figures.unit),
                           "before", "after");
  line("  in sample (training data)", r.before, r.after, noise(r.noise, r.noise_low, r.noise_high));
  line("  hold-out: " + r.holdout, r.holdout_before, r.holdout_after,
       noise(r.holdout_noise, r.holdout_noise_low, r.holdout_noise_high));
  line("  worst block: " + r.worst_block, r.worst_block_before, r.worst_block_after, "");
  line("  worst point: " + r.worst_point, r.worst_point_before, r.worst_point_after, "");
  for (const IndicationError& e : t.of_indications) {
    const RmsFigures own(e.unit, e.si_unit);
    const bool held_out = std::isfinite(e.holdout_after);
    const double was = held_out ? e.holdout_before : e.before, is = held_out ? e.holdout_after : e.after;
    std::cout << fmt::format("{:<44}{:>10}{:>10}\n",
                             fmt::format("  {}: {}{}", held_out ? "hold-out" : "in sample", e.name,
                                         own.unit.empty() || own.unit == "1" ? "" : ", " + own.unit),
                             own.show(was), own.show(is));
  }
  if (std::isfinite(r.replicate_floor))
    std::cout << fmt::format("  replicate floor: readings {} scatter by {} (95 %: {} to {})\n",
                             t.lack_of_fit.cells > 1 ? "of equal conditions" : "that follow each other",
                             show(r.replicate_floor), show(r.replicate_floor_low), show(r.replicate_floor_high));
  if (std::isfinite(r.share_removed))
    std::cout << fmt::format("  {} of the removable mean square of the hold-out residuals has been removed\n",
                             r.share_removed > 1   ? "all"
                             : r.share_removed < 0 ? "nothing"
                                                   : analysis::share_text(r.share_removed));
  if (!std::isfinite(r.holdout_before) && !r.holdout.empty()) std::cout << "  hold-out: " << r.holdout << '\n';
}

void print_repeats(const Trace& t) {
  const RmsFigures figures(t.rms);
  if (const LackOfFit& l = t.lack_of_fit; std::isfinite(l.p_value) && (l.found || l.cells > 1))
    std::cout << fmt::format("lack of fit: {}, p = {} ({} set{} of equal conditions)\n",
                             l.found ? fmt::format("what repeats and is not explained is {}, by {}",
                                                   figures.with_unit(l.size), fmt::join(l.depends_on, ", "))
                                     : "what repeats is no more than chance gives",
                             probability(l.p_value), l.cells, l.cells == 1 ? "" : "s");
  for (const AnomalousBlock& b : t.anomalous_blocks)
    std::cout << fmt::format("{} differs: scatter {}, of the other blocks {}, p = {}\n", b.name,
                             figures.with_unit(b.spread), figures.with_unit(b.others), probability(b.p_value));
  for (std::size_t i = 0; i < std::min(most_listed, t.outliers.size()); ++i) {
    const Outlier& o = t.outliers[i];
    std::cout << fmt::format(
        "outlier: {}{}, residual {}, weight {:.2f}\n", o.reading,
        t.rows.size() > 0 && t.rows.back().indication > 0 ? ", " + o.indication : "",
        (o.si_unit == t.rms.si_unit ? figures : RmsFigures(o.unit, o.si_unit)).with_unit(o.residual), o.weight);
  }
  if (t.outliers.size() > most_listed)
    std::cout << fmt::format("(and {} more outliers in the result file)\n", t.outliers.size() - most_listed);
}

void print_candidates(const std::vector<RankedCandidate>& candidates) {
  if (candidates.empty()) return;
  std::size_t width = 9;
  const std::size_t n = std::min(most_listed, candidates.size());
  for (std::size_t i = 0; i < n; ++i) width = std::max(width, candidates[i].name.size());
  std::cout << fmt::format("{:<{}}  {:>9}  {:>9}  {:>6}  outcome\n", "candidate", width, "2 ln L", "p alone", "left");
  for (std::size_t i = 0; i < n; ++i) {
    const RankedCandidate& c = candidates[i];
    std::cout << fmt::format("{:<{}}  {:>9}  {:>9}  {:>5.1f}%  {}{}\n", c.name, width,
                             std::isfinite(c.statistic) ? fmt::format("{:.4g}", c.statistic) : "-",
                             probability(c.p_single), 100 * c.identifiable,
                             c.shape.empty() ? "" : "with " + c.shape + "; ", c.outcome);
  }
  if (n < candidates.size()) std::cout << fmt::format("({} more in the result file)\n", candidates.size() - n);
}

void print_limits(const std::vector<DetectionLimit>& limits) {
  if (limits.empty()) return;
  std::cout << "detectable in nine cases of ten from\n";
  for (std::size_t i = 0; i < std::min(most_listed, limits.size()); ++i) {
    const ShownSize s = shown(limits[i]);
    const std::string size =
        std::isfinite(s.value) ? with_unit(two_digits(s.value), s.unit) : "undetectable in these data";
    std::cout << fmt::format("  {}, {}: {}\n", limits[i].effect, limits[i].quantity, size);
  }
  if (limits.size() > most_listed)
    std::cout << fmt::format("({} more in the result file)\n", limits.size() - most_listed);
}

void print_noise(const Noise& n, const Rms& r) {
  const RmsFigures figures(r);
  std::string text = n.declared ? n.scale == 1 ? "as declared" : fmt::format("{:.3g} times as declared", n.scale)
                     : std::isfinite(n.scale) ? figures.with_unit(n.scale) + " of a reading, from the residuals"
                                              : "none shows in the residuals";
  if (n.correlation != 0) text += fmt::format(", correlation from reading to reading {:.2f}", n.correlation);
  if (!n.scatter.empty()) text += fmt::format(", scatter by {} {}", n.scatter, figures.with_unit(n.scatter_u));
  if (n.outliers > 0) text += fmt::format(", {} outlier{} with reduced weight", n.outliers, n.outliers == 1 ? "" : "s");
  std::cout << "noise: " << text << '\n';
}

} // namespace

void print_trace(const Trace& t, const std::string& title, const std::vector<std::string>& written,
                 const std::string& traced) {
  if (!title.empty()) std::cout << printable(title) << '\n';
  print_verdict(t);
  for (const Finding& f : t.findings) print_finding(f, t.vetoed);
  if (std::isfinite(t.rms.before)) {
    print_rms(t);
    print_noise(t.noise, t.rms);
    print_repeats(t);
  }
  print_candidates(t.candidates);
  if (t.findings.empty()) print_limits(t.detection_limits);
  for (const std::string& text : t.statements) std::cout << "note: " << text << '\n';
  if (!traced.empty())
    std::cout << fmt::format("scenario {}: {} (gumshoe run --predict says what it expects of readings, "
                             "gumshoe compensate what of it a control can correct)\n",
                             t.findings.empty() || t.vetoed ? "as fitted" : "with the findings", traced);
  else
    std::cout << "no scenario is written, because nothing would be added to it\n";
  if (!written.empty()) std::cout << fmt::format("written: {}\n", fmt::join(written, ", "));
}

} // namespace gumshoe::cli
