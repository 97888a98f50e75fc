/// `gumshoe gauge`: published examples again, and how ours compare.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/analyse.h"
#include "analysis/figures.h"
#include "analysis/stopping.h"
#include "base/json_text.h"
#include "base/units.h"
#include "calibration/figures.h"
#include "cli/command.h"
#include "cli/installed.h"
#include "propagation/memory_store.h"
#include "propagation/propagate.h"

namespace gumshoe::cli {

namespace {

namespace fs = std::filesystem;

/// One figure compared.
struct GaugeLine {
  std::string verdict; ///< PASS, DIFF or NOTE
  std::string example, figure, published, ours, tolerance, why, source, note;
};

/// Half a unit of the last digit that stands in a number: 0.05 for "1.2", 0.5e-8 for "2.38942129E+02".
double half_digit(const std::string& number) {
  int decimals = 0, exponent = 0;
  bool after = false;
  for (std::size_t i = 0; i < number.size(); ++i) {
    const char c = number[i];
    if (c == 'e' || c == 'E') {
      exponent = std::atoi(number.c_str() + i + 1);
      break;
    }
    if (c == '.')
      after = true;
    else if (c == ' ')
      break;
    else if (after)
      ++decimals;
  }
  return 0.5 * std::pow(10.0, exponent - decimals);
}

/// The tolerance in the published figure's unit, and why it is that.
std::pair<double, std::string> tolerance_of(const scenario::Expected& e, double published, double standard_error) {
  double given = half_digit(e.value);
  std::string why = "half a unit of the last digit";
  if (!e.tolerance.empty()) {
    const std::string relative = " relative";
    const bool scaled = e.tolerance.ends_with(relative);
    given = units::parse(scaled ? e.tolerance.substr(0, e.tolerance.size() - relative.size()) : e.tolerance).number;
    if (scaled) given *= std::fabs(published);
    why = e.why;
  }
  if (standard_error > 0) why += " and 4 Monte Carlo standard errors";
  return {given + 4 * standard_error, why};
}

GaugeLine compare(const scenario::Expected& e, const analysis::Figure& f, const std::string& example) {
  GaugeLine line{"", example, e.figure + (e.of.empty() ? "" : " of " + e.of), e.value, "", "", "", e.source, e.note};
  bool equal = false;
  if (!f.word.empty()) {
    line.ours = f.word;
    line.why = "a word";
    equal = f.word == e.value;
  } else {
    const auto published = units::parse(e.value);
    const auto kind = f.difference ? units::Kind::difference : units::Kind::point;
    const double ours = units::from_si(f.value, published.unit, f.si_unit, kind);
    const double se = std::fabs(units::from_si(f.standard_error, published.unit, f.si_unit, units::Kind::difference));
    const auto [tolerance, why] = tolerance_of(e, published.number, std::isfinite(se) ? se : 0);
    const std::string unit = units::suffix(published.unit);
    line.ours = fmt::format("{:.10g}{}", ours, unit);
    line.tolerance = fmt::format("{:.2g}{}", tolerance, unit);
    line.why = why;
    equal = std::fabs(ours - published.number) <= tolerance;
  }
  line.verdict = equal ? "PASS" : e.note.empty() ? "DIFF" : "NOTE";
  return line;
}

std::size_t output_of(const scenario::Expected& e, const analysis::Results& r) {
  for (std::size_t o = 0; o < r.summaries.size(); ++o) {
    const auto& output = r.summaries[o].output;
    const auto& labels = output.labels;
    const bool fits =
        std::ranges::all_of(e.labels, [&](const auto& l) { return std::ranges::find(labels, l) != labels.end(); });
    if (fits && (e.of.empty() || output.measurand == e.of)) return o;
  }
  throw InputError("no output matches");
}

/// Compares every expected figure with the one that `find` gives; its errors are located at the figure.
template <class Find>
std::vector<GaugeLine> compare_all(const scenario::Scenario& s, const std::string& example, const Find& find) {
  std::vector<GaugeLine> lines;
  for (const auto& e : s.expected) {
    try {
      lines.push_back(compare(e, find(e), example));
    } catch (const InputError& error) {
      auto problems = error.problems();
      for (Problem& p : problems) p.where = e.where;
      throw InputError(problems);
    }
  }
  return lines;
}

std::vector<GaugeLine> run_example(const std::string& file, int threads) {
  scenario::Scenario s = scenario::read(file, catalogue());
  const std::string example = fs::path(file).stem().string();
  if (s.expected.empty())
    throw InputError(
        {{{file}, "there is nothing to compare with", "it has no [[expected]]", "use gumshoe run " + file}});
  const propagation::Experiment experiment(s);
  if (s.expected.front().figure.starts_with("fit.")) {
    const auto fit = calibration::estimate(experiment, {threads});
    return compare_all(s, example, [&](const auto& e) { return calibration::figure(fit, experiment, e.figure); });
  }
  const bool adaptive = s.run.adaptive.rule != scenario::StoppingRule::fixed;
  propagation::MemoryStore store(experiment.outputs().size(), adaptive ? 0 : s.run.samples);
  propagation::RunSettings settings;
  settings.threads = threads;
  bool stopped = false;
  if (adaptive) {
    analysis::run_adaptively(experiment, store, settings, stopped);
    s.run.samples = store.samples();
  } else {
    propagation::propagate(experiment, store, settings);
  }
  const analysis::Results results = analysis::analyse(experiment, analysis::view_of(store), threads);
  return compare_all(s, example,
                     [&](const auto& e) { return analysis::figure(results, output_of(e, results), e.figure); });
}

void print(const GaugeLine& l) {
  std::cout << fmt::format("{} {}: {}: published {}{}, ours {}{}{}\n", l.verdict, l.example, l.figure, l.published,
                           l.source.empty() ? "" : " (" + l.source + ")", l.ours,
                           l.tolerance.empty() ? "" : fmt::format(", tolerance {} ({})", l.tolerance, l.why),
                           l.note.empty() ? "" : "; " + l.note);
}

std::vector<std::string> examples(const std::vector<std::string>& asked) {
  std::vector<std::string> files;
  const char* folder = std::getenv("GUMSHOE_SCENARIOS");
  std::vector<std::string> from = asked;
  if (from.empty())
    from = {(fs::path(folder ? folder : data_folder("scenarios", GUMSHOE_SCENARIOS_DIR)) / "gauge").string()};
  for (const std::string& name : from) {
    if (!fs::is_directory(name)) {
      files.push_back(name);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : fs::directory_iterator(name))
      if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
    if (files.size() == before) throw InputError("'" + name + "' contains no scenario files");
  }
  return files;
}

ExitCode gauge(const std::vector<std::string>& asked, int threads, bool json) {
  const auto started = std::chrono::steady_clock::now();
  std::size_t passed = 0, different = 0, noted = 0;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& file : examples(asked))
    for (const GaugeLine& l : run_example(file, threads)) {
      ++(l.verdict == "PASS" ? passed : l.verdict == "NOTE" ? noted : different);
      if (!json) print(l);
      all.push_back({{"verdict", l.verdict},
                     {"example", l.example},
                     {"figure", l.figure},
                     {"published", l.published},
                     {"ours", l.ours},
                     {"tolerance", l.tolerance},
                     {"why", l.why},
                     {"source", l.source},
                     {"note", l.note}});
    }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  if (json)
    std::cout << json_text(all) << '\n';
  else
    std::cout << fmt::format("{} figures: {} PASS, {} DIFF, {} NOTE, in {:.1f} s\n", passed + different + noted, passed,
                             different, noted, seconds);
  return different > 0 ? ExitCode::different : ExitCode::done;
}

} // namespace

void add_gauge(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("gauge", "repeats published examples and compares: PASS, DIFF or NOTE, one line each");
  struct Options {
    std::vector<std::string> files;
    std::string format = "text";
    int threads = 0;
  };
  const auto o = std::make_shared<Options>();
  command->add_option("examples", o->files, "scenario files or folders (default: those shipped with the program)");
  add_threads(*command, o->threads);
  command->add_option("--format", o->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  command->callback([=, &action] { action = [=] { return gauge(o->files, o->threads, o->format == "json"); }; });
}

} // namespace gumshoe::cli
