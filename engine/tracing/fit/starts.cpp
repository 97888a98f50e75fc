#include "tracing/fit/starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tracing/criteria.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {
namespace {

std::vector<Index> in_order(Index count, const auto& by) {
  std::vector<Index> out(index(count));
  std::iota(out.begin(), out.end(), Index{0});
  std::ranges::stable_sort(out, std::ranges::less{}, by);
  return out;
}

/// rad; of a vector of no length, zero.
double angle(const auto& a, const auto& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0)) : 0;
}

void append(Matrix& to, const Matrix& columns) {
  to.conservativeResize(Eigen::NoChange, to.cols() + columns.cols());
  to.rightCols(columns.cols()) = columns;
}

} // namespace

Starts::Starts(Vector none, Index amplitudes, double freedom)
    : none_(std::move(none)), freedom_(freedom), at_(amplitudes, 0), moved_(none_.size(), 0) {}

void Starts::add(const Matrix& at, const Matrix& reduced, const std::vector<bool>& valid) {
  append(at_, at);
  append(moved_, (-reduced).colwise() + none_);
  for (Index k = 0; k < at.cols(); ++k) {
    const double squares = reduced.col(k).squaredNorm();
    left_.push_back(valid[index(k)] && std::isfinite(squares) ? squares : std::numeric_limits<double>::infinity());
  }
}

Matrix Starts::between_best(double step, int batch) const {
  const auto best = in_order(at_.cols(), [&](Index k) { return left_[index(k)]; });
  const Index centres = std::min(at_.cols(), criteria.close_starts);
  Matrix out(at_.rows(), centres * criteria.starts_between);
  const Matrix by = step * normals(index(out.rows()), index(out.cols()), static_cast<std::uint64_t>(batch), 12);
  for (Index k = 0; k < out.cols(); ++k) out.col(k) = at_.col(best[index(k % centres)]) + by.col(k);
  return out;
}

std::optional<Start> Starts::best() const {
  const auto least = std::ranges::min_element(left_);
  if (least == left_.end() || !std::isfinite(*least)) return std::nullopt;
  return Start{at_.col(least - left_.begin()), freedom_ * std::log(none_.squaredNorm() / *least),
               at_.rows() == 1 ? turns() : static_cast<double>(at_.cols())};
}

double Starts::turns() const {
  const auto order = in_order(at_.cols(), [&](Index k) { return at_(0, k); });
  double out = 1;
  for (std::size_t k = 1; k < order.size(); ++k)
    out += std::min(1.0, criteria.turn_counts * angle(moved_.col(order[k - 1]), moved_.col(order[k])));
  return out;
}

} // namespace gumshoe::tracing
