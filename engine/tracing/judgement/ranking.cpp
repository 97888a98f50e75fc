#include "tracing/judgement/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace gumshoe::tracing {

std::vector<Candidate> ranking(const Scan& scan, const Assessment& assessment,
                               const std::vector<Alternative>& alternatives, const Design& fit,
                               const std::map<std::size_t, std::string>& outcomes) {
  constexpr std::size_t compared = 40; // with the best
  std::vector<std::size_t> order(alternatives.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = a;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return assessment.p[a] < assessment.p[b]; });
  std::vector<Candidate> out;
  for (const std::size_t a : order) {
    const Alternative& one = alternatives[a];
    Candidate line;
    line.name = one.name;
    line.shape = one.shape;
    line.family = name(one.family);
    line.parameters = static_cast<int>(one.columns.cols());
    line.statistic = assessment.data.ratio(static_cast<Index>(a), 0);
    line.p_single = assessment.p[a];
    line.identifiable = scan.identifiable(a);
    if (line.identifiable < 0.1 && scan.absorbed_by(a) >= 0) {
      const auto by = static_cast<std::size_t>(scan.absorbed_by(a)), fixed = fit.fixed_names.size();
      line.absorbed_by = by < fixed ? fit.fixed_names[by] : fit.random_names[by - fixed];
    }
    if (out.size() < compared) line.correlation = scan.correlation(order[0], a, assessment.data.structure[0]);
    if (const auto it = outcomes.find(a); it != outcomes.end())
      line.outcome = it->second;
    else if (line.identifiable <= absorbed_share)
      line.outcome =
          "not testable: absorbed by " + (line.absorbed_by.empty() ? std::string("the fit") : line.absorbed_by);
    else if (assessment.p[a] > assessment.threshold)
      line.outcome = "refused: no more than chance";
    else
      line.outcome = "refused: another explains it better";
    out.push_back(std::move(line));
  }
  return out;
}

std::vector<DetectionLimit> detection_limits(const Scan& scan, const Assessment& assessment,
                                             const std::vector<Alternative>& alternatives) {
  constexpr double nine_of_ten = 1.2816; // quantile of the normal distribution
  const double s = std::sqrt(assessment.data.variance[0]);
  std::vector<DetectionLimit> out;
  std::set<std::string> seen;
  for (std::size_t a = 0; a < alternatives.size(); ++a) {
    const Alternative& one = alternatives[a];
    if (!one.physical() || one.finite != 0) continue;
    const bool told = scan.identifiable(a) > absorbed_share;
    const double passes = std::sqrt(assessment.null[a].quantile(std::max(assessment.threshold, 1e-12)));
    for (std::size_t j = 0; j < one.amplitudes.size(); ++j) {
      const Amplitude& amplitude = one.amplitudes[j];
      if (!seen.insert(one.name + "/" + amplitude.name).second) continue;
      const double information = told ? scan.information(a, static_cast<Index>(j), assessment.data.structure[0]) : 0;
      out.push_back({one.name, amplitude.name, amplitude.unit, amplitude.si_unit,
                     information > 0 ? (passes + nine_of_ten) * s / std::sqrt(information)
                                     : std::numeric_limits<double>::infinity()});
    }
  }
  return out;
}

} // namespace gumshoe::tracing
