/// Covariance of the eleven unknowns by the fit itself: README.md, "Covariance of a fit".
#include <algorithm>

#include <Eigen/Dense>

#include "math/parameter_covariance.h"
#include "models/sphere_calibration/procedures.h"

namespace gumshoe::models::sphere_calibration {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What was read, or what the declared machine would show.
std::vector<Vector3<double>> commands_of(const Poses<double>& poses) {
  std::vector<Vector3<double>> out;
  for (std::size_t r = 0; r < poses.size(); ++r)
    out.push_back(poses.read.empty() ? simulate(contact(poses.at[r]))
                                     : Vector3<double>{poses.read[r].X, poses.read[r].Y, poses.read[r].Z});
  return out;
}

Identified<double> identify(const Poses<double>& poses, const std::vector<Vector3<double>>& commands,
                            Identification<double>& identification) {
  for (std::size_t r = 0; r < poses.size(); ++r) identification.poses[r] = pose_of(poses.at[r], commands[r]);
  const double* declared = array_of(poses.at[0].q);
  return poses.at[0].evaluation == sequential ? identification.sequential(declared) : identification.joint(declared);
}

/// The rows of the fit, whitened if they are weighted: [row][11 derivatives and the residual].
Matrix rows_at(const double* theta, PoseRows<double>& poses, const Whitening& whitening) {
  const auto& rows = poses.linearise(theta);
  const auto n = static_cast<Eigen::Index>(rows.size());
  Matrix plain(n, unknowns + 1);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= unknowns; ++j)
      plain(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  if (whitening.rows.empty()) return plain;
  Matrix white = Matrix::Zero(n, unknowns + 1);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < whitening.rows[i].size(); ++k)
      white.row(static_cast<Eigen::Index>(i)) +=
          whitening.rows[i][k] * plain.row(static_cast<Eigen::Index>(whitening.first[i] + k));
  return white;
}

/// The unknowns by each command, by differences of a micrometre to either side: their error is that of the third
/// derivatives, 1e-11 of them on links of decimetres.
Matrix by_commands(const Poses<double>& poses, std::vector<Vector3<double>> commands,
                   Identification<double>& identification) {
  constexpr double step = 1e-6;
  Matrix out(unknowns, static_cast<Eigen::Index>(3 * commands.size()));
  for (std::size_t r = 0; r < commands.size(); ++r) {
    double* const at[] = {&commands[r].x, &commands[r].y, &commands[r].z};
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = *at[k];
      *at[k] = value + step;
      const auto above = identify(poses, commands, identification);
      *at[k] = value - step;
      const auto below = identify(poses, commands, identification);
      *at[k] = value;
      for (Eigen::Index j = 0; j < unknowns; ++j)
        out(j, static_cast<Eigen::Index>(3 * r + k)) = (above.theta[j] - below.theta[j]) / (2 * step);
    }
  }
  return out;
}

/// Row of the joint evaluations' measurands.
std::size_t row_named(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(joint_cards, name, &VariableCard::name) - std::begin(joint_cards));
}

} // namespace

std::optional<Fit> Identify::fit(const Poses<double>& poses) {
  const Whitening whitening = weights(poses);
  Identification<double> identification(poses.size(), patterns(poses), whitening);
  const auto commands = commands_of(poses);
  const auto found = identify(poses, commands, identification);
  if (!found.finite || !found.converged) return std::nullopt;
  const Matrix rows = rows_at(found.theta, identification, whitening);
  const Matrix J = rows.leftCols(unknowns);
  const auto known =
      least_squares::parameter_covariance({J.data(), J.data() + J.size()}, static_cast<std::size_t>(J.rows()), unknowns,
                                          std::vector<double>(unknowns, 1e-3), unseen_below);
  Fit out;
  out.residual_rms = row_named("residual_rms");
  out.equations = 3 * poses.size();
  out.degrees_of_freedom = static_cast<double>(out.equations - std::min<std::size_t>(out.equations, known.rank));
  if (!poses.read.empty()) out.squares = rows.col(unknowns).squaredNorm();
  out.whitened = !whitening.rows.empty();
  Matrix cofactors = Eigen::Map<const Matrix>(known.matrix.data(), unknowns, unknowns);
  if (poses.at[0].evaluation == sequential) {
    // No least squares of all rows: its residuals keep more than those of the smallest sum would.
    const Matrix A = by_commands(poses, commands, identification);
    cofactors = A * A.transpose();
    out.degrees_of_freedom = (Matrix::Identity(J.rows(), J.rows()) + J * A).squaredNorm();
  }
  std::vector<Eigen::Index> order; // of the measurands
  for (std::size_t row = 0; row < out.residual_rms; ++row) {
    const auto card = std::ranges::find(quantity_cards, joint_cards[row].name, &QuantityCard::name);
    order.push_back(card - std::begin(quantity_cards));
    out.measurands.push_back(row);
    out.determined.push_back(known.determined[static_cast<std::size_t>(order.back())]);
  }
  for (const Eigen::Index i : order)
    for (const Eigen::Index j : order) out.cofactors.push_back(cofactors(i, j));
  return out;
}

} // namespace gumshoe::models::sphere_calibration
