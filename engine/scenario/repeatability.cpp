#include "scenario/repeatability.h"

#include <fmt/format.h>

#include "scenario/uncertainty.h"

namespace gumshoe::scenario {
namespace {

std::vector<Key> declared_keys() {
  return {{"s", shape::reference("width"), "experimental standard deviation of one reading", true},
          {"degrees_of_freedom", degrees_of_freedom_shape(), "degrees of freedom of s; default: infinite"}};
}

/// Also together with { pooled = true }.
std::vector<Key> repeatability_keys() {
  return {{"evaluation", shape::words({"A", "B"})}, {"source", shape::reference("source")}};
}

Key pooled_key() { return {"pooled", R"("const": true)", "pools s over all cells of the data (GUM 4.2.4)", true}; }

class RepeatabilityReader {
public:
  RepeatabilityReader(Table& table, const VariableCard& card, const IndicationReadouts& readouts, Context& context)
      : table_(table), card_(card), readouts_(readouts), context_(context) {}

  Repeatability read() {
    const Node* node = table_.find("repeatability");
    if (!node) return {};
    const std::string path = table_.path("repeatability");
    if (node->kind == Node::Kind::text && node->text == "readings") {
      own_repeats(*node, path);
      return {Repeatability::Kind::readings, {}, false, 'A', "repeats of each reading"};
    }
    if (node->kind != Node::Kind::table) {
      table_.refuse_key("repeatability", "not understood", "",
                        "use \"readings\", { s = \"...\" } or { pooled = true }");
      return {};
    }
    Table table(*node, path, context_.problems);
    table.declare(declared_keys());
    table.declare(repeatability_keys());
    table.declare({pooled_key()});
    Repeatability out = table.boolean("pooled").value_or(false) ? pooled(table) : declared(table);
    if (const std::string source = table.rendered("source"); !source.empty()) out.source = source;
    if (const auto evaluation = table.choice("evaluation", {"A", "B"})) out.evaluation = *evaluation ? 'B' : 'A';
    table.refuse_unknown();
    return out;
  }

private:
  void own_repeats(const Node& node, const std::string& path) {
    if (!context_.readings_known) return;
    for (const Readouts& r : readouts_.used) {
      if (r.values.size() > 1) continue;
      const std::string of = r.labels.empty() ? "" : fmt::format(" (reading {})", text_of(r.labels));
      context_.problems.add(node,
                            fmt::format("{}: {} indication(s){} cannot show any scatter", path, r.values.size(), of),
                            "", "repeat the reading, declare s, or pool it");
      return;
    }
  }

  Repeatability pooled(Table& table) {
    for (const char* key : {"s", "degrees_of_freedom"})
      if (table.has(key))
        table.refuse(fmt::format("{} is given together with pooled", key), "pooling takes it from the data",
                     "leave it out");
    const Scatter scatter = pooled_scatter(readouts_.all);
    if (!(scatter.degrees_of_freedom > 0)) {
      if (context_.readings_known) table.refuse("there is nothing to pool", "no reading is repeated", "declare s");
      return {};
    }
    return {Repeatability::Kind::declared, scatter, true, 'A',
            fmt::format("s = {} pooled over {} readings, {} degrees of freedom (GUM 4.2.4)",
                        shown_scatter(scatter.s, card_), readouts_.all.size(), scatter.degrees_of_freedom)};
  }

  Repeatability declared(Table& table) {
    Repeatability out{Repeatability::Kind::declared, {}, false, 'A', {}};
    table.require("s", "write s = \"...\" or pooled = true");
    const auto s = table.width("s", std::string(card_.si_unit));
    const auto degrees = read_degrees_of_freedom(table);
    out.scatter.degrees_of_freedom = degrees.value_or(0);
    if (!table.has("degrees_of_freedom")) out.evaluation = 'B';
    if (!s) return {};
    out.scatter.s = *s;
    return out;
  }

  Table& table_;
  const VariableCard& card_;
  const IndicationReadouts& readouts_;
  Context& context_;
};

} // namespace

Key repeatability_key() {
  std::vector<Key> declared = declared_keys(), pooled = {pooled_key()};
  for (const Key& key : repeatability_keys()) declared.push_back(key), pooled.push_back(key);
  return {"repeatability", shape::any_of({R"("const": "readings")", shape::table(declared), shape::table(pooled)}),
          "\"readings\": from the repeats of each reading; or declared; or pooled over all cells of the data"};
}

Repeatability read_repeatability(Table& table, const VariableCard& card, const IndicationReadouts& readouts,
                                 Context& context) {
  return RepeatabilityReader(table, card, readouts, context).read();
}

double sum_of_squares(const std::vector<double>& x) {
  double mean = 0, sum = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  for (const double v : x) sum += (v - mean) * (v - mean);
  return sum;
}

Scatter pooled_scatter(const std::vector<Readouts>& cells) {
  Scatter out;
  double squares = 0;
  for (const Readouts& cell : cells) {
    if (cell.values.size() < 2) continue;
    squares += sum_of_squares(cell.values);
    out.degrees_of_freedom += static_cast<double>(cell.values.size()) - 1;
  }
  if (out.degrees_of_freedom > 0) out.s = std::sqrt(squares / out.degrees_of_freedom);
  return out;
}

std::string shown_scatter(double value, const VariableCard& card) {
  const std::string si_unit(card.si_unit), unit = units::error_unit(std::string(card.unit), si_unit, value);
  return fmt::format("{:.3g}{}", units::from_si(value, unit, si_unit, units::Kind::difference), units::suffix(unit));
}

} // namespace gumshoe::scenario
