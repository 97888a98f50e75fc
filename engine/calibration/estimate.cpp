#include "calibration/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "calibration/priors.h"
#include "math/direction_words.h"
#include "math/parameter_covariance.h"

namespace gumshoe::calibration {
namespace {

using least_squares::Loss;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

double median_of(std::vector<double> x) {
  const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  if (x.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(x.begin(), middle)) / 2;
}

/// Slope of psi, for the covariance of an M-estimate.
double slope(Loss loss, double r, double width) {
  const double q = (r / width) * (r / width);
  if (loss == Loss::huber) return q <= 1 ? 1 : 0;
  if (loss == Loss::cauchy) return (1 - q) / ((1 + q) * (1 + q));
  if (loss == Loss::tukey) return q < 1 ? (1 - q) * (1 - 5 * q) : 0;
  return 1;
}

class Fit {
public:
  Fit(const propagation::Experiment& e, const Options& options)
      : experiment_(e), unknowns_(unknowns_of(e)), data_(data_of(e)), simulation_(e, unknowns_, options.threads),
        priors_(priors_of(e, unknowns_)), n_(data_.measured.size()), p_(unknowns_.size()),
        loss_(e.scenario().estimate.loss) {
    width_ = e.scenario().estimate.width > 0 ? e.scenario().estimate.width : least_squares::usual_width(loss_);
    check();
  }

  Estimate estimate() {
    for (const Unknown& u : unknowns_) x_.push_back(u.start);
    if (data_.noise_declared || (loss_ == Loss::squared && priors_.target.empty()))
      solve(1);
    else
      find_scale();
    Estimate out;
    out.notes = data_.notes;
    describe(out);
    covariance(out);
    rows(out);
    goodness(out);
    remarks(out);
    return out;
  }

private:
  void check() const {
    const auto& s = experiment_.scenario();
    const std::size_t m = priors_.target.size();
    if (n_ + m < p_)
      refuse(s.file,
             fmt::format("{} readings{} cannot determine {} estimated quantities", n_,
                         m > 0 ? fmt::format(" and {} priors", m) : "", p_),
             "each unknown needs a reading or a prior", "add readings, or give some of them a prior (u)");
    if (data_.noise_declared) return;
    const auto& indications = experiment_.model().card->indications;
    for (const auto& i : indications)
      if (i.si_unit != indications[0].si_unit)
        refuse(s.file, fmt::format("indications {} and {} have no declared noise", indications[0].name, i.name),
               "what is measured in different units cannot be weighed without it", "repeatability = { s = \"...\" }");
    if (m > 0 && n_ <= p_ && !(data_.pure_freedom > 0))
      refuse(s.file, fmt::format("{} readings cannot tell their own noise beside {} unknowns", n_, p_),
             "priors are weighed against it", "repeatability = { s = \"...\" }");
  }

  /// Whitened residuals over `sigma`, and their Jacobian.
  bool evaluate(const double* x, double* r, double* jacobian, double sigma) const {
    if (!simulation_(x, r, jacobian)) return false;
    for (std::size_t i = 0; i < n_; ++i) r[i] = (data_.measured[i] - r[i]) / sigma;
    whiten(data_, r, 1);
    if (!jacobian) return true;
    for (std::size_t i = 0; i < n_ * p_; ++i) jacobian[i] = -jacobian[i] / sigma;
    whiten(data_, jacobian, p_);
    return true;
  }

  void solve_with(Loss loss, double width, double sigma, bool with_priors) {
    least_squares::Problem problem;
    problem.residuals = n_;
    problem.parameters = p_;
    problem.start = x_;
    for (const Unknown& u : unknowns_) {
      problem.magnitude.push_back(u.magnitude);
      problem.low.push_back(u.low > -1e290 ? u.low : -infinity);
      problem.high.push_back(u.high < 1e290 ? u.high : infinity);
    }
    if (with_priors) {
      problem.prior_matrix = priors_.matrix;
      problem.prior_target = priors_.target;
    }
    problem.loss = loss;
    problem.width = width;
    problem.evaluate = [&](const double* x, double* r, double* jacobian) { return evaluate(x, r, jacobian, sigma); };
    least_squares::Options options;
    options.iterations = experiment_.scenario().estimate.iterations;
    const int before = iterations_, evaluations = evaluations_;
    const double first = cost_before_;
    solution_ = least_squares::solve(problem, options);
    iterations_ = before + solution_.report.iterations;
    evaluations_ = evaluations + solution_.report.evaluations;
    cost_before_ = evaluations == 0 ? solution_.report.cost_before : first;
    x_ = solution_.x;
    sigma_ = sigma;
  }

  void solve(double sigma) {
    // Redescending losses need a start near the minimum: Huber's has one only.
    if (loss_ == Loss::tukey || loss_ == Loss::cauchy)
      solve_with(Loss::huber, least_squares::usual_width(Loss::huber), sigma, true);
    if (defined()) solve_with(loss_, width_, sigma, true);
  }

  bool defined() const { return solution_.residuals.empty() || std::isfinite(solution_.residuals.front()); }

  /// Whitened residuals in the unit of sigma = 1.
  double scale_of_residuals() const {
    std::vector<double> sizes;
    double squares = 0;
    for (const double r : solution_.residuals) {
      sizes.push_back(std::fabs(r) * sigma_);
      squares += r * sigma_ * r * sigma_;
    }
    // What is left of exact data is rounding.
    double floor = 0;
    for (const double y : data_.measured) floor = std::max(floor, std::fabs(y) * 1e-14);
    if (loss_ != Loss::squared) return std::max(median_of(sizes) / 0.6744897501960817, floor);
    return std::max(std::sqrt((squares + data_.pure_error) / freedom()), floor);
  }

  /// n minus the trace of the data's share in the fit: n - p without priors.
  double freedom() const {
    const auto c = least_squares::parameter_covariance(stacked(), n_ + priors_.target.size(), p_, magnitudes());
    const auto n = static_cast<Eigen::Index>(n_), p = static_cast<Eigen::Index>(p_);
    const Eigen::Map<const Matrix> jacobian(solution_.jacobian.data(), n, p), matrix(c.matrix.data(), p, p);
    return static_cast<double>(n_) + data_.pure_freedom - (jacobian * matrix).cwiseProduct(jacobian).sum();
  }

  /// Noise unknown, beside priors or a robust loss: its scale and the fit in turns until both stand still.
  void find_scale() {
    if (n_ > p_ || priors_.target.empty()) solve_with(Loss::squared, 1, 1, false);
    double sigma = 0;
    for (int turn = 0; turn < 50 && defined(); ++turn) {
      const double next = scale_of_residuals();
      if (std::fabs(next - sigma) <= 1e-10 * next) return;
      sigma = next;
      solve(sigma);
    }
    if (defined()) scale_settled_ = false;
  }

  std::vector<double> magnitudes() const {
    std::vector<double> out;
    for (std::size_t j = 0; j < p_; ++j) out.push_back(std::max(std::fabs(x_[j]), unknowns_[j].magnitude));
    return out;
  }
  std::vector<double> stacked() const {
    std::vector<double> out = solution_.jacobian;
    out.insert(out.end(), priors_.matrix.begin(), priors_.matrix.end());
    return out;
  }

  void describe(Estimate& out) const {
    out.noise_declared = data_.noise_declared;
    out.loss = loss_;
    out.loss_width = loss_ == Loss::squared ? 0 : width_;
    out.solver = solution_.report;
    out.solver.iterations = iterations_;
    out.solver.evaluations = evaluations_;
    out.solver.cost_before = cost_before_;
    if (!scale_settled_) {
      out.solver.converged = false;
      out.solver.reason = "the scale of the residuals does not settle";
    }
    if (!defined()) {
      const auto failed = simulation_.failure();
      const std::string at = propagation::reading_name(experiment_.scenario().readings[failed.reading]);
      out.solver.reason += fmt::format(": reading {}{}: {}", failed.reading + 1, at.empty() ? "" : " (" + at + ")",
                                       status_name(failed.status));
    }
    for (const std::size_t j : out.solver.vanished) out.solver.reason += fmt::format(": {}", unknowns_[j].name);
    for (std::size_t j = 0; j < p_; ++j) out.parameters.push_back({unknowns_[j], x_[j], nan, false});
    for (const std::size_t j : out.solver.at_bound) out.parameters[j].at_limit = true;
  }

  void covariance(Estimate& out) const {
    out.covariance.assign(p_ * p_, nan);
    out.correlation.assign(p_ * p_, nan);
    out.condition = nan;
    out.determined = false;
    if (!defined()) return;
    const double tolerance = simulation_.exact() ? 1e-11 : 1e-7;
    const auto by_data = least_squares::parameter_covariance(solution_.jacobian, n_, p_, magnitudes(), tolerance);
    const auto all =
        least_squares::parameter_covariance(stacked(), n_ + priors_.target.size(), p_, magnitudes(), tolerance);
    out.rank = by_data.rank;
    out.condition = by_data.condition;
    std::vector<least_squares::Parameter> named;
    for (const Unknown& u : unknowns_) named.push_back({u.name, u.unit, u.si_unit});
    for (const auto& direction : by_data.unseen) out.indistinguishable.push_back(in_words(direction, named));
    out.determined = all.rank == p_;
    if (by_data.rank == p_ && by_data.condition > 1e6) {
      const auto names = members(by_data.weakest, named);
      out.notes.push_back(fmt::format("{} {} hardly told apart by the data (condition number {:.1e})",
                                      fmt::join(names, ", "), names.size() > 1 ? "are" : "is", by_data.condition));
    }
    const double factor = variance_factor(out, all.rank);
    for (std::size_t i = 0; i < p_; ++i) {
      Parameter& parameter = out.parameters[i];
      parameter.standard_uncertainty = all.determined[i] ? std::sqrt(factor * all.matrix[i * p_ + i]) : infinity;
      for (std::size_t j = 0; j < p_; ++j) {
        if (!all.determined[i] || !all.determined[j]) continue;
        out.covariance[i * p_ + j] = factor * all.matrix[i * p_ + j];
        out.correlation[i * p_ + j] =
            i == j ? 1
                   : std::clamp(all.matrix[i * p_ + j] / std::sqrt(all.matrix[i * p_ + i] * all.matrix[j * p_ + j]),
                                -1.0, 1.0);
      }
    }
  }

  /// What the covariance of rows in standard deviations is multiplied by; sets s and its degrees of freedom.
  double variance_factor(Estimate& out, std::size_t rank) const {
    double squares = 0, psi = 0, slopes = 0;
    for (const double r : solution_.residuals) {
      const double w = least_squares::weight(loss_, r, width_);
      squares += r * r;
      psi += (w * r) * (w * r);
      slopes += slope(loss_, r, width_) / static_cast<double>(n_);
    }
    const double left = static_cast<double>(n_) - static_cast<double>(rank);
    out.residual_sum_of_squares = squares * sigma_ * sigma_;
    // Repeats of a reading know the noise too: with them the fit of the means is the fit of all readouts.
    const bool repeats = !data_.noise_declared && loss_ == Loss::squared;
    if (repeats) out.residual_sum_of_squares += data_.pure_error;
    out.degrees_of_freedom = data_.noise_declared ? left + static_cast<double>(priors_.target.size())
                             : priors_.target.empty() || loss_ != Loss::squared
                                 ? left + (repeats ? data_.pure_freedom : 0)
                                 : freedom();
    out.s = out.degrees_of_freedom > 0 ? std::sqrt(out.residual_sum_of_squares / out.degrees_of_freedom) : nan;
    if (loss_ != Loss::squared) {
      if (!data_.noise_declared) out.s = sigma_;
      return left > 0 ? psi / left / (slopes * slopes) : nan; // Huber 1981, section 7.6
    }
    if (data_.noise_declared || !priors_.target.empty()) return 1;
    return out.s * out.s;
  }

  void rows(Estimate& out) const {
    const std::size_t k = experiment_.model().card->indications.size();
    std::vector<double> simulated(n_, nan);
    if (defined()) simulation_(x_.data(), simulated.data(), nullptr);
    const double unit = out.noise_declared || sigma_ != 1 ? 1 : out.s;
    for (std::size_t i = 0; i < n_; ++i)
      out.rows.push_back({i / k, i % k, data_.measured[i], simulated[i], data_.measured[i] - simulated[i],
                          defined() ? solution_.residuals[i] / unit : nan, solution_.weights[i]});
  }

  void goodness(Estimate& out) const {
    out.chi_squared = out.chi_squared_probability = nan;
    if (!out.noise_declared || !defined()) return;
    out.chi_squared = out.residual_sum_of_squares;
    for (std::size_t i = 0; i < priors_.target.size(); ++i) {
      double r = -priors_.target[i];
      for (std::size_t j = 0; j < p_; ++j) r += priors_.matrix[i * p_ + j] * x_[j];
      out.chi_squared += r * r;
    }
    if (!(out.degrees_of_freedom > 0)) return;
    out.s = std::sqrt(out.chi_squared / out.degrees_of_freedom);
    out.chi_squared_probability = boost::math::cdf(
        boost::math::complement(boost::math::chi_squared(out.degrees_of_freedom), std::min(out.chi_squared, 1e300)));
  }

  void remarks(Estimate& out) const {
    const auto& s = experiment_.scenario();
    const auto& card = *experiment_.model().card;
    for (std::size_t q = 0; q < s.quantities.size(); ++q) {
      if (experiment_.layout().indications.contains(q)) continue;
      const auto& quantity = s.quantities[q];
      const bool uncertain = std::any_of(quantity.entries.begin(), quantity.entries.end(),
                                         [](const auto& e) { return !e.components.empty(); });
      if (uncertain && !quantity.estimated)
        out.notes.push_back(quantity.name + " is held at its estimate: its uncertainty is not in the result (marked "
                                            "estimated, it is)");
    }
    if (!out.indistinguishable.empty())
      for (std::size_t c = 0; c < card.conditions.size() && s.readings.size() > 1; ++c) {
        const double first = s.readings.front().conditions[c];
        const std::string unit(card.conditions[c].unit);
        if (std::all_of(s.readings.begin(), s.readings.end(), [&](const auto& r) { return r.conditions[c] == first; }))
          out.notes.push_back(fmt::format("{} is {:.6g}{} in every reading", card.conditions[c].name,
                                          units::from_si(first, unit, std::string(card.conditions[c].si_unit)),
                                          unit == "1" ? "" : " " + unit));
      }
    for (const Parameter& p : out.parameters)
      if (p.at_limit) out.notes.push_back(p.unknown.name + " is held by a limit of its card");
    if (!out.noise_declared && !(out.degrees_of_freedom > 0))
      out.notes.push_back("as many unknowns as readings and no declared noise: no standard uncertainties");
    if (out.chi_squared_probability < 1e-6)
      out.notes.push_back(fmt::format("the residuals are {:.3g} times what the declared noise explains: is a unit, a "
                                      "label or a reading wrong, an effect missing, or the noise larger?",
                                      out.s));
    outlier(out);
  }

  /// The largest residual, if it stands out from the others' middle.
  void outlier(Estimate& out) const {
    std::vector<double> sizes;
    for (const Row& r : out.rows) sizes.push_back(std::fabs(r.normalised));
    if (sizes.size() < 5 || !defined()) return;
    const double scale = median_of(sizes) / 0.6744897501960817;
    const auto largest = std::max_element(sizes.begin(), sizes.end());
    if (!(*largest > 8 * scale) || !(*largest > (out.noise_declared ? 5 : 0))) return;
    const Row& row = out.rows[static_cast<std::size_t>(largest - sizes.begin())];
    const auto& indication = experiment_.model().card->indications[row.indication];
    const std::string unit(indication.unit),
        name = propagation::reading_name(experiment_.scenario().readings[row.reading]);
    out.notes.push_back(
        fmt::format("reading {}{} stands out: {} is {:.4g}{} from the fit, {:.3g} times the usual residual",
                    row.reading + 1, name.empty() ? "" : " (" + name + ")", indication.name,
                    units::from_si(row.residual, unit, std::string(indication.si_unit), units::Kind::difference),
                    unit == "1" ? "" : " " + unit, *largest / scale));
  }

  const propagation::Experiment& experiment_;
  std::vector<Unknown> unknowns_;
  Data data_;
  Simulation simulation_;
  Priors priors_;
  std::size_t n_, p_;
  Loss loss_;
  double width_ = 1;
  std::vector<double> x_;
  least_squares::Solution solution_;
  double sigma_ = 1, cost_before_ = 0;
  int iterations_ = 0, evaluations_ = 0;
  bool scale_settled_ = true;
};

} // namespace

Estimate estimate(const propagation::Experiment& experiment, const Options& options) {
  return Fit(experiment, options).estimate();
}

} // namespace gumshoe::calibration
