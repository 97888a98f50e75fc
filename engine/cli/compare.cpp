/// `gumshoe compare`: two results of the same measurands, or two traces, such as before and after an improvement.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/agreement.h"
#include "analysis/fields_json.h"
#include "analysis/result_fields.h"
#include "analysis/rounding.h"
#include "base/json_text.h"
#include "base/special_values.h"
#include "base/units.h"
#include "cli/command.h"
#include "cli/shards.h"
#include "store/result_file.h"
#include "store/stored_results.h"

namespace gumshoe::cli {

namespace {
using namespace analysis;

constexpr std::size_t most_changes = 3; ///< contributions named in text
constexpr std::size_t most_measurands = 12; ///< measurands in text: beyond that, those of the largest E_n

struct CompareOptions {
  std::string before, after, format = "text";
  std::vector<std::string> same;
  bool all = false;
};

store::Identity comparable(const std::string& path) {
  store::Identity identity = require_finished(path);
  if (!identity.has_outputs() && identity.command != "trace")
    throw InputError(path + ": holds no result to compare", fmt::format("gumshoe {} wrote it", identity.command),
                     "compare results of gumshoe run, or of gumshoe trace");
  store::require_sound_samples(path);
  return identity;
}

/// "21 % smaller"; empty where there is nothing to relate.
std::string relative(double before, double after) {
  if (!(before > 0) || !(after >= 0) || before == after) return "";
  const double change = after / before - 1;
  const auto two_digits = [](double x) { return x < 9.95 ? fmt::format("{:.2g}", x) : fmt::format("{:.0f}", x); };
  if (change > 1) return fmt::format(" ({} times)", two_digits(after / before));
  return fmt::format(" ({} % {})", two_digits(100 * std::fabs(change)), change < 0 ? "smaller" : "larger");
}

std::string size(double x, const std::string& unit, const std::string& si_unit) {
  return x == 0 ? "0" : with_suitable_unit(x, unit, si_unit);
}

/// "from 3.0 um to 1.0 um (67 % smaller)", or "3.0 um in both" where two digits do not tell them apart.
std::string step(double before, double after, const std::string& unit, const std::string& si_unit) {
  const std::string a = size(before, unit, si_unit), b = size(after, unit, si_unit);
  return a == b ? a + " in both" : fmt::format("from {} to {}{}", a, b, relative(before, after));
}

std::string verdict(const Agreement& a) {
  const double e = a.difference.normalised_error;
  if (std::isnan(e)) return "no verdict, because a result has no expanded uncertainty";
  return std::fabs(e) <= 1 ? "the results agree within their uncertainties (|E_n| <= 1)"
                           : "the results differ by more than their uncertainties explain (|E_n| > 1)";
}

/// To the two decimals that are printed; never -0.
double rounded(double e_n) { return std::round(e_n * 100) / 100 + 0.0; }

void print(const Agreement& a) {
  const auto& d = a.difference;
  const auto shown = [&](double x) { return units::from_si(x, d.unit, d.si_unit, units::Kind::difference); };
  const std::string unit = units::suffix(d.unit);
  const int digits = decimals_for(shown(d.expanded_uncertainty));
  std::cout << fmt::format("{}: after - before = {}{}", d.name, fixed(shown(d.difference), digits), unit);
  if (d.expanded_uncertainty > 0)
    std::cout << fmt::format(", U = {}{}, E_n = {:.2f}", fixed(shown(d.expanded_uncertainty), digits), unit,
                             rounded(d.normalised_error));
  std::cout << ": " << verdict(a) << '\n';
  for (const auto& [when, s] : {std::pair("before", &a.before), {"after", &a.after}})
    if (!s->certificate.empty()) std::cout << fmt::format("  {}: {}\n", when, s->certificate);
  if (std::isfinite(d.standard_uncertainty))
    std::cout << fmt::format("  u {}\n",
                             step(a.before.standard_uncertainty, a.after.standard_uncertainty, d.unit, d.si_unit));
  std::vector<std::string> changes;
  for (const auto& c : a.changes)
    if (changes.size() < most_changes && size(c.before, d.unit, d.si_unit) != size(c.after, d.unit, d.si_unit))
      changes.push_back(fmt::format("{} {}", c.quantity, step(c.before, c.after, d.unit, d.si_unit)));
  if (!changes.empty()) std::cout << fmt::format("  contributions changed most: {}\n", fmt::join(changes, "; "));
  if (!a.counted.empty()) std::cout << fmt::format("  the same in both: {}\n", fmt::join(a.counted, ", "));
}

Json to_json(const Agreement& a) {
  Json out = json(comparison_fields, a.difference);
  out["verdict"] = verdict(a);
  const auto shown = [&](double x) {
    return number(units::from_si(x, a.difference.unit, a.difference.si_unit, units::Kind::difference));
  };
  for (const auto& [when, s] : {std::pair("before", &a.before), {"after", &a.after}})
    out[when] = {{"estimate", number(units::from_si(s->estimate, a.difference.unit, a.difference.si_unit))},
                 {"standard_uncertainty", shown(s->standard_uncertainty)},
                 {"expanded_uncertainty", shown(s->expanded_uncertainty)},
                 {"coverage_factor", number(s->coverage_factor)}};
  out["contributions"] = Json::array();
  for (const auto& c : a.changes)
    out["contributions"].push_back({{"quantity", c.quantity}, {"before", shown(c.before)}, {"after", shown(c.after)}});
  out["same"] = a.counted;
  out["alike"] = a.alike;
  return out;
}

void print(const Agreements& all, bool every) {
  std::vector<const Agreement*> rows;
  for (const auto& a : all.rows) rows.push_back(&a);
  if (rows.size() > most_measurands && !every) {
    const auto far = [](const Agreement* a) { return std::fabs(a->difference.normalised_error); };
    const auto above = std::ranges::count_if(rows, [&](const Agreement* a) { return far(a) > 1; });
    std::cout << fmt::format("{} measurands: |E_n| exceeds 1 in {}; the {} with the largest follow (--all: all)\n",
                             rows.size(), above, most_measurands);
    std::ranges::stable_sort(rows, [&](const Agreement* a, const Agreement* b) {
      return far(a) > far(b) || (!std::isnan(far(a)) && std::isnan(far(b)));
    });
    rows.resize(most_measurands);
  }
  std::vector<std::string> alike;
  for (const Agreement* a : rows) {
    print(*a);
    for (const auto& name : a->alike)
      if (std::ranges::find(alike, name) == alike.end()) alike.push_back(name);
  }
  if (!all.only_before.empty()) std::cout << fmt::format("only before: {}\n", fmt::join(all.only_before, ", "));
  if (!all.only_after.empty()) std::cout << fmt::format("only after: {}\n", fmt::join(all.only_after, ", "));
  if (!alike.empty())
    std::cout << fmt::format("treated as independent, although both budgets list alike: {}. Where one error is in both "
                             "results (the same certificate, the same reference), add --same NAME\n",
                             fmt::join(alike, ", "));
}

ExitCode compare_results(const CompareOptions& o) {
  const Agreements all = agreements(store::read_results(o.before), store::read_results(o.after), o.same);
  if (o.format == "text") {
    print(all, o.all);
    return ExitCode::done;
  }
  Json out{{"before", o.before}, {"after", o.after}, {"comparisons", Json::array()}};
  for (const auto& a : all.rows) out["comparisons"].push_back(to_json(a));
  out["only_before"] = all.only_before;
  out["only_after"] = all.only_after;
  std::cout << json_text(out) << '\n';
  return ExitCode::done;
}

/// A size that both traces found, before and after.
struct SizeChange {
  store::StoredSize before, after;
  double difference() const { return after.value - before.value; }
  /// Half the 95 % intervals, added in squares: E_n compares the difference with it.
  double expanded() const { return std::hypot(before.high - before.low, after.high - after.low) / 2; }
  double normalised_error() const { return expanded() > 0 ? difference() / expanded() : nan; }
};

std::vector<SizeChange> size_changes(const store::StoredTrace& before, const store::StoredTrace& after) {
  std::vector<SizeChange> out;
  for (const store::StoredSize& a : before.sizes)
    for (const store::StoredSize& b : after.sizes)
      if (a.finding == b.finding && a.name == b.name && a.labels == b.labels && a.si_unit == b.si_unit)
        out.push_back({a, b});
  return out;
}

void print(const SizeChange& c) {
  const std::string &unit = c.before.unit, &si = c.before.si_unit;
  const auto width = [&](double x) { return units::from_si(x, unit, si, units::Kind::difference); };
  const auto shown = [&](const store::StoredSize& s) {
    const int d = decimals_for(width(s.u));
    return fmt::format("{}{}, u = {}", fixed(units::from_si(s.value, unit, si), d), units::suffix(unit),
                       fixed(width(s.u), d));
  };
  std::cout << fmt::format("{}.{}{}: before {}; after {}", c.before.finding, c.before.name,
                           c.before.labels.empty() ? "" : "[" + c.before.labels + "]", shown(c.before), shown(c.after));
  if (const double e = c.normalised_error(); std::isfinite(e))
    std::cout << fmt::format("; E_n = {:.2f}: {}", rounded(e),
                             std::fabs(e) <= 1 ? "they agree" : "they differ by more than their uncertainties explain");
  std::cout << '\n';
}

ExitCode compare_traces(const CompareOptions& o) {
  if (!o.same.empty())
    throw InputError("--same: two traces have no budgets to compare", "", "compare results of gumshoe run");
  const store::StoredTrace before = store::read_trace(o.before), after = store::read_trace(o.after);
  if (before.rms.si_unit != after.rms.si_unit)
    throw InputError("the traces have residuals of different dimensions",
                     before.rms.si_unit + " and " + after.rms.si_unit);
  using R = tracing::Rms;
  if (o.format == "json") {
    Json out{{"unit", before.rms.unit}};
    for (const auto& [name, file, t] : {std::tuple("before", &o.before, &before), {"after", &o.after, &after}}) {
      Json one{{"file", *file}, {"verdict", t->verdict}, {"vetoed", t->vetoed}, {"findings", t->findings}};
      for (const auto& [key, member] : {std::pair{"rms", &R::before},
                                        {"rms_with_findings", &R::after},
                                        {"holdout", &R::holdout_before},
                                        {"holdout_with_findings", &R::holdout_after},
                                        {"noise", &R::noise},
                                        {"replicate_floor", &R::replicate_floor}})
        one[key] = number(units::from_si(t->rms.*member, before.rms.unit, before.rms.si_unit, units::Kind::difference));
      out[name] = std::move(one);
    }
    out["sizes"] = Json::array();
    for (const SizeChange& c : size_changes(before, after)) {
      Json one{{"finding", c.before.finding},
               {"quantity", c.before.name},
               {"labels", c.before.labels},
               {"unit", c.before.unit}};
      const auto width = [&](double x) {
        return number(units::from_si(x, c.before.unit, c.before.si_unit, units::Kind::difference));
      };
      for (const auto& [when, s] : {std::pair("before", &c.before), {"after", &c.after}})
        one[when] = {{"value", number(units::from_si(s->value, c.before.unit, c.before.si_unit))},
                     {"standard_uncertainty", width(s->u)}};
      one["difference"] = width(c.difference());
      one["expanded_uncertainty"] = width(c.expanded());
      one["normalised_error"] = number(c.normalised_error());
      out["sizes"].push_back(std::move(one));
    }
    std::cout << json_text(out) << '\n';
    return ExitCode::done;
  }
  const auto line = [&](const char* what, double R::*member) {
    const double a = before.rms.*member, b = after.rms.*member;
    if (std::isfinite(a) && std::isfinite(b))
      std::cout << fmt::format("{}: {}\n", what, step(a, b, before.rms.unit, before.rms.si_unit));
  };
  std::cout << "residual (root mean square), before to after:\n";
  line("  training readings", &R::before);
  line("  training readings, with the findings", &R::after);
  line("  held-out readings", &R::holdout_before);
  line("  held-out readings, with the findings", &R::holdout_after);
  line("  scatter of repeated readings", &R::replicate_floor);
  for (const auto& [when, t] : {std::pair("before", &before), {"after", &after}})
    std::cout << fmt::format("found {}: {}{}\n", when,
                             t->findings.empty() ? "nothing" : fmt::format("{}", fmt::join(t->findings, ", ")),
                             t->vetoed ? "; rejected by the held-out readings" : "");
  for (const SizeChange& c : size_changes(before, after)) print(c);
  if (std::isfinite(before.rms.holdout_after) && std::isfinite(after.rms.holdout_before) && !before.findings.empty())
    std::cout << fmt::format("expected after correcting what was found: {}; measured: {}\n",
                             with_suitable_unit(before.rms.holdout_after, before.rms.unit, before.rms.si_unit),
                             with_suitable_unit(after.rms.holdout_before, before.rms.unit, before.rms.si_unit));
  return ExitCode::done;
}

ExitCode compare(const CompareOptions& o) {
  const store::Identity before = comparable(o.before), after = comparable(o.after);
  const bool traces = before.command == "trace";
  if (traces != (after.command == "trace"))
    throw InputError("a trace and a result of measurands cannot be compared",
                     fmt::format("{} is the trace", traces ? o.before : o.after), "name two files of one kind");
  if (traces && before.model != after.model)
    throw InputError("the traces are of different models", fmt::format("{} and {}", before.model, after.model),
                     "compare traces of one measuring system");
  const auto of_errors = [](const store::Identity& i) {
    return i.method == name(scenario::Method::virtual_experiment);
  };
  if (!traces && of_errors(before) != of_errors(after))
    throw InputError("one of the results holds errors of a virtual experiment, the other values", "they do not compare",
                     "run both scenarios with the same [model] method");
  return traces ? compare_traces(o) : compare_results(o);
}

} // namespace

void add_compare(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("compare", "compares two results of the same measurands, or two traces");
  const auto o = std::make_shared<CompareOptions>();
  command->add_option("before", o->before, "result file (HDF5)")->required();
  command->add_option("after", o->after, "result file (HDF5) of the same kind")->required();
  command->add_option("--same", o->same, "quantities that have one error in both results, such as a certificate's")
      ->delimiter(',');
  command->add_option("--format", o->format, "text or json (all digits)")->check(CLI::IsMember({"text", "json"}));
  command->add_flag("--all", o->all, "text: every measurand, however many there are");
  command->callback([=, &action] { action = [=] { return compare(*o); }; });
}

} // namespace gumshoe::cli
