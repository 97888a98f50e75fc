#include "cli/print.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include <fmt/format.h>

#include "analysis/certificate.h"
#include "analysis/rounding.h"
#include "analysis/selection.h"
#include "base/error.h"
#include "base/units.h"
#include "cli/print_budget.h"
#include "cli/print_studies.h"

namespace gumshoe::cli {

namespace {
using namespace analysis;

constexpr std::size_t most_lines =
    12; ///< outputs of one measurand, comparisons, notes: beyond that a line tells of all

double point(const propagation::Output& o, double x) { return units::from_si(x, o.unit, o.si_unit); }

/// One line per verdict and reason, with the outputs for which it holds; of reasons that differ in their numbers only,
/// the one of the largest Monte Carlo tolerance over delta.
void print_validations(const Results& r) {
  struct Line {
    std::string kind, text;
    double largest = 0;
    std::vector<std::string> outputs;
  };
  std::vector<Line> lines;
  for (const auto& v : r.validations) {
    if (v.output.diagnostic) continue;
    const std::string kind = v.verdict + v.reason.substr(0, v.reason.find("; about "));
    auto line = std::ranges::find(lines, kind, &Line::kind);
    if (line == lines.end()) line = lines.insert(lines.end(), Line{kind, "", -1, {}});
    if (const double ratio = v.delta > 0 ? v.monte_carlo_tolerance / v.delta : 0; !(ratio <= line->largest)) {
      line->largest = ratio;
      line->text = v.verdict + " (" + v.reason + ")";
    }
    line->outputs.push_back(v.output.name);
  }
  for (const auto& [kind, text, largest, outputs] : lines) {
    std::string names;
    for (std::size_t i = 0; i < std::min(most_lines, outputs.size()); ++i) names += (i == 0 ? "" : ", ") + outputs[i];
    if (outputs.size() > most_lines) names = fmt::format("{} outputs", outputs.size());
    std::cout << fmt::format("GUM framework against Monte Carlo (JCGM 101 clause 8): {}: {}\n", text, names);
  }
}

/// What stands below an output's line: u, interval, the GUM framework, the largest contributions, warnings.
void print_details(const Results& r, std::size_t o, bool budget) {
  const Summary& s = r.summaries[o];
  const Budget& b = r.budgets[o];
  const Validation& v = r.validations[o];
  const auto width = [&](double x) { return with_suitable_unit(x, s.output.unit, s.output.si_unit); };
  const int d =
      decimals_for(units::from_si(s.standard_uncertainty, s.output.unit, s.output.si_unit, units::Kind::difference));
  if (!s.certificate.empty()) {
    std::cout << fmt::format("  u = {}; shortest {} coverage interval [{}, {}]{}", width(s.standard_uncertainty),
                             coverage_text(r.coverage_probability), fixed(point(s.output, s.shortest.low), d),
                             fixed(point(s.output, s.shortest.high), d), units::suffix(s.output.unit));
    if (v.verdict == "validated")
      std::cout << "; U and k of the GUM framework, validated by Monte Carlo" << uncertainty_of_factor(s, b);
    else if (b.applicable)
      std::cout << fmt::format("; U and k by Monte Carlo; GUM framework: U = {} with k = {:.2f}{} ({})",
                               width(b.expanded_uncertainty), b.coverage_factor,
                               std::isfinite(b.effective_degrees_of_freedom)
                                   ? fmt::format(" ({})", effective_freedom(b.effective_degrees_of_freedom))
                                   : "",
                               v.verdict);
    else
      std::cout << "; U and k by Monte Carlo";
    std::cout << '\n';
  }
  const bool studied = o < r.sensitivities.size();
  if (!(s.standard_uncertainty == 0))
    std::cout << "  "
              << largest_contributions(b, s, v, studied ? r.sensitivities[o].indices : std::vector<SobolIndex>{})
              << '\n';
  if (!s.warning.empty()) std::cout << "  warning: " << s.warning << '\n';
  if (!s.tail_remark.empty()) std::cout << "  warning: " << s.tail_remark << '\n';
  if (budget) print_budget(b, std::cout);
}

/// The certificate's line; the statement in words where there is none.
std::string head_line(const Summary& s) {
  return s.certificate.empty() ? s.statement : s.certificate;
}

/// One line for all readings of a measurand, and the reading of the largest u in full.
void print_range(const Results& r, const std::vector<std::size_t>& outputs, bool budget) {
  const auto estimate = [&](std::size_t o) { return r.summaries[o].estimate; };
  const auto u = [&](std::size_t o) { return r.summaries[o].standard_uncertainty; };
  const auto known = [](const auto& value) {
    return [&](std::size_t x, std::size_t y) {
      return std::isnan(value(y)) ? false : std::isnan(value(x)) || value(x) < value(y);
    };
  };
  const auto ends = [&](const auto& value) {
    const auto largest = *std::ranges::max_element(outputs, known(value));
    auto least = largest;
    for (const std::size_t o : outputs)
      if (value(o) < value(least)) least = o;
    return std::pair(least, largest);
  };
  const auto [low, high] = ends(estimate);
  const auto [least, worst] = ends(u);
  const auto& output = r.summaries[worst].output;
  const int d = decimals_for(units::from_si(u(worst), output.unit, output.si_unit, units::Kind::difference));
  const auto place = [&](std::size_t o) {
    const std::string& name = r.summaries[o].output.name;
    const auto open = name.find('[');
    return open == std::string::npos ? name : name.substr(open + 1, name.size() - open - 2);
  };
  const auto width = [&](double x) { return with_suitable_unit(x, output.unit, output.si_unit); };
  const auto validated =
      std::ranges::count_if(outputs, [&](std::size_t o) { return r.validations[o].verdict == "validated"; });
  std::cout << fmt::format("{} at {} readings: from {}{} ({}) to {}{} ({}); u from {} to {}; GUM framework validated "
                           "for {}; the largest u:\n",
                           output.name.substr(0, output.name.find('[')), outputs.size(),
                           fixed(point(output, estimate(low)), d), units::suffix(output.unit), place(low),
                           fixed(point(output, estimate(high)), d), units::suffix(output.unit), place(high),
                           width(u(least)), width(u(worst)),
                           validated == static_cast<long>(outputs.size()) ? "all" : fmt::format("{}", validated));
  std::cout << head_line(r.summaries[worst]) << '\n';
  print_details(r, worst, budget);
}

/// "rank = 11, condition_number = 12.3 (u = 0.4)": what says how the evaluation went.
void print_diagnostics(const Results& r, const std::map<std::string, std::vector<std::size_t>>& diagnostics) {
  std::string text;
  for (const auto& [name, outputs] : diagnostics) {
    double low = INFINITY, high = -INFINITY, u = 0;
    for (const std::size_t o : outputs) {
      low = std::fmin(low, r.summaries[o].estimate);
      high = std::fmax(high, r.summaries[o].estimate);
      u = std::fmax(u, r.summaries[o].standard_uncertainty);
    }
    text += fmt::format("{}{} = {:.4g}", text.empty() ? "" : ", ", name, low);
    if (high > low) text += fmt::format(" to {:.4g}", high);
    if (u > 0) text += fmt::format(" (scatters by {:.2g})", u);
  }
  if (!text.empty()) std::cout << "diagnostics: " << text << '\n';
}

/// The outputs; returns the names of those printed in full.
std::set<std::string> print_outputs(const Results& r, const PrintOptions& options) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::size_t>> measurands, diagnostics;
  for (std::size_t o = 0; o < r.summaries.size(); ++o) {
    const auto& output = r.summaries[o].output;
    auto& group = (output.diagnostic ? diagnostics : measurands)[output.measurand];
    if (group.empty() && !output.diagnostic) order.push_back(output.measurand);
    group.push_back(o);
  }
  std::set<std::string> printed;
  for (const std::string& name : order) {
    const auto& outputs = measurands[name];
    if (outputs.size() > most_lines && !options.all) {
      print_range(r, outputs, options.budget);
      continue;
    }
    for (const std::size_t o : outputs) {
      printed.insert(r.summaries[o].output.name);
      std::cout << head_line(r.summaries[o]) << '\n';
      print_details(r, o, options.budget);
    }
  }
  print_diagnostics(r, diagnostics);
  return printed;
}

void print_comparisons(const Results& r, bool all) {
  if (r.comparisons.size() > most_lines && !all) {
    const auto size = [](const ComparisonResult& c) { // without a U none
      return std::isnan(c.normalised_error) ? -1 : std::fabs(c.normalised_error);
    };
    const auto largest = std::ranges::max_element(r.comparisons, {}, size);
    std::cout << fmt::format("{} comparisons: |E_n| exceeds 1 in {}; the largest: {}, E_n = {:.2f}\n",
                             r.comparisons.size(),
                             std::ranges::count_if(r.comparisons, [&](const auto& c) { return size(c) > 1; }),
                             largest->name, largest->normalised_error);
    return;
  }
  for (const auto& c : r.comparisons) {
    const auto shown = [&](double x) { return units::from_si(x, c.unit, c.si_unit, units::Kind::difference); };
    const int d = decimals_for(shown(c.expanded_uncertainty));
    const std::string unit = units::suffix(c.unit);
    if (std::isnan(c.expanded_uncertainty)) {
      std::cout << fmt::format("{} = {:.4g}{}, without U and E_n\n", c.name, shown(c.difference), unit);
      continue;
    }
    std::cout << fmt::format("{} = {}{}, U = {}{}, E_n = {:.2f}\n", c.name, fixed(shown(c.difference), d), unit,
                             fixed(shown(c.expanded_uncertainty), d), unit,
                             std::round(100 * c.normalised_error) / 100 + 0.0); // never -0
  }
}

void print_published(const Results& r, bool all) {
  if (r.printed.size() > most_lines && !all) {
    const auto size = [](const PrintedResult& p) { return std::fabs(p.ours - p.printed) / p.expanded_uncertainty; };
    const auto largest = std::ranges::max_element(r.printed, {}, size);
    std::cout << fmt::format("{} printed figures: the largest difference is {:.2g} U, of {}\n", r.printed.size(),
                             size(*largest), largest->output);
    return;
  }
  for (const auto& p : r.printed) {
    const auto shown = [&](double x) { return units::from_si(x, p.unit, p.si_unit); };
    const int d = decimals_for(units::from_si(p.expanded_uncertainty, p.unit, p.si_unit, units::Kind::difference));
    const std::string unit = units::suffix(p.unit);
    std::cout << fmt::format("{}: ours {}{}, printed {}{}{}\n", p.output, fixed(shown(p.ours), d), unit,
                             fixed(shown(p.printed), d), unit, p.source.empty() ? "" : " (" + p.source + ")");
  }
}

/// If there are many decisions, prints how they came out, and keeps those that are least certain.
void keep_least_certain(std::vector<ConformityResult>& all) {
  if (all.size() <= most_lines) return;
  const auto accepted = std::ranges::count(all, true, &ConformityResult::accepted);
  const auto certainty = [](const ConformityResult& c) {
    const double p = c.conformance_probability;
    return std::isnan(p) ? 0 : std::fabs(p - 0.5);
  };
  std::ranges::stable_sort(all, {}, certainty);
  std::cout << fmt::format("conformity: {} of {} accepted, {} rejected; the {} least certain (--all prints all):\n",
                           accepted, all.size(), all.size() - static_cast<std::size_t>(accepted), most_lines);
  all.resize(most_lines);
}

void print_predicted(const Results& r) {
  if (r.predicted.empty()) return;
  std::cout << fmt::format("{} of {} readings lie in their {} coverage intervals\n",
                           std::ranges::count(r.predicted, true, &PredictedReading::inside), r.predicted.size(),
                           coverage_text(r.coverage_probability));
}

} // namespace

void print_text(const Results& r, const std::string& file, const PrintOptions& options) {
  if (!r.title.empty()) std::cout << printable(r.title) << '\n';
  const std::set<std::string> printed = print_outputs(r, options);
  print_validations(r);
  Results in_full = r;
  keep_outputs(in_full, [&](const auto& output) { return printed.contains(output.name); });
  if (!options.all) keep_least_certain(in_full.conformity);
  print_studies(in_full, std::cout);
  print_comparisons(r, options.all);
  print_published(r, options.all);
  print_predicted(r);
  for (std::size_t i = 0; i < r.notes.size(); ++i) {
    if (i == most_lines && r.notes.size() > most_lines + 1 && !options.all) {
      std::cout << fmt::format("note: {} more notes are in the result file\n", r.notes.size() - i);
      break;
    }
    std::cout << "note: " << r.notes[i] << '\n';
  }
  for (const std::string& f : r.failures) std::cout << "failed: " << f << '\n';
  if (!r.failures.empty() && !r.summaries.empty())
    std::cout << fmt::format("failed samples count for no output: what is stated holds for the {} others\n",
                             r.summaries[0].valid);
  std::cout << fmt::format("{} samples, seed {}, {}, {}: {}\n", r.samples, r.seed, r.method, r.evaluation, file);
}

ExitCode print_results(const Results& r, const std::string& file, const PrintOptions& options) {
  if (options.format == "json")
    print_json(r, file);
  else if (options.format == "csv")
    print_csv(r, options.budget);
  else
    print_text(r, file, options);
  if (static_cast<double>(r.failed) > options.max_failed_share * static_cast<double>(r.samples)) {
    std::cerr << fmt::format("error: {} of {} samples failed (more than max_failed_share = {}).\n", r.failed, r.samples,
                             options.max_failed_share);
    return ExitCode::too_many_failures;
  }
  if (!r.stopping.reached) {
    std::cerr << "error: " << r.stopping.statement << '\n';
    return ExitCode::too_many_failures;
  }
  return ExitCode::done;
}

} // namespace gumshoe::cli
