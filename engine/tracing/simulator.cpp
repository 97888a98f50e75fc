#include "tracing/simulator.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::tracing {
namespace {

Matrix columns_of(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  return Eigen::Map<const Matrix>(values.data(), static_cast<Index>(rows), static_cast<Index>(columns));
}

} // namespace

Simulator::Simulator(const propagation::Experiment& e, int threads)
    : experiment_(e), forward_(e.forward().on_threads(threads)) {}

bool Simulator::simulate(const Points& at, Vector& f) const {
  const propagation::Responses found = forward_.indications(at);
  f = columns_of(found.values, found.rows, 1);
  return found.ok();
}

void Simulator::vary(const Points& at, const std::vector<Variation>& variations, Matrix& f,
                     std::vector<bool>& valid) const {
  const propagation::Responses found = forward_.indications(at, variations);
  f = columns_of(found.values, found.rows, variations.size());
  valid.clear();
  for (const Status s : found.status) valid.push_back(s == Status::ok);
}

double Simulator::step(std::size_t quantity, const Points& at) const {
  double size = 0;
  for (const auto& p : at) size = std::max(size, std::fabs(p[quantity]));
  if (size == 0 && forward_.layout().model.contains(quantity))
    size = std::fabs(forward_.model().card->quantities[quantity].default_value);
  return 6e-6 * (size > 0 ? size : 1); // the cube root of the rounding error
}

bool Simulator::derivatives(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                            bool* kink) const {
  std::vector<propagation::Partial> partials;
  for (const std::size_t q : quantities) {
    const double h = step(q, at);
    partials.push_back({q, h, -h});
  }
  const propagation::Linearisation found = forward_.linearise(at, partials);
  f = columns_of(found.values, found.rows, 1);
  derivative = columns_of(found.derivatives, found.rows, quantities.size());
  if (kink) *kink = found.kink;
  return found.status == Status::ok;
}

} // namespace gumshoe::tracing
