#include "tracing/candidates/forms.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tracing/candidates/courses.h"
#include "tracing/candidates/lags.h"
#include "tracing/candidates/waves.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {

namespace {

const Covariate& covariate(const Observations& o, const std::string& name) {
  return *std::ranges::find(o.covariates, name, &Covariate::name);
}

} // namespace

Candidate with_parameter(const Observations& o, const Candidate& shape, double parameter) {
  const Covariate& along = covariate(o, shape.depends_on[0]);
  Index moved = 0;
  shape.columns.col(0).cwiseAbs().maxCoeff(&moved);
  const std::size_t indication = static_cast<std::size_t>(moved) % o.indications;
  Candidate out = shape.form == Form::wave  ? wave(o, along, indication, parameter)
                  : shape.form == Form::lag ? lag(o, along, covariate(o, shape.depends_on[1]), indication, parameter)
                                            : drift(o, along, indication, parameter);
  out.searched = shape.searched;
  out.parameter_u = shape.parameter_u;
  out.size_u = shape.size_u;
  return out;
}

std::pair<double, double> parameter_limits(const Observations& o, const Candidate& shape) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  switch (shape.form) {
  case Form::lag:
    return limits_of_lag(covariate(o, shape.depends_on[1]));
  case Form::drift:
    return {std::log(criteria.shortest), std::log(criteria.longest)};
  default:
    return {-infinite, infinite};
  }
}

} // namespace gumshoe::tracing
