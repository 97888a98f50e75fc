#include "quantities/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "quantities/cells.h"
#include "quantities/tying.h"

namespace gumshoe::quantities {
namespace {

class Planner {
public:
  Planner(std::span<const InputQuantity> quantities, std::span<const Reading> readings, std::uint64_t seed)
      : quantities_(quantities), readings_(readings), seed_(seed) {
    labels_.insert(reading_label);
    for (const Reading& reading : readings)
      for (const auto& [label, value] : reading.labels) labels_.insert(label);
  }

  SamplePlan plan() {
    check_scopes();
    plan_.gather.resize(readings_.size());
    for (std::size_t r = 0; r < readings_.size(); ++r)
      for (std::size_t q = 0; q < quantities_.size(); ++q) plan_.gather[r].push_back(column_of(q, r));
    if (!problems_.empty()) throw InputError(problems_);
    return std::move(plan_);
  }

private:
  void problem(std::string what, std::string why = {}, std::string remedy = {}) {
    for (const Problem& known : problems_)
      if (known.what == what) return;
    problems_.push_back({{}, std::move(what), std::move(why), std::move(remedy)});
  }

  void check_scopes() {
    const std::vector<std::string> known(labels_.begin(), labels_.end());
    for (const InputQuantity& quantity : quantities_)
      for (const Entry& entry : quantity.entries) {
        std::set<std::string> names;
        for (const Component& component : entry.components) {
          // Equal names would mean equal keys, and so the same random numbers.
          if (!names.insert(component.name).second)
            problem(fmt::format("{}: two components are named '{}'", quantity.name, component.name));
          for (const std::string& label : component.per)
            if (!labels_.contains(label) && !label_value(entry.labels, label)) {
              const std::string near = nearest(label, known);
              problem(fmt::format("{}: per = '{}' is not a label of the readings", quantity.name, label), "",
                      near.empty() ? fmt::format("use one of {}", fmt::join(known, ", ")) : fmt::format("did you mean '{}'?", near));
            }
        }
      }
    if (!problems_.empty()) throw InputError(problems_);
  }

  /// The entry that holds for a reading; with several, the one that asks for the most labels.
  std::size_t entry_of(std::size_t q, std::size_t r) {
    const auto& entries = quantities_[q].entries;
    const std::string number = std::to_string(r + 1);
    const auto numbered = [&](const Entry& e) {
      const std::string* of = label_value(e.labels, reading_label);
      return of && *of == number;
    };
    // Entries of single readings stand in their order.
    if (r < entries.size() && numbered(entries[r])) return r;
    for (std::size_t e = 0; e < entries.size(); ++e)
      if (numbered(entries[e])) return e;
    std::size_t best = entries.size();
    for (std::size_t e = 0; e < entries.size(); ++e)
      if (holds_for(entries[e].labels, readings_[r].labels) &&
          (best == entries.size() || entries[e].labels.size() > entries[best].labels.size()))
        best = e;
    return best;
  }

  std::size_t column_of(std::size_t q, std::size_t r) {
    const InputQuantity& quantity = quantities_[q];
    const std::size_t e = entry_of(q, r);
    if (e == quantity.entries.size()) {
      const std::string labels = text_of(readings_[r].labels);
      problem(fmt::format("{}: no value for {}", quantity.name, labels.empty() ? "readings without labels" : labels),
              fmt::format("reading {} needs one", r + 1), "give a value for this label, or one value for all");
      return 0;
    }
    const Entry& entry = quantity.entries[e];
    Column column{entry.value, {}, q};
    for (std::size_t c = 0; c < entry.components.size(); ++c) {
      const Component& component = entry.components[c];
      if (component.distribution.family == Family::constant) {
        column.value += component.distribution.parameters[0];
        continue;
      }
      try {
        const Labels cell = cell_of(entry.labels, component.per, readings_[r].labels, r, quantity.name);
        column.variates.push_back(variate_of(q, e, c, cell));
      } catch (const InputError& error) {
        for (const Problem& p : error.problems()) problem(p.what, p.why, p.remedy);
        return 0;
      }
    }
    const auto key = std::make_tuple(q, e, column.variates);
    if (const auto found = columns_.find(key); found != columns_.end()) return found->second;
    plan_.columns.push_back(std::move(column));
    return columns_[key] = plan_.columns.size() - 1;
  }

  std::size_t variate_of(std::size_t q, std::size_t e, std::size_t c, const Labels& cell) {
    const auto key = std::make_tuple(q, e, c, cell);
    if (const auto found = variates_.find(key); found != variates_.end()) return found->second;
    const InputQuantity& quantity = quantities_[q];
    const Component& component = quantity.entries[e].components[c];
    Variate variate;
    variate.name = quantity.name;
    if (!cell.empty()) variate.name += "[" + text_of(cell) + "]";
    if (quantity.entries[e].components.size() > 1) variate.name += ": " + component.name;
    variate.quantity = q;
    variate.entry = e;
    variate.component = c;
    variate.cell = cell;
    variate.key = stream_key(seed_, quantity.name, component.name, cell);
    variate.distribution = component.distribution;
    plan_.variates.push_back(std::move(variate));
    return variates_[key] = plan_.variates.size() - 1;
  }

  std::span<const InputQuantity> quantities_;
  std::span<const Reading> readings_;
  std::uint64_t seed_;
  std::set<std::string> labels_;
  SamplePlan plan_;
  std::map<std::tuple<std::size_t, std::size_t, std::vector<std::size_t>>, std::size_t> columns_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t, Labels>, std::size_t> variates_;
  std::vector<Problem> problems_;
};

/// What is known of several draws by one estimated standard deviation.
std::vector<CommonEstimate> common_estimates(std::span<const InputQuantity> quantities, const SamplePlan& plan,
                                             std::uint64_t seed) {
  std::vector<bool> tied(plan.variates.size(), false);
  for (const CopulaGroup& group : plan.copulas)
    for (const std::size_t v : group.variates) tied[v] = true;
  constexpr std::size_t of_all_entries = static_cast<std::size_t>(-1);
  std::map<std::tuple<std::size_t, std::size_t, std::string>, CommonEstimate> known; // by quantity, entry, component
  for (std::size_t v = 0; v < plan.variates.size(); ++v) {
    const Variate& one = plan.variates[v];
    const Component& c = quantities[one.quantity].entries[one.entry].components[one.component];
    if (tied[v] || !std::isfinite(c.degrees_of_freedom)) continue;
    auto [at, fresh] = known.try_emplace({one.quantity, c.common ? of_all_entries : one.entry, c.name});
    CommonEstimate& estimate = at->second;
    if (fresh) {
      const Labels of_entry = c.common ? Labels() : quantities[one.quantity].entries[one.entry].labels;
      estimate.degrees_of_freedom = c.degrees_of_freedom;
      estimate.jointly_t = c.degrees_of_freedom <= 2 * largest_gamma_shape;
      estimate.key = hash64("common estimate", stream_key(seed, quantities[one.quantity].name, c.name, of_entry));
    }
    estimate.jointly_t = estimate.jointly_t && one.distribution.family == Family::t;
    estimate.variates.push_back(v);
  }
  std::vector<CommonEstimate> out;
  for (auto& [of, estimate] : known)
    if (estimate.variates.size() > 1) out.push_back(std::move(estimate));
  return out;
}

} // namespace

double SamplePlan::estimate(std::size_t column) const {
  double sum = columns.at(column).value;
  for (const std::size_t v : columns[column].variates) sum += variates[v].distribution.mean();
  return sum;
}

double SamplePlan::value(std::size_t column, const double* drawn) const {
  double sum = columns.at(column).value;
  for (const std::size_t v : columns[column].variates) sum += drawn[v];
  return sum;
}

SamplePlan make_plan(std::span<const InputQuantity> quantities, std::span<const Correlation> correlations,
                     std::span<const Reading> readings, std::uint64_t seed) {
  SamplePlan plan = Planner(quantities, readings, seed).plan();
  std::vector<Problem> problems;
  for (const Correlation& correlation : correlations) {
    try {
      tie(quantities, correlation, plan);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  plan.estimates = common_estimates(quantities, plan, seed);
  return plan;
}

void SamplePlan::assemble_column(std::size_t c, std::span<const double* const> drawn, std::size_t n,
                                 double* out) const {
  const double value = columns[c].value;
  bool first = true;
  for (const std::size_t v : columns[c].variates) {
    const double* deviation = drawn[v];
    if (first)
      for (std::size_t i = 0; i < n; ++i) out[i] = value + deviation[i];
    else
      for (std::size_t i = 0; i < n; ++i) out[i] += deviation[i];
    first = false;
  }
}

void SamplePlan::assemble(std::span<const double* const> drawn, std::size_t n, double* out,
                          std::size_t stride) const {
  for (std::size_t c = 0; c < columns.size(); ++c) assemble_column(c, drawn, n, out + c * stride);
}

} // namespace gumshoe::quantities
