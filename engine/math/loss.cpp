#include <cmath>

#include "math/least_squares.h"

namespace gumshoe::least_squares {

const char* name(Loss loss) {
  switch (loss) {
  case Loss::huber:
    return "huber";
  case Loss::cauchy:
    return "cauchy";
  case Loss::tukey:
    return "tukey";
  default:
    return "squared";
  }
}

double usual_width(Loss loss) {
  switch (loss) {
  case Loss::huber:
    return 1.345;
  case Loss::cauchy:
    return 2.385;
  case Loss::tukey:
    return 4.685;
  default:
    return 1;
  }
}

double weight(Loss loss, double residual, double width) {
  const double a = std::fabs(residual), q = (a / width) * (a / width);
  switch (loss) {
  case Loss::huber:
    return a <= width ? 1 : width / a;
  case Loss::cauchy:
    return 1 / (1 + q);
  case Loss::tukey:
    return q < 1 ? (1 - q) * (1 - q) : 0;
  default:
    return 1;
  }
}

} // namespace gumshoe::least_squares
