#include "base/status.h"

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

} // namespace gumshoe
