#include "scenario/readings.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenario/noise.h"

namespace gumshoe::scenario {
namespace {

using quantities::Reading;

class ReadingsReader {
public:
  ReadingsReader(const ModelCard& model, Method method, Context& context)
      : model_(model), method_(method), context_(context), problems_(context.problems) {}

  Readings read(Table& top) {
    const std::size_t before = problems_.size();
    const Conditions conditions = read_conditions(top.table("conditions"), model_);
    out_.spreads = conditions.spreads;
    auto indications = top.table("indications");
    static const Node nothing;
    std::vector<Table> tables;
    for (const VariableCard& card : model_.indications) {
      const std::string name(card.name);
      std::optional<Table> table = indications ? indications->table(name) : std::nullopt;
      if (method_ == Method::propagation && !table)
        problems_.add(indications ? indications->node() : top.node(), fmt::format("indications.{} is missing", name),
                      "the propagation of distributions evaluates readings",
                      fmt::format("add [indications.{}] with readings", name));
      tables.push_back(table ? *table : Table(nothing, "indications." + name, problems_));
      tables.back().declare(readout_keys());
      tables.back().declare(noise_keys());
      out_.readouts.push_back(read_readouts(tables.back(), card, model_, conditions, context_));
      if (table && method_ == Method::propagation) need_values(*table, out_.readouts.back());
    }
    if (indications) indications->refuse_unknown();
    drop_selecting_labels();
    merge(tables, conditions, problems_.size() == before);
    context_.readings_known = problems_.size() == before;
    for (const Reading& r : out_.readings) context_.readings.push_back(r.labels);
    for (const auto& of_one : out_.readouts)
      for (const Readouts& r : of_one.all)
        for (const auto& [label, value] : r.labels) context_.label_values[label].insert(value);
    const bool several = out_.readings.size() > 1 || top.has("choose"); // which varies their number
    for (std::size_t i = 0; i < tables.size(); ++i) {
      out_.noise.push_back(read_noise(tables[i], model_.indications[i], out_.readouts[i], several, context_));
      tables[i].refuse_unknown();
    }
    return std::move(out_);
  }

private:
  void need_values(Table& table, const IndicationReadouts& readouts) {
    for (const Readouts& r : readouts.used) {
      if (!r.values.empty()) continue;
      if (table.has("readings") && table.find("readings")->kind == Node::Kind::array) return; // said already
      const std::string of = r.labels.empty() ? "" : " for " + text_of(r.labels);
      table.refuse("no readings" + of, "the propagation of distributions evaluates readings", "readings = [\"...\"]");
      return;
    }
  }

  /// A label by which indications are told apart in one file is no label of the readings: `where` fixes it to different
  /// values, or some indications do not have it.
  void drop_selecting_labels() {
    auto& all = out_.readouts;
    const auto tells_apart = [&](const std::pair<std::string, std::string>& fixed) {
      bool differs = false;
      for (const IndicationReadouts& other : all) {
        const std::string* value = quantities::label_value(other.fixed, fixed.first);
        const bool labelled = std::ranges::any_of(
            other.used, [&](const Readouts& r) { return quantities::label_value(r.labels, fixed.first) != nullptr; });
        if (labelled && !value) return false; // it varies there: readings differ by it
        differs |= !labelled || *value != fixed.second;
      }
      return differs;
    };
    std::vector<quantities::Labels> dropped(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      std::ranges::copy_if(all[i].fixed, std::back_inserter(dropped[i]), tells_apart);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const auto& label : dropped[i]) {
        std::erase_if(all[i].all, [&](const Readouts& r) { return !quantities::holds_for({label}, r.labels); });
        for (auto* readouts : {&all[i].used, &all[i].all})
          for (Readouts& r : *readouts) std::erase(r.labels, label);
      }
  }

  /// The reading with these labels and conditions. Indications in one file have theirs in one order: it is looked for at
  /// this place first.
  std::vector<Reading>::iterator same_reading(const Readouts& r, std::size_t place) {
    const auto same = [&](const Reading& known) {
      return known.conditions == r.conditions && quantities::holds_for(r.labels, known.labels) &&
             quantities::holds_for(known.labels, r.labels);
    };
    if (place < out_.readings.size() && same(out_.readings[place]))
      return out_.readings.begin() + static_cast<std::ptrdiff_t>(place);
    return std::ranges::find_if(out_.readings, same);
  }

  /// One reading per group of equal labels and conditions, in the order of the first indication; without indications
  /// those of the conditions.
  /// @param sound  whether every indication was read: else what is missing follows from what was said
  void merge(std::vector<Table>& tables, const Conditions& conditions, bool sound) {
    std::vector<IndicationReadouts>& readouts = out_.readouts;
    for (std::size_t i = 0; i < readouts.size(); ++i) {
      for (Readouts& r : readouts[i].used) {
        const auto it = i == 0 ? out_.readings.insert(out_.readings.end(), {r.labels, r.conditions, {}, r.repeats})
                               : same_reading(r, static_cast<std::size_t>(&r - readouts[i].used.data()));
        if (it == out_.readings.end()) {
          tables[i].refuse(fmt::format("{} has no reading {}", model_.indications[0].name, text_of(r.labels)),
                           "every indication of a reading is needed");
          continue;
        }
        r.reading = static_cast<std::size_t>(it - out_.readings.begin());
        if (r.values.empty()) continue;
        double mean = 0;
        for (const double v : r.values) mean += (v - r.values.front()) / static_cast<double>(r.values.size());
        it->indications.push_back(r.values.front() + mean);
        double squares = 0;
        for (const double v : r.values) squares += (v - it->indications.back()) * (v - it->indications.back());
        it->scatter.push_back(squares);
      }
    }
    for (const Reading& r : out_.readings) {
      if (!sound || r.indications.empty() || r.indications.size() == readouts.size()) continue;
      const std::string which = r.labels.empty() ? "a reading" : "the reading " + text_of(r.labels);
      tables.back().add(fmt::format("indications: {} lacks an indication", which));
    }
    if (out_.readings.empty())
      for (const Commanded& c : conditions.readings) out_.readings.push_back({c.labels, c.values, {}, 1});
  }

  const ModelCard& model_;
  const Method method_;
  Context& context_;
  Problems& problems_;
  Readings out_;
};

} // namespace

Shape indication_shape() {
  std::vector<Key> keys = readout_keys();
  for (const Key& key : noise_keys()) keys.push_back(key);
  return shape::table(keys);
}

Readings read_readings(Table& top, const ModelCard& model, Method method, Context& context) {
  return ReadingsReader(model, method, context).read(top);
}

} // namespace gumshoe::scenario
