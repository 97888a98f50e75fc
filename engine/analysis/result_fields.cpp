#include "analysis/result_fields.h"

namespace gumshoe::analysis {

using enum In;
using propagation::Output;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_json{.json = same}, in_csv{.csv = same}, in_both{.json = same, .csv = same};

constexpr Field<Equation> equations[] = {
    {"text", of<&Equation::text>, one, "measurement equation, in the language of formulas"},
    {"where", of<&Equation::where>, one, "meaning of its own symbols"}};

template <int i> constexpr auto point_of = [](const AxisRecord& axis) -> Value { return axis.point[i]; };
constexpr Field<AxisRecord> axes[] = {
    {"name", of<&AxisRecord::name>, one, "axis of the machine, from the bed outwards"},
    {"carries", of<&AxisRecord::carries>, one, "workpiece or tool"},
    {"kind", of<&AxisRecord::kind>, one, "linear or rotary"},
    {"direction", of<&AxisRecord::direction>, one, "it moves along, or turns about, X, Y or Z"},
    {"x", point_of<0>, Unit("m"), "design point of a rotary axis, X"},
    {"y", point_of<1>, Unit("m"), "design point of a rotary axis, Y"},
    {"z", point_of<2>, Unit("m"), "design point of a rotary axis, Z"}};

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
    {"measurand", of<&S::output, &Output::measurand>, one, "measurand", {.json = same}},
    {"reading", of<&S::output, &Output::reading>, one, "position of the reading, from 0", {.json = same}},
    {"diagnostic", of<&S::output, &Output::diagnostic>, one,
     "1: no measurand, but a figure that says how the evaluation went, such as a count", {.json = same}},
    {"estimate", of<&S::estimate>, point, "estimate: mean of the valid samples, or their median where no expectation exists or the mean does not settle", {same, same, "estimate"},
     of<&S::estimate_se>},
    {"estimate_is_median", of<&S::estimate_is_median>, one, "1 where the estimate is the median", in_both},
    {"standard_uncertainty", of<&S::standard_uncertainty>, difference, "standard uncertainty",
     {same, same, "standard_uncertainty"}, of<&S::standard_uncertainty_se>},
    {"expanded_uncertainty", of<&S::expanded_uncertainty>, difference,
     "U of the certificate: of the GUM framework where Monte Carlo validates it, else the half-width about the "
     "estimate that covers the coverage probability; NaN without a standard uncertainty",
     in_both},
    {"coverage_factor", of<&S::coverage_factor>, one,
     "k of the certificate: U over u_c of the budget where U is the framework's, else over the standard uncertainty", in_both},
    {"degrees_of_freedom", of<&S::degrees_of_freedom>, one,
     "effective degrees of freedom of that k; infinite also where k is that of the samples", in_both},
    {"symmetric_low", of<symmetric, &Interval::low>, point, "probabilistically symmetric coverage interval, lower end",
     {"symmetric/0", same, "symmetric_low"}, of<symmetric, &Interval::low_se>},
    {"symmetric_high", of<symmetric, &Interval::high>, point,
     "probabilistically symmetric coverage interval, upper end", {"symmetric/1", same, "symmetric_high"},
     of<symmetric, &Interval::high_se>},
    {"symmetric_low_se", of<symmetric, &Interval::low_se>, difference,
     "probabilistically symmetric coverage interval, Monte Carlo standard error of the lower end",
     {"symmetric_se/0", same}},
    {"symmetric_high_se", of<symmetric, &Interval::high_se>, difference,
     "probabilistically symmetric coverage interval, Monte Carlo standard error of the upper end",
     {"symmetric_se/1", same}},
    {"symmetric_low_rank", of<symmetric, &Interval::low_rank>, point,
     "probabilistically symmetric coverage interval, lower end whatever values the failed samples had",
     {.json = "symmetric_rank/0"}},
    {"symmetric_high_rank", of<symmetric, &Interval::high_rank>, point,
     "probabilistically symmetric coverage interval, upper end whatever values the failed samples had",
     {.json = "symmetric_rank/1"}},
    {"shortest_low", of<shortest, &Interval::low>, point, "shortest coverage interval, lower end",
     {"shortest/0", same, "shortest_low"}, of<shortest, &Interval::low_se>},
    {"shortest_high", of<shortest, &Interval::high>, point, "shortest coverage interval, upper end",
     {"shortest/1", same, "shortest_high"}, of<shortest, &Interval::high_se>},
    {"shortest_low_se", of<shortest, &Interval::low_se>, difference,
     "shortest coverage interval, Monte Carlo standard error of the lower end",
     {"shortest_se/0", same}},
    {"shortest_high_se", of<shortest, &Interval::high_se>, difference,
     "shortest coverage interval, Monte Carlo standard error of the upper end",
     {"shortest_se/1", same}},
    {"shortest_low_rank", of<shortest, &Interval::low_rank>, point,
     "shortest coverage interval, lower end whatever values the failed samples had",
     {.json = "shortest_rank/0"}},
    {"shortest_high_rank", of<shortest, &Interval::high_rank>, point,
     "shortest coverage interval, upper end whatever values the failed samples had",
     {.json = "shortest_rank/1"}},
    {"coverage_probability", nullptr, run, "", in_csv},
    {"estimate_se", of<&S::estimate_se>, difference, "Monte Carlo standard error of the estimate", in_both},
    {"standard_uncertainty_se", of<&S::standard_uncertainty_se>, difference,
     "Monte Carlo standard error of the standard uncertainty",
     in_both},
    {"valid", of<&S::valid>, one, "samples with a value", in_both},
    {"failed", of<&S::failed>, one, "samples without a value", {same, same, "failed"}},
    {"skewness", of<&S::skewness>, one, "skewness, NaN of fewer than 3 samples", {.json = same, .gauge = "skewness"}},
    {"kurtosis", of<&S::kurtosis>, one, "kurtosis, NaN of fewer than 4 samples", {.json = same, .gauge = "kurtosis"}},
    {"hill_index", of<&S::hill_index>, one, "tail index by Hill's estimator, NaN if not estimated", in_json},
    {"warning", of<&S::warning>, one, "what the reader must know of this output", in_both},
    {"tail_remark", of<&S::tail_remark>, one, "what heavy tails do to the standard uncertainty", in_json},
    {"statement", of<&S::statement>, one, "the result in the words of the GUM", in_both},
    {"certificate", of<&S::certificate>, one, "the line of a certificate: Y = (y +- U), k and coverage probability; empty "
                                              "without a standard uncertainty", in_both}};

using B = Budget;
constexpr Field<B> budget[] = {
    {"reason", of<&B::reason>, one, "why the framework does not apply", in_json},
    {"remark", of<&B::remark>, one, "why no effective degrees of freedom or no terms of second order are stated", in_json},
    {"applicable", of<&B::applicable>, one, "1 if the framework applies", {.json = same, .gauge = "gum.applicable"}},
    {"estimate", of<&B::estimate>, point, "model at the estimates", {.json = same, .gauge = "gum.estimate"}},
    {"correlation_share", of<&B::correlation_share>, one, "share of the combined variance from all correlations", in_json},
    {"monte_carlo_interactions", of<&B::monte_carlo_interactions>, one,
     "1 minus the sum of the first-order indices, NaN if not computed", in_json},
    {"combined_standard_uncertainty", of<&B::combined_standard_uncertainty>, difference, "u_c, first order",
     {.json = same, .gauge = "gum.standard_uncertainty"}},
    {"second_order_uncertainty", of<&B::second_order_uncertainty>, difference, "u_c with the terms of GUM 5.1.2, note",
     {.json = same, .gauge = "gum.second_order_uncertainty"}},
    {"second_order_bias", of<&B::second_order_bias>, difference, "mean minus estimate, from the second derivatives",
     {.json = same, .gauge = "gum.second_order_bias"}},
    {"effective_degrees_of_freedom", of<&B::effective_degrees_of_freedom>, one,
     "effective degrees of freedom, truncated (GUM G.4.1); may be infinite; NaN: see remark", in_json},
    {"coverage_factor", of<&B::coverage_factor>, one, "coverage factor k", {.json = same, .gauge = "gum.coverage_factor"}},
    {"expanded_uncertainty", of<&B::expanded_uncertainty>, difference, "expanded uncertainty U = k u_c",
     {.json = same, .gauge = "gum.expanded_uncertainty"}}};

using C = Contribution;
constexpr Field<C> contributions[] = {
    {"name", of<&C::name>, one, "component of an input quantity", {"component", "quantity"}},
    {"quantity", of<&C::quantity>, one, "input quantity", in_json},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"estimate", of<&C::estimate>, point, "estimate of the quantity", in_both},
    {"standard_uncertainty", of<&C::standard_uncertainty>, difference, "standard uncertainty, NaN where none exists",
     in_both},
    {"evaluation", of<&C::evaluation>, one, "Type A or Type B evaluation", {same, "type"}},
    {"distribution", of<&C::distribution>, one, "distribution", in_both},
    {"degrees_of_freedom", of<&C::degrees_of_freedom>, one, "degrees of freedom, may be infinite", in_both},
    {"differentiable", of<&C::differentiable>, one, "1 where the measurand has a derivative at the estimate", in_both},
    {"sensitivity", of<&C::sensitivity>, coefficient, "sensitivity coefficient, NaN where not differentiable",
     {.json = same, .csv = same, .gauge = "gum.sensitivity"}},
    {"contribution", of<&C::contribution>, In::output, "contribution to the combined standard uncertainty",
     {.json = same, .csv = same, .gauge = "gum.contribution"}},
    {"contribution_unit", nullptr, output_units, "", in_both},
    {"share", of<&C::share>, one, "share of the combined variance, GUM framework", {same, "share_gum"}},
    {"monte_carlo_share", of<&C::monte_carlo_share>, one,
     "first-order share of the Monte Carlo variance, NaN if not computed", {same, "share_monte_carlo"}},
    {"scope", of<&C::scope>, one, "scope of one draw", in_both},
    {"source", of<&C::source>, one, "source", in_both}};

using V = Validation;
/// The tolerance is two standard errors of the worse end.
constexpr auto end_error = [](const V& v) -> Value { return 0.5 * v.monte_carlo_tolerance; };
constexpr Field<V> validation[] = {
    {"name", of<&V::output, &Output::name>, one, "output", {.csv = "output"}},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"delta", of<&V::delta>, difference, "numerical tolerance, JCGM 101 clause 7.9.2",
     {.json = same, .csv = same, .gauge = "validation.delta"}},
    {"d_low", of<&V::d_low>, difference, "distance of the lower ends, JCGM 101 clause 8",
     {.json = same, .csv = same, .gauge = "validation.d_low"}, end_error},
    {"d_high", of<&V::d_high>, difference, "distance of the upper ends, JCGM 101 clause 8",
     {.json = same, .csv = same, .gauge = "validation.d_high"}, end_error},
    {"monte_carlo_tolerance", of<&V::monte_carlo_tolerance>, difference,
     "Monte Carlo tolerance, must be below delta / 5", in_both},
    {"digits", of<&V::digits>, one, "significant digits of u regarded as meaningful", in_both},
    {"verdict", of<&V::verdict>, one, "verdict on the GUM framework", {.json = same, .csv = same, .gauge = "validation.verdict"}},
    {"reason", of<&V::reason>, one, "reason of the verdict", in_both}};

using D = ComparisonResult;
constexpr Field<D> comparison[] = {
    {"name", of<&D::name>, one, "comparison", {same, "comparison"}},
    {"a", of<&D::a>, one, "output a", in_both},
    {"b", of<&D::b>, one, "output b", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"difference", of<&D::difference>, difference, "d = a - b", in_both},
    {"standard_uncertainty", of<&D::standard_uncertainty>, difference, "standard uncertainty of d, from joint samples",
     in_both},
    {"root_sum_square", of<&D::root_sum_square>, difference, "what ignoring common inputs would give", in_both},
    {"expanded_uncertainty", of<&D::expanded_uncertainty>, difference, "U(d): half the coverage interval about d",
     in_both},
    {"normalised_error", of<&D::normalised_error>, one, "E_n = d / U(d)", in_both}};

using P = PrintedResult;
constexpr Field<P> printed[] = {
    {"output", of<&P::output>, one, "output", in_json},
    {"source", of<&P::source>, one, "where it is printed", in_json},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"printed", of<&P::printed>, point, "printed value", in_json},
    {"ours", of<&P::ours>, point, "our estimate", in_json},
    {"expanded_uncertainty", of<&P::expanded_uncertainty>, difference, "expanded uncertainty of ours", in_json}};

using R = PredictedReading;
constexpr Field<R> predicted[] = {
    {"output", of<&R::output>, one, "output", in_json},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"read", of<&R::read>, point, "the reading, which the prediction does not know", in_json},
    {"predicted", of<&R::predicted>, point, "estimate of the prediction", in_json},
    {"low", of<&R::low>, point, "shortest coverage interval, lower end", in_json},
    {"high", of<&R::high>, point, "shortest coverage interval, upper end", in_json},
    {"inside", of<&R::inside>, one, "1 if the reading lies in that interval", in_json}};

using T = StoppingRecord;
constexpr Field<T> stopping[] = {
    {"rule", of<&T::rule>, one, "jcgm_101 or stein", {.json = same}},
    {"digits", of<&T::digits>, one, "significant digits of u regarded as meaningful", in_json},
    {"block", of<&T::block>, one, "trials per block", in_json},
    {"trials", of<&T::trials>, one, "trials used", {.json = same}},
    {"jcgm_trials", of<&T::jcgm_trials>, one, "trials by JCGM 101, 0: not reached", {.json = same}},
    {"stein_trials", of<&T::stein_trials>, one, "trials by Stein's rule, 0: not reached", {.json = same}},
    {"reached", of<&T::reached>, one, "0 if the run gave up at max_samples", {.json = same}},
    {"statement", of<&T::statement>, one, "how the run ended, in words", in_json}};

} // namespace
// clang-format on

constinit const Fields<Equation> equation_fields{"equations", "equation", equations};
constinit const Fields<AxisRecord> axis_fields{"machine", "axis", axes};
constinit const Fields<InputRecord> input_fields{"inputs", "input", inputs};
constinit const Fields<Summary> summary_fields{"summary", "output", summary, "summary"};
constinit const Fields<Budget> budget_fields{"budget/<k>", "", budget};
constinit const Fields<Contribution> contribution_fields{"budget/<k>", "component", contributions, "budget"};
constinit const Fields<Validation> validation_fields{"validation", "output", validation, "validation"};
constinit const Fields<ComparisonResult> comparison_fields{"comparison", "comparison", comparison, "comparison"};
constinit const Fields<PrintedResult> printed_fields{"printed", "result", printed};
constinit const Fields<PredictedReading> predicted_fields{"predicted", "result", predicted};
constinit const Fields<StoppingRecord> stopping_fields{"stopping", "", stopping};

} // namespace gumshoe::analysis
