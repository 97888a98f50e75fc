#include "calibration/data.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "quantities/cells.h"

namespace gumshoe::calibration {
namespace {

using propagation::Experiment;

/// Card of the size of a stated effect; its unit is in the scenario.
constexpr QuantityCard size_card{"size", "", "", 0, {-HUGE_VAL, HUGE_VAL}, "", "", Role::amplitude};

/// The card of a quantity of the model, of an active effect or of a stated one.
const QuantityCard& card_of(const Experiment& e, std::size_t quantity) {
  if (quantity >= e.layout().effects.end) return size_card;
  if (e.layout().model.contains(quantity)) return e.model().card->quantities[quantity];
  const std::size_t at = quantity - e.layout().effects.begin;
  const effects::Active* owner = nullptr;
  for (const effects::Active& a : e.forward().active())
    if (a.first <= at) owner = &a;
  return effects::cards()[owner->effect]->quantities[at - owner->first];
}

std::size_t column_of(const Experiment& e, std::size_t quantity, std::size_t entry) {
  const auto& labels = e.scenario().quantities[quantity].entries[entry].labels;
  const auto& readings = e.scenario().readings;
  for (std::size_t r = 0; r < readings.size(); ++r)
    if (quantities::holds_for(labels, readings[r].labels)) return e.plan().gather[r][quantity];
  return e.plan().columns.size(); // no reading uses it
}

/// u^2 of the deviation; `finite` is false for a t distribution without a variance.
double variance(const quantities::Distribution& d, bool& finite) {
  finite = std::isfinite(d.variance());
  return d.standard_uncertainty() * d.standard_uncertainty();
}

/// How well the declared noise of readings is known.
class FreedomOfNoise {
public:
  static constexpr double few = 20; ///< degrees of freedom below which a reading's own s is a weight by chance

  void add(const quantities::SamplePlan& plan, const std::vector<std::size_t>& variates, int repeats) {
    double known = 0, t = 0, freedom = HUGE_VAL;
    for (const std::size_t v : variates) {
      const quantities::Distribution& d = plan.variates[v].distribution;
      const double square = d.standard_uncertainty() * d.standard_uncertainty();
      if (d.family == quantities::Family::t)
        t += square, freedom = std::min(freedom, d.parameters[2]);
      else
        known += square;
    }
    least_ = std::min(least_, freedom);
    const double s = std::sqrt(t * repeats), share = t > 0 ? t / (t + known) : 0;
    low_ = std::min(low_, s), high_ = std::max(high_, s);
    effective_ = std::min(effective_, share > 0 ? freedom / (share * share) : HUGE_VAL);
  }
  double common() const { return one_s() ? effective_ : HUGE_VAL; }
  double own() const { return one_s() ? HUGE_VAL : least_; }

private:
  bool one_s() const { return high_ - low_ <= 1e-9 * high_; }
  double least_ = HUGE_VAL, effective_ = HUGE_VAL, low_ = HUGE_VAL, high_ = 0;
};

} // namespace

void refuse(const std::string& file, std::string what, std::string why, std::string remedy) {
  std::vector<Problem> problems(1);
  problems[0].where.file = file;
  problems[0].what = std::move(what);
  problems[0].why = std::move(why);
  problems[0].remedy = std::move(remedy);
  throw InputError(std::move(problems));
}

std::vector<Unknown> unknowns_of(const Experiment& e) {
  const auto& s = e.scenario();
  std::vector<Unknown> out;
  for (std::size_t q = 0; q < s.quantities.size(); ++q) {
    const auto& quantity = s.quantities[q];
    if (!quantity.estimated) continue;
    const QuantityCard& card = card_of(e, q);
    for (std::size_t i = 0; i < quantity.entries.size(); ++i) {
      Unknown u;
      u.quantity = q;
      u.entry = i;
      u.column = column_of(e, q, i);
      if (u.column == e.plan().columns.size()) continue;
      const auto& labels = quantity.entries[i].labels;
      u.name = quantity.name + (labels.empty() ? "" : "[" + quantities::text_of(labels) + "]");
      u.unit = quantity.unit;
      u.si_unit = quantity.si_unit;
      u.start = e.plan().estimate(u.column);
      double squares = 0;
      for (const std::size_t v : e.plan().columns[u.column].variates) {
        bool finite = true;
        squares += variance(e.plan().variates[v].distribution, finite);
        if (!finite)
          refuse(s.file, u.name + ": its distribution has no standard uncertainty",
                 "a prior needs a standard uncertainty", "give u with more than 2 degrees of freedom");
      }
      u.prior_u = std::sqrt(squares);
      u.low = card.limits.low;
      u.high = card.limits.high;
      double usual = std::fabs(card.default_value);
      if (q >= e.layout().effects.end) usual = units::to_si(1, u.unit, u.si_unit, units::Kind::difference);
      u.magnitude = u.start != 0 ? std::fabs(u.start) : u.prior_u > 0 ? u.prior_u : usual > 0 ? usual : 1;
      out.push_back(u);
    }
  }
  if (out.empty())
    refuse(s.file, "no quantity is marked estimated", "there is nothing to fit",
           "write estimated = true in a [quantities.NAME]");
  return out;
}

Data data_of(const Experiment& e) {
  const auto& s = e.scenario();
  const auto& plan = e.plan();
  const propagation::Range noise = e.layout().indications;
  const std::size_t indications = noise.size(), n = s.readings.size() * indications;
  Data out;
  std::map<std::size_t, std::vector<std::size_t>> rows_of; // variate to rows
  std::string quiet, loud;
  bool finite = true;
  FreedomOfNoise freedom;
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    if (s.readings[r].indications.size() != indications)
      refuse(s.file, "there are no readings to fit", "no indication has readings",
             "add [indications.NAME] with readings and method = \"propagation\"");
    const auto point = e.reading_point(r);
    for (std::size_t k = 0; k < indications; ++k) {
      const std::size_t row = out.measured.size();
      out.measured.push_back(point[noise[k]]);
      out.weight.push_back(s.readings[r].repeats);
      if (k < s.readings[r].scatter.size()) {
        out.pure_error += s.readings[r].scatter[k];
        out.pure_freedom += s.readings[r].repeats - 1;
      }
      double squares = 0;
      for (const std::size_t v : plan.columns[plan.gather[r][noise[k]]].variates) {
        bool has = true;
        squares += variance(plan.variates[v].distribution, has);
        finite &= has;
        rows_of[v].push_back(row);
      }
      out.u.push_back(std::sqrt(squares));
      freedom.add(plan, plan.columns[plan.gather[r][noise[k]]].variates, s.readings[r].repeats);
      (squares > 0 ? loud : quiet) = s.quantities[noise[k]].name;
    }
  }
  if (!finite)
    out.notes.push_back(
        "the noise is a t distribution with too few degrees of freedom for a standard uncertainty; its scale "
        "s / sqrt(n) is used as the weight of the readings");
  out.noise_declared = !loud.empty();
  out.noise_freedom = freedom.common();
  if (const double own = freedom.own(); own < FreedomOfNoise::few)
    out.notes.push_back(fmt::format(
        "each reading is weighted by the scatter of its own repeats, of {:.3g} degree{} of freedom: such weights are "
        "chance, and the standard uncertainties too small; if all scatter alike, state repeatability = {{ pooled "
        "= true }}",
        own, own == 1 ? "" : "s"));
  if (!loud.empty() && !quiet.empty())
    refuse(s.file, fmt::format("indications.{}: no noise is declared, but {} has some", quiet, loud),
           "the relative weights of the readings are unknown", "repeatability = { s = \"...\" }");
  bool shared = false;
  for (const auto& [v, rows] : rows_of) shared |= rows.size() > 1;
  if (!shared) return out;
  if (n > 5000)
    refuse(s.file, fmt::format("{} readings share draws of their noise", n),
           "a covariance matrix of more than 5000 readings is not built", "per = \"reading\"");
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (const auto& [v, rows] : rows_of) {
    bool unused = true;
    const double square = variance(plan.variates[v].distribution, unused);
    for (const std::size_t a : rows)
      for (const std::size_t b : rows) covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) += square;
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const Eigen::MatrixXd factor = llt.matrixL();
  const double least = factor.diagonal().minCoeff() / factor.diagonal().maxCoeff();
  if (llt.info() != Eigen::Success || !(least > 1e-7))
    refuse(s.file, "indications: readings share all of their noise", "each reading needs some independent noise",
           "write per = \"reading\" for resolution or repeatability");
  for (Eigen::Index a = 0; a < factor.rows(); ++a)
    for (Eigen::Index b = 0; b < factor.cols(); ++b) out.cholesky.push_back(factor(a, b));
  out.notes.push_back("readings share part of their noise; they are weighted by its full covariance matrix");
  return out;
}

void whiten(const Data& data, double* rows, std::size_t columns) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::size_t n = data.measured.size();
  if (!data.cholesky.empty()) {
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::Map<Matrix> all(rows, size, static_cast<Eigen::Index>(columns));
    Eigen::Map<const Matrix>(data.cholesky.data(), size, size).triangularView<Eigen::Lower>().solveInPlace(all);
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double factor = data.noise_declared ? 1 / data.u[i] : std::sqrt(data.weight[i]);
    for (std::size_t j = 0; j < columns; ++j) rows[i * columns + j] *= factor;
  }
}

} // namespace gumshoe::calibration
