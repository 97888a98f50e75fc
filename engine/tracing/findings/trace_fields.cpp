#include "tracing/findings/trace_fields.h"

#include "tracing/findings/verdict_json.h"

namespace gumshoe::tracing {

using analysis::Field;
using analysis::Fields;
using analysis::of;
using analysis::Shown;
using analysis::Value;
using enum analysis::In;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_json{.json = analysis::same}, in_csv{.csv = analysis::same}, in_both{.json = analysis::same, .csv = analysis::same};

constexpr Field<Trace> search[] = {
    {"verdict", [](const Trace& t) -> Value { return verdict(t); }, one,
     "kind of the first finding, else lack_of_fit, anomalous_block, nothing_found or insufficient_data", in_json},
    {"tried", of<&Trace::tried>, one, "candidates tried", in_json},
    {"p_anything", of<&Trace::p_anything>, one, "p-value of the verdict over all tests", in_json},
    {"alpha", of<&Trace::alpha>, one, "requested false-alarm rate", in_json},
    {"draws", of<&Trace::draws>, one, "draws of the bootstrap", in_json},
    {"capped", of<&Trace::capped>, one,
     "1 if the search ended at its largest number of findings, with more to be found", in_json},
    {"jumps_not_crossed", of<&Trace::jumps_not_crossed>, one,
     "1 if more than noise is left and readings jump with sizes that were tried: better ones may not have been found",
     in_json},
    {"vetoed", of<&Trace::vetoed>, one, "1 if the hold-out blocks rejected the findings", in_json},
    {"unconfirmed", of<&Trace::unconfirmed>, one, "1 if they could neither confirm nor reject the findings", in_json}};

using F = Finding;
constexpr Field<F> finding[] = {
    {"kind", [](const F& f) -> Value { return std::string(name(f.kind)); }, one,
     "named, class, scatter or not_in_catalogue", in_json},
    {"name", of<&F::name>, one, "effect, declared quantity or scatter", in_json},
    {"implausible", of<&F::implausible>, one, "why no such effect has this size: it is likely an alias of another; or empty", in_json},
    {"described_by", of<&F::described_by>, one, "shape that describes an unknown effect, or empty", in_json},
    {"suggestion", of<&F::suggestion>, one, "measurement that would distinguish the members of the class", in_json},
    {"p_value", of<&F::p_value>, one, "p-value of the largest statistic over all candidates tried", in_json},
    {"removed_share", of<&F::removed_share>, one, "share of the residuals' mean square that comes back if it alone is left out", in_json}};

using Q = SizeRow;
constexpr Field<Q> sizes[] = {
    {"name", of<&Q::name>, one, "quantity"},
    {"member", of<&Q::member>, one, "effect whose size it is"},
    {"scenario_name", of<&Q::scenario_name>, one, "name in a scenario; empty: none, and the value is a difference"},
    {"labels", of<&Q::label_values>, one, "label values for which it holds"},
    {"units", nullptr, units, ""},
    {"value", of<&Q::value>, point, "estimate"},
    {"standard_uncertainty", of<&Q::u>, difference, "standard uncertainty"},
    {"low", of<&Q::low95>, point,
     "lower end of the 95 % interval, which allows for the search where one size was found alone"},
    {"high", of<&Q::high95>, point, "upper end of that interval"}};

using C = RankedCandidate;
constexpr Field<C> candidates[] = {
    {"absorbed_by", of<&C::absorbed_by>, one, "quantity that absorbs its signature, if almost nothing is left", in_csv},
    {"correlation", of<&C::correlation>, one, "correlation of its projected signature with that of the best", in_csv},
    {"family", of<&C::family>, one, "effect, declared, stated, shape, omnibus or scatter", in_csv},
    {"identifiable", of<&C::identifiable>, one, "share of its signature that the declared model does not absorb",
     in_csv},
    {"name", of<&C::name>, one, "candidate", in_csv},
    {"outcome", of<&C::outcome>, one, "outcome, and its reason", in_csv},
    {"p_single", of<&C::p_single>, one, "p-value if it were the only candidate tried", in_csv},
    {"parameters", of<&C::parameters>, one, "number of fitted sizes", in_csv},
    {"shape", of<&C::shape>, one, "shape parameters that were held fixed", in_csv},
    {"statistic", of<&C::statistic>, one, "twice the logarithm of the likelihood ratio", in_csv}};

using D = DetectionLimit;
constexpr Field<D> limits[] = {
    {"effect", of<&D::effect>, one, "effect", in_both},
    {"quantity", of<&D::quantity>, one, "its size", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"value", of<&D::value>, difference,
     "smallest size that would be detected in nine cases of ten; infinite: these data cannot detect it", in_both}};

constexpr Field<Rms> rms[] = {
    {"units", nullptr, units, "", {.json = "unit"}},
    {"before", of<&Rms::before>, difference, "root mean square residual of the training data, in sample", in_json},
    {"after", of<&Rms::after>, difference, "root mean square residual of the training data with the findings added to the model", in_json},
    {"noise", of<&Rms::noise>, difference, "root mean square residual of the training data for noise alone", in_json},
    {"holdout_before", of<&Rms::holdout_before>, difference, "root mean square residual of the hold-out readings", in_json},
    {"holdout_after", of<&Rms::holdout_after>, difference, "root mean square residual of the hold-out readings with the findings added", in_json},
    {"worst_block_after", of<&Rms::worst_block_after>, difference, "largest root mean square residual of a hold-out block with the findings added", in_json},
    {"noise_low", of<&Rms::noise_low>, difference, "noise, lower 95 % limit", {.json = "noise_interval95/0"}},
    {"noise_high", of<&Rms::noise_high>, difference, "noise, upper 95 % limit", {.json = "noise_interval95/1"}},
    {"replicate_floor", of<&Rms::replicate_floor>, difference,
     "scatter of readings of equal conditions, free of slow drift; training data; NaN if too few repeat", in_json},
    {"replicate_floor_low", of<&Rms::replicate_floor_low>, difference, "replicate_floor, lower 95 % limit", {.json = "replicate_floor_interval95/0"}},
    {"replicate_floor_high", of<&Rms::replicate_floor_high>, difference, "replicate_floor, upper 95 % limit", {.json = "replicate_floor_interval95/1"}},
    {"holdout_noise", of<&Rms::holdout_noise>, difference, "root mean square residual of the hold-out readings for noise alone", in_json},
    {"holdout_noise_low", of<&Rms::holdout_noise_low>, difference, "holdout_noise, lower 95 % limit", {.json = "holdout_noise_interval95/0"}},
    {"holdout_noise_high", of<&Rms::holdout_noise_high>, difference, "holdout_noise, upper 95 % limit", {.json = "holdout_noise_interval95/1"}},
    {"worst_block_before", of<&Rms::worst_block_before>, difference, "largest root mean square residual of a hold-out block", in_json},
    {"worst_block", of<&Rms::worst_block>, one, "name of the block of worst_block_after", in_json},
    {"worst_point_before", of<&Rms::worst_point_before>, difference, "largest residual of one hold-out reading", in_json},
    {"worst_point_after", of<&Rms::worst_point_after>, difference, "the same with the findings added", in_json},
    {"worst_point", of<&Rms::worst_point>, one, "name of the reading of worst_point_after", in_json},
    {"holdout_before_winsorised", of<&Rms::holdout_before_winsorised>, difference, "holdout_before with bad readings cut to 3.5 robust standard deviations", in_json},
    {"holdout_after_winsorised", of<&Rms::holdout_after_winsorised>, difference, "holdout_after with bad readings cut to 3.5 robust standard deviations", in_json},
    {"share_removed", of<&Rms::share_removed>, one, "(before^2 - after^2) / (before^2 - floor^2) of the hold-out readings; the floor is replicate_floor, else the declared noise", in_json},
    {"holdout", of<&Rms::holdout>, one, "description of the hold-out", in_json}};

using E = IndicationError;
constexpr Field<E> indication_error[] = {
    {"name", of<&E::name>, one, "indication", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"before", of<&E::before>, difference, "root mean square of its residuals in the training data, in sample",
     in_both},
    {"after", of<&E::after>, difference, "the same with the findings added to the model", in_both},
    {"holdout_before", of<&E::holdout_before>, difference, "root mean square of its residuals in the hold-out",
     in_both},
    {"holdout_after", of<&E::holdout_after>, difference, "the same with the findings added to the model", in_both}};

constexpr Field<Noise> noise[] = {
    {"scale", of<&Noise::scale>, one,
     "factor on the declared standard uncertainties; if none is declared, standard uncertainty of one reading, SI",
     in_json},
    {"correlation", of<&Noise::correlation>, one, "correlation of successive readings in the order of measurement",
     in_json},
    {"scatter_u", of<&Noise::scatter_u>, difference, "standard uncertainty of the variance component", in_json},
    {"chi_squared_p", of<&Noise::chi_squared_p>, one,
     "p-value of residuals as large as those before the findings under the declared noise", in_json},
    {"scatter", of<&Noise::scatter>, one, "labels of the variance component in use, or empty", in_json},
    {"declared", of<&Noise::declared>, one, "1 if the scenario declares the noise", in_json},
    {"outliers", of<&Noise::outliers>, one, "number of readings that were down-weighted", in_json}};

using L = LackOfFitRow;
constexpr Field<L> lack_of_fit[] = {
    {"found", of<&L::found>, one, "1 if more repeats with the conditions than chance gives, and no finding explains it", in_json},
    {"p_value", of<&L::p_value>, one, "p-value over all tests of the last round; NaN if too few readings repeat", in_json},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"size", of<&L::size>, difference, "root mean square of what repeats after everything found", in_json},
    {"cells", of<&L::cells>, one, "sets of equal conditions", in_json},
    {"degrees_of_freedom", of<&L::freedom>, one, "degrees of freedom of replicate_floor", in_json}};

using A = AnomalousBlockRow;
constexpr Field<A> anomalous_block[] = {
    {"name", of<&A::name>, one, "block", in_both},
    {"p_value", of<&A::p_value>, one, "p-value over all tests of the last round", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"spread", of<&A::spread>, difference, "scatter of its readings about what the other blocks show, robust", in_both},
    {"others", of<&A::others>, difference, "the same of the other blocks", in_both}};

using O = Outlier;
constexpr Field<O> outlier[] = {
    {"reading", of<&O::reading>, one, "reading, with its labels and conditions", in_both},
    {"block", of<&O::block>, one, "block", in_both},
    {"indication", of<&O::indication>, one, "indication", in_both},
    {"units", nullptr, units, "", {"unit", "unit"}},
    {"residual", of<&O::residual>, difference, "measured minus simulated, with the findings added to the model", in_both},
    {"weight", of<&O::weight>, one, "weight of the reading, below 1", in_both}};

using R = ResidualRow;
constexpr Field<R> residuals[] = {
    {"reading", of<&R::reading>, one, "position of the reading in data, from 0"},
    {"name", of<&R::reading_name>, one, "label values of the reading"},
    {"indication", of<&R::indication_name>, one, "indication"},
    {"units", nullptr, units, "", {.csv = "unit"}},
    {"order", of<&R::order>, analysis::Unit::noted("see order_name"), "order of measurement"},
    {"block", of<&R::block>, one, "block"},
    {"measured", of<&R::measured>, point, "readings of the indications", in_csv},
    {"before", of<&R::before>, difference,
     "measured minus simulated, block offsets subtracted; NaN if not scored", in_csv},
    {"after", of<&R::after>, difference, "the same with the findings added to the model", in_csv},
    {"noise_u", of<&R::noise_u>, difference, "standard uncertainty of the noise of the reading", in_csv},
    {"weight", of<&R::weight>, one, "weight of the reading; below 1: treated as an outlier", in_csv}};

} // namespace
// clang-format on

constinit const Fields<Trace> trace_fields{"trace", "", search};
constinit const Fields<Finding> finding_fields{"trace/findings/<k>", "", finding};
constinit const Fields<SizeRow> size_fields{"trace/findings/<k>/quantities", "quantity", sizes};
constinit const Fields<RankedCandidate> candidate_fields{"trace/candidates", "candidate", candidates, "candidates"};
constinit const Fields<DetectionLimit> limit_fields{"trace/detection_limits", "limit", limits, "detection_limits"};
constinit const Fields<Rms> rms_fields{"trace/rms", "", rms};
constinit const Fields<IndicationError> indication_error_fields{"trace/of_indications", "indication", indication_error,
                                                                "of_indications"};
constinit const Fields<Noise> noise_fields{"trace/noise", "", noise};
constinit const Fields<LackOfFitRow> lack_of_fit_fields{"trace/lack_of_fit", "", lack_of_fit};
constinit const Fields<AnomalousBlockRow> anomalous_block_fields{"trace/anomalous_blocks", "anomalous_block", anomalous_block, "anomalous_blocks"};
constinit const Fields<Outlier> outlier_fields{"trace/outliers", "outlier", outlier, "outliers"};
constinit const Fields<ResidualRow> residual_fields{"residuals", "row", residuals, "residuals"};

} // namespace gumshoe::tracing
