/// The module gumshoe_ceres.so: the only door to Ceres.
#include <cmath>
#include <mutex>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "math/descent.h"

namespace gumshoe::least_squares {
namespace {

class Cost final : public ceres::CostFunction {
public:
  explicit Cost(const Descent& descent) : descent_(descent) {
    set_num_residuals(descent.rows);
    mutable_parameter_block_sizes()->push_back(descent.parameters);
  }
  bool Evaluate(double const* const* z, double* r, double** jacobians) const override {
    return descent_.evaluate(z[0], r, jacobians ? jacobians[0] : nullptr);
  }

private:
  const Descent& descent_;
};

/// Ceres says on stderr what its summary says too.
void silence() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

} // namespace

extern "C" void gumshoe_descend(const Descent& descent, double* z, Descended& ended) {
  silence();
  ceres::Problem problem;
  problem.AddResidualBlock(new Cost(descent), nullptr, z);
  for (int j = 0; j < descent.parameters; ++j) {
    if (std::isfinite(descent.low[j])) problem.SetParameterLowerBound(z, j, descent.low[j]);
    if (std::isfinite(descent.high[j])) problem.SetParameterUpperBound(z, j, descent.high[j]);
  }
  ceres::Solver::Options o;
  o.trust_region_strategy_type =
      descent.strategy == TrustRegion::dogleg ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  o.initial_trust_region_radius = descent.radius;
  o.jacobi_scaling = descent.scaling;
  o.linear_solver_type = ceres::DENSE_QR;
  o.max_num_iterations = descent.iterations;
  o.max_num_consecutive_invalid_steps = 50;
  // The caller polishes and judges; Ceres stops where it gains no more.
  o.function_tolerance = 1e-15;
  o.gradient_tolerance = 1e-15;
  o.parameter_tolerance = 1e-13;
  o.num_threads = 1;
  o.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(o, &problem, &summary);
  ended = {summary.message, static_cast<int>(summary.iterations.size())};
}

} // namespace gumshoe::least_squares
