#include "tracing/planning/linear_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "calibration/data.h"
#include "quantities/cells.h"
#include "scenario/conditions.h"
#include "tracing/candidates/extended_scenario.h"
#include "tracing/criteria.h"
#include "tracing/judgement/holdout.h"
#include "tracing/planning/further_readings.h"

namespace gumshoe::tracing {
namespace {

using scenario::AllowedReading;
using scenario::Scenario;

/// Share of a column's length that stands for a prior where nothing determines it: far below any share that counts, far
/// above rounding.
constexpr double ridge = 1e-9;
/// Columns shorter than this, of which all readings have the length 1, are zero.
constexpr double least_length = 1e-7;
/// What is left of a column, as a share of its squared length, if the others explain it: above rounding.
constexpr double explained_share = 1e-10;

/// The scenario as it is linearised: with every effect, and asked for nothing but its readings.
Scenario prepared(const Scenario& s) {
  Scenario out = extended(s);
  scenario::predict_readings(out);
  out.trace.priors.clear();
  out.trace.blocks.clear();
  out.trace.final_blocks.clear();
  out.trace.redone.emplace();
  return out;
}

/// Why the model has no value for a reading; empty: it has one.
std::string impossible(Scenario& alone) {
  try {
    const propagation::Experiment experiment(alone);
    const auto found = experiment.forward().indications(experiment.estimates());
    for (const Status status : found.status)
      if (status != Status::ok) return status_name(status);
  } catch (const InputError& error) {
    return error.problems().front().what;
  }
  return {};
}

class Builder {
public:
  Builder(const Scenario& s, int threads) : s_(s), plan_(*s.plan), extended_(prepared(s)), threads_(threads) {}

  LinearModel build() {
    const models::Model& model = s_.made ? *s_.made : *models::find(s_.model);
    if (!model.simulate_gradient && !(model.kernels && model.kernels() && model.kernels()->simulate))
      calibration::refuse(s_.file, fmt::format("[plan]: the model {} cannot simulate its indications", s_.model),
                          "what a reading tells is the derivative of what it would be",
                          s_.made ? "add [model.indications] with a formula for each" : "");
    find_usable();
    name_settings();
    find_setups();
    std::vector<int> twice(plan_.readings.size(), 0);
    for (const std::size_t i : out_.allowed) twice[i] = 2;
    out_.all = with_readings(extended_, twice);
    existing_ = has_readings(s_) ? s_.readings.size() : 0;
    linearise();
    return std::move(out_);
  }

private:
  /// Each reading by itself: one that cannot be must not take the others along.
  void find_usable() {
    const Scenario one_each = with_readings(extended_, std::vector<int>(plan_.readings.size(), 1));
    Scenario alone = one_each;
    const std::size_t first = one_each.readings.size() - plan_.readings.size();
    std::string why;
    for (std::size_t i = 0; i < plan_.readings.size(); ++i) {
      scenario::narrow_to_reading(alone, one_each, first + i);
      const std::string reason = impossible(alone);
      if (reason.empty())
        out_.allowed.push_back(i);
      else
        why = reason;
    }
    const std::size_t left_out = plan_.readings.size() - out_.allowed.size();
    if (out_.allowed.empty())
      calibration::refuse(s_.file, "[plan]: the model has no value for any of the allowed readings", why);
    if (left_out > 0)
      out_.notes.push_back(fmt::format("{} allowed readings are impossible and left out: {}", left_out, why));
  }

  void name_settings() {
    const ModelCard& card = s_.made ? *s_.made->card : *models::find(s_.model)->card;
    std::vector<std::vector<std::string>> words(out_.allowed.size());
    const auto add = [&](const std::string& name, const auto& value_of) {
      std::vector<std::string> all;
      for (const std::size_t i : out_.allowed) all.push_back(value_of(plan_.readings[i]));
      if (std::ranges::all_of(all, [&](const std::string& x) { return x == all.front(); }) && all.size() > 1) return;
      for (std::size_t k = 0; k < all.size(); ++k)
        words[k].push_back(all[k].starts_with(name) ? all[k] : name + " " + all[k]);
    };
    std::vector<std::string> known;
    for (std::size_t c = 0; c < card.conditions.size(); ++c) {
      const VariableCard& v = card.conditions[c];
      known.emplace_back(v.name);
      std::string unit(v.unit);
      for (const scenario::PlanColumn& column : plan_.columns) // as the data state it
        if (column.holds == scenario::PlanColumn::Holds::condition && column.condition == c) unit = column.unit;
      add(known.back(), [&](const AllowedReading& r) {
        return fmt::format("{:.6g}{}", units::from_si(r.conditions[c], unit, std::string(v.si_unit)),
                           units::suffix(unit));
      });
    }
    for (const auto& [label, value] : plan_.readings.front().labels)
      if (std::ranges::find(known, label) == known.end())
        add(label, [&](const AllowedReading& r) { return *quantities::label_value(r.labels, label); });
    for (std::size_t c = 0; c < s_.trace.columns.size(); ++c) {
      const auto& column = s_.trace.columns[c];
      add(column.name, [&](const AllowedReading& r) {
        return fmt::format("{:.6g}{}", units::from_si(r.columns[c], column.unit, column.si_unit),
                           units::suffix(column.unit));
      });
    }
    for (const auto& w : words) out_.settings.push_back(fmt::format("{}", fmt::join(w, ", ")));
  }

  void find_setups() {
    for (const std::size_t i : out_.allowed) {
      out_.cost.push_back(plan_.readings[i].cost);
      out_.opens.emplace_back();
      for (const auto& [label, value] : new_values(s_, plan_.readings[i])) {
        const std::string name = value.starts_with(label) ? value : label + " " + value;
        auto at = std::ranges::find(out_.setups, name);
        if (at == out_.setups.end()) {
          const auto cost = std::ranges::find(plan_.setup_costs, label, &std::pair<std::string, double>::first);
          out_.setups.push_back(name);
          out_.opening.push_back(cost == plan_.setup_costs.end() ? 0 : cost->second);
          at = out_.setups.end() - 1;
        }
        out_.opens.back().push_back(static_cast<std::size_t>(at - out_.setups.begin()));
      }
    }
  }

  [[noreturn]] void no_value() const {
    calibration::refuse(s_.file, "[plan]: the model cannot be linearised at its readings and those that are allowed",
                        "it has no value there");
  }

  void linearise() {
    const propagation::Experiment experiment(out_.all);
    const Observations observations = observe(experiment);
    const Simulator simulator(experiment, threads_);
    std::vector<bool> chosen(out_.all.readings.size(), false);
    std::fill_n(chosen.begin(), existing_, true);
    const std::vector<Index> rows = rows_where(observations, chosen);
    const Fitter fitter(experiment, simulator, observations, rows, threads_);
    out_.noise_declared = fitter.noise_declared();
    out_.indications = observations.indications;
    out_.fit = fitter.linearised(1);
    if (!out_.fit.valid) no_value();
    out_.values = static_cast<int>(rows.size());
    out_.noise_known = out_.noise_declared || rows.size() > independent(out_.fit.design, rows).size();
    const bool fitted = existing_ > 0 && out_.noise_known;
    if (fitted) out_.fit = fitter.fit({}, out_.noise_declared ? 1 : 0);
    if (!out_.fit.valid) no_value();
    out_.at = fitted ? fitter.without_draws(out_.fit) : out_.fit.at;
    if (!out_.noise_declared && fitted) out_.noise = std::sqrt(out_.fit.variance);
    if (fitted && !out_.fit.converged)
      out_.notes.push_back("the fit of the readings did not converge; the plan holds for the point at which it ended");
    if (fitted && out_.fit.covariance_model.correlation > 0)
      out_.notes.push_back(
          "successive readings are correlated beyond what is declared; the plan takes them as declared");
    columns(experiment, simulator, observations, fitter);
  }

  /// All columns, then their information reading by reading.
  void columns(const propagation::Experiment& experiment, const Simulator& simulator, const Observations& observations,
               const Fitter& fitter) {
    const Design& d = out_.fit.design;
    const Index fixed = d.fixed.cols(), random = d.random.cols();
    find_effects(experiment, simulator, observations);
    Index count = fixed + random;
    for (EffectColumns& e : out_.effects)
      for (Index j = 0; j < e.candidate.columns.cols(); ++j) e.columns.push_back(count++);
    Matrix all(d.fixed.rows(), count);
    all.leftCols(fixed) = d.fixed;
    all.middleCols(fixed, random) = d.random;
    for (const EffectColumns& e : out_.effects)
      all.middleCols(e.columns[0], e.candidate.columns.cols()) = e.candidate.columns;
    name_columns(experiment, fitter, fixed, random, count);
    weigh(all, fixed, random);
    for (QuantityColumns* q : named()) // coefficients of the scaled columns
      for (std::size_t j = 0; j < q->columns.size(); ++j) q->weight[index(j)] *= out_.unit[index(q->columns[j])];
  }

  std::vector<QuantityColumns*> named() {
    std::vector<QuantityColumns*> out;
    for (auto& q : out_.unknowns) out.push_back(&q);
    for (auto& q : out_.declared) out.push_back(&q);
    return out;
  }

  void find_effects(const propagation::Experiment& experiment, const Simulator& simulator,
                    const Observations& observations) {
    std::set<std::string> wanted(plan_.split.begin(), plan_.split.end());
    wanted.insert(plan_.detect.begin(), plan_.detect.end());
    if (wanted.empty()) return;
    const auto skip = [&](const Candidate& a) {
      return a.finite != 0 || (!wanted.contains(a.name) && !wanted.contains(a.amplitudes[0].scenario_name));
    };
    const double step = criteria.secant_step * out_.fit.design.reference[0];
    for (Candidate& a : physical_candidates(experiment, simulator, out_.fit.at, observations, step, skip))
      out_.effects.push_back({std::move(a), {}});
  }

  void name_columns(const propagation::Experiment& experiment, const Fitter& fitter, Index fixed, Index random,
                    Index count) {
    const auto& plan = experiment.plan();
    const auto& quantities = out_.all.quantities;
    out_.quantity.assign(index(count), Amplitude::npos);
    for (Index j = 0; j < fixed; ++j) {
      const FreeUnknown& u = fitter.unknowns()[index(j)];
      out_.free.push_back(j);
      out_.quantity[index(j)] = u.quantity;
      out_.unknowns.push_back(
          {u.name, quantities[u.quantity].unit, quantities[u.quantity].si_unit, {j}, Vector::Ones(1)});
    }
    // Indexed by place: tied variates of a group act through the factor of their matrix.
    std::vector<Index> column(plan.variates.size(), -1);
    for (Index j = 0; j < random; ++j) {
      column[out_.fit.draw_of[index(j)]] = fixed + j;
      out_.quantity[index(fixed + j)] = plan.variates[out_.fit.draw_of[index(j)]].quantity;
    }
    for (std::size_t v = 0; v < plan.variates.size(); ++v) {
      if (column[v] < 0) continue;
      std::vector<std::pair<Index, double>> parts{{column[v], 1.0}};
      for (const auto& group : plan.copulas) {
        const auto at = std::ranges::find(group.variates, v);
        if (at == group.variates.end()) continue;
        const auto i = static_cast<std::size_t>(at - group.variates.begin());
        parts.clear();
        for (std::size_t k = 0; k <= i; ++k)
          if (column[group.variates[k]] >= 0)
            parts.emplace_back(column[group.variates[k]], group.cholesky[i * group.variates.size() + k]);
      }
      const auto& variate = plan.variates[v];
      const std::string name = variate.name.substr(0, variate.name.find(": "));
      auto known = std::ranges::find(out_.declared, name, &QuantityColumns::name);
      if (known == out_.declared.end()) {
        const auto& q = quantities[variate.quantity];
        out_.declared.push_back({name, q.unit, q.si_unit, {}, {}});
        known = out_.declared.end() - 1;
      }
      for (const auto& [j, share] : parts) {
        auto at = std::ranges::find(known->columns, j);
        if (at == known->columns.end()) {
          known->columns.push_back(j);
          known->weight.conservativeResize(index(known->columns.size()));
          known->weight[index(known->columns.size() - 1)] = 0;
          at = known->columns.end() - 1;
        }
        known->weight[at - known->columns.begin()] += variate.distribution.standard_uncertainty() * share;
      }
    }
  }

  void weigh(const Matrix& all, Index fixed, Index random) {
    const Design& d = out_.fit.design;
    const auto k = index(d.indications);
    const Index count = all.cols();
    const auto white = [&](std::size_t place) {
      Matrix out = all.middleRows(index(place) * k, k);
      d.local[place].triangularView<Eigen::Lower>().solveInPlace(out);
      return Matrix(out / out_.noise);
    };
    std::vector<std::size_t> place(out_.all.readings.size()); // of each reading in the sequence
    for (std::size_t p = 0; p < d.local.size(); ++p) place[d.reading[p * d.indications]] = p;
    out_.base = Matrix::Zero(count, count);
    for (std::size_t r = 0; r < existing_; ++r) {
      const Matrix one = white(place[r]);
      out_.base += one.transpose() * one;
    }
    Vector squares = out_.base.diagonal();
    for (std::size_t i = 0; i < out_.allowed.size(); ++i) {
      out_.rows.push_back(white(place[existing_ + 2 * i]));
      squares += out_.rows.back().colwise().squaredNorm().transpose();
    }
    out_.base.diagonal().segment(fixed, random).array() += 1; // the draws as declared
    squares.segment(fixed, random).array() += 1;
    Vector factor(count);
    for (Index j = 0; j < count; ++j) factor[j] = squares[j] > 0 ? 1 / std::sqrt(squares[j]) : 1;
    out_.unit.assign(factor.begin(), factor.end());
    for (Matrix& one : out_.rows) one = one * factor.asDiagonal();
    out_.base = factor.asDiagonal() * out_.base * factor.asDiagonal();
    out_.base.diagonal().array() += ridge;
  }

  const Scenario& s_;
  const scenario::Plan& plan_;
  const Scenario extended_;
  int threads_;
  std::size_t existing_ = 0;
  LinearModel out_;
};

} // namespace

std::vector<Index> LinearModel::nuisances(const std::vector<const EffectColumns*>& of) const {
  std::vector<Index> out;
  const auto taken = [&](std::size_t q) {
    return std::ranges::any_of(of, [&](const EffectColumns* e) {
      return std::ranges::any_of(e->candidate.amplitudes,
                                 [&](const Amplitude& a) { return a.quantity == q && a.labels.empty(); });
    });
  };
  for (std::size_t j = 0; j < quantity.size(); ++j)
    if (quantity[j] != Amplitude::npos && !taken(quantity[j])) out.push_back(index(j));
  return out;
}

std::vector<QuantityColumns> LinearModel::quantities_named(const std::string& name) const {
  std::vector<QuantityColumns> out;
  for (const auto* list : {&unknowns, &declared})
    for (const QuantityColumns& q : *list)
      if (q.name == name || q.name.starts_with(name + "[")) out.push_back(q);
  return out;
}

double LinearModel::stated_size(const Amplitude& a) const {
  if (a.quantity == Amplitude::npos || a.declared > 0) return 0;
  return all.quantities[a.quantity].entries.front().value;
}

int LinearModel::fitted(const PlanGoal& goal, const Matrix& information) const {
  std::vector<Index> columns = goal.of;
  for (const Index j : goal.others) // a declared draw is part of the noise
    if (quantity[index(j)] == Amplitude::npos || std::ranges::find(free, j) != free.end()) columns.push_back(j);
  Matrix m = information(columns, columns);
  m.diagonal().array() -= ridge;
  const Vector length = m.diagonal().cwiseMax(0).cwiseSqrt();
  std::vector<Index> some;
  for (Index j = 0; j < m.rows(); ++j)
    if (length[j] > least_length) some.push_back(j);
  if (some.empty()) return 0;
  const Vector scale = length(some).cwiseInverse();
  Eigen::FullPivLU<Matrix> left(scale.asDiagonal() * m(some, some) * scale.asDiagonal());
  left.setThreshold(explained_share);
  return static_cast<int>(left.rank());
}

double LinearModel::share_left(const PlanGoal& goal, const Matrix& information) const {
  PlanGoal one = goal;
  one.kind = PlanGoal::Kind::size;
  one.required = 1;
  for (std::size_t j = 0; j < one.of.size(); ++j)
    one.weight[index(j)] = 1 / std::sqrt(information(one.of[j], one.of[j]));
  return reached(one, information);
}

double LinearModel::undetermined(const PlanGoal& goal) const { return goal.weight.norm() / std::sqrt(1e3 * ridge); }

LinearModel linear_model(const Scenario& s, int threads) { return Builder(s, threads).build(); }

} // namespace gumshoe::tracing
