#include "cli/print.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/rounding.h"
#include "base/units.h"
#include "cli/print_studies.h"

namespace gumshoe::cli {

namespace {

/// One line per verdict, with the outputs it holds for.
void print_validations(const analysis::Results& r) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const auto& v : r.validations) {
    const std::string text = v.verdict + " (" + v.reason + ")";
    const auto line = std::ranges::find(lines, text, &std::pair<std::string, std::string>::first);
    if (line == lines.end())
      lines.emplace_back(text, v.output.name);
    else
      line->second += ", " + v.output.name;
  }
  for (const auto& [text, outputs] : lines)
    std::cout << fmt::format("GUM framework against Monte Carlo (JCGM 101 clause 8): {}: {}\n", text, outputs);
}

} // namespace

void print_text(const analysis::Results& r, const std::string& out) {
  std::cout << r.title << '\n';
  for (const auto& s : r.summaries) std::cout << s.statement << '\n';
  print_validations(r);
  print_studies(r, std::cout);
  for (const auto& c : r.comparisons) {
    const auto shown = [&](double x) { return units::from_si(x, c.unit, c.si_unit, units::Kind::difference); };
    const int d = analysis::decimals_for(shown(c.expanded_uncertainty));
    std::cout << fmt::format("{} = {} {}, U = {} {}, E_n = {:.2f}\n", c.name, analysis::fixed(shown(c.difference), d),
                             c.unit, analysis::fixed(shown(c.expanded_uncertainty), d), c.unit, c.normalised_error);
  }
  for (const auto& p : r.printed) {
    const auto shown = [&](double x) { return units::from_si(x, p.unit, p.si_unit); };
    const int d =
        analysis::decimals_for(units::from_si(p.expanded_uncertainty, p.unit, p.si_unit, units::Kind::difference));
    std::cout << fmt::format("{}: ours {} {}, printed {} {} ({})\n", p.output, analysis::fixed(shown(p.ours), d),
                             p.unit, analysis::fixed(shown(p.printed), d), p.unit, p.source);
  }
  for (const std::string& note : r.notes) std::cout << "note: " << note << '\n';
  for (const std::string& f : r.failures) std::cout << "failed: " << f << '\n';
  std::cout << fmt::format("{} samples, seed {}, {}, {}: {}\n", r.samples, r.seed, r.method, r.evaluation, out);
}

void print_table(const analysis::Results& r, bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  if (!json)
    std::cout << "output,unit,estimate,standard_uncertainty,symmetric_low,symmetric_high,shortest_low,shortest_high,"
                 "valid,failed\n";
  for (const auto& s : r.summaries) {
    const auto shown = [&](double x) { return units::from_si(x, s.output.unit, s.output.si_unit); };
    const double u = units::from_si(s.standard_uncertainty, s.output.unit, s.output.si_unit, units::Kind::difference);
    const auto number = [](double x) {
      return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
    };
    if (json) {
      all.push_back({{"output", s.output.name},
                     {"unit", s.output.unit},
                     {"estimate", number(shown(s.estimate))},
                     {"standard_uncertainty", number(u)},
                     {"symmetric", {number(shown(s.symmetric.low)), number(shown(s.symmetric.high))}},
                     {"shortest", {number(shown(s.shortest.low)), number(shown(s.shortest.high))}},
                     {"valid", s.valid},
                     {"failed", s.failed}});
      add_studies(r, s.output, all.back());
    } else {
      std::cout << fmt::format("\"{}\",{},{:.15g},{:.6g},{:.15g},{:.15g},{:.15g},{:.15g},{},{}\n", s.output.name,
                               s.output.unit, shown(s.estimate), u, shown(s.symmetric.low), shown(s.symmetric.high),
                               shown(s.shortest.low), shown(s.shortest.high), s.valid, s.failed);
    }
  }
  if (json) std::cout << all.dump(2) << '\n';
}

ExitCode print_results(const analysis::Results& r, const std::string& file, const std::string& format,
                       double max_failed_share) {
  if (format == "text")
    print_text(r, file);
  else
    print_table(r, format == "json");
  if (static_cast<double>(r.failed) > max_failed_share * static_cast<double>(r.samples)) {
    std::cerr << fmt::format("error: {} of {} samples failed (more than max_failed_share = {})\n", r.failed, r.samples,
                             max_failed_share);
    return ExitCode::too_many_failures;
  }
  if (!r.stopping.reached) {
    std::cerr << "error: " << r.stopping.statement << '\n';
    return ExitCode::too_many_failures;
  }
  return ExitCode::done;
}

} // namespace gumshoe::cli
