#include "analysis/result_fields.h"

namespace gumshoe::analysis {

using enum In;
using propagation::Output;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_json{.json = same}, in_csv{.csv = same}, in_both{.json = same, .csv = same};

constexpr Field<Sensitivity> sobol_study[] = {
    {"base_samples", of<&Sensitivity::base_samples>, one, "rows of each of the two base matrices"},
    {"dropped_rows", of<&Sensitivity::dropped_rows>, one, "rows left out because a sample of them failed"},
    {"confidence", of<&Sensitivity::confidence>, one, "confidence level of the limits"}};

using I = SobolIndex;
constexpr Field<I> sobol[] = {
    {"input", of<&I::input>, one, "input quantity", in_csv},
    {"first", of<&I::first>, one, "first-order Sobol' index", {"first/value", same, "first"},
     half_width<&I::first_low, &I::first_high>},
    {"first_high", of<&I::first_high>, one, "first-order index, upper confidence limit", {"first/high", same}},
    {"first_low", of<&I::first_low>, one, "first-order index, lower confidence limit", {"first/low", same}},
    {"first_verdict", of<&I::first_verdict>, one, "how well the first-order index is known", {"first/verdict", same}},
    {"total", of<&I::total>, one, "total Sobol' index", {"total/value", same, "total"},
     half_width<&I::total_low, &I::total_high>},
    {"total_high", of<&I::total_high>, one, "total index, upper confidence limit", {"total/high", same}},
    {"total_low", of<&I::total_low>, one, "total index, lower confidence limit", {"total/low", same}},
    {"total_verdict", of<&I::total_verdict>, one, "how well the total index is known", {"total/verdict", same}}};

using P = SobolPair;
constexpr Field<P> pairs[] = {
    {"a", of<&P::a>, one, "input quantity", in_csv},
    {"b", of<&P::b>, one, "the other input quantity", in_csv},
    {"second", of<&P::second>, one, "second-order Sobol' index: of the two together, beyond each alone",
     {.csv = same, .gauge = "second"}, half_width<&P::low, &P::high>},
    {"low", of<&P::low>, one, "second-order index, lower confidence limit", in_csv},
    {"high", of<&P::high>, one, "second-order index, upper confidence limit", in_csv},
    {"verdict", of<&P::verdict>, one, "how well the index is known", in_csv}};

constexpr Field<Shapley> shapley_study[] = {
    {"base_rows", of<&Shapley::rows>, one, "rows drawn"},
    {"dropped_rows", of<&Shapley::dropped_rows>, one, "rows left out because a sample of them failed"}};
constexpr auto index_error = half_width<&Index::low, &Index::high>;
constexpr Field<Index> shapley[] = {
    {"input", of<&Index::input>, one, "input quantity", in_csv},
    {"effect", of<&Index::value>, one, "Shapley effect: share of the variance, all add up to 1",
     {"value", same, "shapley"}, index_error},
    {"effect_high", of<&Index::high>, one,
     "Shapley effect: share of the variance, all add up to 1, upper 95 % confidence limit", {"high", same}},
    {"effect_low", of<&Index::low>, one,
     "Shapley effect: share of the variance, all add up to 1, lower 95 % confidence limit", {"low", same}},
    {"effect_verdict", of<&Index::verdict>, one,
     "how well it is known: Shapley effect: share of the variance, all add up to 1", {"verdict", same}}};

constexpr Field<GivenData> given_data_study[] = {
    {"samples", of<&GivenData::samples>, one, "samples used"},
    {"dropped", of<&GivenData::dropped>, one, "samples among the first ones that failed"}};
constexpr Field<Index> given_data[] = {{"input", of<&Index::input>, one, "input quantity", in_csv}};
constexpr Field<Index> rank[] = {
    {"first", of<&Index::value>, one, "first-order index from ranks (Chatterjee, Gamboa)",
     {"first/value", same, "rank_first"}, index_error},
    {"first_high", of<&Index::high>, one,
     "first-order index from ranks (Chatterjee, Gamboa), upper 95 % confidence limit", {"first/high", same}},
    {"first_low", of<&Index::low>, one,
     "first-order index from ranks (Chatterjee, Gamboa), lower 95 % confidence limit", {"first/low", same}},
    {"first_verdict", of<&Index::verdict>, one,
     "how well it is known: first-order index from ranks (Chatterjee, Gamboa)", {"first/verdict", same}}};
constexpr Field<Index> delta[] = {
    {"delta", of<&Index::value>, one, "Borgonovo's delta", {"delta/value", same, "delta"}, index_error},
    {"delta_high", of<&Index::high>, one, "Borgonovo's delta, upper 95 % confidence limit", {"delta/high", same}},
    {"delta_low", of<&Index::low>, one, "Borgonovo's delta, lower 95 % confidence limit", {"delta/low", same}},
    {"delta_verdict", of<&Index::verdict>, one, "how well it is known: Borgonovo's delta", {"delta/verdict", same}}};

constexpr Field<Morris> morris_study[] = {
    {"trajectories", of<&Morris::trajectories>, one, "trajectories drawn"},
    {"dropped", of<&Morris::dropped>, one, "trajectories left out because a sample of them failed"}};
using M = MorrisRow;
constexpr Field<M> morris[] = {
    {"input", of<&M::input>, one, "input quantity", in_csv},
    {"unit", nullptr, output_units, "", in_csv},
    {"mean_absolute", of<&M::mean_absolute>, In::output,
     "mu*: mean of the absolute elementary effects per standard uncertainty", in_both},
    {"mean_absolute_se", of<&M::mean_absolute_se>, In::output, "standard error of mu*", in_both},
    {"mean", of<&M::mean>, In::output, "mean elementary effect per standard uncertainty", in_both},
    {"standard_deviation", of<&M::standard_deviation>, In::output,
     "sigma: standard deviation of the elementary effects", in_both}};

constexpr Field<Dgsm> dgsm_study[] = {
    {"points", of<&Dgsm::points>, one, "points drawn"},
    {"dropped", of<&Dgsm::dropped>, one, "points left out because they failed"},
    {"exact", of<&Dgsm::exact>, one, "0 if the derivatives are differences"}};
using G = DgsmRow;
constexpr Unit squared = Unit::noted("output units squared / input units squared");
constexpr Field<G> dgsm[] = {
    {"input", of<&G::input>, one, "input quantity", in_csv},
    {"nu", of<&G::nu>, squared, "nu: mean squared derivative", {.csv = "nu_si"}},
    {"nu_se", of<&G::nu_se>, squared, "standard error of nu", {.csv = "nu_se_si"}},
    {"bound", of<&G::bound>, one, "upper bound of the total Sobol' index, NaN where none is known",
     {same, same, "dgsm_bound"}, half_width<&G::bound_low, &G::bound_high>},
    {"bound_low", of<&G::bound_low>, one, "bound, lower 95 % confidence limit, NaN where none is known", {"low", same}},
    {"bound_high", of<&G::bound_high>, one, "bound, upper 95 % confidence limit, NaN where none is known",
     {"high", same}}};

constexpr Field<OneAtATimeRow> one_at_a_time[] = {
    {"quantity", of<&OneAtATimeRow::quantity>, one, "input quantity"},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"step", of<&OneAtATimeRow::step>, difference, "what is added to the quantity", in_json}};

using J = JointRegion;
constexpr Field<J> joint[] = {
    {"coverage_probability", of<&J::coverage_probability>, one, "coverage probability of the regions", in_json},
    {"k_p", of<&J::k_p>, one, "ellipsoid: (y - estimate)' covariance^-1 (y - estimate) <= k_p^2; NaN if singular",
     {.json = same, .gauge = "joint.k_p"}, of<&J::k_p_se>},
    {"k_p_se", of<&J::k_p_se>, one, "Monte Carlo standard error of k_p", in_json},
    {"k_q", of<&J::k_q>, one, "rectangle: |y_i - estimate_i| <= k_q u_i", {.json = same, .gauge = "joint.k_q"},
     of<&J::k_q_se>},
    {"k_q_se", of<&J::k_q_se>, one, "Monte Carlo standard error of k_q", in_json},
    {"remark", of<&J::remark>, one, "why there is no ellipsoid", in_json}};

using F = FitCovariance;
constexpr Field<F> fit[] = {
    {"meaning", of<&F::meaning>, one, "from what the covariance follows", in_json},
    {"equations", of<&F::equations>, one, "indications that were fitted", in_json},
    {"degrees_of_freedom", of<&F::degrees_of_freedom>, one, "degrees of freedom of the residuals", in_json},
    {"scatter", of<&F::scatter>, difference,
     "standard deviation of an indication by the residuals, which scales the covariance; NaN of a weighted fit", in_json},
    {"chi_squared", of<&F::chi_squared>, one, "chi-squared of a weighted fit of readings, NaN else", in_json},
    {"probability", of<&F::probability>, one, "probability of a larger chi-squared, NaN without one", in_json}};

using R = CircularSummary;
constexpr Field<R> circular[] = {
    {"name", of<&R::output, &Output::name>, one, "output, an angle", {.csv = "output"}},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"mean_direction", of<&R::mean_direction>, difference, "mean direction on the circle, NaN if there is none",
     {same, same, "circular.mean_direction"}, of<&R::mean_direction_se>},
    {"low", of<&R::low>, difference, "shortest arc of the coverage probability, beginning", {"arc/0", same}},
    {"high", of<&R::high>, difference, "shortest arc, end; not below low, may pass pi", {"arc/1", same}},
    {"standard_deviation", of<&R::standard_deviation>, difference, "circular standard deviation sqrt(-2 ln R)",
     {same, same, "circular.standard_deviation"}, of<&R::standard_deviation_se>},
    {"resultant_length", of<&R::resultant_length>, one,
     "mean resultant length R: 1 all in one direction, 0 none preferred", {same, same, "circular.resultant_length"},
     of<&R::resultant_length_se>},
    {"remark", of<&R::remark>, one, "when the linear statistics mislead", in_both}};

using C = ConformityResult;
constexpr Field<C> conformity[] = {
    {"name", of<&C::output, &Output::name>, one, "output", {.csv = "output"}},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"lower", of<&C::lower>, point, "lower tolerance limit, NaN if there is none", in_both},
    {"upper", of<&C::upper>, point, "upper tolerance limit, NaN if there is none", in_both},
    {"acceptance_lower", of<&C::acceptance_lower>, point, "lower acceptance limit, NaN if there is none", in_both},
    {"acceptance_upper", of<&C::acceptance_upper>, point, "upper acceptance limit, NaN if there is none", in_both},
    {"estimate", of<&C::estimate>, point, "estimate", in_both},
    {"estimate_se", of<&C::estimate_se>, difference, "Monte Carlo standard error of the estimate, NaN if not known",
     in_both},
    {"process_mean", of<&C::process_mean>, point, "mean of what is known before measuring, NaN without a process",
     in_both},
    {"rule", of<&C::rule>, one, "decision rule: stated, simple_acceptance, iso_14253_1 or ilac_g8", in_both},
    {"guard_band", of<&C::guard_band>, difference,
     "guard band: how far an acceptance limit lies inside its tolerance limit, negative outside", in_both},
    {"process_u", of<&C::process_u>, difference,
     "standard deviation of what is known before measuring, NaN without a process", in_both},
    {"accepted", of<&C::accepted>, one, "1 if the estimate lies within the acceptance limits", in_both},
    {"conformance_probability", of<&C::conformance_probability>, one, "conformance probability p_c, JCGM 106 clause 7",
     {same, same, "conformity.probability"}, of<&C::conformance_probability_se>},
    {"conformance_probability_low", of<&C::conformance_probability_low>, one,
     "lower 95 % confidence limit of p_c: what so many samples support", in_both},
    {"conformance_probability_high", of<&C::conformance_probability_high>, one, "upper 95 % confidence limit of p_c",
     in_both},
    {"least_risk", of<&C::least_risk>, one, "risks below it are not resolved by the samples: they are at most this",
     in_both},
    {"conformance_probability_se", of<&C::conformance_probability_se>, one, "Monte Carlo standard error of p_c", in_both},
    {"global_consumer_risk", of<&C::global_consumer_risk>, one,
     "share accepted that does not conform, NaN without a process", {same, same, "conformity.global_consumer_risk"}},
    {"global_consumer_risk_se", of<&C::global_consumer_risk_se>, one, "Monte Carlo standard error of it", in_both},
    {"global_producer_risk", of<&C::global_producer_risk>, one, "share rejected that conforms, NaN without a process",
     {same, same, "conformity.global_producer_risk"}},
    {"global_producer_risk_se", of<&C::global_producer_risk_se>, one, "Monte Carlo standard error of it", in_both},
    {"posterior_conformance", of<&C::posterior_conformance>, one,
     "conformance probability from process and measurement together, JCGM 106 clause 7, NaN if not known", in_both},
    {"posterior_conformance_se", of<&C::posterior_conformance_se>, one, "Monte Carlo standard error of it", in_both},
    {"process_conformance", of<&C::process_conformance>, one,
     "share of the process that conforms, NaN without a process", in_both},
    {"specific_consumer_risk", of<&C::specific_consumer_risk>, one,
     "accepted, but does not conform: 1 - p_c, NaN where the decision excludes it",
     {same, same, "conformity.specific_consumer_risk"}},
    {"specific_producer_risk", of<&C::specific_producer_risk>, one,
     "rejected, but conforms: p_c, NaN where the decision excludes it",
     {same, same, "conformity.specific_producer_risk"}},
    {"statement", of<&C::statement>, one, "the decision in words", in_both}};

using T = TargetResult;
constexpr Field<T> target_study[] = {
    {"wanted", of<&T::wanted>, difference, "expanded uncertainty that is wanted", in_json},
    {"present", of<&T::present>, difference, "expanded uncertainty as it is", in_json},
    {"reached", of<&T::reached>, difference, "expanded uncertainty of the cheapest combination, NaN if there is none",
     in_json},
    {"cost_ratio", of<&T::cost_ratio>, one, "cost of the cheapest combination over the present one", in_json},
    {"statement", of<&T::statement>, one, "what would reach the target, in words", in_json}};
using Q = TargetRow;
constexpr Field<Q> target[] = {
    {"quantity", of<&Q::quantity>, one, "input quantity", in_csv},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"present", of<&Q::present>, difference, "standard uncertainty as it is", in_both},
    {"allowed", of<&Q::allowed>, difference,
     "largest standard uncertainty that reaches the target, the others as they are; Monte Carlo; NaN: none reaches it, "
     "infinite: it does not matter",
     {same, same, "target.allowed"}},
    {"allowed_gum", of<&Q::allowed_gum>, difference,
     "the same by the law of propagation, NaN: none, infinite: it does not matter", {same, same, "target.allowed_gum"}},
    {"cheapest", of<&Q::cheapest>, difference,
     "standard uncertainty in the cheapest combination, NaN if there is none", {same, same, "target.cheapest"}},
    {"cost", of<&Q::cost>, one, "relative cost, NaN if not given", in_both}};

} // namespace
// clang-format on

constinit const Fields<Sensitivity> sobol_study_fields{"sensitivity/<k>", "", sobol_study};
constinit const Fields<SobolIndex> sobol_fields{"sensitivity/<k>", "input_quantity", sobol, "sensitivity"};
constinit const Fields<SobolPair> pair_fields{"sensitivity/<k>/pairs", "pair", pairs, "sensitivity_pairs"};
constinit const Fields<Shapley> shapley_study_fields{"shapley/<k>", "", shapley_study};
constinit const Fields<Index> shapley_fields{"shapley/<k>", "input_quantity", shapley, "shapley"};
constinit const Fields<GivenData> given_data_study_fields{"given_data/<k>", "", given_data_study};
constinit const Fields<Index> given_data_fields{"given_data/<k>", "input_quantity", given_data, "given_data"};
constinit const Fields<Index> rank_fields{"given_data/<k>", "input_quantity", rank, "given_data"};
constinit const Fields<Index> delta_fields{"given_data/<k>", "input_quantity", delta, "given_data"};
constinit const Fields<Morris> morris_study_fields{"morris/<k>", "", morris_study};
constinit const Fields<MorrisRow> morris_fields{"morris/<k>", "input_quantity", morris, "morris"};
constinit const Fields<Dgsm> dgsm_study_fields{"dgsm/<k>", "", dgsm_study};
constinit const Fields<DgsmRow> dgsm_fields{"dgsm/<k>", "input_quantity", dgsm, "dgsm"};
constinit const Fields<OneAtATimeRow> one_at_a_time_fields{"one_at_a_time/<k>", "row", one_at_a_time};
constinit const Fields<JointRegion> joint_fields{"joint/<k>", "", joint};
constinit const Fields<FitCovariance> fit_fields{"fit/<k>", "", fit};
constinit const Fields<CircularSummary> circular_fields{"circular", "output", circular, "circular"};
constinit const Fields<ConformityResult> conformity_fields{"conformity", "test", conformity, "conformity"};
constinit const Fields<TargetResult> target_study_fields{"target/<k>", "", target_study};
constinit const Fields<TargetRow> target_fields{"target/<k>", "row", target, "target"};

} // namespace gumshoe::analysis
