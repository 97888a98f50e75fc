#include "made/full_results.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <boost/math/distributions/normal.hpp>

#include "store/result_file.h"

namespace gumshoe::made {
using namespace analysis;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), um = 1e-6, mm = 1e-3, deg = std::numbers::pi / 180;
constexpr double centre[] = {12.3456 * mm, 8.4 * um, 170 * deg, 3.2 * um};
constexpr double spread[] = {2.1 * um, 1.7 * um, 11 * deg, 1.9 * um};

Contribution contribution(const char* name, const char* unit, const char* si, double estimate, double u, double c,
                          const char* distribution, double dof = std::numeric_limits<double>::infinity()) {
  Contribution row;
  row.name = row.quantity = name;
  row.unit = unit;
  row.si_unit = si;
  row.estimate = estimate;
  row.standard_uncertainty = u;
  row.sensitivity = c;
  row.contribution = std::abs(c) * u;
  row.distribution = distribution;
  row.degrees_of_freedom = dof;
  row.evaluation = std::isfinite(dof) ? 'A' : 'B';
  row.monte_carlo_share = none;
  row.source = "assumed";
  return row;
}

Budget budget(const propagation::Output& output, double estimate, std::vector<Contribution> rows,
              double correlation_share) {
  Budget b;
  b.output = output;
  b.estimate = estimate;
  double variance = 0;
  for (const Contribution& row : rows) variance += row.contribution * row.contribution;
  variance /= 1 - correlation_share;
  for (Contribution& row : rows) row.share = row.contribution * row.contribution / variance;
  b.contributions = std::move(rows);
  b.correlation_share = correlation_share;
  b.monte_carlo_interactions = none;
  b.combined_standard_uncertainty = std::sqrt(variance);
  b.second_order_uncertainty = 1.5 * b.combined_standard_uncertainty;
  b.second_order_bias = 0.4 * um;
  b.effective_degrees_of_freedom = correlation_share == 0 ? 41 : none;
  b.coverage_factor = 2.02;
  b.expanded_uncertainty = b.coverage_factor * b.combined_standard_uncertainty;
  return b;
}

Summary summary(std::size_t k) {
  Summary s;
  s.output = outputs()[k];
  s.valid = samples;
  s.estimate = centre[k];
  s.estimate_se = spread[k] / std::sqrt(double(samples));
  s.standard_uncertainty = spread[k];
  s.standard_uncertainty_se = spread[k] / 36;
  s.kurtosis = 3;
  s.symmetric = {centre[k] - 1.96 * spread[k], centre[k] + 1.96 * spread[k], 0, 0, 0, 0};
  s.shortest = s.symmetric;
  s.hill_index = none;
  for (int i = 0; i <= 40; ++i) s.bin_edges.push_back(centre[k] + (i - 20) * 0.2 * spread[k]);
  for (int i = 0; i < 40; ++i) {
    const double x = (i - 19.5) * 0.2;
    s.density.push_back(std::exp(-x * x / 2) / (spread[k] * std::sqrt(2 * std::numbers::pi)));
  }
  return s;
}

Index index(const char* input, double value, double half, const char* verdict = "resolved") {
  return {input, value, value - half, value + half, verdict};
}
SobolIndex sobol(const char* input, double first, double total) {
  return {input,     first,        first - 0.012, first + 0.012,
          total,     total - 0.01, total + 0.01,  first > 0.012 ? "resolved" : "zero within its interval",
          "resolved"};
}

void add_budgets(Results& r) {
  const auto o = outputs();
  r.budgets.push_back(budget(o[0], centre[0],
                             {contribution("rod_length", "mm", "m", 0.160591, um, 1, "normal"),
                              contribution("beam_radius", "mm", "m", 0.00075, 1.5 * um, -0.4, "rectangular"),
                              contribution("spindle_z", "mm", "m", -0.3299, 0.5 * um, 1, "t", 4),
                              contribution("beam_pitch", "deg", "rad", 0, 0.2 * deg, 0, "normal"),
                              contribution("camera_angle", "deg", "rad", 0, 0.3 * deg, 0, "normal")},
                             0));
  const double firsts[] = {0.227, 0.082, 0.113, 0.2, 0.001};
  for (std::size_t i = 0; i < 5; ++i) r.budgets[0].contributions[i].monte_carlo_share = firsts[i];
  r.budgets[0].monte_carlo_interactions = 0.377;
  const std::vector<Contribution> runout = {contribution("runout_x", "um", "m", 6 * um, 1.2 * um, 0.71, "normal"),
                                            contribution("runout_y", "um", "m", 5.9 * um, 1.4 * um, 0.7, "normal")};
  r.budgets.push_back(budget(o[1], centre[1], runout, 0.31));
  r.budgets.push_back(budget(o[2], centre[2],
                             {contribution("runout_x", "um", "m", 6 * um, 1.2 * um, -84000, "normal"),
                              contribution("runout_y", "um", "m", 5.9 * um, 1.4 * um, 85000, "normal")},
                             -0.2));
  Budget kink = budget(o[3], centre[3], {contribution("tilt", "deg", "rad", 0, 0.1 * deg, none, "normal")}, 0);
  kink.applicable = false;
  kink.reason = "there is no derivative at the estimate with respect to tilt";
  kink.contributions[0].differentiable = false;
  kink.contributions[0].share = none;
  kink.combined_standard_uncertainty = kink.expanded_uncertainty = none;
  r.budgets.push_back(kink);
}

void add_sensitivity(Results& r) {
  const auto o = outputs();
  Sensitivity s{o[0], 65536, 12, 0.95, {}, {}};
  s.indices = {sobol("rod_length", 0.227, 0.228), sobol("beam_radius", 0.082, 0.082), sobol("spindle_z", 0.113, 0.113),
               sobol("beam_pitch", 0.2, 0.576), sobol("camera_angle", 0.001, 0.376)};
  s.pairs = {{"beam_pitch", "camera_angle", 0.375, 0.36, 0.39, "resolved"},
             {"rod_length", "beam_pitch", 0.001, -0.014, 0.016, "zero within its interval"}};
  r.sensitivities = {s};
  r.shapley = {{o[1], 4096, 0, {index("runout_x", 0.41, 0.02), index("runout_y", 0.59, 0.02)}}};
  r.given_data = {{o[0],
                   samples,
                   3,
                   {index("rod_length", 0.22, 0.05), index("beam_radius", 0.09, 0.05), index("spindle_z", 0.10, 0.05),
                    index("beam_pitch", 0.21, 0.05), index("camera_angle", 0.0, 0.05, "zero within its interval")},
                   {index("rod_length", 0.17, 0.02), index("beam_radius", 0.07, 0.02), index("spindle_z", 0.08, 0.02),
                    index("beam_pitch", 0.24, 0.02), index("camera_angle", 0.06, 0.02)}}};
  r.morris = {{o[0],
               64,
               1,
               {{"rod_length", um, um, 0, 0},
                {"beam_radius", -0.6 * um, 0.6 * um, 0, 0.01 * um},
                {"spindle_z", 0.7 * um, 0.7 * um, 0.01 * um, 0.05 * um},
                {"beam_pitch", 0.1 * um, 1.6 * um, 0.2 * um, 1.9 * um},
                {"camera_angle", -0.05 * um, 1.2 * um, 0.15 * um, 1.4 * um}}}};
  r.dgsm = {{o[0],
             4096,
             0,
             true,
             {{"rod_length", 1, 0, 0.2268, 0.22, 0.24},
              {"spindle_z", 1, 0, none, none, none},
              {"beam_pitch", 2.1e-7, 1e-8, 1.12, 1.0, 1.25}}}};
  r.one_at_a_time = {{"each error given 100 um or 0.1 mrad",
                      {o[0], o[1]},
                      {{"rod_length", "um", "m", 100 * um, {100 * um, 0}, {-100 * um, 0}},
                       {"beam_pitch", "mrad", "rad", 1e-4, {0.02 * um, 0}, {0.02 * um, 0}},
                       {"runout_x", "um", "m", 100 * um, {0, 92 * um}, {0, none}}}}};
}

JointRegion region(const std::vector<std::size_t>& members, double r12, double r13, double r23) {
  JointRegion region;
  const double r[3][3] = {{1, r12, r13}, {r12, 1, r23}, {r13, r23, 1}};
  for (std::size_t a = 0; a < members.size(); ++a) {
    region.outputs.push_back(outputs()[members[a]]);
    region.estimate.push_back(centre[members[a]]);
    for (std::size_t b = 0; b < members.size(); ++b) {
      region.correlation.push_back(r[a][b]);
      region.covariance.push_back(r[a][b] * spread[members[a]] * spread[members[b]]);
    }
  }
  region.k_p = members.size() == 2 ? 2.4477 : 2.7955;
  region.k_p_se = 0.011;
  region.k_q = members.size() == 2 ? 2.2121 : 2.3882;
  region.k_q_se = 0.009;
  return region;
}

void add_joint(Results& r) {
  const auto o = outputs();
  r.joint = {region({0, 1}, -0.55, 0, 0), region({0, 1, 2}, -0.55, 0.2, 0.4), region({1, 3}, 1, 0, 0)};
  r.joint[0].gum_covariance = r.joint[0].covariance;
  r.joint[2].k_p = r.joint[2].k_p_se = none;
  r.joint[2].remark = "no ellipsoid: the measurands are linearly dependent";
  FitCovariance fit;
  fit.outputs = {o[0], o[1]};
  fit.standard_uncertainty = {0.8 * spread[0], 1.1 * spread[1]};
  fit.covariance = {0.64 * spread[0] * spread[0], -0.44 * spread[0] * spread[1], -0.44 * spread[0] * spread[1], 1.21 * spread[1] * spread[1]};
  fit.correlation = {1, -0.5, -0.5, 1};
  fit.equations = 24;
  fit.degrees_of_freedom = 22;
  fit.scatter = 2 * um;
  fit.chi_squared = fit.probability = none;
  fit.output = o[0];
  fit.meaning = "from the residuals, as if every indication had an independent error of the same size";
  r.fits = {fit};
  r.circular = {{o[2], 171.2 * deg, 0.982, 10.9 * deg, 149 * deg, 193 * deg,
                 "14 % of the samples lie across the cut of the circle"}};
  ConformityResult c;
  c.output = o[0];
  c.lower = centre[0] - 8 * um;
  c.upper = centre[0] + 6 * um;
  c.guard_band = 3 * um;
  c.rule = "stated";
  c.acceptance_lower = c.lower + c.guard_band;
  c.acceptance_upper = c.upper - c.guard_band;
  c.estimate = centre[0];
  c.conformance_probability = 0.9978;
  c.conformance_probability_se = 0.0018;
  c.accepted = true;
  c.specific_consumer_risk = 0.0022;
  c.specific_producer_risk = none;
  c.process_mean = centre[0] - um;
  c.process_u = 3 * um;
  c.process_conformance = 0.98;
  c.posterior_conformance = 0.9985;
  c.posterior_conformance_se = 0.0004;
  c.global_consumer_risk = 0.0009;
  c.global_consumer_risk_se = 0.0001;
  c.global_producer_risk = 0.151;
  c.global_producer_risk_se = 0.001;
  c.statement = "height is accepted: it lies within the acceptance limits";
  ConformityResult rejected;
  rejected.output = o[1];
  rejected.rule = "simple_acceptance";
  rejected.lower = rejected.acceptance_lower = none;
  rejected.upper = rejected.acceptance_upper = 7 * um;
  rejected.estimate = centre[1];
  rejected.conformance_probability = 0.205;
  rejected.conformance_probability_se = 0.016;
  rejected.specific_consumer_risk = none;
  rejected.specific_producer_risk = 0.205;
  rejected.process_mean = rejected.process_u = rejected.process_conformance = none;
  rejected.posterior_conformance = rejected.posterior_conformance_se = none;
  rejected.global_consumer_risk = rejected.global_producer_risk = none;
  rejected.global_consumer_risk_se = rejected.global_producer_risk_se = none;
  rejected.statement = "runout is rejected";
  r.conformity = {c, rejected};
}

void add_planning(Results& r) {
  TargetResult t;
  t.output = outputs()[0];
  t.wanted = 3 * um;
  t.present = 4.1 * um;
  t.reached = 3 * um;
  t.cost_ratio = 1.8;
  t.rows = {{"rod_length", "um", "m", um, none, 0.7 * um, 3, 0.6 * um},
            {"beam_pitch", "deg", "rad", 0.2 * deg, 0.11 * deg, std::numeric_limits<double>::infinity(), 1, 0.12 * deg},
            {"spindle_z", "um", "m", 0.5 * um, none, none, none, none}};
  t.statement = "U = 3.0 um can be had from beam_pitch alone";
  r.targets = {t};
  r.stopping.rule = "stein";
  r.stopping.block = 10000;
  r.stopping.jcgm_trials = 120000;
  r.stopping.stein_trials = 640000;
  r.stopping.trials = 640000;
  r.stopping.tolerance = {0.05 * um, 0.05 * um, 0.5 * deg, 0.05 * um};
  r.stopping.statement = "the two-stage rule asked for 640000 trials";
}

} // namespace

std::vector<propagation::Output> outputs() {
  return {{"height", "height", 0, "mm", "m"},
          {"runout", "runout", 0, "um", "m"},
          {"runout_angle", "runout_angle", 0, "deg", "rad"},
          {"loss", "loss", 0, "um", "m"}};
}

double value(std::size_t output, std::uint64_t i) {
  const std::uint64_t shuffled = (i * (211 + 2 * output)) % samples; // both odd factors share nothing with 640
  const double p = (static_cast<double>(shuffled) + 0.5) / static_cast<double>(samples);
  return centre[output] + spread[output] * boost::math::quantile(boost::math::normal(), p);
}

Results full_results() {
  Results r;
  r.title = "made up: every study";
  r.model = r.model_title = "made_up";
  r.method = "propagation";
  r.samples = samples;
  r.version = "0";
  r.readings.push_back({{}, {}, {}, 1});
  for (std::size_t k = 0; k < outputs().size(); ++k) {
    r.summaries.push_back(summary(k));
    r.summaries[k].statement = outputs()[k].name + " in words";
    r.validations.push_back({outputs()[k], 0.05 * um, 2 * um, 1.6 * um, 0.004 * um, 2, "not validated",
                             "an end differs by more than delta"});
  }
  r.validations[3].verdict = "not applicable";
  r.validations[3].reason = "there is no derivative at the estimate with respect to tilt";
  r.summaries[3].standard_uncertainty = r.summaries[3].standard_uncertainty_se = none;
  r.summaries[3].hill_index = 1.6;
  r.summaries[3].warning = "no standard uncertainty: Hill's tail index is 1.6, the variance does not settle";
  r.summaries[1].hill_index = 3.4;
  r.summaries[1].tail_remark = "heavy tails, Hill's tail index 3.4: the standard error of u is worth little";
  add_budgets(r);
  add_sensitivity(r);
  add_joint(r);
  add_planning(r);
  return r;
}

void write_full_result(const std::string& path) {
  store::Identity id;
  id.scenario_text = "# Question: does every study reach the page?\n";
  id.scenario_file = "made_up.toml";
  id.model = "made_up";
  id.design = "monte_carlo";
  id.samples = samples;
  store::ResultFile file(path, id, outputs(), {"1"});
  propagation::ResultBlock block{0, samples, {}, std::vector<std::uint8_t>(samples, 0)};
  for (std::size_t k = 0; k < outputs().size(); ++k)
    for (std::uint64_t i = 0; i < samples; ++i) block.outputs.push_back(value(k, i));
  file.write(block);
  file.finish(full_results());
}

} // namespace gumshoe::made
