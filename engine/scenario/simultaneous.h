#pragma once
/// Quantities that were observed together: one joint Type A evaluation.
#include <string>
#include <vector>

#include "quantities/input_quantity.h"
#include "scenario/reader.h"

namespace gumshoe::scenario {

/// A quantity, or component, as a correlation names it; null if the name stands for several draws or for none.
struct NamedComponent {
  std::string name;
  quantities::Component* component = nullptr;
};

/// Matrix of the correlation of the means of simultaneous observations (GUM 5.2.3): row-major; empty, and problems at
/// the table, if they are not. n observations of N quantities make the means a multivariate t distribution with n - N
/// degrees of freedom and the scales sqrt(sum of squares / (n (n - N))) (JCGM 102, 5.3.2), which the components get. The
/// law of propagation keeps s/sqrt(n) with n - 1 degrees of freedom (GUM, H.2).
std::vector<double> evaluate_together(Table& correlation, const std::vector<NamedComponent>& members);

} // namespace gumshoe::scenario
