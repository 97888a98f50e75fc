#include "models/tool_length/procedures.h"

#include <algorithm>
#include <list>
#include <vector>

#include <fmt/format.h>

#include "models/tool_length/curve_fit.h"

namespace gumshoe::models::tool_length {

namespace {

constexpr double pi = 3.14159265358979323846;

/// One reading of one sample.
struct Reading {
  double q[count], condition[conditions];
  std::vector<double> effects;
  PointCall<double> point; ///< of these
  Event<double> event;
  double height = 0; ///< of the spindle above the beam's axis at the trigger, effects removed
};

class Readings {
public:
  explicit Readings(const BlockCall& call) : all_(call.readings), call_(call) {
    for (Reading& r : all_) {
      r.effects.resize(call.effect_quantities + 1);
      r.point.quantities = r.q;
      r.point.effects = r.effects.data();
      r.point.active = call.active;
      r.point.conditions = r.condition;
      r.point.evaluation = call.evaluation;
    }
  }

  std::vector<Reading>& load(std::size_t sample) {
    const auto at = [&](const Column& c) { return c.data[c.stride * sample]; };
    for (std::size_t r = 0; r < call_.readings; ++r) {
      Reading& x = all_[r];
      for (std::size_t j = 0; j < count; ++j) x.q[j] = at(call_.quantities[r * count + j]);
      for (std::size_t j = 0; j < call_.effect_quantities; ++j)
        x.effects[j] = at(call_.effects[r * call_.effect_quantities + j]);
      for (std::size_t j = 0; j < conditions; ++j)
        x.condition[j] = at(call_.conditions[r * conditions + j]);
      if (!call_.indications) continue;
      const double z = at(call_.indications[r]);
      x.q[length] = z - x.q[laser_z]; // what grows with the length does so by that of the readout
      x.event = outcome_at(solver_, x.q, x.point, false).event;
      x.height = chain::actual_of(z, x.event) - x.q[laser_z] - x.event.tool_growth;
    }
    return all_;
  }

private:
  TriggerSolver solver_;
  std::vector<Reading> all_;
  const BlockCall& call_;
};

int flutes_of(const Reading& r) { return std::clamp(static_cast<int>(r.q[inserts]), 1, chain::most_inserts); }
double drop(const Reading& r) { return motion(r.q, r.event, r.condition).drop; }
/// Of the lines on which readings come down, where this one's is: m, but for what all share.
double line_of(const Reading& r) {
  const auto m = motion(r.q, r.event, r.condition);
  return m.height + m.drop * m.angle;
}
double least_raise(const Reading& r) { return least_raise(r.q, r.event); }

bool possible(const std::vector<Reading>& all) {
  for (const Reading& r : all)
    if (impossible(r.q, r.condition, r.event) || r.q[inserts] != all[0].q[inserts]) return false;
  return true;
}

/// Trigger curves of the flutes at hand; what is equal is tabulated once, from sample to sample, too.
class Curves {
public:
  /// Null if no cover is ever reached.
  const TriggerCurve* at(const Insert<double>& insert, const Beam<double>& beam, double drop) {
    const InsertHeight& heights = solver_.heights(insert, beam);
    for (const Known& k : known_)
      if (k.drop == drop && k.insert == insert && k.beam == beam) return &k.curve;
    if (!heights.ever_covered()) return nullptr;
    known_.push_front({insert, beam, drop, TriggerCurve(heights, drop)});
    return &known_.front().curve;
  }
  /// Keeps the pointers of one sample alive.
  void next_sample() {
    if (known_.size() > 2 * chain::most_inserts) known_.clear();
  }

private:
  struct Known {
    Insert<double> insert;
    Beam<double> beam;
    double drop;
    TriggerCurve curve;
  };
  TriggerSolver solver_;
  std::list<Known> known_;
};

/// False if no flute ever covers the beam.
bool prepare(const std::vector<Reading>& all, Curves& curves, CurveReadings& data) {
  const int n = flutes_of(all[0]);
  data.readings = all.size();
  data.flutes = static_cast<std::size_t>(n);
  data.drop = drop(all[0]);
  data.curves.clear();
  data.lines.clear();
  data.heights.clear();
  data.alike = true;
  const double reference = line_of(all[0]); // what all readings share leaves no trace in the fit
  for (const Reading& r : all) {
    const auto m = motion(r.q, r.event, r.condition);
    const double line = line_of(r) - reference;
    data.heights.push_back(r.height);
    for (int k = 0; k < n; ++k) {
      const auto f = flute(r.q, r.event, k);
      data.curves.push_back(curves.at(f.insert, beam(r.q), m.drop));
      if (!data.curves.back()) return false;
      data.lines.push_back(line + m.drop * f.azimuth);
      data.alike &= data.curves.back() == data.curves[data.curves.size() - 1 - static_cast<std::size_t>(k)] &&
                    std::fabs(f.azimuth - 2 * pi * k / n) < 1e-12;
    }
  }
  return true;
}

/// Where a sample's results go.
struct Results {
  const BlockCall& call;
  std::size_t sample;
  void set(int row, double x) const { call.measurands[row][sample] = x; }
  void flute(int first, int k, double length, double longest, bool seen) const {
    set(first + flute_rows * k + flute_length_row, length);
    set(first + flute_rows * k + wear_difference_row, longest - length);
    set(first + flute_rows * k + seen_row, seen);
  }
  void fail(Status status) const {
    call.status[sample] = code(status);
    const std::size_t rows = measurands_in_use(call.evaluation, inserts_.data());
    for (std::size_t m = 0; m < rows; ++m) call.measurands[m][sample] = std::nan("");
  }
  std::vector<double> inserts_;
};

double whole_turn(double angle) { return angle - 2 * pi * std::floor(angle / (2 * pi)); }

/// Flutes of the curve are numbered from the longest that shows, in the order of their seats.
void write_curve(const Results& results, const Reading& reading, const double* lengths, const bool* seen, double holder,
                 double tool_length) {
  const int n = flutes_of(reading);
  int longest = -1, shown = 0;
  for (int k = 0; k < n; ++k) {
    shown += seen[k];
    if (seen[k] && (longest < 0 || lengths[k] > lengths[longest])) longest = k;
  }
  results.set(joint_length_row, tool_length);
  results.set(joint_effective_row, lengths[longest]);
  results.set(phase_row, whole_turn(holder + flute(reading.q, reading.event, longest).azimuth));
  results.set(seen_flutes_row, shown);
  results.set(freedom_row, static_cast<double>(results.call.readings) - 1.0 - shown);
  for (int k = 0; k < n; ++k) {
    const int j = (longest + k) % n;
    results.flute(curve_rows, k, lengths[j], lengths[longest], seen[j]);
  }
}

void evaluate_curve(const Results& results, const std::vector<Reading>& all, const CurveReadings& data) {
  const CurveFit fit = fit_curve(data);
  if (!fit.converged) return results.fail(Status::not_converged);
  double lengths[chain::most_inserts], effective = -1e300;
  for (int k = 0; k < flutes_of(all[0]); ++k) {
    const auto at = static_cast<std::size_t>(k);
    lengths[k] = fit.heights[at];
    if (fit.seen[at]) effective = std::max(effective, lengths[k]);
  }
  const double length = effective + least_raise(all[0]);
  // A line's phase is start_height + tool_length: what it shows beyond turns the holder.
  write_curve(results, all[0], lengths, fit.seen.data(),
              all[0].q[holder_angle] + (fit.phase - line_of(all[0]) - length) / data.drop, length);
  results.set(residual_row, std::sqrt(fit.squares / static_cast<double>(all.size())));
}

/// Local maxima of the readouts around the turn, highest first; of equal neighbours the first.
std::vector<double> peaks_of(const std::vector<Reading>& all) {
  std::vector<double> h, found;
  for (const Reading& r : all)
    if (h.empty() || r.height != h.back()) h.push_back(r.height);
  while (h.size() > 1 && h.back() == h.front()) h.pop_back();
  const std::size_t n = h.size();
  for (std::size_t i = 0; i < n; ++i)
    if (n == 1 || (h[i] > h[(i + n - 1) % n] && h[i] > h[(i + 1) % n])) found.push_back(h[i]);
  std::ranges::sort(found, std::greater());
  return found;
}

void evaluate_peaks(const Results& results, const std::vector<Reading>& all) {
  const auto peaks = peaks_of(all);
  const int n = flutes_of(all[0]);
  results.set(joint_length_row, peaks[0] + least_raise(all[0]));
  results.set(joint_effective_row, peaks[0]);
  results.set(peaks_row, static_cast<double>(peaks.size()));
  const double per_flute = 2 * pi * drop(all[0]) / n; // a flute shorter by more has no peak
  for (int k = 0; k < n; ++k) {
    const bool seen = static_cast<std::size_t>(k) < peaks.size();
    results.flute(peak_rows, k, seen ? peaks[static_cast<std::size_t>(k)] : peaks[0] - per_flute, peaks[0], seen);
  }
}

/// The truth, in the layout of the evaluation. `seen`: which flutes triggered a reading.
void write_truth(const Results& results, const Reading& r, const bool* seen) {
  const int n = flutes_of(r);
  double lengths[chain::most_inserts];
  bool exists[chain::most_inserts];
  for (int k = 0; k < n; ++k) lengths[k] = r.q[length] - flute(r.q, r.event, k).raise, exists[k] = true;
  if (results.call.evaluation == characteristic_curve) {
    write_curve(results, r, lengths, exists, r.q[holder_angle], r.q[length]);
    const int longest = static_cast<int>(std::max_element(lengths, lengths + n) - lengths);
    int shown = 0;
    for (int k = 0; k < n; ++k) {
      results.set(curve_rows + flute_rows * k + seen_row, seen[(longest + k) % n]);
      shown += seen[k];
    }
    results.set(seen_flutes_row, shown);
    results.set(freedom_row, static_cast<double>(results.call.readings) - 1.0 - shown);
    results.set(residual_row, 0);
    return;
  }
  const double longest = *std::max_element(lengths, lengths + n);
  results.set(joint_length_row, r.q[length]);
  results.set(joint_effective_row, longest);
  if (results.call.evaluation != peaks) return;
  results.set(peaks_row, n);
  std::sort(lengths, lengths + n, std::greater());
  for (int k = 0; k < n; ++k) results.flute(peak_rows, k, lengths[k], longest, true);
}

} // namespace

std::size_t measurands_in_use(int evaluation, const double* q) {
  const auto flutes = static_cast<std::size_t>(std::clamp(q[inserts], 1.0, 1.0 * chain::most_inserts));
  return evaluation == characteristic_curve ? curve_rows + flute_rows * flutes
         : evaluation == peaks              ? peak_rows + flute_rows * flutes
                                            : static_cast<std::size_t>(lengths);
}

void simulate_together(const BlockCall& call) {
  BlockCall simulated = call;
  simulated.indications = nullptr;
  Readings readings(simulated);
  TriggerSolver solver;
  for (std::size_t i = 0; i < call.samples; ++i) {
    auto& all = readings.load(i);
    bool seen[chain::most_inserts] = {};
    auto status = Status::ok;
    for (std::size_t r = 0; r < all.size(); ++r) {
      call.simulated[r][i] = std::nan("");
      if (status != Status::ok) continue;
      const auto o = simulate(solver, all[r].point);
      all[r].event = o.event;
      status = o.trigger.height.status;
      if (status != Status::ok) continue;
      seen[o.trigger.insert] = true;
      call.simulated[r][i] = o.spindle_z;
    }
    if (all[0].q[inserts] != all.back().q[inserts]) status = Status::out_of_domain;
    const Results results{call, i, {all[0].q, all[0].q + count}};
    if (status == Status::ok)
      write_truth(results, all[0], seen);
    else
      results.fail(status);
  }
}

void evaluate_together(const BlockCall& call) {
  Readings readings(call);
  Curves curves;
  CurveReadings data;
  for (std::size_t i = 0; i < call.samples; ++i) {
    const auto& all = readings.load(i);
    const Results results{call, i, {all[0].q, all[0].q + count}};
    if (call.status[i] != 0 || !possible(all)) {
      results.fail(call.status[i] != 0 ? static_cast<Status>(call.status[i])
                                       : Status::out_of_domain);
    } else if (call.evaluation == peaks) {
      evaluate_peaks(results, all);
    } else if (call.evaluation == characteristic_curve) {
      curves.next_sample();
      if (prepare(all, curves, data))
        evaluate_curve(results, all, data);
      else
        results.fail(Status::never_covered);
    } else {
      results.set(joint_length_row, all[0].height + least_raise(all[0]));
      results.set(joint_effective_row, all[0].height);
    }
  }
}

std::string check_readings(const BlockCall& call) {
  Readings readings(call);
  const auto& all = readings.load(0);
  const std::size_t m = all.size();
  if (m == 0) return "no reading: at least one readout is needed";
  if (call.evaluation == single || call.evaluation == slow)
    return m == 1 ? ""
                  : fmt::format("{} readings, where one readout is the measurement; peaks and characteristic_curve use "
                                "several",
                                m);
  for (std::size_t r = 1; r < m; ++r) {
    const auto differs = [&](const double* a, const double* b) { return std::fabs(*a - *b) > 1e-12 * std::fabs(*b); };
    const auto& x = all[r];
    if (x.q[inserts] != all[0].q[inserts]) return fmt::format("inserts differ between readings 1 and {}", r + 1);
    if (differs(&x.condition[feed], &all[0].condition[feed]))
      return fmt::format("feed differs between readings 1 and {}: they belong to different curves", r + 1);
    if (differs(&x.condition[speed], &all[0].condition[speed]))
      return fmt::format("spindle_speed differs between readings 1 and {}: they belong to different curves", r + 1);
    if (call.evaluation == peaks && differs(&x.condition[start_height], &all[0].condition[start_height]))
      return fmt::format("start_height differs between readings 1 and {}: their points cannot be connected", r + 1);
    const bool same_height = !differs(&x.condition[start_height], &all[r - 1].condition[start_height]);
    if (same_height && !(x.condition[start_angle] > all[r - 1].condition[start_angle]))
      return fmt::format(
          "start_angle of reading {} ({:g} deg) does not follow that of reading {} ({:g} deg): increasing "
          "order, none twice",
          r + 1, x.condition[start_angle] * 180 / pi, r, all[r - 1].condition[start_angle] * 180 / pi);
    if (x.condition[start_angle] - all[0].condition[start_angle] > 2 * pi * (1 - 1e-12))
      return fmt::format("start_angle of reading {} is a turn or more after the first: angles repeat", r + 1);
  }
  if (call.evaluation != characteristic_curve) return "";
  const int n = flutes_of(all[0]);
  if (m < static_cast<std::size_t>(n) + 1)
    return fmt::format("{} reading{} for {} unknowns: {} flute height{} and the phase", m, m == 1 ? "" : "s", n + 1, n,
                       n == 1 ? "" : "s");
  // From above all flutes the curve repeats every turn of the start angle.
  Curves curves;
  CurveReadings data;
  if (!possible(all)) return "";
  if (!prepare(all, curves, data)) return "no flute ever covers the beam: the offset is too large";
  for (std::size_t r = 0; r < m; ++r)
    for (int k = 0; k < n; ++k) {
      const double needed = data.curves[r * data.flutes + static_cast<std::size_t>(k)]->highest() -
                            flute(all[r].q, all[r].event, k).raise;
      if (all[r].condition[start_height] < needed)
        return fmt::format("start_height of reading {} is {:g} mm, where flute {} may already be in the beam: above "
                           "{:.4f} mm the curve repeats every turn",
                           r + 1, all[r].condition[start_height] * 1e3, k + 1, needed * 1e3);
    }
  return "";
}

} // namespace gumshoe::models::mill
