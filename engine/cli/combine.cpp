/// `gumshoe combine`: the weighted mean of results that may share inputs, and whether they are consistent.
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/fields_json.h"
#include "analysis/rounding.h"
#include "analysis/weighted_mean.h"
#include "base/json_text.h"
#include "base/units.h"
#include "calibration/combined_scenario.h"
#include "cli/command.h"
#include "cli/shards.h"
#include "cli/shell.h"
#include "store/result_file.h"
#include "store/stored_results.h"

namespace gumshoe::cli {

namespace {
using namespace analysis;

struct CombineOptions {
  std::vector<std::string> files, same;
  std::string measurand, out, format = "text";
  bool force = false;
};

/// A file that is one of the others again, or a copy, would be counted twice.
std::vector<NamedResult> read_all(const std::vector<std::string>& files) {
  std::vector<NamedResult> out;
  std::map<std::string, std::string> scenarios; // hash to file
  for (const std::string& file : files) {
    const store::Identity identity = require_finished(file);
    if (!identity.has_outputs())
      throw InputError(file + ": holds no result to combine", fmt::format("gumshoe {} wrote it", identity.command),
                       "name results of gumshoe run");
    store::require_sound_samples(file);
    const auto [first, fresh] = scenarios.try_emplace(identity.scenario_hash, file);
    if (!fresh)
      throw InputError(fmt::format("{} and {} are one measurement", first->second, file),
                       "their scenarios and readings are equal, and the mean would count them twice",
                       "name each measurement once");
    out.push_back({file, store::read_results(file)});
  }
  return out;
}

std::string verdict(const WeightedMean& m) {
  if (m.consistent()) return "the results are consistent";
  const auto far =
      std::ranges::max_element(m.parts, {}, [](const WeightedPart& p) { return std::fabs(p.normalised_error); });
  // Two are equally far from their mean, whatever their uncertainties.
  const std::string which = m.parts.size() == 2
                                ? "one of the two"
                                : fmt::format("a result, most likely number {},", far - m.parts.begin() + 1);
  return fmt::format(
      "the results are not consistent, and U of the mean is too small: {} has an error that its budget lacks", which);
}

void print(const WeightedMean& m, const std::vector<NamedResult>& results) {
  constexpr double least_p = 1e-6;
  const auto& o = m.mean.output;
  const auto with_unit = [&](double x) { return with_suitable_unit(x, o.unit, o.si_unit); };
  std::cout << fmt::format("{}\n  u = {}; weighted mean of {} results\n", m.mean.certificate,
                           with_unit(m.mean.standard_uncertainty), m.parts.size());
  const int digits =
      decimals_for(units::from_si(m.mean.expanded_uncertainty, o.unit, o.si_unit, units::Kind::difference));
  for (std::size_t i = 0; i < m.parts.size(); ++i) {
    const WeightedPart& p = m.parts[i];
    std::cout << fmt::format("  {}. {}: {}{}, u = {}, weight {:.2f}, E_n = {:.2f}\n", i + 1, results[p.result].name,
                             fixed(units::from_si(p.summary.estimate, o.unit, o.si_unit), digits),
                             units::suffix(o.unit), with_unit(p.summary.standard_uncertainty), p.weight,
                             p.normalised_error);
  }
  const std::string p = (m.probability < least_p ? "p " : "p = ") + probability_text(m.probability, least_p);
  if (std::isfinite(m.ratio_degrees_of_freedom))
    std::cout << fmt::format(
        "  the weights come from estimated uncertainties, which adds {} to u of the mean\n"
        "  chi^2 = {:.2f}; by Welch's test F = {:.2f} ({} and {:.1f} degrees of freedom, {}): {}\n",
        with_unit(m.weighing), m.chi_squared, m.ratio, m.parts.size() - 1, m.ratio_degrees_of_freedom, p, verdict(m));
  else
    std::cout << fmt::format("  chi^2 = {:.2f} ({} degree{} of freedom, {}): {}\n", m.chi_squared, m.parts.size() - 1,
                             m.parts.size() == 2 ? "" : "s", p, verdict(m));
  std::vector<std::string> shared;
  for (const SharedPart& s : m.shared) shared.push_back(s.name);
  if (!shared.empty()) std::cout << fmt::format("  one error in several results: {}\n", fmt::join(shared, ", "));
}

void print(const WeightedMeans& all, const std::vector<NamedResult>& results) {
  std::vector<std::string> alike;
  for (const WeightedMean& m : all.rows) {
    print(m, results);
    for (const std::string& name : m.alike)
      if (std::ranges::find(alike, name) == alike.end()) alike.push_back(name);
  }
  for (const LeftOut& l : all.left_out)
    std::cout << fmt::format("left out: {}{}\n", l.problem.what,
                             l.problem.why.empty() ? "" : " (" + l.problem.why + ")");
  if (!all.single.empty()) std::cout << fmt::format("in one result only: {}\n", fmt::join(all.single, ", "));
  if (!alike.empty())
    std::cout << fmt::format(
        "treated as independent, although the budgets list alike: {}. Where one error is in several "
        "results (the same certificate, the same reference), add --same NAME\n",
        fmt::join(alike, ", "));
}

Json to_json(const WeightedMean& m, const std::vector<NamedResult>& results) {
  const auto& o = m.mean.output;
  const auto point = [&](double x) { return number(units::from_si(x, o.unit, o.si_unit)); };
  const auto width = [&](double x) { return number(units::from_si(x, o.unit, o.si_unit, units::Kind::difference)); };
  Json out{{"output", o.name},
           {"unit", o.unit},
           {"estimate", point(m.mean.estimate)},
           {"standard_uncertainty", width(m.mean.standard_uncertainty)},
           {"expanded_uncertainty", width(m.mean.expanded_uncertainty)},
           {"coverage_factor", number(m.mean.coverage_factor)},
           {"degrees_of_freedom", number(m.mean.degrees_of_freedom)},
           {"certificate", m.mean.certificate},
           {"chi_squared", number(m.chi_squared)},
           {"chi_squared_degrees_of_freedom", m.parts.size() - 1},
           {"ratio", number(m.ratio)},
           {"ratio_degrees_of_freedom", number(m.ratio_degrees_of_freedom)},
           {"weighing_uncertainty", width(m.weighing)},
           {"probability", number(m.probability)},
           {"consistent", m.consistent()},
           {"results", Json::array()},
           {"shared", Json::array()},
           {"alike", m.alike}};
  for (const WeightedPart& p : m.parts)
    out["results"].push_back({{"file", results[p.result].name},
                              {"estimate", point(p.summary.estimate)},
                              {"standard_uncertainty", width(p.summary.standard_uncertainty)},
                              {"own_uncertainty", width(p.own)},
                              {"weight", number(p.weight)},
                              {"difference", width(p.difference)},
                              {"normalised_error", number(p.normalised_error)}});
  for (const SharedPart& s : m.shared) {
    out["shared"].push_back({{"component", s.name}, {"contributions", Json::array()}});
    for (const double c : s.contributions) out["shared"].back()["contributions"].push_back(width(c));
  }
  return out;
}

ExitCode combine(const CombineOptions& o) {
  const std::vector<NamedResult> results = read_all(o.files);
  const WeightedMeans all = weighted_means(results, o.same, o.measurand);
  if (!o.out.empty() && all.rows.size() > 1)
    throw InputError("--out: a scenario has the mean of one measurand",
                     fmt::format("the results have {} in common", all.rows.size()), "name one by --measurand");
  if (!o.out.empty()) write_table(o.out, calibration::combined_scenario(all.rows[0], results), o.force);
  if (o.format == "text") {
    print(all, results);
    if (!o.out.empty())
      std::cout << fmt::format("{}: the mean as a scenario. Next: gumshoe run {}\n", o.out, shell_file(o.out));
    return ExitCode::done;
  }
  Json out{{"means", Json::array()},
           {"left_out", Json::array()},
           {"single", all.single},
           {"scenario_out", o.out.empty() ? Json(nullptr) : Json(o.out)}};
  for (const WeightedMean& m : all.rows) out["means"].push_back(to_json(m, results));
  for (const LeftOut& l : all.left_out)
    out["left_out"].push_back({{"output", l.output}, {"what", l.problem.what}, {"why", l.problem.why}});
  std::cout << json_text(out) << '\n';
  return ExitCode::done;
}

} // namespace

void add_combine(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("combine", "weighted mean of two or more results, and whether they are consistent");
  const auto o = std::make_shared<CombineOptions>();
  command->add_option("results", o->files, "result files (HDF5) of the same measurands")->required();
  command->add_option("--same", o->same, "quantities that have one error in several results, such as a certificate's")
      ->delimiter(',')
      ->type_name("NAME[,NAME]")
      ->allow_extra_args(false); // what follows is a file
  command->add_option("--measurand", o->measurand,
                      "the one to combine, with its labels (default: all in common that can be combined)");
  command->add_option("-o,--out", o->out,
                      "scenario to write with the mean: gumshoe run then gives its result and budget");
  command->add_option("--format", o->format, "text or json (all digits)")->check(CLI::IsMember({"text", "json"}));
  add_force(*command, o->force);
  command->callback([=, &action] { action = [=] { return combine(*o); }; });
}

} // namespace gumshoe::cli
