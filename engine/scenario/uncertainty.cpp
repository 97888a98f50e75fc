#include "scenario/uncertainty.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "scenario/family.h"
#include "scenario/series.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using quantities::Family;

std::vector<std::string> distribution_names() {
  std::vector<std::string> names;
  for (const auto& family : quantities::families())
    if (family.family != Family::constant) names.emplace_back(family.name);
  return names;
}

/// Type A: the mean of n observations is a t with n - 1 degrees of freedom and scale s/sqrt(n),
/// JCGM 101:2008, 6.4.9.
std::optional<Uncertainty> read_observations(Table& table, const Form& form, Context& context) {
  const auto read = read_series(table, "observations", {form.si_unit}, context);
  if (!read) return std::nullopt;
  const std::vector<double>& x = *read;
  if (x.size() < 2) {
    table.refuse_key("observations", fmt::format("{} observation(s) cannot show any scatter", x.size()), "",
                     "give two or more");
    return std::nullopt;
  }
  const double n = static_cast<double>(x.size());
  double mean = 0, squares = 0;
  for (const double v : x) mean += v / n;
  for (const double v : x) squares += (v - mean) * (v - mean);
  const double scale = std::sqrt(squares / (n - 1) / n);
  // In units of s/sqrt(n): a mean is as far from its expectation in one case of a thousand.
  const double far = quantile(complement(boost::math::students_t(n - 1), 5e-4));
  if (const double apart = form.absolute && form.value ? std::abs(*form.value - mean) / scale : 0; apart > far)
    context.notes.push_back(fmt::format("{}: the mean of the observations is not used, because a value is stated; they "
                                        "differ by {:.3g} s/sqrt(n)",
                                        table.path(), apart));
  Uncertainty out;
  out.value = form.value.value_or(mean);
  out.exact = !(scale > 0);
  out.component.distribution = {Family::t, {0, scale, n - 1}, std::make_shared<const std::vector<double>>(x), nullptr};
  out.component.evaluation = 'A';
  out.component.degrees_of_freedom = n - 1;
  if (out.exact) {
    context.notes.push_back(
        fmt::format("{}: the {} observations are equal: their Type A uncertainty is zero; state the "
                    "resolution of the indication instead",
                    table.path(), x.size()));
  }
  return out;
}

/// The key that is like "distribution"; empty: none is.
std::string misspelt_distribution(const Table& table) {
  for (const Member& m : table.node().members)
    if (m.key != "distribution" && !nearest(m.key, {"distribution"}).empty()) return m.key;
  return {};
}

std::optional<Uncertainty> read_distribution(Table& table, const Form& form, Context& context) {
  std::string name = "normal"; // u, or U with k, alone
  if (table.has("distribution")) {
    const std::vector<std::string> names = distribution_names();
    const auto index = table.choice("distribution", names);
    if (!index) {
      table.members(); // the parameters cannot be judged
      return std::nullopt;
    }
    name = names[*index];
  } else if (!table.has("u") && !table.has("U")) {
    const bool bounded = table.has("half_width") || table.has("low") || table.has("high");
    const std::string key = misspelt_distribution(table);
    table.refuse("the distribution is missing", key.empty() ? "" : fmt::format("'{}' is no key", key),
                 !key.empty() ? "did you mean 'distribution'?"
                 : bounded    ? "distribution = \"rectangular\""
                              : "give distribution, u, U with k, or observations");
    table.members(); // the other keys cannot be judged
    return std::nullopt;
  }
  const auto* card = quantities::find_family(name);
  const auto located = card ? read_family(table, *card, form, context) : std::nullopt;
  if (!located) return std::nullopt;
  Uncertainty out;
  out.component.distribution = located->distribution;
  out.value = located->value;
  return out;
}

/// The samples of the output, which keep its shape; without any, its u with degrees of freedom.
std::optional<Uncertainty> read_earlier(Table& table, const Form& form, Context& context) {
  const Node& from = *table.find("from");
  const std::string path = table.path("from");
  const EarlierOutput* output = context.earlier.open(from, path, context.problems);
  if (!output) return std::nullopt;
  if (output->si_unit != form.si_unit) {
    table.refuse_key("from",
                     fmt::format("{} is in {}, not {}", output->name, output->unit, units::kind_name(form.si_unit)));
    return std::nullopt;
  }
  Uncertainty out;
  const bool deviation = form.value.has_value() || !form.absolute;
  out.value = form.value.value_or(form.absolute ? output->estimate : 0);
  Component& c = out.component;
  c.earlier = context.earlier.locate(from.text);
  c.degrees_of_freedom = output->degrees_of_freedom;
  auto values = std::make_shared<std::vector<double>>();
  for (const double x : output->samples)
    if (!std::isnan(x)) values->push_back(x);
  if (values->empty()) {
    const double u = output->standard_uncertainty;
    if (!std::isfinite(u)) {
      table.refuse_key("from", fmt::format("{} has neither samples nor a standard uncertainty", output->name));
      return std::nullopt;
    }
    out.exact = !(u > 0);
    if (out.exact && deviation) out.value += output->estimate;
    c.distribution = {Family::normal, {deviation ? output->estimate : 0, u}, {}, {}};
    context.note(fmt::format("{}: its samples are not stored; taken as {}", path,
                             std::isfinite(c.degrees_of_freedom) ? "a t distribution" : "normal"));
    return out;
  }
  const double n = static_cast<double>(values->size());
  std::ranges::sort(*values);
  const double front = values->front();
  double mean = 0;
  for (const double x : *values) mean += (x - front) / n;
  // About the run's estimate, of which the first samples have not the exact mean.
  for (double& x : *values) x = x - front - mean + (deviation ? output->estimate : 0);
  out.exact = !(values->back() > values->front());
  if (out.exact && deviation) out.value += output->estimate;
  c.distribution = {Family::empirical, {}, std::move(values), {}};
  if (std::isfinite(output->degrees_of_freedom)) c.distribution.parameters[0] = output->standard_uncertainty;
  if (output->drawn > output->samples.size())
    context.note(fmt::format("{}: drawn from the first {} of {} samples", path, output->samples.size(), output->drawn));
  if (n < static_cast<double>(output->samples.size()))
    context.note(fmt::format("{}: {} samples failed and are left out", path,
                             output->samples.size() - static_cast<std::size_t>(n)));
  return out;
}

} // namespace

Shape degrees_of_freedom_shape() { return shape::at_least(quantities::least_degrees_of_freedom); }

std::optional<double> read_degrees_of_freedom(Table& table) {
  const auto degrees = table.number("degrees_of_freedom");
  if (!degrees || *degrees >= quantities::least_degrees_of_freedom) return degrees;
  table.refuse_key("degrees_of_freedom",
                   fmt::format("{:.6g} must be at least {}", *degrees, quantities::least_degrees_of_freedom),
                   "a t distribution of fewer is wider than floating-point numbers can be",
                   "state 1, which is that of two readings, or more");
  return std::nullopt;
}

namespace {

/// Finite degrees of freedom of u make a normal distribution a t, of a Type A evaluation (JCGM 101:2008, 6.4.9) and of
/// a certificate (6.4.9.7) alike. For other families they only enter the effective degrees of freedom (GUM G.4.2).
void apply_degrees_of_freedom(Component& c, std::optional<double> declared, Table& table, Context& context) {
  if (declared && table.has("observations") && *declared != c.degrees_of_freedom)
    table.refuse_key("degrees_of_freedom",
                     fmt::format("{:.0f} observations have {:.0f}", c.degrees_of_freedom + 1, c.degrees_of_freedom),
                     "their mean is a t with n - 1 degrees of freedom (JCGM 101, 6.4.9)",
                     "leave it out, or state u of pooled observations with it");
  if (declared) c.degrees_of_freedom = *declared;
  auto& d = c.distribution;
  if (d.family == Family::normal && std::isfinite(c.degrees_of_freedom)) {
    if (table.has("distribution"))
      context.notes.push_back(fmt::format("{}: a standard uncertainty with {:.6g} degrees of freedom is drawn from a t "
                                          "distribution (JCGM 101, 6.4.9)",
                                          table.path(), c.degrees_of_freedom));
    d = {Family::t, {d.parameters[0], d.parameters[1], c.degrees_of_freedom}, nullptr, nullptr};
  }
  if (d.family == Family::t && d.parameters[1] > 0 && d.parameters[2] <= 2)
    context.notes.push_back(fmt::format("{}: a t distribution with {:.6g} degree{} of freedom has no standard "
                                        "uncertainty{}: only quantiles are given",
                                        table.path(), d.parameters[2], d.parameters[2] == 1 ? "" : "s",
                                        d.parameters[2] > 1 ? "" : " and no expectation"));
}

void check_scope(Table& table, const std::vector<std::string>& per, Context& context) {
  if (!context.readings_known) return;
  std::vector<std::string> names = context.label_names();
  names.emplace_back("reading");
  for (const std::string& name : per) {
    if (std::ranges::find(names, name) != names.end()) continue;
    table.refuse_key("per", fmt::format("no reading has the label '{}'", name),
                     "a scope is a label of the readings or \"reading\"", did_you_mean(name, names));
  }
}

} // namespace

const char* const uncertainty_rules = R"("dependencies": {"U": ["k"], "k": ["U"]})";

std::vector<Key> uncertainty_keys() {
  using namespace shape;
  const Shape measure = reference("measure"), width = reference("width"), positive = reference("positive");
  return {
      {"distribution", words(distribution_names()), "JCGM 101:2008, Table 1, and a few more; default: normal"},
      {"u", width,
       "standard uncertainty, absolute or relative to the value (\"0.1 %\"); for a t distribution the scale s/sqrt(n)"},
      {"U", width, "expanded uncertainty, absolute or relative, with its coverage factor k"},
      {"k", positive, "coverage factor of U"},
      {"half_width", width, "half-width about the value, absolute or relative"},
      {"low", measure, "lower limit; for a component, of the deviation"},
      {"high", measure, "upper limit; for a component, of the deviation"},
      {"inexactness", width, "curvilinear trapezoid: half-width of each limit's range"},
      {"top_ratio", interval(0, 1, false), "trapezoid: width of the top over that of the base"},
      {"mean", width, "exponential: expectation"},
      {"shape", positive_up_to(quantities::largest_gamma_shape), "gamma: shape"},
      {"scale", width, "gamma: scale"},
      {"median", measure, "lognormal: median"},
      {"mu", number(), "lognormal: expectation of ln x, x in SI"},
      {"sigma", positive, "lognormal: standard deviation of ln x"},
      {"values", reference("series"), "discrete and empirical: the values, or a column of a data file"},
      {"probabilities", list(interval(0, 1, false)), "discrete: one probability per value; their sum is 1"},
      {"observations", reference("series"),
       "Type A evaluation: repeated observations, or a column of them in a data file, giving a t distribution with n - "
       "1 "
       "degrees of freedom"},
      {"from", text(),
       "\"FILE.h5:OUTPUT\", output of an earlier run: its samples are the distribution, its estimate the value; "
       "outputs of "
       "one file keep their correlation"},
      {"same", list(text()),
       "from: quantities in the budget of that output whose errors are those of another result here, or of the "
       "quantity "
       "of that name here"},
      {"evaluation", words({"A", "B"}), "Type A or Type B evaluation (GUM 2.3.2, 2.3.3)"},
      {"degrees_of_freedom", degrees_of_freedom_shape(),
       "degrees of freedom of u; finite ones make a normal distribution a t (JCGM 101, 6.4.9); default: infinite"},
      {"per", any_of({text(), list(text())}),
       "scope: one draw per combination of these labels, or per \"reading\"; default: a single draw, as with []"},
      {"source", reference("source")},
  };
}

std::optional<Uncertainty> read_uncertainty(Table& table, const Form& form, Context& context) {
  const bool observed = table.has("observations");
  if (observed && (table.has("distribution") || table.has("u") || table.has("U")))
    table.refuse("observations are given together with another statement of uncertainty", "both state the uncertainty",
                 "leave one out");
  const bool earlier = table.has("from");
  if (earlier)
    for (const char* key : {"distribution", "u", "U", "observations", "degrees_of_freedom", "evaluation"})
      if (table.has(key))
        table.refuse_key(key, "is given together with from", "the result states the uncertainty", "leave it out");
  const auto same = table.texts("same");
  if (table.has("same") && !earlier)
    table.refuse_key("same", "there is no result", "", "from = \"calibration.h5:laser_z\"");
  auto out = earlier    ? read_earlier(table, form, context)
             : observed ? read_observations(table, form, context)
                        : read_distribution(table, form, context);

  // Read in any case, so that these keys are known and their problems are told too.
  const auto evaluation = table.choice("evaluation", {"A", "B"});
  const auto degrees = read_degrees_of_freedom(table);
  const auto per = table.texts("per");
  check_scope(table, per, context);
  const std::string source = table.rendered("source");
  if (!out) return std::nullopt;
  Component& c = out->component;
  if (evaluation) c.evaluation = *evaluation ? 'B' : 'A';
  apply_degrees_of_freedom(c, degrees, table, context);
  c.per = per;
  c.source = source.empty() && c.earlier ? table.find("from")->text : source;
  if (c.earlier) c.earlier->same = same;
  return out;
}

} // namespace gumshoe::scenario
