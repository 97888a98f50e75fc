#include "math/least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/module.h"
#include "math/descent.h"
#include "math/gauss_newton.h"

namespace gumshoe::least_squares {
namespace {

struct Strategy {
  const char* name;
  TrustRegion type;
  double radius;
  bool scaling; ///< columns of the Jacobian to length one; without it steps are measured in magnitudes
};
// The second half serves when the first steps run away: they start with steps of about one magnitude.
constexpr Strategy strategies[] = {{"Levenberg-Marquardt", TrustRegion::levenberg_marquardt, 1e4, true},
                                   {"dogleg", TrustRegion::dogleg, 1e4, true},
                                   {"cautious Levenberg-Marquardt", TrustRegion::levenberg_marquardt, 1e-2, true},
                                   {"cautious dogleg", TrustRegion::dogleg, 0.1, false}};

struct Attempt {
  Vector z, r;
  Matrix jacobian;
  std::string said;
  int iterations = 0;
  std::vector<std::size_t> vanished;
  bool rank_lost = false; ///< fewer directions act on the residuals than at the start
  Tangent tangent;
  bool converged = false;
  double cost() const { return 0.5 * r.squaredNorm(); }
};

/// False for columns whose effect of one magnitude is negligible compared with the others.
std::vector<bool> acting(const Matrix& jacobian, const Vector& z) {
  Vector effect(jacobian.cols());
  for (Eigen::Index j = 0; j < jacobian.cols(); ++j)
    effect[j] = jacobian.col(j).norm() * std::max(std::fabs(z[j]), 1.0);
  std::vector<bool> out;
  for (Eigen::Index j = 0; j < jacobian.cols(); ++j) out.push_back(effect[j] > 1e-11 * effect.maxCoeff());
  return out;
}

/// Share of the first cost that counts as none: what is left of exact data is rounding.
constexpr double exact = 1e-18;

bool stationary(const Tangent& t, const Options& options) {
  // A minimum at infinity has an offset that dwindles and steps that do not.
  constexpr double longest_step = 1e-4;
  return t.relative_step <= options.step_tolerance ||
         (t.relative_offset <= options.offset_tolerance && t.relative_step <= longest_step);
}

/// Opened by the first that needs it.
decltype(&gumshoe_descend) descend() {
  static const auto opened = [] {
    std::string why;
    void* const found = module_symbol("gumshoe_ceres", "gumshoe_descend", why);
    if (!found)
      throw InputError("the part of this program that fits cannot be opened", why,
                       "it stands in gumshoe_ceres.so: next to the program, or in lib/gumshoe where it is installed");
    return reinterpret_cast<decltype(&gumshoe_descend)>(found);
  }();
  return opened;
}

std::optional<Attempt> attempt(const Rows& rows, const Vector& start, const Strategy& strategy,
                               const Options& options) {
  Attempt out;
  out.z = start;
  if (!rows.evaluate(out.z, out.r, &out.jacobian)) return std::nullopt;
  const auto acted = acting(out.jacobian, out.z);
  const Eigen::Index rank = tangent(rows, out.z, out.r, out.jacobian).rank;

  Descent descent{strategy.type, strategy.radius, strategy.scaling, options.iterations};
  descent.rows = static_cast<int>(rows.rows());
  descent.parameters = static_cast<int>(rows.parameters());
  descent.low = rows.low().data();
  descent.high = rows.high().data();
  descent.evaluate = [&rows](const double* z, double* r, double* jacobian) { return rows.evaluate(z, r, jacobian); };
  Descended ended;
  descend()(descent, out.z.data(), ended);
  out.said = fmt::format("{}: {}", strategy.name, ended.message);
  out.iterations = ended.iterations;
  out.z = rows.clamp(out.z);
  if (!rows.evaluate(out.z, out.r, &out.jacobian)) return std::nullopt;
  out.iterations += polish(rows, out.z, out.r, out.jacobian);
  out.tangent = tangent(rows, out.z, out.r, out.jacobian);
  const auto acts = acting(out.jacobian, out.z);
  for (std::size_t j = 0; j < acts.size(); ++j)
    if (acted[j] && !acts[j]) out.vanished.push_back(j);
  out.rank_lost = out.tangent.rank + static_cast<Eigen::Index>(out.tangent.held.size()) < rank;
  out.converged = out.vanished.empty() && !out.rank_lost && stationary(out.tangent, options);
  return out;
}

/// A converged attempt before one that is not, then the lower one; the earlier where they agree.
bool better(const Attempt& a, const Attempt& b) {
  if (a.converged != b.converged) return a.converged;
  return a.cost() < b.cost() * (1 - 1e-9);
}

std::string why(const Attempt& a, const Options& options, const Report& r) {
  if (!a.vanished.empty()) return "a parameter has reached a region where the residuals no longer depend on it";
  if (a.rank_lost) return "the parameters have reached a region where the residuals determine fewer of them than at the start";
  if (a.converged && r.relative_offset <= options.offset_tolerance)
    return fmt::format("relative offset {:.1e}: the remaining step is negligible compared with the residuals", r.relative_offset);
  if (a.converged) return fmt::format("the next step is {:.1e} of the parameters", r.step);
  if (a.iterations >= options.iterations) return fmt::format("no minimum after {} iterations", a.iterations);
  return fmt::format("no minimum: relative offset {:.1e}, next step {:.1e}, and no step lowers the cost",
                     r.relative_offset, r.step);
}

std::optional<Attempt> best_attempt(const Rows& rows, const Vector& start, const Options& options, Report& report) {
  std::optional<Attempt> best;
  for (const Strategy& strategy : strategies) {
    auto one = attempt(rows, start, strategy, options);
    if (!one) continue;
    report.iterations += one->iterations;
    // Two attempts that agree are enough.
    const bool agree = best && best->converged && one->converged &&
                       std::fabs(one->cost() - best->cost()) <= 1e-6 * best->cost() + exact * report.cost_before;
    if (!best || better(*one, *best)) best = std::move(one);
    if (agree) break;
  }
  return best;
}

/// Where to start again when parameters have no slope, if that is lower. Such a parameter may lie on a ridge between
/// two valleys (b in y = b^2 x at b = 0), or have run away before the others were near: then its start serves anew.
std::optional<Vector> lower_start(const Rows& rows, const Attempt& at) {
  const auto acts = acting(at.jacobian, at.z);
  std::vector<Vector> candidates;
  Vector returned = at.z;
  for (const std::size_t j : at.vanished)
    returned[static_cast<Eigen::Index>(j)] = rows.start()[static_cast<Eigen::Index>(j)];
  candidates.push_back(returned);
  for (std::size_t i = 0; i < acts.size(); ++i)
    for (const double step : {0.1, -0.1, 1e-3, -1e-3}) {
      if (acts[i]) break;
      const auto j = static_cast<Eigen::Index>(i);
      candidates.push_back(at.z);
      candidates.back()[j] += step * std::max(std::fabs(at.z[j]), 1.0);
    }
  std::optional<Vector> lowest;
  double cost = at.r.squaredNorm() * (1 - 1e-9);
  for (const Vector& candidate : candidates) {
    const Vector z = rows.clamp(candidate);
    Vector r;
    if (!rows.evaluate(z, r, nullptr) || !(r.squaredNorm() < cost)) continue;
    cost = r.squaredNorm();
    lowest = z;
  }
  return lowest;
}

} // namespace

Solution solve(const Problem& problem, const Options& options) {
  const Rows rows(problem);
  Solution out;
  Report& report = out.report;
  Vector r;
  const Vector start = rows.start();
  const Vector first = rows.parameters_of(start);
  out.x.assign(first.data(), first.data() + first.size());
  out.residuals.assign(problem.residuals, std::numeric_limits<double>::quiet_NaN());
  out.jacobian.assign(problem.residuals * problem.parameters, std::numeric_limits<double>::quiet_NaN());
  out.weights.assign(problem.residuals, 1);
  if (!rows.evaluate(start, r, nullptr)) {
    report.reason = "the residuals are undefined at the start values";
    report.evaluations = rows.evaluations();
    report.cost_before = report.cost_after = report.relative_offset = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  report.cost_before = 0.5 * r.squaredNorm();
  std::optional<Attempt> best = best_attempt(rows, start, options, report);
  for (int again = 0; best && again < 3; ++again) {
    const auto lower = lower_start(rows, *best);
    if (!lower) break;
    auto next = best_attempt(rows, *lower, options, report);
    if (!next || !better(*next, *best)) break;
    best = std::move(next);
  }
  report.evaluations = rows.evaluations();
  if (!best) {
    report.reason = "the derivatives are undefined at the start values";
    return out;
  }
  const Vector x = rows.parameters_of(best->z);
  out.x.assign(x.data(), x.data() + x.size());
  report.converged = best->converged;
  report.solver = best->said;
  report.cost_after = best->cost();
  report.gradient_norm = best->tangent.gradient;
  report.relative_offset = best->tangent.relative_offset;
  report.step = best->tangent.relative_step;
  report.at_bound = best->tangent.held;
  report.vanished = best->vanished;
  report.reason = why(*best, options, report);
  if (problem.evaluate(out.x.data(), out.residuals.data(), out.jacobian.data()))
    for (std::size_t i = 0; i < problem.residuals; ++i)
      out.weights[i] = weight(problem.loss, out.residuals[i], problem.width);
  return out;
}

} // namespace gumshoe::least_squares
