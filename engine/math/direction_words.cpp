#include "math/direction_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe::least_squares {
namespace {

/// A part of the direction smaller than this is left out of the words.
constexpr double dominant = 0.01;

std::vector<std::size_t> order(const Direction& direction) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < direction.share.size(); ++j)
    if (std::fabs(direction.share[j]) > dominant) out.push_back(j);
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) {
    return std::fabs(direction.share[a]) > std::fabs(direction.share[b]) * (1 + 1e-6);
  });
  return out;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return out;
}

} // namespace

std::vector<std::string> members(const Direction& direction, const std::vector<Parameter>& parameters) {
  std::vector<std::string> out;
  for (const std::size_t j : order(direction)) out.push_back(parameters[j].name);
  return out;
}

std::string in_words(const Direction& direction, const std::vector<Parameter>& parameters) {
  const auto who = order(direction);
  const Parameter& first = parameters[who.front()];
  if (who.size() == 1) return "the indications do not depend on " + first.name;
  std::vector<std::string> others, changes;
  // One unit of the first, and what the others do about it.
  const double one = units::to_si(1, first.unit, first.si_unit, units::Kind::difference) / direction.change[who[0]];
  for (const std::size_t j : who) {
    const Parameter& u = parameters[j];
    const double change = units::from_si(direction.change[j] * one, u.unit, u.si_unit, units::Kind::difference);
    changes.push_back(fmt::format("{} {:+.4g}{}", u.name, change, units::suffix(u.unit)));
    if (j != who[0]) others.push_back(u.name);
  }
  return fmt::format("{} is indistinguishable from {}{} ({} leave every indication unchanged)", first.name,
                     joined(others), others.size() > 1 ? " together" : "", joined(changes));
}

} // namespace gumshoe::least_squares
