#include "analysis/analyse.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/certificate.h"
#include "analysis/circular.h"
#include "analysis/comparison.h"
#include "analysis/conformity.h"
#include "analysis/differences.h"
#include "analysis/failures.h"
#include "analysis/fit.h"
#include "analysis/given_data.h"
#include "analysis/gum.h"
#include "analysis/index_verdict.h"
#include "analysis/joint.h"
#include "analysis/record.h"
#include "analysis/rounding.h"
#include "analysis/scale_points.h"
#include "analysis/screening.h"
#include "analysis/shapley.h"
#include "analysis/sobol.h"
#include "analysis/summary.h"
#include "analysis/tails.h"
#include "analysis/target.h"
#include "analysis/validation.h"
#include "base/instruction_set.h"
#include "base/progress.h"
#include "base/special_values.h"
#include "base/units.h"
#include "base/version.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

std::string statement(const Summary& s, const Budget& b, const Validation& v, double p, bool virtual_experiment) {
  const auto shown = [&](double x) { return units::from_si(x, s.output.unit, s.output.si_unit); };
  const auto width = [&](double x) {
    return units::from_si(x, s.output.unit, s.output.si_unit, units::Kind::difference);
  };
  const std::string unit = units::suffix(s.output.unit);
  if (s.standard_uncertainty == 0 && s.valid > 1)
    return fmt::format("{} = {:.10g}{}, the same in every sample.", s.output.name, shown(s.estimate), unit);
  const int d = decimals_for(width(
      std::isfinite(s.standard_uncertainty) ? s.standard_uncertainty : 0.25 * (s.symmetric.high - s.symmetric.low)));
  constexpr std::string_view said_before = "no standard uncertainty: ";
  const std::string why =
      s.warning.substr(std::min(s.warning.size(), s.warning.find(said_before) == s.warning.npos
                                                      ? std::size_t{0}
                                                      : s.warning.find(said_before) + said_before.size()));
  std::string text = fmt::format("{} = {}{}", s.output.name, fixed(shown(s.estimate), d), unit);
  if (s.estimate_is_median) text += " (the median, because the mean does not settle)";
  if (std::isfinite(s.standard_uncertainty))
    text += fmt::format("{} u = {}{}",
                        virtual_experiment ? " in the mean, with a standard deviation" : " with a standard uncertainty",
                        fixed(width(s.standard_uncertainty), d), unit);
  else
    text += " without a standard uncertainty (" + why + ")";
  if (std::isnan(s.shortest.low))
    text += " and without a coverage interval" +
            (std::isfinite(s.standard_uncertainty) ? " (" + s.warning + ")" : std::string());
  else
    text += fmt::format("; the shortest {} coverage interval is [{}, {}]{}", coverage_text(p),
                        fixed(shown(s.shortest.low), d), fixed(shown(s.shortest.high), d), unit);
  if (b.applicable && b.expanded_uncertainty > 0) {
    const double U = width(b.expanded_uncertainty); // to its own two digits (JCGM 100, 7.2.6)
    text +=
        fmt::format(". GUM framework: U = {}{} with k = {:.2f}{}{}", fixed(U, decimals_for(U)), unit, b.coverage_factor,
                    std::isfinite(b.effective_degrees_of_freedom)
                        ? fmt::format(" ({})", effective_freedom(b.effective_degrees_of_freedom))
                        : "",
                    v.verdict == "validated" ? uncertainty_of_factor(s, b) : "");
    if (!b.remark.empty()) text += "; " + b.remark;
    if (v.verdict != "validated") text += fmt::format(" ({} by Monte Carlo)", v.verdict);
  }
  text += ".";
  if (!s.tail_remark.empty()) text += " (" + s.tail_remark + ".)";
  return text;
}

namespace {

/// Warns where samples in double precision are too coarse for the uncertainty.
void warn_of_resolution(Summary& s, const Budget& b) {
  const double u =
      b.applicable && b.combined_standard_uncertainty > 0 ? b.combined_standard_uncertainty : s.standard_uncertainty;
  if (resolved(s, u)) return;
  const auto width = [&](double x) { return with_suitable_unit(x, s.output.unit, s.output.si_unit); };
  s.warning += fmt::format("{}numbers of double precision are {} apart here: the samples do not show a standard "
                           "uncertainty of {}; state the difference from a nominal value",
                           s.warning.empty() ? "" : "; ", width(spacing_of_doubles(s.estimate)), width(u));
}

void describe(Results& r, const propagation::Experiment& e) {
  const auto& s = e.scenario();
  const ModelCard& card = *e.model().card;
  r.title = s.title;
  r.model = s.model;
  r.model_title = card.title;
  r.method = scenario::name(s.method);
  r.evaluation = s.evaluation;
  r.scenario_file = s.file;
  r.scenario_text = s.text;
  r.scenario_hash = s.hash;
  r.version = version;
  r.git_hash = git_hash;
  r.instruction_set = name(best_instruction_set());
  r.design = scenario::name(s.run.design);
  r.seed = s.run.seed;
  r.samples = s.run.samples;
  r.coverage_probability = s.analysis.coverage_probability;
  r.notes = scenario::notes_of_a_run(s);
  r.notes.insert(r.notes.end(), e.remarks().begin(), e.remarks().end());
  r.readings = s.readings;
  for (const auto& c : card.conditions)
    r.condition_names.emplace_back(c.name), r.condition_units.emplace_back(c.si_unit),
        r.condition_shown.emplace_back(c.unit);
  for (const auto& i : card.indications)
    r.indication_names.emplace_back(i.name), r.indication_units.emplace_back(i.si_unit),
        r.indication_shown.emplace_back(i.unit);
  r.equations = equations_of(card, s.evaluation);
  r.axes = axis_records(card);
  r.inputs = input_records(s);
}

/// Latin hypercube and Sobol' points are not independent: the standard errors' formulas do not hold for
/// one randomisation of them, so none are stated.
void drop_standard_errors(Summary& s) {
  s.estimate_se = s.standard_uncertainty_se = std::nan("");
  for (Interval* i : {&s.symmetric, &s.shortest}) i->low_se = i->high_se = std::nan("");
}

/// Puts first-order indices next to the GUM contributions, and the remainder under interactions.
void add_monte_carlo_column(Results& r) {
  for (std::size_t o = 0; o < r.sensitivities.size(); ++o) {
    double sum = 0;
    for (const SobolIndex& index : r.sensitivities[o].indices) {
      sum += index.first;
      for (Contribution& c : r.budgets[o].contributions)
        if (c.name == index.input) c.monte_carlo_share = index.first;
    }
    r.budgets[o].monte_carlo_interactions = 1 - sum;
  }
}

/// Marks the indices of outputs without a variance as not converged: they are shares of it.
void doubt_indices(Results& r) {
  const std::string unknown(verdict(nan, nan));
  std::vector<std::string> names;
  for (std::size_t o = 0; o < r.summaries.size(); ++o) {
    if (std::isfinite(r.summaries[o].standard_uncertainty)) continue;
    if (o < r.sensitivities.size()) {
      for (SobolIndex& i : r.sensitivities[o].indices) i.first_verdict = i.total_verdict = unknown;
      for (SobolPair& pair : r.sensitivities[o].pairs) pair.verdict = unknown;
    }
    if (o < r.shapley.size())
      for (Index& i : r.shapley[o].effects) i.verdict = unknown;
    if (o < std::max(r.sensitivities.size(), r.shapley.size())) names.push_back(r.summaries[o].output.name);
  }
  if (!names.empty())
    r.notes.push_back(
        fmt::format("{}: Sobol' indices and Shapley effects are shares of a variance, which does not exist "
                    "here; the values given depend on the samples drawn",
                    fmt::join(names, ", ")));
}

/// Notes the residual root mean square of the readings themselves: that of the samples contains their noise twice.
void note_residuals(Results& r) {
  for (const FitCovariance& fit : r.fits)
    for (const Budget& b : r.budgets)
      if (b.output.name == fit.output.name && b.applicable)
        r.notes.push_back(
            fmt::format("{}: {} for the readings themselves; the samples contain noise twice, that of the "
                        "readings and that which is drawn",
                        b.output.name, with_suitable_unit(b.estimate, b.output.unit, b.output.si_unit)));
}

/// Whether an indication has noise.
bool noise_declared(const propagation::Experiment& e) {
  const propagation::Range noise = e.layout().indications;
  for (std::size_t q = noise.begin; q < noise.end; ++q)
    for (const quantities::Entry& entry : e.scenario().quantities[q].entries)
      if (!entry.components.empty()) return true;
  return false;
}

/// Notes outputs that depend on readings and on what a fit to readings found: their errors are not independent if the
/// readings are the same.
void note_readings_used_twice(Results& r, const propagation::Experiment& e) {
  if (e.scenario().method != scenario::Method::propagation) return;
  const propagation::Range noise = e.layout().indications;
  const auto is_reading = [&](const Contribution& c) {
    for (std::size_t q = noise.begin; q < noise.end; ++q)
      if (e.scenario().quantities[q].name == c.quantity) return true;
    return false;
  };
  std::vector<std::string> names;
  for (const Budget& b : r.budgets) {
    const auto counts = [](const Contribution& c) { return c.share > 1e-6; };
    if (std::ranges::any_of(b.contributions, [&](const auto& c) { return counts(c) && is_reading(c); }) &&
        std::ranges::any_of(b.contributions,
                            [&](const auto& c) { return counts(c) && c.source.starts_with("gumshoe estimate of"); }))
      names.push_back(b.output.name);
  }
  constexpr std::size_t most = 4;
  if (names.empty()) return;
  const std::string others = names.size() > most ? fmt::format(" and {} more", names.size() - most) : "";
  if (names.size() > most) names.resize(most);
  r.notes.push_back(
      fmt::format("{}{}: the readings and what was estimated are taken as independent; of the readings to which "
                  "it was fitted that is not true",
                  fmt::join(names, ", "), others));
}

InputDraws input_draws(const propagation::Experiment& e) {
  InputDraws draws;
  for (const auto& variate : e.plan().variates) {
    const auto& quantity = e.scenario().quantities[variate.quantity];
    draws.names.push_back(variate.name);
    draws.units.push_back(quantity.unit);
    draws.si_units.push_back(quantity.si_unit);
  }
  draws.draw = propagation::variate_draws(e);
  return draws;
}

} // namespace

Results analyse(const propagation::Experiment& e, const Samples& samples, const propagation::Workers& workers) {
  const int threads = workers.threads;
  Results r;
  const auto& s = e.scenario();
  describe(r, e);
  Failures failures = failures_of(e, samples);
  r.failed = failures.samples;
  r.failures = std::move(failures.reasons);
  const bool virtual_experiment = s.method == scenario::Method::virtual_experiment;
  const std::size_t outputs = e.outputs().size();
  progress::stage("summary and uncertainty budget");
  r.summaries.resize(outputs);
  r.budgets.resize(outputs);
  r.validations.resize(outputs);
  const std::size_t measurands = e.measurands().size();
  const auto budgets_at = [&](std::size_t reading, const propagation::Workers& who) {
    std::ranges::move(budgets(e, reading * measurands, s.analysis.coverage_probability, who),
                      r.budgets.begin() + static_cast<std::ptrdiff_t>(reading * measurands));
  };
  if (stencils_at_estimates(e)) // model runs, which all workers share
    for (std::size_t reading = 0; reading < outputs / measurands; ++reading) budgets_at(reading, workers);
  else
    propagation::parallel_for(outputs / measurands, threads, [&](std::size_t reading) { budgets_at(reading, 1); });
  side_by_side(outputs, samples.size, threads, [&](std::size_t o) {
    Room room;
    const Column values = held(samples.values(o), room);
    const auto& output = e.outputs()[o];
    const double p = s.analysis.coverage_probability;
    KeptOrder order;
    Summary& summary = r.summaries[o] = summarise(output, values, p, threads, &order);
    const Budget& b = r.budgets[o];
    if (!(b.applicable && b.combined_standard_uncertainty > 0.5 * summary.standard_uncertainty)) {
      double largest = 0; // contributions that cancel leave their own rounding
      for (const Contribution& c : b.contributions) largest = std::fmax(largest, c.contribution);
      join_rounded(summary, largest);
    }
    withhold(summary, without_variance(e, b), values, threads, order);
    if (s.run.design != scenario::Design::monte_carlo) drop_standard_errors(summary);
    warn_of_resolution(summary, b);
    r.validations[o] = validate(b, summary, p, s.analysis.validation_digits);
    summary.statement = statement(summary, b, r.validations[o], p, virtual_experiment);
    certify(summary, b, r.validations[o], p);
  });
  if (!e.has_gradient() && !virtual_experiment)
    r.notes.push_back("sensitivity coefficients are differences over a standard uncertainty, because the model "
                      "provides no derivatives");
  if (s.analysis.sensitivity.sobol > 0) {
    progress::stage("Sobol' indices");
    r.sensitivities = sobol_indices(e, s.analysis.sensitivity.sobol, workers);
    add_monte_carlo_column(r);
  }
  if (!virtual_experiment)
    for (const std::string& note : scale_point_notes(e, workers)) r.notes.push_back(note);
  if (const double least = 1 / (1 - s.analysis.coverage_probability), enough = 1e4 * least,
      trials = static_cast<double>(samples.size);
      s.run.adaptive.rule == scenario::StoppingRule::fixed && trials >= least && trials < enough)
    r.notes.push_back(
        fmt::format("{} trials are fewer than the 10^4 / (1 - p) = {:.0f} of JCGM 101, 7.2.2: the coverage "
                    "intervals are {}",
                    samples.size, enough,
                    s.run.design == scenario::Design::monte_carlo ? "known to their Monte Carlo standard errors only"
                                                                  : "uncertain"));
  if (s.run.design != scenario::Design::monte_carlo)
    r.notes.push_back(fmt::format(
        "design {}: its points are not independent, so that no Monte Carlo standard errors are given", r.design));
  const auto& wanted = s.analysis.sensitivity;
  const auto study = [](bool asked, const char* name, auto& result, const auto& compute) {
    if (!asked) return;
    progress::stage(name);
    result = compute();
  };
  study(wanted.shapley > 0, "Shapley effects", r.shapley, [&] { return shapley_effects(e, wanted.shapley, workers); });
  doubt_indices(r);
  study(wanted.given_data > 0, "indices from given data", r.given_data,
        [&] { return given_data_indices(e, samples.values, wanted.given_data, threads); });
  study(wanted.morris > 0, "screening by elementary effects", r.morris,
        [&] { return morris_screening(e, wanted.morris, workers); });
  study(wanted.dgsm > 0, "derivative-based measures", r.dgsm,
        [&] { return derivative_measures(e, wanted.dgsm, r.summaries, workers); });
  study(true, "one at a time", r.one_at_a_time, [&] { return one_at_a_time(e, workers); });
  study(true, "joint regions", r.joint, [&] { return joint_regions(e, samples, r.summaries, r.budgets, threads); });
  study(true, "covariance of the fit", r.fits, [&] { return fit_covariances(e, samples); });
  if (!virtual_experiment) note_residuals(r);
  study(true, "circular statistics", r.circular, [&] { return circular_summaries(e, samples.values, threads); });
  for (const CircularSummary& c : r.circular)
    for (Summary& summary : r.summaries)
      if (!c.remark.empty() && summary.output.name == c.output.name && summary.standard_uncertainty > 0)
        correct_by_circle(summary, c, s.analysis.coverage_probability);
  study(true, "conformity", r.conformity, [&] { return conformity(e, samples.values, r.summaries, threads); });
  study(true, "target uncertainties", r.targets, [&] { return target_uncertainties(e, r.summaries, r.budgets, threads); });
  if (s.run.store_inputs) r.draws = input_draws(e);
  r.comparisons = compare(e, samples.values, r.summaries, r.budgets, threads);
  r.printed = beside_printed(e, r.summaries);
  note_readings_used_twice(r, e);
  r.predicted = predicted_readings(e, r.summaries);
  if (!r.predicted.empty() && !noise_declared(e))
    r.notes.emplace_back("the coverage intervals of readings are those of the model alone, because no noise of a reading is "
                         "declared: fewer readings lie in them than their probability says");
  return r;
}

} // namespace gumshoe::analysis
