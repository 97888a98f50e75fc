#include "tracing/candidates/forms.h"

#include <algorithm>

#include "tracing/candidates/courses.h"
#include "tracing/candidates/lags.h"
#include "tracing/candidates/waves.h"

namespace gumshoe::tracing {

Candidate with_parameter(const Observations& o, const Candidate& shape, double parameter) {
  const auto covariate = [&](const std::string& name) {
    return std::ranges::find(o.covariates, name, &Covariate::name);
  };
  const auto along = covariate(shape.depends_on[0]);
  Index moved = 0;
  shape.columns.col(0).cwiseAbs().maxCoeff(&moved);
  const std::size_t indication = static_cast<std::size_t>(moved) % o.indications;
  Candidate out = shape.form == Form::wave  ? wave(o, *along, indication, parameter)
                  : shape.form == Form::lag ? lag(o, *along, *covariate(shape.depends_on[1]), indication, parameter)
                                            : drift(o, *along, indication, parameter);
  out.searched = shape.searched;
  out.parameter_u = shape.parameter_u;
  out.size_u = shape.size_u;
  return out;
}

} // namespace gumshoe::tracing
