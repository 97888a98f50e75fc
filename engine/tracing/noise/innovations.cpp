#include "tracing/noise/innovations.h"

#include <cmath>
#include <map>

namespace gumshoe::tracing {

Innovations::Innovations(const Rows& z) : rows_(z.size()) {
  std::map<std::size_t, std::size_t> last;
  for (std::size_t i = 0; i < z.size(); ++i)
    for (const auto& [effect, factor] : z[i]) last[effect] = i;
  std::map<std::size_t, Index> slot; // of the open effects
  std::vector<Index> free;
  Matrix covariance; // of the open effects, given the rows before
  for (std::size_t i = 0; i < z.size(); ++i) {
    Row& row = rows_[i];
    for (const auto& [effect, factor] : z[i]) {
      if (slot.contains(effect)) continue;
      if (free.empty()) {
        free.push_back(slots_++);
        covariance.conservativeResizeLike(Matrix::Zero(slots_, slots_));
      }
      const Index s = slot[effect] = free.back();
      free.pop_back();
      covariance.row(s).setZero();
      covariance.col(s).setZero();
      covariance(s, s) = 1;
      row.opened.push_back(s);
    }
    if (z[i].empty()) continue;
    Vector told = Vector::Zero(slots_);
    for (const auto& [effect, factor] : z[i]) {
      row.moved.push_back({slot[effect], factor});
      told += factor * covariance.col(slot[effect]);
    }
    double variance = 1;
    for (const auto& [s, factor] : row.moved) variance += factor * told[s];
    row.scale = 1 / std::sqrt(variance);
    log_determinant_ += std::log(variance);
    for (auto it = slot.begin(); it != slot.end();) {
      const auto [effect, s] = *it;
      if (last[effect] == i) { // what it was is asked no more
        free.push_back(s);
        it = slot.erase(it);
        continue;
      }
      if (told[s] != 0) row.gain.push_back({s, told[s] / variance});
      ++it;
    }
    covariance -= told * told.transpose() / variance;
  }
}

void Innovations::whiten(Matrix& x) const {
  Matrix mean = Matrix::Zero(x.rows(), slots_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    auto one = x.col(index(i));
    for (const Index s : row.opened) mean.col(s).setZero();
    for (const auto& [s, factor] : row.moved) one -= factor * mean.col(s);
    for (const auto& [s, gain] : row.gain) mean.col(s) += gain * one;
    one *= row.scale;
  }
}

} // namespace gumshoe::tracing
