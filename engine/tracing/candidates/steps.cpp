#include "tracing/candidates/steps.h"

#include <algorithm>
#include <iterator>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Places of the fitted readings in the sequence, of all or of one part.
std::vector<Index> fitted_places(const Observations& o, const std::vector<Index>& rows, const Members& part) {
  std::vector<Index> out;
  for (const Index row : rows)
    if (const Index place = row / index(o.indications);
        part.holds(o.sequence[index(place)]) && (out.empty() || out.back() != place))
      out.push_back(place);
  return out;
}

} // namespace

Steps::Steps(const Observations& o, std::size_t indication) : o_(o), indication_(index(indication)) {}

Steps::Steps(const Observations& o, std::size_t indication, Vector time)
    : o_(o), indication_(index(indication)), time_(std::move(time)) {}

Matrix Steps::columns(std::span<const Stretch> stretches) const {
  const Index n = index(o_.readings), k = index(o_.indications);
  Matrix out = Matrix::Zero(n * k, index(stretches.size()));
  for (Index j = 0; j < out.cols(); ++j) {
    const auto& [from, part, until] = stretches[static_cast<std::size_t>(j)];
    const double begun = time_.size() > 0 ? time_[place_before(o_, from, part)] : 0;
    for (Index r = from; r < std::min(n, until); ++r)
      if (part.holds(o_.sequence[index(r)])) out(r * k + indication_, j) = time_.size() > 0 ? time_[r] - begun : 1;
  }
  return out;
}

Stretch Steps::best(const std::vector<Stretch>& places, const Gain& gain) const {
  Stretch found = places.front();
  double height = -1;
  for (std::size_t i = 0; i < places.size(); i += at_once) {
    const auto some = std::span(places).subspan(i, std::min<std::size_t>(at_once, places.size() - i));
    Index highest = 0;
    const double here = gain(columns(some), 1, criteria.absorbed_share).maxCoeff(&highest);
    if (here > height) height = here, found = some[static_cast<std::size_t>(highest)];
  }
  return found;
}

std::vector<Stretch> steps(const Observations& o, const std::vector<Index>& rows, const Members& part) {
  const std::vector<Index> fitted = fitted_places(o, rows, part);
  const std::size_t few = part.label ? criteria.least_repeats : static_cast<std::size_t>(criteria.few_readings) + 1;
  std::vector<Stretch> out;
  for (std::size_t i = few; i + few <= fitted.size(); ++i) out.push_back({fitted[i], part});
  return out;
}

std::vector<Stretch> steps_of_parts(const Observations& o, const std::vector<Index>& rows, const Grouping& label) {
  std::vector<Stretch> out;
  for (std::size_t g = 0; g < label.groups.size(); ++g)
    std::ranges::copy(steps(o, rows, {&label, g}), std::back_inserter(out));
  return out;
}

std::vector<Stretch> at_beginnings_of_blocks(const Observations& o, const std::vector<Stretch>& places) {
  std::vector<Stretch> out;
  for (const Stretch& at : places)
    if (!o.blocks.group.empty() &&
        o.blocks.group[o.sequence[index(at.from)]] != o.blocks.group[o.sequence[index(at.from - 1)]])
      out.push_back(at);
  return out;
}

Whiles::Whiles(const Observations& o, const std::vector<Index>& rows, const Grouping* label) {
  const bool blocks = !o.blocks.group.empty();
  for (std::size_t g = 0; g < (label ? label->groups.size() : 1); ++g) {
    ends_.push_back({{label, g}, !label && blocks ? 2u : 1u, {}});
    const std::vector<Index> places = fitted_places(o, rows, ends_.back().part);
    const auto block = [&](std::size_t i) { return o.blocks.group[o.sequence[index(places[i])]]; };
    for (std::size_t i = 1; i < places.size(); ++i)
      if (!blocks || block(i) != block(i - 1)) ends_.back().at.push_back({i, places[i]});
  }
}

std::size_t Whiles::number() const {
  std::size_t out = 0;
  for (const Ends& e : ends_)
    for (std::size_t i = 0; i < e.at.size(); ++i)
      for (std::size_t j = i + 1; j < e.at.size(); ++j) out += e.is_one(i, j);
  return out;
}

std::optional<Stretch> Whiles::best(const Steps& steps, const Gain& gain) const {
  std::vector<Stretch> grid;
  for (const Ends& e : ends_)
    for (std::size_t i = 0; i < e.at.size(); i += e.stride())
      for (std::size_t j = i + e.stride(); j < e.at.size(); j += e.stride())
        if (e.is_one(i, j)) grid.push_back(e.between(i, j));
  if (grid.empty()) return std::nullopt;
  Stretch found = steps.best(grid, gain);
  const Ends& own = ends_[found.part.group];
  for (int pass = 0; own.stride() > 1 && pass < 2; ++pass) {
    found = steps.best(own.near(found, own.stride(), 0), gain);
    found = steps.best(own.near(found, 0, own.stride()), gain);
  }
  return found;
}

std::size_t Whiles::Ends::stride() const {
  return std::max<std::size_t>(1, (at.size() + criteria.most_ends - 1) / criteria.most_ends);
}

bool Whiles::Ends::is_one(std::size_t i, std::size_t j) const {
  return j >= i + least && at[j].before - at[i].before >= criteria.least_repeats;
}

std::vector<Stretch> Whiles::Ends::near(const Stretch& one, std::size_t from, std::size_t until) const {
  const auto around = [&](Index place, std::size_t reach) {
    const auto i = static_cast<std::size_t>(std::ranges::find(at, place, &End::place) - at.begin());
    return std::pair(i - std::min(i, reach), std::min(i + reach, at.size() - 1));
  };
  const auto [first, last] = around(one.from, from);
  const auto [least_end, last_end] = around(one.until, until);
  std::vector<Stretch> out;
  for (std::size_t i = first; i <= last; ++i)
    for (std::size_t j = std::max(least_end, i + 1); j <= last_end; ++j)
      if (is_one(i, j)) out.push_back(between(i, j));
  return out;
}

Index place_before(const Observations& o, Index place, const Members& part) {
  do --place;
  while (!part.holds(o.sequence[index(place)]));
  return place;
}

std::size_t last_before(const Observations& o, Index place, const Members& part) {
  return o.sequence[index(place_before(o, place, part))] + 1;
}

} // namespace gumshoe::tracing
