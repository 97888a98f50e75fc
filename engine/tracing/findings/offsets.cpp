#include "tracing/findings/offsets.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracing/findings/sizes.h"

namespace gumshoe::tracing {

std::vector<std::string> fitted_by_label(const Trace& t) {
  struct Values {
    const calibration::Unknown* unknown = nullptr;
    std::vector<std::string> labels;
    std::vector<double> all;
  };
  std::map<std::size_t, Values> by_quantity;
  for (std::size_t i = 0; i < t.taken.size() && i < t.estimate.parameters.size(); ++i) {
    if (!t.taken[i].block_offset || t.taken[i].labels.empty()) continue;
    Values& v = by_quantity[t.estimate.parameters[i].unknown.quantity];
    v.unknown = &t.estimate.parameters[i].unknown;
    v.labels.clear();
    for (const auto& [label, value] : t.taken[i].labels) v.labels.push_back(label);
    v.all.push_back(t.estimate.parameters[i].value);
  }
  std::vector<std::string> out;
  for (const auto& [quantity, v] : by_quantity) {
    if (v.all.size() < 2) continue;
    const auto [low, high] = std::ranges::minmax(v.all);
    const std::string label = fmt::format("{}", fmt::join(v.labels, " and "));
    out.push_back(fmt::format("{} is fitted for each {} by itself, and its values differ by up to {}: what differs so "
                              "from one {} to the next is not judged",
                              t.extended.quantities[quantity].name, label,
                              shown_size(high - low, v.unknown->unit, v.unknown->si_unit), label));
  }
  return out;
}

} // namespace gumshoe::tracing
