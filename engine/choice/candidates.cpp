#include "choice/candidates.h"

#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "choice/figures.h"
#include "choice/setup.h"

namespace gumshoe::choice {

namespace {

constexpr const char* first_names[] = {"possible", "time", "readings"};
constexpr const char* figure_names[] = {"mean",  "mean_se", "standard_deviation", "left", "expanded", "expanded_se",
                                        "valid", "failed"};
constexpr double Figures::*numbers[] = {&Figures::mean, &Figures::mean_se,  &Figures::standard_deviation,
                                        &Figures::left, &Figures::expanded, &Figures::expanded_se};
constexpr std::uint64_t Figures::*counts[] = {&Figures::valid, &Figures::failed};
constexpr std::size_t figure_values = std::size(numbers) + std::size(counts), first_figure = std::size(first_names);
static_assert(std::size(figure_names) == figure_values);

void assess(const scenario::Scenario& s, const Place& place, int threads, double* out) {
  std::fill_n(out, assessment_values(s), 0.0);
  std::unique_ptr<Setup> setup;
  try {
    setup = std::make_unique<Setup>(s, settings_at(*s.choose, place));
  } catch (const InputError&) {
    return;
  }
  *out++ = 1;
  *out++ = setup->seconds();
  *out++ = static_cast<double>(setup->experiment().scenario().readings.size());
  const Errors e = errors({setup.get()}, s.choose->samples, quantities::Purpose::sampling, threads);
  for (const Figures& f : figures_of(s, e[0])) {
    for (const auto number : numbers) *out++ = f.*number;
    for (const auto count : counts) *out++ = static_cast<double>(f.*count);
  }
}

constexpr const char* grid_name = "grid";

/// "grid", or "1 0 2;1 0 3;"
std::string name_of(const scenario::Scenario& s, const std::vector<Place>& places) {
  if (places == coarse_places(s)) return grid_name;
  std::string text;
  for (const Place& place : places) {
    for (std::size_t v = 0; v < place.size(); ++v) text += (v > 0 ? " " : "") + std::to_string(place[v]);
    text += ';';
  }
  return text;
}

std::vector<Place> places_of(const scenario::Scenario& s, const std::string& name) {
  if (name == grid_name) return coarse_places(s);
  std::vector<Place> places;
  std::istringstream all(name);
  for (std::string one; std::getline(all, one, ';');) {
    std::istringstream in(one);
    places.emplace_back();
    for (int part; in >> part;) places.back().push_back(part);
  }
  return places;
}

} // namespace

std::vector<std::string> assessment_names(const scenario::Scenario& s) {
  std::vector<std::string> names(std::begin(first_names), std::end(first_names));
  for (std::size_t k = 0; k < 1 + s.choose->cases.size(); ++k)
    for (const char* name : figure_names) names.push_back((k > 0 ? fmt::format("case_{}_", k) : "") + name);
  return names;
}

std::size_t assessment_values(const scenario::Scenario& s) {
  return first_figure + figure_values * (1 + s.choose->cases.size());
}

std::vector<scenario::Setting> settings_at(const scenario::Choose& choose, const Place& place) {
  const Places grid(choose);
  std::vector<scenario::Setting> out;
  for (std::size_t v = 0; v < place.size(); ++v) out.push_back({choose.variables[v].knob, grid.value(v, place[v])});
  return out;
}

std::vector<Figures> figures_of(const scenario::Scenario& s, const std::vector<std::vector<double>>& errors) {
  const double p = s.analysis.coverage_probability;
  const bool corrected = s.choose->definition == scenario::Choose::Definition::corrected;
  std::vector<Figures> out{average_figures(errors[0], p, s.choose->definition)};
  for (std::size_t k = 1; k < errors.size(); ++k)
    out.push_back(case_figures(errors[k], p, corrected ? out[0].mean : 0));
  return out;
}

std::vector<Place> coarse_places(const scenario::Scenario& s) {
  const Places grid(*s.choose);
  std::set<std::vector<double>> known;
  std::vector<Place> out;
  for (Place& place : grid.coarse()) {
    std::vector<double> values;
    for (std::size_t v = 0; v < place.size(); ++v) values.push_back(grid.value(v, place[v]));
    if (known.insert(std::move(values)).second) out.push_back(std::move(place));
  }
  return out;
}

std::string coarse_grid_hash(const scenario::Scenario& s) {
  std::string text = fmt::format("{} samples;", s.choose->samples);
  for (const std::string& name : assessment_names(s)) text += name + ';';
  for (const scenario::Variable& v : s.choose->variables)
    text += fmt::format("{} {};", static_cast<int>(v.knob.kind), v.knob.name);
  for (const Place& place : coarse_places(s))
    for (const scenario::Setting& setting : settings_at(*s.choose, place)) text += fmt::format("{:a};", setting.value);
  return fmt::format("{:016x}", hash64(text));
}

propagation::Work assessment_work(const scenario::Scenario& s, std::vector<Place> list, int threads) {
  const auto places = std::make_shared<const std::vector<Place>>(std::move(list));
  const std::size_t values = assessment_values(s);
  return {.name = name_of(s, *places),
          .units = places->size(),
          .values = values,
          .runs = s.choose->samples * (1 + s.choose->cases.size()),
          .compute = [&s, places, values, threads](std::uint64_t first, std::uint64_t last, double* out) {
            for (std::uint64_t i = first; i < last; ++i, out += values) assess(s, (*places)[i], threads, out);
          }};
}

propagation::Work assessment_work(const scenario::Scenario& s, const std::string& name) {
  return assessment_work(s, places_of(s, name));
}

Assessment assessment(const scenario::Scenario& s, const double* values) {
  Assessment a{values[0] != 0, values[1], static_cast<std::size_t>(values[2]), {}};
  values += first_figure;
  for (std::size_t k = 0; k < 1 + s.choose->cases.size(); ++k) {
    Figures f;
    for (const auto number : numbers) f.*number = *values++;
    for (const auto count : counts) f.*count = static_cast<std::uint64_t>(*values++);
    a.figures.push_back(f);
  }
  return a;
}

} // namespace gumshoe::choice
