#include "choice/fields.h"

#include <cmath>

#include "choice/choose.h"

namespace gumshoe::choice {

using analysis::Field;
using analysis::Fields;
using analysis::of;
using analysis::same;
using analysis::Shown;
using analysis::Value;
using enum analysis::In;
using scenario::Choose;

// clang-format off: a field is a line or two
namespace {

constexpr Shown in_json{.json = same}, in_csv{.csv = same}, in_both{.json = same, .csv = same};

template <auto member> constexpr auto asked_for = of<&Result::asked, member>;
constexpr Field<Result> question[] = {
    {"measurand", asked_for<&Choose::measurand>, one, "measurand whose error is judged", in_json},
    {"target", asked_for<&Choose::target>, difference, "target expanded uncertainty", in_json},
    {"target_of", [](const Result& r) -> Value { return std::string(r.asked.worst_case ? "worst_case" : "average"); },
     one, "average or worst_case", in_json},
    {"bias_limit", [](const Result& r) -> Value { return r.asked.bias.value_or(std::nan("")); }, difference,
     "limit of the mean error's magnitude, NaN: none", in_json},
    {"definition", [](const Result& r) -> Value { return std::string(name(r.asked.definition)); }, one,
     "corrected or uncorrected", in_json},
    {"samples", asked_for<&Choose::samples>, one, "samples of a candidate"},
    {"confirm_samples", asked_for<&Choose::confirm_samples>, one, "samples of a fresh run"},
    {"confirm_probability", asked_for<&Choose::confirm_probability>, one,
     "probability of meeting the target that a recommendation needs"},
    {"statement", of<&Result::statement>, one, "the recommendation in words", in_json},
    {"reached", of<&Result::reached>, one, "1 if a candidate meets the target", in_json},
    {"confirmed", of<&Result::confirmed>, one, "1 if the fresh numbers agree", in_json},
    {"probability", of<&Result::probability>, one, "probability that the recommended setting meets the target",
     in_json},
    {"best", of<&Result::best>, one, "the recommended setting, by position in candidates"},
    {"tried", of<&Result::tried>, one, "candidates run afresh, with faster ones than the first that was confirmed",
     in_json},
    {"skipped", of<&Result::skipped>, one, "impossible combinations", {.json = "skipped/count"}},
    {"near_share",
     asked_for<&Choose::near>,
     one,
     "share of time or U within which settings count as near",
     {.json = "near/share"}},
    {"near_count",
     of<&Result::near_count>,
     one,
     "candidates that meet the target within this share of the least time",
     {.json = "near/candidates"}}};

using V = VariableRow;
constexpr Field<V> variables[] = {
    {"name", of<&V::name>, one, "variables that may be chosen"},
    {"kind", of<&V::kind>, one, "condition, quantity, readings or evaluation"},
    {"units", nullptr, units, "", {.json = "unit"}},
    {"range", of<&V::range>, one, "1: a range, refined; 0: a list"},
    {"logarithmic", of<&V::logarithmic>, one, "1: even steps on a logarithmic scale"},
    {"resolution", of<&V::resolution>, one, "last step as share of the range on its scale, 0 of a list", in_json},
    {"near_low", of<&V::near_low>, point, "least value among settings that meet the target in nearly the least time"},
    {"near_high", of<&V::near_high>, point, "largest value among these; NaN if there is none"}};

constexpr Field<CaseRow> cases[] = {{"name", of<&CaseRow::name>, one, "case"},
                                    {"source", of<&CaseRow::source>, one, "where it comes from"},
                                    {"values", of<&CaseRow::values>, one, "true values of quantities in it"}};

using F = Figures;
constexpr Field<F> figures[] = {
    {"expanded", of<&F::expanded>, output, "expanded uncertainty U over all uncertain quantities", {"U", "U"}},
    {"expanded_se", of<&F::expanded_se>, output, "Monte Carlo standard error of U", {"U_se", "U_se"}},
    {"mean", of<&F::mean>, output, "mean error, the bias, over all uncertain quantities", {"bias", "mean_error"}},
    {"mean_se", of<&F::mean_se>, output, "Monte Carlo standard error of the mean error", {"bias_se", "mean_error_se"}},
    {"standard_deviation", of<&F::standard_deviation>, output, "standard deviation of the error", in_both},
    {"valid", of<&F::valid>, one, "samples with a value", in_both},
    {"failed", of<&F::failed>, one, "samples without a value", in_both}};

using C = CandidateRow;
template <auto member> constexpr auto known = [](const C& c) -> Value { return c.candidate->*member; };
template <auto member> constexpr auto judged = [](const C& c) -> Value { return c.asked->*member; };
constexpr Field<C> candidates[] = {
    {"time", known<&Candidate::time>, analysis::Unit("s"), "time that measuring takes", {same, "time_s"}},
    {"readings", known<&Candidate::readings>, one, "number of readings", {same, "number_of_readings"}},
    {"unit", nullptr, output_units, "", in_csv}};
constexpr Field<C> compared_with_target[] = {
    {"asked", judged<&F::expanded>, output,
     "expanded uncertainty that the target is asked of: of the average, or of the worst case"},
    {"asked_se", judged<&F::expanded_se>, output, "Monte Carlo standard error of it"},
    {"meets", known<&Candidate::meets>, one, "1 if target and limit of the bias are met by these numbers", in_both}};
constexpr Field<C> searched[] = {
    {"refuted", known<&Candidate::refuted>, one,
     "1 if it meets them in the search, and not with fresh samples, or would not", in_both},
    {"setting", of<&C::setting>, one, "setting in words"},
    {"pareto", known<&Candidate::pareto>, one, "1 if nothing tried beats it in both time and U", in_both},
    {"round", known<&Candidate::round>, one, "0: coarse grid, then refinements, last the optimum's neighbours",
     in_both}};
constexpr Field<C> fresh[] = {
    {"name", of<&C::name>, one, "recommended, then the settings compared with it", in_both},
    {"setting", of<&C::setting>, one, "setting in words", in_both},
    {"source", of<&C::source>, one, "where a compared setting comes from", in_both},
    {"probability", of<&C::probability>, one, "probability that it meets the target, from the standard errors",
     in_both}};

using N = Neighbour;
constexpr Field<N> neighbours[] = {
    {"variable", of<&N::variable>, one, "the variable that differs from the optimum's, by position in variables"},
    {"candidate", of<&N::candidate>, one, "position in candidates"},
    {"time_ratio", of<&N::time_ratio>, one, "time over the optimum's", in_both},
    {"expanded_ratio", of<&N::expanded_ratio>, one, "U over the optimum's, with common random numbers",
     {"U_ratio", "U_ratio"}},
    {"near", of<&N::near>, one, "1 if neither is larger by more than near_share", in_both}};

constexpr const char* kinds[] = {"condition", "quantity", "readings", "evaluation"};

} // namespace
// clang-format on

constinit const Fields<Result> question_fields{"choice", "", question};
constinit const Fields<VariableRow> variable_fields{"choice/variables", "variable", variables};
constinit const Fields<CaseRow> case_fields{"choice/cases", "case", cases};
constinit const Fields<Figures> figure_fields{"choice/candidates", "candidate", figures, "candidates"};
constinit const Fields<CandidateRow> candidate_fields{"choice/candidates", "candidate", candidates, "candidates"};
constinit const Fields<CandidateRow> asked_fields{"choice/candidates", "candidate", compared_with_target, "candidates"};
constinit const Fields<CandidateRow> searched_fields{"choice/candidates", "candidate", searched, "candidates"};
constinit const Fields<CandidateRow> fresh_fields{"choice/fresh", "row", fresh, "compared"};
constinit const Fields<Neighbour> neighbour_fields{"choice/neighbours", "neighbour", neighbours, "neighbours"};

std::string in_words(const Result& r, const std::vector<double>& values) {
  std::vector<scenario::Setting> settings;
  for (std::size_t v = 0; v < values.size(); ++v) settings.push_back({r.asked.variables[v].knob, values[v]});
  return in_words(settings, r.evaluations);
}

std::vector<VariableRow> variable_rows(const Result& r) {
  std::vector<VariableRow> rows;
  const bool any = r.near_count > 0;
  for (std::size_t v = 0; v < r.asked.variables.size(); ++v) {
    const auto& [knob, values, range, steps, logarithmic] = r.asked.variables[v];
    rows.push_back({knob.name, kinds[static_cast<int>(knob.kind)], knob.unit, knob.si_unit, range, logarithmic,
                    r.resolution[v], any ? r.near[v].low : std::nan(""), any ? r.near[v].high : std::nan("")});
  }
  return rows;
}

std::vector<CaseRow> case_rows(const Result& r) {
  std::vector<CaseRow> rows;
  for (const auto& c : r.asked.cases) rows.push_back({c.name, c.source, in_words(c.values, r.evaluations)});
  return rows;
}

std::vector<CandidateRow> candidate_rows(const Result& r) {
  std::vector<CandidateRow> rows;
  for (const Candidate& c : r.candidates)
    rows.push_back({&c, &asked(c, r.asked.worst_case), in_words(r, c.values), "", ""});
  return rows;
}

std::vector<CandidateRow> fresh_rows(const Result& r) {
  std::vector<CandidateRow> rows{{&r.fresh, &asked(r.fresh, r.asked.worst_case), in_words(r, r.fresh.values),
                                  "recommended", "", r.probability}};
  for (const Compared& c : r.compared)
    rows.push_back({&c.candidate, &asked(c.candidate, r.asked.worst_case), c.setting, c.name, c.source, c.probability});
  return rows;
}

} // namespace gumshoe::choice
