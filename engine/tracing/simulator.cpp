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

std::vector<propagation::Partial> Simulator::partials(const Points& at,
                                                      const std::vector<std::size_t>& quantities) const {
  std::vector<propagation::Partial> out;
  for (const std::size_t q : quantities) {
    const double h = step(q, at);
    out.push_back({q, h, -h});
  }
  return out;
}

bool Simulator::derivatives(const Points& at, const std::vector<std::size_t>& quantities, Vector& f, Matrix& derivative,
                            bool* kink) const {
  const propagation::Linearisation found = forward_.linearise(at, partials(at, quantities));
  f = columns_of(found.values, found.rows, 1);
  derivative = columns_of(found.derivatives, found.rows, quantities.size());
  if (kink) *kink = found.kink;
  return found.status == Status::ok;
}

std::vector<std::vector<bool>> Simulator::changes_with(const Points& at,
                                                       const std::vector<std::size_t>& quantities) const {
  constexpr std::size_t most_readings = 8;
  constexpr double rounding = 1e-9;
  std::vector<std::size_t> some;
  for (std::size_t r = 0; r < forward_.readings(); r += 1 + forward_.readings() / most_readings) some.push_back(r);
  Points there;
  for (const std::size_t r : some) there.push_back(at[r]);
  const std::size_t conditions = forward_.model().card->conditions.size();
  std::vector<std::vector<bool>> out(quantities.size(), std::vector<bool>(conditions, true));
  for (std::size_t c = 0; c < conditions; ++c) {
    double low = forward_.conditions(0)[c], high = low;
    for (std::size_t r = 0; r < forward_.readings(); ++r) {
      low = std::min(low, forward_.conditions(r)[c]);
      high = std::max(high, forward_.conditions(r)[c]);
    }
    Matrix slope[2];
    bool valid = low < high;
    for (const std::size_t end : {0, 1}) {
      if (!valid) break;
      const propagation::Linearisation found =
          forward_.with_condition(some, c, end == 0 ? low : high).linearise(there, partials(at, quantities));
      valid = found.status == Status::ok;
      slope[end] = columns_of(found.derivatives, found.rows, quantities.size());
    }
    for (std::size_t i = 0; i < quantities.size() && valid; ++i) {
      const auto of = [&](std::size_t end) { return slope[end].col(static_cast<Index>(i)); };
      out[i][c] = (of(0) - of(1)).norm() > rounding * std::max(of(0).norm(), of(1).norm());
    }
  }
  return out;
}

} // namespace gumshoe::tracing
