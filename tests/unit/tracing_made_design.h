#pragma once
/// A design of 48 readings that is made up, to look for shapes in.
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "tracing/candidates/candidates.h"

namespace tracing_design {

using namespace gumshoe;
using namespace gumshoe::tracing;

inline constexpr std::size_t count = 48;

inline Covariate covariate(const std::string& name, const std::string& si, std::vector<double> value) {
  const std::set<double> levels(value.begin(), value.end());
  return {name, si, si, std::move(value), {levels.begin(), levels.end()}, si == "rad"};
}

/// Feed up and down, an angle all round, load on two levels, time; order reversed, to tell sequence and rows apart.
inline Observations made() {
  Observations o;
  o.readings = count;
  o.indications = 1;
  o.names = {"z"};
  std::vector<double> feed, angle, load, time;
  Grouping setup{"setup", {"setup"}, {}, {"setup 1", "setup 2", "setup 3"}, {{"1"}, {"2"}, {"3"}}};
  for (std::size_t r = 0; r < count; ++r) {
    o.sequence.push_back(count - 1 - r);
    const auto i = static_cast<double>(r);
    feed.push_back(1 + std::fmod(3 * i, 8));
    angle.push_back(2 * std::numbers::pi * std::fmod(5 * i, 48) / 48);
    load.push_back(static_cast<int>(i * i) % 7 < 3 ? 10 : 20);
    time.push_back(100 - i);
    setup.group.push_back(r % 3);
  }
  o.covariates = {covariate("feed", "m/s", feed), covariate("angle", "rad", angle), covariate("load", "N", load),
                  covariate("time", "s", time)};
  o.covariates.back().course = true;
  o.labels = {setup};
  return o;
}

inline const Candidate& named(const std::vector<Candidate>& all, const std::string& name,
                              const std::string& shape = "") {
  for (const Candidate& a : all)
    if (a.name == name && (shape.empty() || a.shape == shape)) return a;
  throw InputError("no shape " + name);
}

} // namespace tracing_design
