#include "tracing/judgement/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

std::vector<RankedCandidate> ranking(const Scan& scan, const Assessment& assessment,
                                     const std::vector<Candidate>& candidates, const Design& fit,
                                     const std::map<std::size_t, std::string>& outcomes) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = a;
  // Equal signatures differ by rounding: in digits that depend on no order of sums, then as they were made.
  const auto place = [&](std::size_t a) { return std::round(std::log(assessment.p[a]) * 1e6); };
  std::ranges::stable_sort(order, std::ranges::less{}, place);
  std::vector<RankedCandidate> out;
  std::set<std::string> starts;
  for (const std::size_t a : order) {
    const Candidate& one = candidates[a];
    // Only the best start of each effect is ranked.
    if (!one.start.empty() && !starts.insert(one.name + one.amplitudes[0].scenario_name).second) continue;
    RankedCandidate line;
    line.name = one.name;
    line.shape = one.shape;
    line.family = name(one.family);
    line.parameters = static_cast<int>(one.columns.cols());
    line.statistic = assessment.data.ratio(index(a), 0);
    line.p_single = assessment.null[a].single(line.statistic);
    line.identifiable = scan.identifiable(a);
    if (line.identifiable < criteria.mostly_absorbed && scan.absorbed_by(a) >= 0) {
      const auto by = index(scan.absorbed_by(a)), fixed = fit.fixed_names.size();
      line.absorbed_by = by < fixed ? fit.fixed_names[by] : fit.random_names[by - fixed];
    }
    if (out.size() < criteria.compared)
      line.correlation = scan.correlation(order[0], a, assessment.data.covariance_model[0]);
    const auto known = outcomes.find(a);
    line.outcome = known != outcomes.end()
                       ? known->second
                       : refusal(line.identifiable, line.absorbed_by, assessment.p[a], assessment.threshold);
    out.push_back(std::move(line));
  }
  return out;
}

namespace {

/// What is known of an effect's size: whitened length of the readings' change by a unit of it, and over a finite size.
struct Response {
  std::size_t candidate = 0, amplitude = 0;
  double passes = 0, tangent = 0;
  std::vector<std::pair<double, double>> finite; ///< size, length by the unit

  /// The size that changes the readings by `needed`, with the curvature that the finite sizes show; of both signs the
  /// larger one.
  double size(double needed) const {
    const double straight = tangent > 0 ? needed / tangent : std::numeric_limits<double>::infinity();
    double out = 0;
    for (const auto& [at, length] : finite) {
      const double bend = (length - tangent) / std::fabs(at); // length of x: tangent x + bend x^2
      out = std::max(out,
                     bend > 0 ? (std::sqrt(tangent * tangent + 4 * bend * needed) - tangent) / (2 * bend) : straight);
    }
    return finite.empty() ? straight : out;
  }
};

} // namespace

std::vector<DetectionLimit> detection_limits(const Scan& scan, const Assessment& assessment,
                                             const std::vector<Candidate>& candidates) {
  const double s = std::sqrt(assessment.data.variance[0]);
  std::vector<std::pair<std::string, Response>> responses; // by effect and quantity, in the order of the candidates
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    const Candidate& one = candidates[a];
    if (!one.physical() || one.in_part() || !one.start.empty()) continue;
    const bool told = scan.identifiable(a) > criteria.absorbed_share;
    for (std::size_t j = 0; j < one.amplitudes.size(); ++j) {
      const std::string key = one.name + "/" + one.amplitudes[j].name;
      auto known = std::ranges::find(responses, key, &std::pair<std::string, Response>::first);
      const bool fresh = known == responses.end();
      if (fresh) {
        const double passes = std::sqrt(assessment.null[a].quantile(std::max(assessment.threshold, 1e-12)));
        known = responses.insert(known, {key, {a, j, passes, 0, {}}});
      }
      const double length = told ? std::sqrt(scan.information(a, index(j), assessment.data.covariance_model[0])) : 0;
      if (one.finite != 0)
        known->second.finite.emplace_back(one.finite, length);
      else if (fresh)
        known->second.tangent = length;
    }
  }
  std::vector<DetectionLimit> out;
  for (const auto& [key, response] : responses) {
    const Candidate& one = candidates[response.candidate];
    const Amplitude& amplitude = one.amplitudes[response.amplitude];
    out.push_back({one.name, amplitude.name, amplitude.unit, amplitude.si_unit,
                   response.size((response.passes + criteria.detected) * s)});
  }
  return out;
}

} // namespace gumshoe::tracing
