/// The size of what is not in the catalogue, as a curve.
#include <algorithm>
#include <cmath>

#include "tracing/criteria.h"
#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {
namespace {

/// The indication that a term moves: the last, if it moves several.
std::size_t moved_indication(const Matrix& columns, std::size_t indications) {
  for (std::size_t i = indications; i-- > 1;)
    if (columns(Eigen::seq(index(i), Eigen::last, index(indications)), Eigen::all).norm() > 0) return i;
  return 0;
}

class CurveMaker {
public:
  CurveMaker(const TraceContext& c, const JointFit& fit, std::size_t term)
      : o_(c.observations), term_(fit.terms[term]),
        indication_(moved_indication(term_.candidate.columns, o_.indications)) {
    const Index first = first_column(fit, term), d = term_.size.size();
    covariance_ = fit.covariance.block(first, first, d, d);
    const auto& card = c.experiment.model().card->indications[indication_];
    empty_.indication = card.name;
    empty_.indication_unit = card.unit;
    empty_.indication_si_unit = card.si_unit;
  }

  Curve against(const Covariate& covariate) const {
    Curve out = empty_;
    out.against = covariate.name;
    out.unit = covariate.unit;
    out.si_unit = covariate.si_unit;
    const auto group = neighbours(covariate, criteria.most_curve_points);
    for (std::size_t g = 0; g <= *std::ranges::max_element(group); ++g) {
      double sum = 0, count = 0;
      for (std::size_t r = 0; r < group.size(); ++r)
        if (group[r] == g) sum += covariate.value[r], ++count;
      if (count > 0) add(sum / count, group, g, out);
    }
    return out;
  }

  Curve against(const Grouping& label) const {
    Curve out = empty_;
    out.against = label.name;
    for (std::size_t g = 0; g < label.groups.size(); ++g)
      if (add(static_cast<double>(g), label.group, g, out)) out.levels.push_back(label.groups[g]);
    return out;
  }

private:
  /// The mean over the training readings of a group, if there are any.
  bool add(double x, const std::vector<std::size_t>& group, std::size_t which, Curve& out) const {
    const Matrix& columns = term_.candidate.columns;
    Vector mean = Vector::Zero(columns.cols());
    double count = 0;
    for (std::size_t i = 0; i < o_.sequence.size(); ++i)
      if (group[o_.sequence[i]] == which && !o_.held_out[o_.sequence[i]]) {
        mean += columns.row(index(i * o_.indications + indication_)).transpose();
        ++count;
      }
    if (count == 0) return false;
    mean /= count;
    out.x.push_back(x);
    out.y.push_back(mean.dot(term_.size));
    out.u.push_back(std::sqrt(std::max(0.0, mean.dot(covariance_ * mean))));
    return true;
  }

  const Observations& o_;
  const Term& term_;
  std::size_t indication_;
  Matrix covariance_;
  Curve empty_;
};

} // namespace

void add_curves(const TraceContext& c, const JointFit& fit, std::size_t term, Finding& finding) {
  const CurveMaker make(c, fit, term);
  const auto add = [&](const auto& all, const std::string& name) {
    for (const auto& one : all)
      if (one.name == name)
        if (Curve curve = make.against(one); !curve.x.empty()) finding.curves.push_back(std::move(curve));
  };
  for (const std::string& name : finding.depends_on) {
    add(c.observations.covariates, name);
    add(c.observations.labels, name);
  }
}

} // namespace gumshoe::tracing
