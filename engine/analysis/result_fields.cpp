#include "analysis/result_fields.h"

namespace gumshoe::analysis {

using enum In;
using propagation::Output;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_csv{.csv = same}, in_both{.json = same, .csv = same};

constexpr Field<InputRecord> inputs[] = {
    {"name", of<&InputRecord::name>, one, "input quantity"},
    {"labels", of<&InputRecord::labels>, one, "label values for which it holds"},
    {"units", nullptr, units, ""},
    {"value", of<&InputRecord::value>, point, "estimate"},
    {"standard_uncertainty", of<&InputRecord::standard_uncertainty>, difference, "standard uncertainty"},
    {"distribution", of<&InputRecord::distribution>, one, "distribution"},
    {"evaluation", of<&InputRecord::evaluation>, one, "Type A or Type B evaluation"},
    {"scope", of<&InputRecord::scope>, one, "scope of one draw"},
    {"source", of<&InputRecord::source>, one, "source"}};

using S = Summary;
constexpr auto symmetric = &S::symmetric, shortest = &S::shortest;
constexpr Field<S> summary[] = {
    {"name", of<&S::output, &Output::name>, one, "output: a measurand at a reading", {"output", "output"}},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"measurand", of<&S::output, &Output::measurand>, one, "measurand"},
    {"reading", of<&S::output, &Output::reading>, one, "position of the reading, from 0"},
    {"estimate", of<&S::estimate>, point, "estimate: mean of the valid samples, or their median where no expectation exists", {same, same, "estimate"},
     of<&S::estimate_se>},
    {"estimate_is_median", of<&S::estimate_is_median>, one, "1 where no expectation exists and the estimate is the median",
     in_both},
    {"standard_uncertainty", of<&S::standard_uncertainty>, difference, "standard uncertainty",
     {same, same, "standard_uncertainty"}, of<&S::standard_uncertainty_se>},
    {"symmetric_low", of<symmetric, &Interval::low>, point, "probabilistically symmetric coverage interval, lower end",
     {"symmetric/0", same, "symmetric_low"}, of<symmetric, &Interval::low_se>},
    {"symmetric_high", of<symmetric, &Interval::high>, point,
     "probabilistically symmetric coverage interval, upper end", {"symmetric/1", same, "symmetric_high"},
     of<symmetric, &Interval::high_se>},
    {"symmetric_low_se", of<symmetric, &Interval::low_se>, difference,
     "probabilistically symmetric coverage interval, Monte Carlo standard error of the lower end"},
    {"symmetric_high_se", of<symmetric, &Interval::high_se>, difference,
     "probabilistically symmetric coverage interval, Monte Carlo standard error of the upper end"},
    {"symmetric_low_rank", of<symmetric, &Interval::low_rank>, point,
     "probabilistically symmetric coverage interval, lower end whatever values the failed samples had"},
    {"symmetric_high_rank", of<symmetric, &Interval::high_rank>, point,
     "probabilistically symmetric coverage interval, upper end whatever values the failed samples had"},
    {"shortest_low", of<shortest, &Interval::low>, point, "shortest coverage interval, lower end",
     {"shortest/0", same, "shortest_low"}, of<shortest, &Interval::low_se>},
    {"shortest_high", of<shortest, &Interval::high>, point, "shortest coverage interval, upper end",
     {"shortest/1", same, "shortest_high"}, of<shortest, &Interval::high_se>},
    {"shortest_low_se", of<shortest, &Interval::low_se>, difference,
     "shortest coverage interval, Monte Carlo standard error of the lower end"},
    {"shortest_high_se", of<shortest, &Interval::high_se>, difference,
     "shortest coverage interval, Monte Carlo standard error of the upper end"},
    {"shortest_low_rank", of<shortest, &Interval::low_rank>, point,
     "shortest coverage interval, lower end whatever values the failed samples had"},
    {"shortest_high_rank", of<shortest, &Interval::high_rank>, point,
     "shortest coverage interval, upper end whatever values the failed samples had"},
    {"coverage_probability", nullptr, run, "", in_csv},
    {"estimate_se", of<&S::estimate_se>, difference, "Monte Carlo standard error of the estimate", in_csv},
    {"standard_uncertainty_se", of<&S::standard_uncertainty_se>, difference,
     "Monte Carlo standard error of the standard uncertainty", in_csv},
    {"valid", of<&S::valid>, one, "samples with a value", in_both},
    {"failed", of<&S::failed>, one, "samples without a value", {same, same, "failed"}},
    {"skewness", of<&S::skewness>, one, "skewness", {.gauge = "skewness"}},
    {"kurtosis", of<&S::kurtosis>, one, "kurtosis", {.gauge = "kurtosis"}},
    {"hill_index", of<&S::hill_index>, one, "tail index by Hill's estimator, NaN if not estimated"},
    {"warning", of<&S::warning>, one, "what the reader must know of this output", in_csv},
    {"tail_remark", of<&S::tail_remark>, one, "what heavy tails do to the standard uncertainty"},
    {"statement", of<&S::statement>, one, "the result in the words of the GUM", in_csv}};

using B = Budget;
constexpr Field<B> budget[] = {
    {"reason", of<&B::reason>, one, "why the framework does not apply"},
    {"remark", of<&B::remark>, one, "why no effective degrees of freedom are stated"},
    {"applicable", of<&B::applicable>, one, "1 if the framework applies", {.gauge = "gum.applicable"}},
    {"estimate", of<&B::estimate>, point, "model at the estimates", {.gauge = "gum.estimate"}},
    {"correlation_share", of<&B::correlation_share>, one, "share of the combined variance from all correlations"},
    {"monte_carlo_interactions", of<&B::monte_carlo_interactions>, one,
     "1 minus the sum of the first-order indices, NaN if not computed"},
    {"combined_standard_uncertainty", of<&B::combined_standard_uncertainty>, difference, "u_c, first order",
     {.gauge = "gum.standard_uncertainty"}},
    {"second_order_uncertainty", of<&B::second_order_uncertainty>, difference, "u_c with the terms of GUM 5.1.2, note",
     {.gauge = "gum.second_order_uncertainty"}},
    {"second_order_bias", of<&B::second_order_bias>, difference, "mean minus estimate, from the second derivatives",
     {.gauge = "gum.second_order_bias"}},
    {"effective_degrees_of_freedom", of<&B::effective_degrees_of_freedom>, one,
     "effective degrees of freedom, truncated (GUM G.4.1); may be infinite; NaN: see remark"},
    {"coverage_factor", of<&B::coverage_factor>, one, "coverage factor k", {.gauge = "gum.coverage_factor"}},
    {"expanded_uncertainty", of<&B::expanded_uncertainty>, difference, "expanded uncertainty U = k u_c",
     {.gauge = "gum.expanded_uncertainty"}}};

using C = Contribution;
constexpr Field<C> contributions[] = {
    {"name", of<&C::name>, one, "component of an input quantity", {.csv = "quantity"}},
    {"quantity", of<&C::quantity>, one, "input quantity"},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"estimate", of<&C::estimate>, point, "estimate of the quantity", in_csv},
    {"standard_uncertainty", of<&C::standard_uncertainty>, difference, "standard uncertainty, NaN where none exists",
     in_csv},
    {"evaluation", of<&C::evaluation>, one, "Type A or Type B evaluation", {.csv = "type"}},
    {"distribution", of<&C::distribution>, one, "distribution", in_csv},
    {"degrees_of_freedom", of<&C::degrees_of_freedom>, one, "degrees of freedom, may be infinite", in_csv},
    {"differentiable", of<&C::differentiable>, one, "1 where the measurand has a derivative at the estimate", in_csv},
    {"sensitivity", of<&C::sensitivity>, coefficient, "sensitivity coefficient, NaN where not differentiable",
     {.csv = same, .gauge = "gum.sensitivity"}},
    {"contribution", of<&C::contribution>, In::output, "contribution to the combined standard uncertainty",
     {.csv = same, .gauge = "gum.contribution"}},
    {"contribution_unit", nullptr, output_units, "", in_csv},
    {"share", of<&C::share>, one, "share of the combined variance, GUM framework", {.csv = "share_gum"}},
    {"monte_carlo_share", of<&C::monte_carlo_share>, one,
     "first-order share of the Monte Carlo variance, NaN if not computed", {.csv = "share_monte_carlo"}},
    {"scope", of<&C::scope>, one, "scope of one draw", in_csv},
    {"source", of<&C::source>, one, "source", in_csv}};

using V = Validation;
/// The tolerance is two standard errors of the worse end.
constexpr auto end_error = [](const V& v) -> Value { return 0.5 * v.monte_carlo_tolerance; };
constexpr Field<V> validation[] = {
    {"name", of<&V::output, &Output::name>, one, "output", {.csv = "output"}},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"delta", of<&V::delta>, difference, "numerical tolerance, JCGM 101 clause 7.9.2",
     {.csv = same, .gauge = "validation.delta"}},
    {"d_low", of<&V::d_low>, difference, "distance of the lower ends, JCGM 101 clause 8",
     {.csv = same, .gauge = "validation.d_low"}, end_error},
    {"d_high", of<&V::d_high>, difference, "distance of the upper ends, JCGM 101 clause 8",
     {.csv = same, .gauge = "validation.d_high"}, end_error},
    {"monte_carlo_tolerance", of<&V::monte_carlo_tolerance>, difference,
     "Monte Carlo tolerance, must be below delta / 5", in_csv},
    {"digits", of<&V::digits>, one, "significant digits of u regarded as meaningful", in_csv},
    {"verdict", of<&V::verdict>, one, "verdict on the GUM framework", {.csv = same, .gauge = "validation.verdict"}},
    {"reason", of<&V::reason>, one, "reason of the verdict", in_csv}};

using D = ComparisonResult;
constexpr Field<D> comparison[] = {
    {"name", of<&D::name>, one, "comparison", {.csv = "comparison"}},
    {"a", of<&D::a>, one, "output a", in_csv},
    {"b", of<&D::b>, one, "output b", in_csv},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"difference", of<&D::difference>, difference, "d = a - b", in_csv},
    {"standard_uncertainty", of<&D::standard_uncertainty>, difference, "standard uncertainty of d, from joint samples",
     in_csv},
    {"root_sum_square", of<&D::root_sum_square>, difference, "what ignoring common inputs would give", in_csv},
    {"expanded_uncertainty", of<&D::expanded_uncertainty>, difference, "U(d): half the shortest coverage interval",
     in_csv},
    {"normalised_error", of<&D::normalised_error>, one, "E_n = d / U(d)", in_csv}};

using P = PrintedResult;
constexpr Field<P> printed[] = {
    {"output", of<&P::output>, one, "output"},
    {"source", of<&P::source>, one, "where it is printed"},
    {"units", nullptr, units, ""},
    {"printed", of<&P::printed>, point, "printed value"},
    {"ours", of<&P::ours>, point, "our estimate"},
    {"expanded_uncertainty", of<&P::expanded_uncertainty>, difference, "expanded uncertainty of ours"}};

using T = StoppingRecord;
constexpr Field<T> stopping[] = {
    {"rule", of<&T::rule>, one, "jcgm_101 or stein", {.json = same}},
    {"digits", of<&T::digits>, one, "significant digits of u regarded as meaningful"},
    {"block", of<&T::block>, one, "trials per block"},
    {"trials", of<&T::trials>, one, "trials used", {.json = same}},
    {"jcgm_trials", of<&T::jcgm_trials>, one, "trials by JCGM 101, 0: not reached", {.json = same}},
    {"stein_trials", of<&T::stein_trials>, one, "trials by Stein's rule, 0: not reached", {.json = same}},
    {"reached", of<&T::reached>, one, "0 if the run gave up at max_samples", {.json = same}},
    {"statement", of<&T::statement>, one, "how the run ended, in words"}};

} // namespace
// clang-format on

constinit const Fields<InputRecord> input_fields{"inputs", "input", inputs};
constinit const Fields<Summary> summary_fields{"summary", "output", summary, "summary"};
constinit const Fields<Budget> budget_fields{"budget/<k>", "", budget};
constinit const Fields<Contribution> contribution_fields{"budget/<k>", "component", contributions, "budget"};
constinit const Fields<Validation> validation_fields{"validation", "output", validation, "validation"};
constinit const Fields<ComparisonResult> comparison_fields{"comparison", "comparison", comparison, "comparison"};
constinit const Fields<PrintedResult> printed_fields{"printed", "result", printed};
constinit const Fields<StoppingRecord> stopping_fields{"stopping", "", stopping};

} // namespace gumshoe::analysis
