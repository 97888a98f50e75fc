#include "tracing/noise/observations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "calibration/data.h"
#include "quantities/cells.h"
#include "scenario/document.h"
#include "scenario/stretches.h"
#include "tracing/criteria.h"
#include "tracing/noise/step.h"

namespace gumshoe::tracing {
namespace {

using scenario::Scenario;

/// Groups are numbered as they are met in the order of measurement.
Grouping grouping(const Scenario& s, const std::vector<std::size_t>& sequence, const std::vector<std::string>& labels) {
  Grouping out;
  out.group.resize(s.readings.size());
  out.labels = labels;
  out.name = fmt::format("{}", fmt::join(labels, ","));
  std::map<std::vector<std::string>, std::size_t> known;
  for (const std::size_t r : sequence) {
    std::vector<std::string> values;
    std::string name;
    for (const std::string& label : labels) {
      const std::string* value = quantities::label_value(s.readings[r].labels, label);
      values.push_back(value ? *value : "");
      name +=
          (name.empty() ? "" : ", ") + (values.back().starts_with(label) ? values.back() : label + " " + values.back());
    }
    const auto [it, fresh] = known.insert({values, out.groups.size()});
    if (fresh) {
      out.groups.push_back(name);
      out.values.push_back(values);
    }
    out.group[r] = it->second;
  }
  return out;
}

std::vector<std::string> label_names(const Scenario& s) {
  std::vector<std::string> out;
  for (const auto& [label, value] : s.readings.front().labels) out.push_back(label);
  return out;
}

/// Whether the blocks are stretches of the data, cut by their number or length.
bool blocks_are_stretches(const Scenario& s) {
  if (s.trace.blocks != scenario::stretch_label) return false;
  const scenario::Node document = scenario::parse_document(s.text, s.file);
  return scenario::has_stretches(scenario::find_member(document, "trace"));
}

/// Labels by which readings may differ, or scatter. A slice of time is no cause: what changes from one to the next
/// changes with time, or resembles what was before.
std::vector<std::string> causes(const Scenario& s) {
  auto out = label_names(s);
  if (blocks_are_stretches(s)) std::erase(out, scenario::stretch_label);
  return out;
}

void add_covariate(Observations& o, const std::string& name, const std::string& unit, const std::string& si,
                   const std::vector<double>& value, bool commanded = false) {
  const std::set<double> levels(value.begin(), value.end());
  if (levels.size() < 2) return;
  o.covariates.push_back({name, unit, si, value, {levels.begin(), levels.end()}, si == "rad", commanded});
}

/// Readings in the order of measurement; ties, and data without an order, by what they are and not by where they stand.
std::vector<std::size_t> sequence_of(const Scenario& s) {
  std::vector<std::size_t> out(s.readings.size());
  std::iota(out.begin(), out.end(), 0);
  if (s.trace.order.empty()) return out;
  std::ranges::sort(out, [&](std::size_t a, std::size_t b) {
    const auto& x = s.readings[a];
    const auto& y = s.readings[b];
    return std::tie(s.trace.order[a], x.labels, x.conditions, x.indications) <
           std::tie(s.trace.order[b], y.labels, y.conditions, y.indications);
  });
  return out;
}

ReadoutScatter scatter_of_readouts(const Scenario& s, std::size_t indications) {
  ReadoutScatter out{std::vector<double>(indications, 0), 0};
  for (const auto& r : s.readings) {
    if (r.scatter.size() != indications) continue;
    out.freedom += r.repeats - 1;
    for (std::size_t i = 0; i < indications; ++i) out.s[i] += r.scatter[i];
  }
  for (double& one : out.s) one = out.freedom > 0 ? std::sqrt(one / out.freedom) : 0;
  return out;
}

/// A label that only names the conditions of a reading stands for no repeated set-up step.
bool says_conditions(const Scenario& s, const Grouping& g) {
  std::map<std::vector<double>, std::set<std::size_t>> groups;
  std::set<std::vector<double>> all;
  for (std::size_t r = 0; r < s.readings.size(); ++r) {
    groups[s.readings[r].conditions].insert(g.group[r]);
    all.insert(s.readings[r].conditions);
  }
  if (all.size() == s.readings.size()) return false; // every reading differs, by its time say
  return std::ranges::all_of(groups, [](const auto& c) { return c.second.size() == 1; });
}

/// Whether groups come back: each in two blocks at least, and in half of them, on average.
bool come_back(const Grouping& g, const Grouping& blocks) {
  std::set<std::pair<std::size_t, std::size_t>> met;
  for (std::size_t r = 0; r < g.group.size(); ++r) met.insert({g.group[r], blocks.group[r]});
  return met.size() >= criteria.least_repeats * g.groups.size() &&
         2 * met.size() >= g.groups.size() * blocks.groups.size();
}

void find_label_pairs(const Scenario& s, Observations& o) {
  if (s.trace.blocks.empty()) return;
  const Grouping blocks = grouping(s, o.sequence, {s.trace.blocks});
  const auto done_anew = [&](const Grouping& label) {
    return s.trace.redone && std::ranges::any_of(*s.trace.redone, [&](const std::vector<std::string>& set) {
             return std::ranges::find(set, label.name) != set.end();
           });
  };
  for (std::size_t i = 0; i < o.labels.size(); ++i)
    for (std::size_t j = i + 1; j < o.labels.size(); ++j) {
      if (done_anew(o.labels[i]) || done_anew(o.labels[j])) continue;
      Grouping g = grouping(s, o.sequence, {o.labels[i].name, o.labels[j].name});
      const bool crossed = g.groups.size() > std::max(o.labels[i].groups.size(), o.labels[j].groups.size());
      if (crossed && come_back(g, blocks)) o.label_pairs.push_back(std::move(g));
    }
}

void find_replicate_groups(const Scenario& s, Observations& o) {
  auto sets = s.trace.redone.value_or(std::vector<std::vector<std::string>>{});
  if (!s.trace.redone) {
    const auto names = causes(s);
    // Not all are tried: one that numbers what was done anew goes before two that number it together.
    for (const std::string& name : names) sets.push_back({name});
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t j = i + 1; j < names.size(); ++j) sets.push_back({names[i], names[j]});
    // What comes back from block to block is no scatter but a correction. What a label, or two, have of each block alone
    // does not come back: a set-up that is numbered and done anew.
    if (!s.trace.blocks.empty()) {
      const Grouping blocks = grouping(s, o.sequence, {s.trace.blocks});
      for (const Grouping& label : o.labels)
        if (label.name != s.trace.blocks && come_back(label, blocks))
          std::erase(sets, std::vector<std::string>{label.name});
    }
    for (const Grouping& pair : o.label_pairs) {
      std::erase(sets, pair.labels);
      if (!blocks_are_stretches(s)) sets.push_back({pair.labels[0], pair.labels[1], s.trace.blocks});
    }
  }
  const std::size_t least = s.trace.redone ? criteria.stated_replicates : criteria.found_replicates;
  for (const auto& set : sets) {
    Grouping g = grouping(s, o.sequence, set);
    if (g.groups.size() < least) {
      if (s.trace.redone)
        o.statements.push_back(
            fmt::format("{} was repeated only {} times; at least {} are needed to judge whether it scatters", g.name,
                        g.groups.size(), least));
      continue;
    }
    if (!s.trace.redone && says_conditions(s, g)) continue;
    // One reading each: it cannot be distinguished from the noise of a reading.
    if (g.groups.size() * 5 > s.readings.size() * criteria.most_groups_of_five) continue;
    const bool known = std::ranges::any_of(o.replicate_groups, [&](const Grouping& h) { return h.group == g.group; });
    const std::size_t more = !s.trace.redone && set.size() > 2 ? 1 : 0; // in place of a pair
    if (!known && o.replicate_groups.size() < criteria.most_replicate_groups + more)
      o.replicate_groups.push_back(std::move(g));
  }
}

void find_blocks(const Scenario& s, Observations& o) {
  o.held_out.assign(o.readings, false);
  if (s.trace.blocks.empty()) {
    o.statements.push_back("[trace] blocks names no label; therefore no readings are held out, and findings are "
                           "not confirmed on data that the search has not used");
    return;
  }
  o.blocks = grouping(s, o.sequence, {s.trace.blocks});
  const std::size_t count = o.blocks.groups.size();
  const auto value_of = [&](std::size_t group) {
    for (std::size_t r = 0; r < o.readings; ++r)
      if (o.blocks.group[r] == group) return *quantities::label_value(s.readings[r].labels, s.trace.blocks);
    return std::string();
  };
  if (count == 1) {
    o.statements.push_back(
        fmt::format("all readings are of one block ({}); nothing can be held out, and these data do not show "
                    "whether an effect recurs in another {}",
                    o.blocks.groups[0], s.trace.blocks));
    return;
  }
  std::vector<std::string> chosen = s.trace.final_blocks;
  if (chosen.empty() && count >= criteria.blocks_for_holdout) {
    // The last part in the order of measurement.
    std::vector<std::size_t> met;
    for (const std::size_t r : o.sequence)
      if (std::ranges::find(met, o.blocks.group[r]) == met.end()) met.push_back(o.blocks.group[r]);
    for (std::size_t i = count - std::max<std::size_t>(1, count / criteria.holdout_part); i < count; ++i)
      chosen.push_back(value_of(met[i]));
  }
  if (chosen.empty() || chosen.size() + criteria.least_training_blocks > count) {
    o.statements.push_back(
        fmt::format("{} blocks are too few to hold some out; each is left out in turn instead, and the "
                    "figures are from data that the search has partly used",
                    count));
    return;
  }
  for (std::size_t r = 0; r < o.readings; ++r)
    o.held_out[r] = std::ranges::find(chosen, value_of(o.blocks.group[r])) != chosen.end();
  o.holdout_blocks = chosen;
}

/// A commanded condition of which each reading has a value of its own, beyond that of the one before: the number of a
/// reading would only stand for what was set. Null: none.
const Covariate* set_in_order(const Observations& o) {
  for (const Covariate& c : o.covariates) {
    if (!c.commanded || c.levels.size() < o.readings) continue;
    std::vector<double> met;
    for (const std::size_t r : o.sequence) met.push_back(c.value[r]);
    if (std::ranges::is_sorted(met) || std::ranges::is_sorted(met, std::ranges::greater{})) return &c;
  }
  return nullptr;
}

/// Whether a course goes back in the order of measurement, to values that it had before.
bool begins_anew(const Observations& o, const Covariate& c) {
  const auto earlier = [&](std::size_t later, std::size_t before) { return c.value[later] < c.value[before]; };
  return c.levels.size() * criteria.least_repeats <= o.readings &&
         std::ranges::adjacent_find(o.sequence, [&](std::size_t a, std::size_t b) { return earlier(b, a); }) !=
             o.sequence.end();
}

} // namespace

bool counts_readings(const Covariate& c) {
  if (!c.course || c.unit != "1" || c.levels.size() != c.value.size()) return false;
  const double first = c.levels.front();
  for (std::size_t i = 0; i < c.levels.size(); ++i)
    if (c.levels[i] != first + static_cast<double>(i)) return false;
  return first == 0 || first == 1;
}

std::vector<std::size_t> neighbours(const Covariate& c, std::size_t most) {
  const std::size_t levels = c.levels.size(), groups = std::min(levels, most);
  std::vector<std::size_t> out;
  for (const double x : c.value)
    out.push_back(index(std::ranges::lower_bound(c.levels, x) - c.levels.begin()) * groups / levels);
  return out;
}

Matrix in_sequence(const Observations& o, const Matrix& rows) {
  Matrix out(rows.rows(), rows.cols());
  const auto k = index(o.indications);
  for (std::size_t i = 0; i < o.sequence.size(); ++i)
    out.middleRows(index(i) * k, k) = rows.middleRows(index(o.sequence[i]) * k, k);
  return out;
}

Observations observe(const propagation::Experiment& e) {
  const Scenario& s = e.scenario();
  const ModelCard& card = *e.model().card;
  Observations o;
  o.readings = s.readings.size();
  o.indications = card.indications.size();
  for (const auto& i : card.indications) {
    o.names.emplace_back(i.name);
    o.one_kind = o.one_kind && i.si_unit == card.indications[0].si_unit;
  }
  for (const auto& r : s.readings) {
    if (r.indications.size() != o.indications)
      calibration::refuse(s.file, "there are no readings to trace", "no indication has readings",
                          "add [indications.NAME] with readings, or use --data");
    o.measured.insert(o.measured.end(), r.indications.begin(), r.indications.end());
  }
  // Means of n readouts come in steps of the display over n; of too many different n, in none that can be told.
  constexpr long most = 1000;
  long together = 1;
  for (const auto& r : s.readings) {
    o.readouts.push_back(r.repeats);
    together = together > most ? 0 : std::lcm(together, static_cast<long>(r.repeats));
  }
  std::vector<double> one(o.readings);
  for (std::size_t i = 0; i < o.indications; ++i) {
    for (std::size_t r = 0; r < o.readings; ++r) one[r] = s.readings[r].indications[i];
    o.step.push_back(recorded_step(one, together, s.quantities[e.layout().indications[i]].display_alone));
  }
  o.of_readouts = scatter_of_readouts(s, o.indications);
  o.sequence = sequence_of(s);
  for (std::size_t r = 0; r < o.readings; ++r)
    o.order.push_back(s.trace.order.empty() ? static_cast<double>(r + 1) : s.trace.order[r]);
  for (std::size_t c = 0; c < card.conditions.size(); ++c) {
    for (std::size_t r = 0; r < o.readings; ++r) one[r] = s.readings[r].conditions[c];
    add_covariate(o, std::string(card.conditions[c].name), std::string(card.conditions[c].unit),
                  std::string(card.conditions[c].si_unit), one, true);
  }
  for (const auto& c : s.trace.columns) add_covariate(o, c.name, c.unit, c.si_unit, c.values);
  for (Covariate& c : o.covariates) {
    c.course = c.name == s.trace.order_name || c.name == "time";
    c.comes_back = c.course && begins_anew(o, c);
  }
  o.order_known = s.trace.order_known;
  if (!o.order_known)
    o.statements.push_back(
        "the order of measurement is not known: readings are taken to be independent, and nothing is "
        "sought that changes from one to the next");
  const bool timed = std::ranges::any_of(o.covariates, [](const Covariate& c) { return c.course && !c.comes_back; });
  if (const Covariate* set = timed || !o.order_known ? nullptr : set_in_order(o))
    o.statements.push_back(fmt::format("{} was set in the order of measurement, each value once; what depends on the "
                                       "order cannot be distinguished from what depends on {}",
                                       set->name, set->name));
  else if (!timed && o.order_known && o.readings > 2) {
    std::vector<double> rank(o.readings);
    for (std::size_t i = 0; i < o.readings; ++i) rank[o.sequence[i]] = static_cast<double>(i + 1);
    add_covariate(o, "order", "1", "1", rank);
    o.covariates.back().course = true;
  }
  for (const std::string& label : causes(s)) {
    Grouping g = grouping(s, o.sequence, {label});
    if (g.groups.size() >= 2 && g.groups.size() < o.readings) o.labels.push_back(std::move(g));
  }
  find_label_pairs(s, o);
  find_replicate_groups(s, o);
  find_blocks(s, o);
  return o;
}

} // namespace gumshoe::tracing
