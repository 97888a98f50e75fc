#include "scenario/family.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "scenario/series.h"

namespace gumshoe::scenario {
namespace {

using quantities::Family;
using quantities::FamilyCard;
using quantities::ParameterCard;

class FamilyReader {
public:
  FamilyReader(Table& table, const FamilyCard& card, const Form& form, Context& context)
      : table_(table), card_(card), form_(form), context_(context) {
    out_.distribution.family = card.family;
    out_.value = form.value.value_or(form.fallback);
  }

  std::optional<Located> read() {
    const std::size_t problems = context_.problems.size();
    switch (card_.family) {
    case Family::constant:
      break;
    case Family::rectangular:
    case Family::curvilinear_trapezoid:
    case Family::trapezoid:
    case Family::triangular:
    case Family::arcsine:
      bounded();
      break;
    case Family::normal:
    case Family::t:
      around_value();
      break;
    case Family::truncated_normal:
      truncated();
      break;
    case Family::exponential:
    case Family::gamma:
    case Family::lognormal:
      from_zero();
      break;
    case Family::discrete:
    case Family::empirical:
      listed();
      break;
    }
    if (context_.problems.size() != problems) return std::nullopt;
    if (const std::string wrong = invalid_parameters(out_.distribution); !wrong.empty()) {
      table_.refuse(wrong, std::string(card_.name));
      return std::nullopt;
    }
    if (card_.family == Family::truncated_normal && form_.absolute) centre_truncated();
    return out_;
  }

private:
  double& parameter(std::size_t i) { return out_.distribution.parameters[i]; }
  Dimension difference() const { return {form_.si_unit, units::Kind::difference}; }
  Dimension location() const { return {form_.si_unit, form_.absolute ? units::Kind::point : units::Kind::difference}; }
  void missing(const std::string& what, const std::string& remedy = {}) {
    table_.add(fmt::format("{} is missing", table_.path(what)), std::string(card_.name), remedy);
  }
  double needed(const std::string& key, std::optional<double> value) {
    if (!table_.has(key)) missing(key);
    return value.value_or(0);
  }

  /// low and high, or half_width about the value; then a third parameter of the family, by its card.
  void bounded() {
    const auto low = table_.measure("low", location()), high = table_.measure("high", location());
    const auto half = read_width(table_, "half_width", form_, context_);
    const bool ends = table_.has("low") || table_.has("high");
    if (table_.has("half_width") && ends) {
      table_.refuse("half_width is given together with low or high", "both state the width", "leave one out");
    } else if (table_.has("half_width")) {
      if (half && *half <= 0)
        table_.refuse_key("half_width", "must be above 0", "", "leave the distribution out for an exact value");
      parameter(0) = -half.value_or(1);
      parameter(1) = half.value_or(1);
    } else if (!ends) {
      missing("half_width", "give half_width, or low and high");
    } else {
      const double a = needed("low", low), b = needed("high", high);
      if (low && high && a >= b) table_.refuse_key("low", "low must be below high");
      if (form_.absolute && form_.value)
        table_.refuse("value is given together with low and high", "the value is the middle of the limits",
                      "give value with half_width, or low and high alone");
      const double middle = form_.absolute ? a + (b - a) / 2 : 0;
      if (form_.absolute) out_.value = middle;
      parameter(0) = form_.absolute ? -(b - a) / 2 : a;
      parameter(1) = form_.absolute ? (b - a) / 2 : b;
    }
    if (card_.parameters.size() > 2) parameter(2) = generic(card_.parameters[2]);
  }

  void around_value() {
    parameter(0) = 0;
    parameter(1) = standard_uncertainty();
    if (card_.family != Family::t) return;
    const auto degrees = read_degrees_of_freedom(table_);
    parameter(2) = degrees.value_or(1);
    if (!table_.has("degrees_of_freedom")) missing("degrees_of_freedom");
  }

  void truncated() {
    parameter(0) = form_.absolute ? out_.value : 0;
    parameter(1) = standard_uncertainty();
    parameter(2) = needed("low", table_.measure("low", location()));
    parameter(3) = needed("high", table_.measure("high", location()));
  }

  /// What is left after truncation has another mean: it is the value, and the rest is about it.
  void centre_truncated() {
    const double mean = out_.distribution.mean();
    for (const std::size_t i : {0, 2, 3}) parameter(i) -= mean;
    out_.value = mean;
  }

  void from_zero() {
    out_.value = form_.value.value_or(0);
    for (std::size_t i = 0; i < card_.parameters.size(); ++i) {
      if (card_.family == Family::lognormal && i == 0 && table_.has("median")) {
        const auto median = table_.measure("median", {form_.si_unit});
        if (median && *median <= 0) table_.refuse_key("median", "must be above 0");
        parameter(0) = std::log(median.value_or(1));
      } else {
        parameter(i) = generic(card_.parameters[i]);
      }
    }
  }

  double generic(const ParameterCard& p) {
    const std::string key(p.key);
    if (!table_.has(key)) missing(key);
    const auto value = p.dimension == ParameterCard::Dimension::number || p.dimension == ParameterCard::Dimension::log
                           ? table_.number(key)
                           : table_.measure(key, difference());
    return value.value_or(1);
  }

  void listed() {
    out_.value = form_.value.value_or(0);
    const Dimension dimension{form_.si_unit,
                              form_.value || !form_.absolute ? units::Kind::difference : units::Kind::point};
    if (!table_.has("values")) missing("values");
    const std::vector<double> values = read_series(table_, "values", dimension, context_).value_or(std::vector<double>{});
    std::vector<double> shares;
    if (card_.family == Family::discrete) shares = read_probabilities(values.size());
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
    auto sorted = std::make_shared<std::vector<double>>();
    auto sorted_shares = std::make_shared<std::vector<double>>();
    for (const std::size_t i : order) {
      sorted->push_back(values[i]);
      if (i < shares.size()) sorted_shares->push_back(shares[i]);
    }
    out_.distribution.values = sorted;
    if (card_.family == Family::discrete) out_.distribution.probabilities = sorted_shares;
  }

  std::vector<double> read_probabilities(std::size_t n) {
    std::vector<double> shares;
    const auto* items = table_.array("probabilities");
    if (!items) {
      if (!table_.has("probabilities"))
        missing("probabilities", "give them, or use distribution = \"empirical\" for equal ones");
      return shares;
    }
    for (const Node& item : *items)
      if (const auto p = read_number(item, table_.path("probabilities"), context_.problems)) shares.push_back(*p);
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    if (n > 0 && shares.size() != n)
      table_.refuse_key("probabilities", fmt::format("there are {} probabilities for {} values", shares.size(), n));
    else if (std::abs(sum - 1) > 1e-6)
      table_.refuse_key("probabilities", fmt::format("the probabilities add up to {}, not 1", sum));
    for (double& p : shares) p /= sum;
    return shares;
  }

  double standard_uncertainty() {
    if (!table_.has("u") && !table_.has("U")) missing("u", "give u, or U with k");
    return read_standard_uncertainty(table_, form_, context_).value_or(1);
  }

  Table& table_;
  const FamilyCard& card_;
  const Form& form_;
  Context& context_;
  Located out_;
};

} // namespace

namespace {

/// The unit of a text that is a share of something: "%", "ppm", "um/m"; empty for any other.
std::string unit_of_share(const Node* node) {
  if (!node || node->kind != Node::Kind::text) return {};
  try {
    const std::string unit = units::parse(node->text).unit;
    return unit != "1" && units::convertible(unit, "1") ? unit : "";
  } catch (const InputError&) {
    return {};
  }
}

/// Whether a share is one of the value: it is, unless the quantity is one itself. An angle is one as um/m (a slope), and
/// either is where its value is written as one or there is none.
bool is_relative(const std::string& share, const Form& form) {
  if (!units::convertible(share, form.si_unit)) return true;
  const bool slope = form.si_unit != "1" && share.find('/') != std::string::npos;
  return !slope && form.reference.value_or(0) != 0 && unit_of_share(form.reference_node).empty();
}

} // namespace

std::optional<double> read_width(Table& table, const std::string& key, const Form& form, Context& context) {
  const Node* node = table.find(key);
  const std::string share = unit_of_share(node);
  if (share.empty() || !is_relative(share, form)) {
    const auto width = table.measure(key, {form.si_unit, units::Kind::difference});
    // "10 %" of "100 ppm" may be meant as 10 ppm.
    if (const std::string own = unit_of_share(form.reference_node);
        width && !share.empty() && own != share && !own.empty())
      context.note(fmt::format("{}: '{}' is taken as {:.6g} {}, and not as a share of '{}'", table.path(key),
                               node->text, units::from_si(*width, own, form.si_unit, units::Kind::difference), own,
                               form.reference_node->text));
    return width;
  }
  std::string remedy;
  try {
    units::to_si(0, "1e-3", form.si_unit);
  } catch (const InputError& error) {
    remedy = error.problems().front().remedy;
  }
  if (form.si_unit == "K")
    table.refuse_key(key, fmt::format("'{}' of a temperature depends on its scale", node->text), "", "use K");
  else if (form.reference.value_or(0) == 0)
    table.refuse_key(key, fmt::format("'{}' is a share of the value", node->text),
                     form.reference ? "the value is zero" : "no value is stated here", remedy);
  else {
    const double width = std::abs(*form.reference) * units::to_si(units::parse(node->text).number, share, "1");
    if (form.si_unit == "1")
      context.note(fmt::format("{}: '{}' is taken as a share of the value: {:.6g}", table.path(key), node->text, width));
    return width;
  }
  return std::nullopt;
}

std::optional<double> read_standard_uncertainty(Table& table, const Form& form, Context& context) {
  const auto u = read_width(table, "u", form, context), expanded = read_width(table, "U", form, context);
  const auto k = table.positive("k");
  const bool has_u = table.has("u"), has_expanded = table.has("U"), has_k = table.has("k");
  if (has_u && has_expanded) {
    table.refuse("both u and U are given", "both state the uncertainty", "leave one out");
    return std::nullopt;
  }
  if (has_expanded && !has_k) {
    table.refuse_key("U", "the coverage factor is missing", "an expanded uncertainty is meaningless without k",
                     "k = 2");
    return std::nullopt;
  }
  if (!has_expanded && has_k) {
    table.refuse_key("k", "k belongs to an expanded uncertainty U", "", "write U instead of u");
    return std::nullopt;
  }
  const auto given = has_u ? u : expanded;
  const std::string key = has_u ? "u" : "U";
  if (given && *given <= 0) {
    table.refuse_key(key, "must be above 0", "", *given == 0 ? "leave it out for an exact value" : "");
    return std::nullopt;
  }
  if (!given || (has_expanded && !k)) return std::nullopt;
  return has_u ? *u : *expanded / *k;
}

std::optional<Located> read_family(Table& table, const FamilyCard& card, const Form& form, Context& context) {
  return FamilyReader(table, card, form, context).read();
}

} // namespace gumshoe::scenario
