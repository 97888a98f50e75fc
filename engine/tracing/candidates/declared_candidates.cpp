#include <algorithm>
#include <cmath>
#include <set>

#include "quantities/cells.h"
#include "tracing/candidates/candidate_families.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

using quantities::InputQuantity;
using Cell = std::vector<std::pair<std::string, std::string>>;

/// Sets of labels by which a quantity may be wrong: all readings, then those that its entries and scopes distinguish.
std::vector<std::vector<std::string>> label_sets(const InputQuantity& q) {
  std::set<std::vector<std::string>> out;
  const auto add = [&](std::vector<std::string> labels) {
    std::erase(labels, quantities::reading_label);
    if (labels.empty()) return;
    std::ranges::sort(labels);
    for (const std::string& l : labels) out.insert({l});
    out.insert(labels);
  };
  for (const auto& entry : q.entries) {
    std::vector<std::string> names;
    for (const auto& [label, value] : entry.labels) names.push_back(label);
    add(names);
    for (const auto& c : entry.components) {
      auto all = names;
      all.insert(all.end(), c.per.begin(), c.per.end());
      add(all);
    }
  }
  std::vector<std::vector<std::string>> sets{{}};
  sets.insert(sets.end(), out.begin(), out.end());
  return sets;
}

/// The values that readings have of these labels, together.
std::set<Cell> cells_of(const scenario::Scenario& s, const std::vector<std::string>& labels) {
  std::set<Cell> out;
  for (const auto& reading : s.readings) {
    Cell cell;
    for (const std::string& l : labels)
      if (const std::string* v = quantities::label_value(reading.labels, l)) cell.emplace_back(l, *v);
    if (cell.size() == labels.size()) out.insert(cell);
  }
  return out;
}

double declared_uncertainty(const InputQuantity& q, const quantities::Labels& labels) {
  double variance = 0;
  for (const auto& entry : q.entries)
    if (quantities::holds_for(entry.labels, labels))
      for (const auto& c : entry.components) variance += std::pow(c.distribution.standard_uncertainty(), 2);
  return std::sqrt(variance);
}

void add_cell(const CandidateMaker& make, std::size_t q, const Cell& cell, std::vector<Candidate>& found) {
  const auto& s = make.experiment.scenario();
  const QuantityCard& card = make.experiment.model().card->quantities[q];
  std::vector<bool> mask;
  double low = 1e300, high = -1e300;
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    mask.push_back(quantities::holds_for(cell, s.readings[r].labels));
    if (!mask.back()) continue;
    low = std::min(low, make.at[r][q]);
    high = std::max(high, make.at[r][q]);
  }
  Candidate one;
  one.family = Family::declared;
  one.name = "declared:" + s.quantities[q].name + (cell.empty() ? "" : "[" + quantities::text_of(cell) + "]");
  one.amplitudes = {make.amplitude(q, card)};
  one.amplitudes[0].labels = cell;
  const auto first = std::ranges::find(mask, true);
  if (first != mask.end())
    one.amplitudes[0].declared = declared_uncertainty(s.quantities[q], s.readings[index(first - mask.begin())].labels);
  one.amplitudes[0].low = card.limits.low - low; // of the shift
  one.amplitudes[0].high = card.limits.high - high;
  make.add_single(std::move(one), q, cell.empty() ? nullptr : &mask, found);
}

} // namespace

std::vector<Candidate> declared_candidates(const CandidateMaker& make) {
  const auto& s = make.experiment.scenario();
  std::vector<Candidate> out;
  for (std::size_t q = 0; q < make.experiment.layout().model.end; ++q) {
    const InputQuantity& quantity = s.quantities[q];
    if (quantity.estimated && quantity.entries.front().components.empty()) continue; // free: absorbs itself
    std::vector<Candidate> found;
    for (const auto& labels : label_sets(quantity)) {
      const std::set<Cell> cells = cells_of(s, labels);
      if (!labels.empty() && (cells.size() < 2 || cells.size() > criteria.most_cells)) continue;
      for (const Cell& cell : cells) add_cell(make, q, cell, found);
    }
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

} // namespace gumshoe::tracing
