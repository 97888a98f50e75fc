/// The catalogue of families: names, parameters, sources, and what makes parameters invalid.
#include <cmath>

#include <fmt/format.h>

#include "quantities/distribution.h"

namespace gumshoe::quantities {
namespace {

using enum ParameterCard::Dimension;

constexpr ParameterCard constant_parameters[] = {{"value", point, "the value"}};
constexpr ParameterCard limits[] = {{"low", point, "lower limit"}, {"high", point, "upper limit"}};
constexpr ParameterCard curvilinear_parameters[] = {{"low", point, "middle of the inexact lower limit"},
                                                    {"high", point, "middle of the inexact upper limit"},
                                                    {"inexactness", difference, "half-width of each limit's range"}};
constexpr ParameterCard trapezoid_parameters[] = {{"low", point, "lower limit"},
                                                  {"high", point, "upper limit"},
                                                  {"top_ratio", number, "width of the top over that of the base"}};
constexpr ParameterCard normal_parameters[] = {{"mean", point, "expectation"},
                                               {"u", difference, "standard uncertainty"}};
constexpr ParameterCard t_parameters[] = {
    {"mean", point, "centre"}, {"u", difference, "scale, s / sqrt(n)"}, {"degrees_of_freedom", number, "n - 1"}};
constexpr ParameterCard exponential_parameters[] = {{"mean", difference, "expectation; values start at 0"}};
constexpr ParameterCard gamma_parameters[] = {{"shape", number, "shape; q + 1 after q counts"},
                                              {"scale", difference, "scale; expectation over shape"}};
constexpr ParameterCard lognormal_parameters[] = {{"mu", log, "expectation of ln x"},
                                                  {"sigma", number, "standard deviation of ln x"}};
constexpr ParameterCard truncated_parameters[] = {{"mean", point, "expectation of the parent"},
                                                  {"u", difference, "standard deviation of the parent"},
                                                  {"low", point, "lower limit"},
                                                  {"high", point, "upper limit"}};

constexpr FamilyCard cards[] = {
    {Family::constant, "constant", "a value without uncertainty", constant_parameters},
    {Family::rectangular, "rectangular", "JCGM 101:2008, 6.4.2", limits},
    {Family::curvilinear_trapezoid, "curvilinear_trapezoid", "JCGM 101:2008, 6.4.3", curvilinear_parameters},
    {Family::trapezoid, "trapezoid", "JCGM 101:2008, 6.4.4", trapezoid_parameters},
    {Family::triangular, "triangular", "JCGM 101:2008, 6.4.5", limits},
    {Family::arcsine, "arcsine", "JCGM 101:2008, 6.4.6", limits},
    {Family::normal, "normal", "JCGM 101:2008, 6.4.7", normal_parameters},
    {Family::t, "t", "JCGM 101:2008, 6.4.9", t_parameters},
    {Family::exponential, "exponential", "JCGM 101:2008, 6.4.10", exponential_parameters},
    {Family::gamma, "gamma", "JCGM 101:2008, 6.4.11", gamma_parameters},
    {Family::lognormal, "lognormal", "ln x is normal", lognormal_parameters},
    {Family::truncated_normal, "truncated_normal", "normal, given that it lies between limits", truncated_parameters},
    {Family::discrete, "discrete", "stated values with stated probabilities", {}},
    {Family::empirical, "empirical", "stated values, equally probable", {}},
};

std::string invalid_values(const Distribution& d) {
  if (!d.values || d.values->empty()) return "needs at least one value";
  for (std::size_t i = 0; i < d.values->size(); ++i) {
    if (!std::isfinite((*d.values)[i])) return "values must be finite";
    if (i > 0 && (*d.values)[i] < (*d.values)[i - 1]) return "values must be sorted";
  }
  if (d.family == Family::empirical) return {};
  if (!d.probabilities || d.probabilities->size() != d.values->size()) return "needs one probability per value";
  double sum = 0;
  for (const double p : *d.probabilities) {
    if (!(p >= 0 && p <= 1)) return "probabilities must lie between 0 and 1";
    sum += p;
  }
  return std::abs(sum - 1) <= 1e-9 ? std::string{} : "probabilities must add up to 1";
}

std::string invalid_numbers(const Distribution& d) {
  const auto& p = d.parameters;
  switch (d.family) {
  case Family::rectangular:
  case Family::triangular:
  case Family::arcsine:
    return p[0] < p[1] ? "" : "low must be below high";
  case Family::curvilinear_trapezoid:
    if (!(p[0] < p[1])) return "low must be below high";
    if (!(p[2] > 0)) return "inexactness must be positive";
    return p[2] <= (p[1] - p[0]) / 2 ? "" : "inexactness must not exceed half the distance between the limits";
  case Family::trapezoid:
    if (!(p[0] < p[1])) return "low must be below high";
    return p[2] >= 0 && p[2] <= 1 ? "" : "top_ratio must lie between 0 and 1";
  case Family::normal:
    return p[1] > 0 ? "" : "u must be positive";
  case Family::t:
    if (!(p[1] > 0)) return "u must be positive";
    return p[2] >= least_degrees_of_freedom
               ? ""
               : fmt::format("degrees_of_freedom must be at least {}", least_degrees_of_freedom);
  case Family::exponential:
    return p[0] > 0 ? "" : "mean must be positive";
  case Family::gamma:
    if (!(p[0] > 0)) return "shape must be positive";
    if (!(p[0] <= largest_gamma_shape))
      return fmt::format("shape must be at most {:g}; a larger one makes the distribution normal", largest_gamma_shape);
    return p[1] > 0 ? "" : "scale must be positive";
  case Family::lognormal:
    return p[1] > 0 ? "" : "sigma must be positive";
  case Family::truncated_normal: {
    if (!(p[1] > 0)) return "u must be positive";
    if (!(p[2] < p[3])) return "low must be below high";
    const double nearest = p[2] > p[0] ? p[2] - p[0] : p[3] < p[0] ? p[0] - p[3] : 0;
    return nearest <= 37 * p[1] ? ""
                                : "both limits lie more than 37 u from the mean, where the probability of a normal "
                                  "distribution is negligible";
  }
  default:
    return {};
  }
}

} // namespace

std::span<const FamilyCard> families() { return cards; }

const FamilyCard* find_family(std::string_view name) {
  for (const FamilyCard& card : cards)
    if (card.name == name) return &card;
  return nullptr;
}

std::string invalid_parameters(const Distribution& d) {
  if (d.family == Family::discrete || d.family == Family::empirical) return invalid_values(d);
  const FamilyCard* card = nullptr;
  for (const FamilyCard& candidate : cards)
    if (candidate.family == d.family) card = &candidate;
  if (!card) return "unknown family";
  for (std::size_t i = 0; i < card->parameters.size(); ++i) {
    // One-sided truncation is a normal use.
    const bool may_be_infinite = d.family == Family::truncated_normal && i >= 2;
    if (std::isnan(d.parameters[i]) || (std::isinf(d.parameters[i]) && !may_be_infinite))
      return std::string(card->parameters[i].key) + " must be a finite number";
  }
  return invalid_numbers(d);
}

} // namespace gumshoe::quantities
