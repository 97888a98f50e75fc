#pragma once
/// A model's fit (fit.h), for its row of the catalogue. Kernels do not know it.
#include "models/adapter.h"
#include "models/fit.h"

namespace gumshoe::models::detail {

/// By the function `fit` of a joint evaluation, if it has one.
template <class M> std::optional<Fit> fit(const BlockCall& call) {
  std::optional<Fit> out;
  if constexpr (HasJoint<M>)
    with_joint<M>(call.evaluation, [&]<class J>() {
      if constexpr (requires { J::fit(first_sample<M>(call)); }) out = J::fit(first_sample<M>(call));
    });
  return out;
}

} // namespace gumshoe::models::detail

/// Defines gumshoe::models::FOLDER::fit_of for the struct TYPE of that namespace.
#define GUMSHOE_MODEL_FIT(folder, type)                                                                                \
  namespace gumshoe::models::folder {                                                                                  \
  std::optional<Fit> fit_of(const BlockCall&);                                                                         \
  std::optional<Fit> fit_of(const BlockCall& call) { return models::detail::fit<type>(call); }                         \
  }
