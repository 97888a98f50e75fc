#include "base/status.h"

#include "base/status_meaning.h"

namespace gumshoe {

const char* status_name(Status status) {
  switch (status) {
  case Status::ok:
    return "ok";
  case Status::never_covered:
    return "never_covered";
  case Status::not_converged:
    return "not_converged";
  case Status::out_of_domain:
    return "out_of_domain";
  case Status::not_finite:
    return "not_finite";
  case Status::model_failed:
    return "model_failed";
  case Status::already_covered:
    return "already_covered";
  default:
    return "no_solution";
  }
}

const char* status_meaning(Status status) {
  switch (status) {
  case Status::ok:
    return "";
  case Status::never_covered:
    return "the shadow cannot cover the share of the beam at which the trigger fires";
  case Status::not_converged:
    return "a solver did not reach its tolerance";
  case Status::out_of_domain:
    return "a value is impossible, such as a fillet larger than the rod";
  case Status::not_finite:
    return "a formula has no finite value";
  case Status::model_failed:
    return "the program of the model gave no value";
  case Status::already_covered:
    return "the tool stands in the beam before it moves";
  default:
    return "the geometry or the data admit no answer";
  }
}

} // namespace gumshoe
