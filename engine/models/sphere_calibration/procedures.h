#pragma once
/// Joint evaluations of the sphere calibration: probe and axes from all poses together.
#include <string>
#include <vector>

#include "models/block.h"
#include "models/fit.h"
#include "models/sphere_calibration/identification.h"

namespace gumshoe::models::sphere_calibration {

template <class T> using Poses = Together<Rows, T>;

/// Names of the rows of joint_cards.
struct JointRows {
  GUMSHOE_NAMED(Measurands, probe_x, probe_y, probe_z, E_X0B, E_Z0B, E_A0B, E_C0B, E_X0C, E_Y0C, E_A0C, E_B0C,
                residual_rms, rank, condition_number);
};
/// The unknowns, in the order of the model's quantities, in the rows of the result.
template <class T> JointRows::Measurands<T> in_rows(const T* theta) {
  JointRows::Measurands<T> y{};
  y.probe_x = theta[Q::probe_x], y.probe_y = theta[Q::probe_y], y.probe_z = theta[Q::probe_z];
  y.E_X0B = theta[Q::E_X0B], y.E_Z0B = theta[Q::E_Z0B], y.E_X0C = theta[Q::E_X0C], y.E_Y0C = theta[Q::E_Y0C];
  y.E_A0B = theta[Q::E_A0B], y.E_C0B = theta[Q::E_C0B], y.E_A0C = theta[Q::E_A0C], y.E_B0C = theta[Q::E_B0C];
  y.residual_rms = y.rank = y.condition_number = T(0.0);
  return y;
}

/// Which readings are of pattern I and which of pattern II.
Patterns patterns(const Poses<double>& poses);
/// The commands of one reading by one quantity, at the declared estimates.
Vector3<double> derivative(const Poses<double>& poses, std::size_t reading, std::size_t quantity);
/// Weights from the declared uncertainties. Does not throw: empty rows and a `problem` if a command has no noise.
Whitening whitening(const Poses<double>& poses, std::string& problem);
/// Weights of the present evaluation: none except for joint_weighted.
Whitening weights(const Poses<double>& poses);

/// All three: sequential, joint, joint_weighted.
struct Identify {
  template <class T> using Measurands = JointRows::Measurands<T>;
  using Names = JointRows::MeasurandsRow;

  /// Data fixed by conditions and declarations, the same for all samples of a block.
  template <class T> struct Memory : Identification<T> {
    explicit Memory(const Poses<double>& all) : Identification<T>(all.size(), patterns(all), weights(all)) {}
  };

  template <class T>
  static Measurands<T> evaluate(const Poses<T>& all, Memory<T>& identification, Outcome<T>& outcome) {
    for (std::size_t r = 0; r < all.size(); ++r)
      identification.poses[r] = pose_of(all.at[r], {all.read[r].X, all.read[r].Y, all.read[r].Z});
    const T* declared = array_of(all.at[0].q);
    const auto found =
        all.at[0].evaluation == sequential ? identification.sequential(declared) : identification.joint(declared);
    auto y = in_rows(found.theta);
    y.residual_rms = found.residual_rms, y.rank = found.rank, y.condition_number = found.condition;
    for (std::size_t i = 0; i < numbers_in<T>; ++i) {
      if (!holds_at(found.finite, i)) outcome.fail(i, Status::out_of_domain);
      if (!holds_at(found.converged, i)) outcome.fail(i, Status::not_converged);
    }
    return y;
  }
  /// The true machine, which is the same at all readings.
  template <class T, class Shown>
  static Measurands<T> truth(const Poses<T>& poses, const std::vector<Shown>&, Outcome<T>&) {
    return in_rows(array_of(poses.at[0].q));
  }

  /// Message if all poses together are impossible; empty otherwise.
  static std::string check(const Poses<double>& poses);
  /// Directions that all commands together do not determine, among the unknowns and those quantities of links and
  /// artefact whose uncertainty all readings share.
  static std::vector<std::string> remarks(const Poses<double>& poses);
  /// What the fit itself says of the covariance of the eleven; null if it fails.
  static std::optional<Fit> fit(const Poses<double>& poses);
};

} // namespace gumshoe::models::sphere_calibration
