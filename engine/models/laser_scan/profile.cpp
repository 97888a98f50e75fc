#include "models/laser_scan/profile.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace gumshoe::models::laser_scan {

std::vector<Points> points_of(const std::vector<Rows::Conditions<double>>& conditions) {
  std::vector<Points> profiles;
  for (std::size_t r = 0; r < conditions.size(); ++r) {
    const auto& c = conditions[r];
    const auto k = static_cast<std::size_t>(c.profile);
    if (k < 1 || k > most_profiles) continue; // refused elsewhere
    if (profiles.size() < k) profiles.resize(k);
    profiles[k - 1].readings.push_back(r);
    profiles[k - 1].place.push_back({c.radius * std::cos(c.theta), c.radius * std::sin(c.theta)});
  }
  for (Points& p : profiles) {
    const auto n = static_cast<Eigen::Index>(p.readings.size());
    Eigen::MatrixXd rows(n, 3);
    double size = 0;
    for (const auto& [x, y] : p.place) size = std::max({size, std::fabs(x), std::fabs(y)});
    if (!(size > 0)) continue;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& [x, y] = p.place[static_cast<std::size_t>(i)];
      rows.row(i) << 1, x / size, y / size;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    solver.compute(rows);
    if (solver.rank() < 3) continue;
    const Eigen::MatrixXd inverse = solver.pseudoInverse();
    for (Eigen::Index i = 0; i < n; ++i) p.fit.push_back({inverse(0, i), inverse(1, i) / size, inverse(2, i) / size});
  }
  return profiles;
}

std::string Profile::check(const Together<Rows, double>& all) {
  const auto profiles = points_of(conditions_of(all));
  const auto declared = static_cast<std::size_t>(all.at[0].q.profiles);
  if (profiles.size() > declared)
    return fmt::format("a point belongs to profile {}, but there are {} (quantity profiles)", profiles.size(), declared);
  for (std::size_t k = 0; k < declared; ++k)
    if (k >= profiles.size() || profiles[k].fit.empty())
      return fmt::format("profile {} has too few points for a plane: three that are not on a line", k + 1);
  return "";
}

} // namespace gumshoe::models::laser_scan
