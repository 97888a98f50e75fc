#include "tracing/judgement/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

std::vector<RankedCandidate> ranking(const Scan& scan, const Assessment& assessment,
                                     const std::vector<Candidate>& candidates, const Design& fit,
                                     const std::map<std::size_t, std::string>& outcomes) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = a;
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return assessment.p[a] < assessment.p[b]; });
  std::vector<RankedCandidate> out;
  for (const std::size_t a : order) {
    const Candidate& one = candidates[a];
    RankedCandidate line;
    line.name = one.name;
    line.shape = one.shape;
    line.family = name(one.family);
    line.parameters = static_cast<int>(one.columns.cols());
    line.statistic = assessment.data.ratio(index(a), 0);
    line.p_single = assessment.p[a];
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
                       : refusal(line.identifiable, line.absorbed_by, line.p_single, assessment.threshold);
    out.push_back(std::move(line));
  }
  return out;
}

std::vector<DetectionLimit> detection_limits(const Scan& scan, const Assessment& assessment,
                                             const std::vector<Candidate>& candidates) {
  const double s = std::sqrt(assessment.data.variance[0]);
  std::vector<DetectionLimit> out;
  std::set<std::string> seen;
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    const Candidate& one = candidates[a];
    if (!one.physical() || one.finite != 0) continue;
    const bool told = scan.identifiable(a) > criteria.absorbed_share;
    const double passes = std::sqrt(assessment.null[a].quantile(std::max(assessment.threshold, 1e-12)));
    for (std::size_t j = 0; j < one.amplitudes.size(); ++j) {
      const Amplitude& amplitude = one.amplitudes[j];
      if (!seen.insert(one.name + "/" + amplitude.name).second) continue;
      const double information = told ? scan.information(a, index(j), assessment.data.covariance_model[0]) : 0;
      out.push_back({one.name, amplitude.name, amplitude.unit, amplitude.si_unit,
                     information > 0 ? (passes + criteria.detected) * s / std::sqrt(information)
                                     : std::numeric_limits<double>::infinity()});
    }
  }
  return out;
}

} // namespace gumshoe::tracing
