#include "models/tool_length/procedures.h"

#include <algorithm>

#include <fmt/format.h>

namespace gumshoe::models::tool_length {

namespace {

double whole_turn(double angle) { return angle - 2 * pi * std::floor(angle / (2 * pi)); }

/// Flutes of the curve are numbered from the longest that shows, in the order of their seats. All but the residuals.
CurveRows curve_rows(const Quantities<double>& q, const Event<double>& event, std::size_t readings,
                     const double* lengths, const bool* seen, double holder, double tool_length) {
  const int n = flutes(q);
  int longest = -1, shown = 0;
  for (int k = 0; k < n; ++k) {
    shown += seen[k];
    if (seen[k] && (longest < 0 || lengths[k] > lengths[longest])) longest = k;
  }
  CurveRows out{};
  out.tool_length = tool_length;
  out.effective_length = lengths[longest];
  out.phase = whole_turn(holder + flute(q, event, longest).azimuth);
  out.seen_flutes = shown;
  out.degrees_of_freedom = static_cast<double>(readings) - 1.0 - shown;
  for (int k = 0; k < n; ++k) {
    const int j = (longest + k) % n;
    out.flute[static_cast<std::size_t>(k)] = {lengths[j], lengths[longest] - lengths[j], seen[j] ? 1.0 : 0.0};
  }
  return out;
}

/// Local maxima of the indications around the turn, highest first; of equal neighbours the first.
std::vector<double> peaks_of(const Heights& all) {
  std::vector<double> h, found;
  for (const Height& r : all)
    if (h.empty() || r.height != h.back()) h.push_back(r.height);
  while (h.size() > 1 && h.back() == h.front()) h.pop_back();
  const std::size_t n = h.size();
  for (std::size_t i = 0; i < n; ++i)
    if (n == 1 || (h[i] > h[(i + n - 1) % n] && h[i] > h[(i + 1) % n])) found.push_back(h[i]);
  std::ranges::sort(found, std::greater());
  return found;
}

/// True lengths of the flutes; returns how many.
int true_lengths(const Readings& all, const std::vector<Shown>& shown, double* lengths, Outcome<double>& outcome) {
  const auto& q = all.at[0].q;
  outcome.refuse(q.inserts != all.at.back().q.inserts, "inserts differ between readings");
  const int n = flutes(q);
  for (int k = 0; k < n; ++k) lengths[k] = q.tool_length - flute(q, shown[0].event, k).raise;
  return n;
}

/// Rows without those of flutes that are not there.
template <class All> std::size_t with_flutes(const Quantities<double>& q) {
  const auto missing = chain::most_inserts - std::clamp(q.inserts, 1.0, 1.0 * chain::most_inserts);
  return (sizeof(All) - static_cast<std::size_t>(missing) * sizeof(FluteRows)) / sizeof(double);
}

std::string problem_of_turn(const Readings& all, bool one_height) {
  if (all.size() == 0) return "there is no reading; at least one is needed";
  const auto differs = [](double a, double b) { return std::fabs(a - b) > 1e-12 * std::fabs(b); };
  const auto& first = all.at[0];
  for (std::size_t r = 1; r < all.size(); ++r) {
    const auto &c = all.at[r].c, &before = all.at[r - 1].c;
    if (all.at[r].q.inserts != first.q.inserts) return fmt::format("inserts differ between readings 1 and {}", r + 1);
    if (differs(c.feed, first.c.feed))
      return fmt::format("feed differs between readings 1 and {}: they belong to different curves", r + 1);
    if (differs(c.spindle_speed, first.c.spindle_speed))
      return fmt::format("spindle_speed differs between readings 1 and {}: they belong to different curves", r + 1);
    if (one_height && differs(c.start_height, first.c.start_height))
      return fmt::format("start_height differs between readings 1 and {}: their points cannot be connected", r + 1);
    if (!differs(c.start_height, before.start_height) && !(c.start_angle > before.start_angle))
      return fmt::format(
          "start_angle of reading {} ({:g} deg) does not exceed that of reading {} ({:g} deg): the angles must "
          "increase",
          r + 1, c.start_angle / deg, r, before.start_angle / deg);
    if (c.start_angle - first.c.start_angle > 2 * pi * (1 - 1e-12))
      return fmt::format("start_angle of reading {} is a turn or more after the first: angles repeat", r + 1);
  }
  return "";
}

} // namespace

LengthRows Single::evaluate(const Readings& all, Workspace& work, Outcome<double>& outcome) {
  find_heights(all, work.heights, outcome);
  return {work.heights[0].height + least_raise(work.heights[0]), work.heights[0].height};
}
LengthRows Single::truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome) {
  double lengths[chain::most_inserts];
  const int n = true_lengths(all, shown, lengths, outcome);
  return {all.at[0].q.tool_length, *std::max_element(lengths, lengths + n)};
}
std::string Single::check(const Readings& all) {
  if (all.size() == 0) return "there is no reading; at least one is needed";
  if (all.size() == 1) return "";
  return fmt::format("there are {} readings, but this evaluation uses only one; peaks and characteristic_curve use "
                     "several",
                     all.size());
}

CurveRows Curve::evaluate(const Readings& all, Workspace& work, Outcome<double>& outcome) {
  find_heights(all, work.heights, outcome);
  if (outcome.failed) return {};
  const Height& first = work.heights[0];
  work.curves.next_sample();
  if (!prepare(work.heights, work.curves, work.data)) return outcome.fail(Status::never_covered), CurveRows{};
  const CurveFit fit = fit_curve(work.data);
  if (!fit.converged) return outcome.fail(Status::not_converged), CurveRows{};
  double lengths[chain::most_inserts], effective = -1e300;
  for (int k = 0; k < flutes(first.at.q); ++k) {
    const auto at = static_cast<std::size_t>(k);
    lengths[k] = fit.heights[at];
    if (fit.seen[at]) effective = std::max(effective, lengths[k]);
  }
  const double length = effective + least_raise(first);
  // A line's phase is start_height + tool_length: what it shows beyond turns the holder.
  CurveRows out = curve_rows(first.at.q, first.event, all.size(), lengths, fit.seen.data(),
                             first.at.q.holder_angle + (fit.phase - line_of(first) - length) / work.data.drop, length);
  out.residual_rms = std::sqrt(fit.squares / static_cast<double>(all.size()));
  return out;
}
CurveRows Curve::truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome) {
  double lengths[chain::most_inserts];
  bool exists[chain::most_inserts], seen[chain::most_inserts] = {};
  const int n = true_lengths(all, shown, lengths, outcome);
  std::fill_n(exists, n, true);
  for (const Shown& s : shown) seen[s.insert] = true;
  const auto& q = all.at[0].q;
  CurveRows out = curve_rows(q, shown[0].event, all.size(), lengths, exists, q.holder_angle, q.tool_length);
  const auto longest = std::max_element(lengths, lengths + n) - lengths;
  out.seen_flutes = static_cast<double>(std::count(seen, seen + n, true));
  out.degrees_of_freedom = static_cast<double>(all.size()) - 1.0 - out.seen_flutes;
  for (int k = 0; k < n; ++k) out.flute[static_cast<std::size_t>(k)].seen = seen[(longest + k) % n];
  return out;
}
std::string Curve::check(const Readings& all) {
  if (std::string problem = problem_of_turn(all, false); !problem.empty()) return problem;
  const int n = flutes(all.at[0].q);
  if (all.size() < static_cast<std::size_t>(n) + 1)
    return fmt::format("{} reading{} for {} unknowns: {} flute height{} and the phase", all.size(),
                       all.size() == 1 ? "" : "s", n + 1, n, n == 1 ? "" : "s");
  Outcome<double> outcome;
  for (const auto& at : all.at) check_together(at, outcome);
  Heights heights;
  if (!outcome.failed) find_heights(all, heights, outcome);
  if (outcome.failed) return "";
  Curves curves;
  CurveReadings data;
  if (!prepare(heights, curves, data)) return "no flute covers the beam at any angle: the offset is too large";
  // From above all flutes the curve repeats every turn of the start angle.
  for (std::size_t r = 0; r < all.size(); ++r)
    for (int k = 0; k < n; ++k) {
      const double needed = data.curves[r * data.flutes + static_cast<std::size_t>(k)]->highest() -
                            flute(heights[r].at.q, heights[r].event, k).raise;
      const double start_height = all.at[r].c.start_height;
      if (start_height < needed)
        return fmt::format("start_height of reading {} is {:g} mm, where flute {} may already be in the beam: the "
                           "feed must start above {:.4f} mm",
                           r + 1, start_height / mm, k + 1, needed / mm);
    }
  return "";
}
std::size_t Curve::in_use(const Quantities<double>& q) { return with_flutes<CurveRows>(q); }

PeakRows Peaks::evaluate(const Readings& all, Single::Workspace& work, Outcome<double>& outcome) {
  find_heights(all, work.heights, outcome);
  if (outcome.failed) return {};
  const Height& first = work.heights[0];
  const auto peaks = peaks_of(work.heights);
  const int n = flutes(first.at.q);
  PeakRows out{{peaks[0] + least_raise(first), peaks[0]}, static_cast<double>(peaks.size()), {}};
  const double per_flute = 2 * pi * drop(first) / n; // a flute shorter by more has no peak
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
    const bool seen = k < peaks.size();
    const double length = seen ? peaks[k] : peaks[0] - per_flute;
    out.flute[k] = {length, peaks[0] - length, seen ? 1.0 : 0.0};
  }
  return out;
}
PeakRows Peaks::truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome) {
  double lengths[chain::most_inserts];
  const int n = true_lengths(all, shown, lengths, outcome);
  std::sort(lengths, lengths + n, std::greater());
  PeakRows out{{all.at[0].q.tool_length, lengths[0]}, static_cast<double>(n), {}};
  for (int k = 0; k < n; ++k) out.flute[static_cast<std::size_t>(k)] = {lengths[k], lengths[0] - lengths[k], 1};
  return out;
}
std::string Peaks::check(const Readings& all) { return problem_of_turn(all, true); }
std::size_t Peaks::in_use(const Quantities<double>& q) { return with_flutes<PeakRows>(q); }

} // namespace gumshoe::models::tool_length
