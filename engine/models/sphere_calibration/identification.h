#pragma once
/// Probe and axes from the commands of many poses, on lanes: each lane is one sample's identification.
///
/// With t, r, e of contact.h the commands are x = t - r(theta) + e. Unknowns theta are the seven lengths,
/// in which r is linear, and the four orientation errors, in the order of the model's quantities. README.md has the
/// mathematics.
#include <vector>

#include "math/symmetric.h"
#include "models/sphere_calibration/pose_rows.h"

namespace gumshoe::models::sphere_calibration {

/// Singular values below this share of the largest count as zero (columns of length one). What such a direction would
/// make of a micrometre is a metre.
inline constexpr double unseen_below = 1e-6;
/// Steps end where what is left of them moves the commands by less, m.
inline constexpr double converged_below = 1e-13;

/// Which readings lie in a plane, by their conditions: C moves at one B, B moves at one C.
struct Patterns {
  std::vector<std::size_t> I, II;
};

/// Rows of a matrix W that makes the data's covariance matrix the unit matrix, W V W' = 1: lower triangle, row i from
/// column first[i] on. `size` is the root mean square of W's columns, 1/m. Empty: equal weights.
struct Whitening {
  std::vector<std::size_t> first;
  std::vector<std::vector<double>> rows;
  double size = 1;
};

/// What the data say near theta: sums over rows, columns of length one.
template <class T> struct Normal {
  Symmetric<T, unknowns> matrix;
  T right[unknowns], scale[unknowns]; ///< 1/length of a column; 0 for one without effect
};

template <class T> struct Identified {
  T theta[unknowns];
  T residual_rms, rank, condition;
  decltype(T() < T()) converged, finite;
};

template <class T> class Identification : public PoseRows<T> {
  using PoseRows<T>::rows_, PoseRows<T>::linearise, PoseRows<T>::undisturbed, PoseRows<T>::moved_to;

public:
  using PoseRows<T>::poses, typename PoseRows<T>::Row;
  Identification(std::size_t readings, Patterns patterns, Whitening whitening)
      : PoseRows<T>(readings), patterns_(std::move(patterns)), whitening_(std::move(whitening)) {
    for (std::size_t i = 0; i < readings; ++i) all_.push_back(i);
  }

  /// Plane fits for the orientations; probe and C axis from pattern I, then the B axis from pattern II (eqs 4.27 and
  /// 4.40, which are linear in the lengths). @param declared theta
  Identified<T> sequential(const T* declared) {
    Identified<T> out = in_sequence(declared);
    // What brings the points of a pattern into one plane is then known from the machine found.
    const auto varies = held_varies();
    if (!num::any(varies)) return out;
    const Identified<T> again = in_sequence(out.theta);
    for (int j = 0; j < unknowns; ++j) out.theta[j] = num::select(varies, again.theta[j], out.theta[j]);
    for (T Identified<T>::*figure : {&Identified<T>::residual_rms, &Identified<T>::rank, &Identified<T>::condition})
      out.*figure = num::select(varies, again.*figure, out.*figure);
    out.finite = out.residual_rms < T(1e300);
    return out;
  }

  /// All eleven at once, by Gauss-Newton from the planes' orientations.
  Identified<T> joint(const T* declared) {
    Identified<T> out = begin(declared);
    Normal<T> normal, last;
    T before(0.0);
    out.converged = T(0.0) != T(0.0);
    for (int i = 0; i < 100; ++i) { // a limit for data that are no such machine's
      normal = normal_equations(out.theta, all_);
      T step[unknowns];
      const T size = solve(normal, step, unknowns) / T(whitening_.size);
      for (int j = 0; j < unknowns; ++j) {
        out.theta[j] = num::select(out.converged, out.theta[j], out.theta[j] + step[j]);
        last.right[j] = normal.right[j];
        last.scale[j] = num::select(out.converged, last.scale[j], normal.scale[j]);
        for (int k = 0; k <= j; ++k)
          last.matrix.at[j][k] = num::select(out.converged, last.matrix.at[j][k], normal.matrix.at[j][k]);
      }
      // Steps shrink by a factor or faster; the next one is what this one leaves.
      out.converged = out.converged || (size <= T(converged_below)) ||
                      ((size < before) && (size * size <= T(converged_below) * before));
      before = size;
      if (!num::any(!out.converged && (size == size))) break;
    }
    residuals(out.theta);
    judge(last, out);
    return out;
  }

private:
  Identified<T> in_sequence(const T* declared) {
    Identified<T> out = begin(declared);
    constexpr bool of_C[lengths] = {true, true, true, false, false, true, true};
    constexpr bool of_B[lengths] = {false, false, false, true, true, false, false};
    constexpr bool all[lengths] = {true, true, true, true, true, true, true};
    if (!patterns_.I.empty()) solve_lengths(patterns_.I, of_C, out);
    if (!patterns_.II.empty()) solve_lengths(patterns_.II, patterns_.I.empty() ? all : of_B, out);
    out.converged = T(0.0) == T(0.0);
    judge(normal_equations(out.theta, all_), out);
    return out;
  }

  /// Whether the axis that a pattern holds stands elsewhere in some of its poses: it has an error of its own in each.
  auto held_varies() const {
    auto out = T(0.0) != T(0.0);
    for (const std::size_t i : patterns_.I) out = out || (poses[i].at_B != poses[patterns_.I[0]].at_B);
    for (const std::size_t i : patterns_.II) out = out || (poses[i].at_C != poses[patterns_.II[0]].at_C);
    return out;
  }

  /// Declared lengths, orientations by the planes of the two patterns (eqs 4.15, 4.16 and 4.28); as declared where
  /// there is no plane.
  Identified<T> begin(const T* declared) {
    Identified<T> out;
    for (int j = 0; j < unknowns; ++j) out.theta[j] = declared[j];
    T* e = out.theta;
    const T one(1.0), zero(0.0);
    if (patterns_.II.size() > 2) {
      Vector3<T> n;
      const auto plane = normal_of(patterns_.II, declared, &Pose<T>::at_C, n);
      n = num::select(n.y < zero, -one, one) * n;
      const auto upright = plane && (n.y > T(0.1));
      e[Q::E_A0B] = num::select(upright, num::atan2(n.z, n.y), e[Q::E_A0B]);
      e[Q::E_C0B] = num::select(upright, num::atan2(-n.x, n.y), e[Q::E_C0B]);
    }
    if (patterns_.I.size() > 2) {
      Vector3<T> n;
      const auto plane = normal_of(patterns_.I, declared, &Pose<T>::at_B, n);
      // Seen before B turned it.
      const Pose<T>& pose = poses[patterns_.I[0]];
      const auto lines = directions(Orientation<T>{e[Q::E_A0B], e[Q::E_C0B], e[Q::E_A0C], e[Q::E_B0C]});
      n = rotation(lines.b, -pose.at_B) * n;
      n = num::select(n.z < zero, -one, one) * n;
      const auto upright = plane && (n.z > T(0.1));
      e[Q::E_A0C] = num::select(upright, num::atan2(-n.y, n.z), e[Q::E_A0C]);
      e[Q::E_B0C] = num::select(upright, num::atan2(n.x, n.z), e[Q::E_B0C]);
    }
    return out;
  }

  /// Normal of the plane with the least squares of distances; false where the points lie on a line.
  /// @param held  angle of the axis that the pattern holds: points are brought to where it stands in the first pose
  auto normal_of(const std::vector<std::size_t>& which, const T* declared, T Pose<T>::*held, Vector3<T>& normal) {
    const auto lines =
        directions(Orientation<T>{declared[Q::E_A0B], declared[Q::E_C0B], declared[Q::E_A0C], declared[Q::E_B0C]});
    std::vector<Vector3<T>>& points = points_;
    points.clear();
    Vector3<T> middle;
    for (const std::size_t i : which) {
      points.push_back(undisturbed(poses[i], declared, lines));
      if (num::any(poses[i].*held != poses[which[0]].*held))
        points.back() = points.back() + moved_to(poses[i], held, poses[which[0]].*held, declared, lines);
      middle = middle + points.back();
    }
    middle = T(1.0 / static_cast<double>(which.size())) * middle;
    Symmetric<T, 3> scatter;
    for (auto& row : scatter.at)
      for (T& x : row) x = T(0.0);
    for (const Vector3<T>& point : points) {
      const Vector3<T> d = point - middle;
      const T v[] = {d.x, d.y, d.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) scatter.at[i][j] = scatter.at[i][j] + v[i] * v[j];
    }
    const auto axes = eigen_system(scatter);
    T least = axes.value[0], most = axes.value[0], sum = axes.value[0];
    T v[] = {axes.vector[0][0], axes.vector[0][1], axes.vector[0][2]};
    for (int k = 1; k < 3; ++k) {
      const auto less = axes.value[k] < least;
      for (int i = 0; i < 3; ++i) v[i] = num::select(less, axes.vector[k][i], v[i]);
      least = num::select(less, axes.value[k], least);
      most = num::select(axes.value[k] > most, axes.value[k], most);
      sum = sum + axes.value[k];
    }
    normal = {v[0], v[1], v[2]};
    const T second = sum - least - most;
    return (second > T(unseen_below * unseen_below) * most) && (second > T(1e-14));
  }

  void whiten() {
    for (std::size_t i = whitening_.rows.size(); i-- > 0;) {
      Row sum;
      for (T& x : sum) x = T(0.0);
      for (std::size_t j = whitening_.first[i]; j <= i; ++j) {
        const T w(whitening_.rows[i][j - whitening_.first[i]]);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = sum[k] + w * rows_[j][k];
      }
      rows_[i] = sum;
    }
  }

  void residuals(const T* theta) {
    linearise(theta);
    squares();
  }
  void squares() {
    squares_ = T(0.0);
    for (const Row& row : rows_) squares_ = squares_ + row[unknowns] * row[unknowns];
  }

  /// The lengths of `kept` from the readings of one pattern, all else as it is.
  void solve_lengths(const std::vector<std::size_t>& pattern, const bool (&kept)[lengths], Identified<T>& out) {
    Normal<T> normal = normal_equations(out.theta, pattern);
    for (int j = 0; j < lengths; ++j) {
      if (kept[j]) continue;
      for (int k = 0; k < j; ++k) normal.matrix.at[j][k] = T(0.0);
      for (int k = j; k < lengths; ++k) normal.matrix.at[k][j] = T(k == j ? 1.0 : 0.0);
      normal.right[j] = T(0.0);
    }
    T step[unknowns];
    solve(normal, step, lengths);
    for (int j = 0; j < lengths; ++j) out.theta[j] = out.theta[j] + step[j];
  }

  /// From some readings; whitened only if from all.
  Normal<T> normal_equations(const T* theta, const std::vector<std::size_t>& readings) {
    residuals(theta);
    whiten();
    Normal<T> n;
    for (int j = 0; j < unknowns; ++j) {
      n.right[j] = T(0.0);
      for (int k = 0; k <= j; ++k) n.matrix.at[j][k] = T(0.0);
    }
    for (const std::size_t i : readings) {
      const Row &a = rows_[3 * i], &b = rows_[3 * i + 1], &c = rows_[3 * i + 2];
      for (std::size_t j = 0; j < unknowns; ++j) {
        for (std::size_t k = 0; k <= j; ++k)
          n.matrix.at[j][k] = n.matrix.at[j][k] + (a[j] * a[k] + b[j] * b[k] + c[j] * c[k]);
        n.right[j] = n.right[j] + (a[j] * a[unknowns] + b[j] * b[unknowns] + c[j] * c[unknowns]);
      }
    }
    T largest(0.0);
    for (int j = 0; j < unknowns; ++j) largest = num::select(n.matrix.at[j][j] > largest, n.matrix.at[j][j], largest);
    for (int j = 0; j < unknowns; ++j) {
      const T square = n.matrix.at[j][j];
      const auto felt = square > T(1e-26) * largest;
      n.scale[j] = num::select(felt, 1.0 / num::sqrt(num::select(felt, square, T(1.0))), T(0.0));
    }
    for (int j = 0; j < unknowns; ++j) {
      n.right[j] = n.right[j] * n.scale[j];
      for (int k = 0; k <= j; ++k) n.matrix.at[j][k] = n.matrix.at[j][k] * (n.scale[j] * n.scale[k]);
    }
    return n;
  }

  /// The least-squares step of the first n unknowns, of minimum norm where the data cannot see all. Returns its effect
  /// on the rows, root mean square.
  T solve(const Normal<T>& normal, T* step, int n) {
    for (int j = 0; j < n; ++j) step[j] = normal.right[j];
    const T pivot = solve_cholesky(normal.matrix, step, n);
    const auto doubtful = !(pivot > T(1e-9));
    if (num::any(doubtful)) {
      const auto system = eigen_system(normal.matrix, n);
      const T least = smallest_seen(system, n);
      T least_norm[unknowns];
      for (int j = 0; j < n; ++j) least_norm[j] = T(0.0);
      for (int k = 0; k < n; ++k) {
        T along(0.0);
        for (int j = 0; j < n; ++j) along = along + system.vector[k][j] * normal.right[j];
        const auto seen = system.value[k] > least;
        along = num::select(seen, along / num::select(seen, system.value[k], T(1.0)), T(0.0));
        for (int j = 0; j < n; ++j) least_norm[j] = least_norm[j] + along * system.vector[k][j];
      }
      for (int j = 0; j < n; ++j) step[j] = num::select(doubtful, least_norm[j], step[j]);
    }
    T effect(0.0);
    for (int j = 0; j < n; ++j) {
      effect = effect + step[j] * normal.right[j];
      step[j] = step[j] * normal.scale[j];
    }
    effect = effect * T(1.0 / static_cast<double>(rows_.size()));
    return num::sqrt(num::select(effect < T(0.0), T(0.0), effect)); // step'J'J step = step'J'residuals
  }

  static T smallest_seen(const EigenSystem<T, unknowns>& system, int n) {
    T largest = system.value[0];
    for (int k = 1; k < n; ++k) largest = num::select(system.value[k] > largest, system.value[k], largest);
    return largest * T(unseen_below * unseen_below);
  }

  void judge(const Normal<T>& normal, Identified<T>& out) {
    const auto system = eigen_system(normal.matrix);
    const T least = smallest_seen(system, unknowns);
    T smallest(1e300), largest(0.0);
    out.rank = T(0.0);
    for (int k = 0; k < unknowns; ++k) {
      const auto seen = system.value[k] > least;
      out.rank = out.rank + num::select(seen, T(1.0), T(0.0));
      smallest = num::select(seen && (system.value[k] < smallest), system.value[k], smallest);
      largest = num::select(system.value[k] > largest, system.value[k], largest);
    }
    out.condition = num::sqrt(largest / smallest);
    out.residual_rms = num::sqrt(squares_ * T(1.0 / static_cast<double>(rows_.size())));
    out.finite = out.residual_rms < T(1e300);
  }

  Patterns patterns_;
  Whitening whitening_;
  std::vector<std::size_t> all_; ///< readings
  std::vector<Vector3<T>> points_;
  T squares_;
};

} // namespace gumshoe::models::sphere_calibration
