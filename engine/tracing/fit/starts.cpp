#include "tracing/fit/starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/special_values.h"
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
    left_.push_back(valid[index(k)] && std::isfinite(squares) ? squares : infinity);
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

double Starts::ratio() const {
  const double least = left_.empty() ? infinity : std::ranges::min(left_);
  return std::isfinite(least) ? freedom_ * std::log(none_.squaredNorm() / least) : 0;
}

std::optional<Start> Starts::best() const {
  const auto least = std::ranges::min_element(left_);
  if (least == left_.end() || !std::isfinite(*least)) return std::nullopt;
  return Start{at_.col(least - left_.begin()), ratio(), turns()};
}

/// If any of the statistics exceeds a limit, the first does, or an edge of the tree leads from one below the limit to
/// one above it; the probability of that grows with the angle (Prim 1957 for the tree).
double Starts::turns() const {
  Matrix along = moved_(Eigen::all, moving());
  along.colwise().normalize();
  const Index n = along.cols();
  if (n == 0) return 1;
  Vector nearest = Vector::Constant(n, -1); // cosine with the tree
  std::vector<bool> joined(index(n), false);
  double out = 1;
  for (Index last = 0, k = 1; k < n; ++k) {
    joined[index(last)] = true;
    nearest = nearest.cwiseMax(along.transpose() * along.col(last));
    Index next = -1;
    for (Index i = 0; i < n; ++i)
      if (!joined[index(i)] && (next < 0 || nearest[i] > nearest[next])) next = i;
    out += std::min(1.0, criteria.turn_counts * std::acos(std::clamp(nearest[next], -1.0, 1.0)));
    last = next;
  }
  return out;
}

std::vector<Index> Starts::moving() const {
  std::vector<Index> out;
  for (Index k = 0; k < moved_.cols(); ++k)
    if (std::isfinite(left_[index(k)]) && moved_.col(k).squaredNorm() > 0) out.push_back(k);
  return out;
}

} // namespace gumshoe::tracing
