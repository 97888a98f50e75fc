#include "models/fit.h"

#include <algorithm>

namespace gumshoe::models {

#define GUMSHOE_MODEL(folder, type)                                                                                    \
  namespace folder {                                                                                                   \
  extern const Model model;                                                                                            \
  std::optional<Fit> fit_of(const BlockCall&);                                                                         \
  }
#include "models/catalogue.def"
#undef GUMSHOE_MODEL

namespace {

struct Row {
  const Model* model;
  FitFunction fit;
};
#define GUMSHOE_MODEL(folder, type) {&folder::model, &folder::fit_of},
const Row fits[] = {
#include "models/catalogue.def"
};
#undef GUMSHOE_MODEL

} // namespace

FitFunction fit_function(const Model& model) {
  const auto row = std::ranges::find(fits, &model, &Row::model);
  return row == std::end(fits) ? nullptr : row->fit;
}

} // namespace gumshoe::models
