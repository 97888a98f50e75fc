#include "cli/print.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "analysis/result_fields.h"
#include "analysis/rounding.h"
#include "base/units.h"
#include "cli/fields_json.h"
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

namespace {

/// The fields of the summary that JSON shows, as a line of CSV.
std::string csv_line(const analysis::Summary& s) {
  std::string line;
  const auto unit = analysis::unit_of(s);
  for (const auto& field : analysis::summary_fields.list) {
    if (field.shown.json.empty()) continue;
    if (!line.empty()) line += ',';
    const auto cell = [&]<class T>(const T& value) {
      if constexpr (std::is_same_v<T, double>)
        line += fmt::format("{:.{}g}", converted(value, field.unit, unit), field.unit.in == analysis::In::point ? 15 : 6);
      else if constexpr (std::is_same_v<T, std::string>)
        line += '"' + value + '"';
      else
        line += fmt::format("{}", value);
    };
    if (field.get)
      std::visit(cell, field.get(s));
    else
      line += unit.shown;
  }
  return line;
}

} // namespace

void print_table(const analysis::Results& r, bool json) {
  if (json) {
    Json all = Json::array();
    for (const auto& s : r.summaries) {
      all.push_back(cli::json(analysis::summary_fields, s));
      add_studies(r, s.output, all.back());
    }
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::string head;
  for (const auto& field : analysis::summary_fields.list)
    if (!field.shown.json.empty())
      head += (head.empty() ? "" : ",") + std::string(field.name(field.shown.csv));
  std::cout << head << '\n';
  for (const auto& s : r.summaries) std::cout << csv_line(s) << '\n';
}

ExitCode print_results(const analysis::Results& r, const std::string& file, const std::string& format,
                       double max_failed_share) {
  if (format == "text")
    print_text(r, file);
  else
    print_table(r, format == "json");
  if (static_cast<double>(r.failed) > max_failed_share * static_cast<double>(r.samples)) {
    std::cerr << fmt::format("error: {} of {} samples failed (more than max_failed_share = {}).\n", r.failed, r.samples,
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
