#include "scenario/trace.h"

#include <algorithm>

#include <fmt/format.h>

#include "formula/formula.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t least_draws = 99, most_draws = 1'000'000, most_seed = std::int64_t{1} << 40;

class TraceReader {
public:
  TraceReader(Table table, const TraceScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context), problems_(context.problems) {}

  TraceOptions read() {
    out_.stated = true;
    if (auto columns = table_.table("columns"))
      for (const Member& m : columns->members()) column(m, *columns);
    blocks();
    order();
    redone();
    out_.free = table_.texts("free");
    if (const auto alpha = table_.number("alpha")) {
      if (!(*alpha > 0 && *alpha < 1))
        problems_.add(*table_.find("alpha"), fmt::format("trace.alpha: {} must lie between 0 and 1", *alpha),
                      "the chance of a finding where there is nothing", "alpha = 0.05");
      out_.alpha = *alpha;
    }
    if (const auto n = table_.integer("draws", least_draws, most_draws)) out_.draws = static_cast<int>(*n);
    if (const auto n = table_.integer("seed", 0, most_seed)) out_.seed = static_cast<std::uint64_t>(*n);
    table_.refuse_unknown();
    return std::move(out_);
  }

private:
  void refuse(const Member& m, const std::string& what, const std::string& why, const std::string& remedy = {}) {
    problems_.add(m.line, m.column, fmt::format("trace.columns.{}: {}", m.key, what), why, remedy);
  }

  bool writable(const Member& m) {
    const auto is_it = [&](const auto& card) { return card.name == m.key; };
    if (!formula::is_name(m.key))
      refuse(m, "no name that a formula can write", "letters, digits and _, no digit first");
    else if (std::ranges::any_of(scope_.model.conditions, is_it) ||
             std::ranges::any_of(scope_.model.indications, is_it) ||
             std::ranges::any_of(scope_.model.quantities, is_it))
      refuse(m, "the name has a meaning already", fmt::format("of the model {}", scope_.model.name), "choose another name");
    else
      return true;
    return false;
  }

  /// name = { column = "...", unit = "..." }
  void column(const Member& m, Table& columns) {
    auto table = columns.table(m.key);
    if (!table) return;
    const bool named = writable(m);
    const bool given = table->require("column", "column = \"...\"") != nullptr;
    const std::string unit = table->text("unit").value_or("1");
    const Csv* csv = scope_.readouts.empty() ? nullptr : scope_.readouts.front().csv;
    if (!csv && context_.readings_known)
      refuse(m, "the readings stand in no data file", "columns are of the file that holds them");
    const int index = csv && given ? find_column(*table, "column", *csv) : -1;
    table->find("column");
    table->refuse_unknown();
    TraceColumn out{m.key, unit, "1", {}};
    try {
      out.si_unit = units::si_unit_of(unit);
    } catch (const InputError& error) {
      const Problem& p = error.problems().front();
      problems_.add(*table->find("unit"), table->path("unit") + ": " + p.what, p.why, p.remedy);
      return;
    }
    if (!named) return;
    if (index >= 0 && context_.readings_known && own(m, *csv, index))
      values(*csv, static_cast<std::size_t>(index), out);
    out_.columns.push_back(std::move(out));
  }

  /// Not one of the readings themselves.
  bool own(const Member& m, const Csv& csv, int column) {
    for (const IndicationReadouts& of_one : scope_.readouts)
      if (of_one.csv == &csv && of_one.column == csv.header[static_cast<std::size_t>(column)].text) {
        refuse(m, fmt::format("'{}' holds readings", of_one.column),
               "a signature computed from what was measured explains itself");
        return false;
      }
    return true;
  }

  /// Means over the readouts of each reading; a cell without a number is a problem at its place, and there are none.
  void values(const Csv& csv, std::size_t column, TraceColumn& out) {
    const std::size_t before = problems_.size();
    for (const Readouts& r : scope_.readouts.front().used) {
      double sum = 0;
      for (const std::size_t row : r.rows)
        sum += read_cell(csv, csv.rows[row][column], out.unit, {out.si_unit}, problems_).value_or(0);
      out.values.push_back(sum / static_cast<double>(r.rows.size()));
    }
    if (problems_.size() != before) out.values.clear();
  }

  bool is_label(const Node& node, const std::string& path, const std::string& name) {
    if (!context_.readings_known || context_.label_values.contains(name)) return true;
    problems_.add(node, fmt::format("{}: no reading has the label '{}'", path, name), "",
                  did_you_mean(name, context_.label_names()));
    return false;
  }

  void blocks() {
    const auto label = table_.text("blocks");
    const Node* const final_node = table_.find("final");
    if (final_node && !table_.has("blocks"))
      problems_.add(*final_node, "trace.final: there are no blocks", "they are values of a label",
                    "blocks = \"setup\"");
    out_.final_blocks = table_.texts("final");
    if (final_node && final_node->kind == Node::Kind::array && final_node->items.empty())
      problems_.add(*final_node, "trace.final: empty", "without it the last quarter of the blocks is kept apart",
                    "leave it out");
    if (!label || !is_label(*table_.find("blocks"), "trace.blocks", *label)) return;
    out_.blocks = *label;
    if (!context_.readings_known) return;
    std::set<std::string> known;
    for (const quantities::Reading& r : scope_.readings) {
      if (const std::string* value = find_label(r.labels, *label)) {
        known.insert(*value);
        continue;
      }
      problems_.add(*table_.find("blocks"), fmt::format("trace.blocks: a reading has no label '{}'", *label),
                    "every reading belongs to a block");
      return;
    }
    for (std::size_t i = 0; final_node && i < out_.final_blocks.size(); ++i) {
      const std::string& name = out_.final_blocks[i];
      const Node& at = final_node->kind == Node::Kind::array ? final_node->items[i] : *final_node;
      if (!known.contains(name))
        problems_.add(at, fmt::format("trace.final: no reading has {} = '{}'", *label, name), "",
                      did_you_mean(name, {known.begin(), known.end()}));
      else if (std::find(out_.final_blocks.begin(), out_.final_blocks.begin() + static_cast<std::ptrdiff_t>(i), name) !=
               out_.final_blocks.begin() + static_cast<std::ptrdiff_t>(i))
        problems_.add(at, fmt::format("trace.final: '{}' stands twice", name));
    }
    if (final_node && known.size() == out_.final_blocks.size() &&
        std::ranges::all_of(out_.final_blocks, [&](auto& b) { return known.contains(b); }))
      problems_.add(*final_node, "trace.final: every block is kept apart", "nothing is left to search in",
                    "list fewer of them");
  }

  void order() {
    const auto name = table_.text("order");
    if (!name) return;
    std::vector<std::string> names;
    for (std::size_t c = 0; c < scope_.model.conditions.size(); ++c) {
      names.emplace_back(scope_.model.conditions[c].name);
      if (names.back() != *name) continue;
      for (const quantities::Reading& r : scope_.readings) out_.order.push_back(r.conditions[c]);
      out_.order_name = *name;
      return;
    }
    for (const TraceColumn& c : out_.columns) {
      names.push_back(c.name);
      if (c.name != *name) continue;
      out_.order = c.values;
      out_.order_name = *name;
      return;
    }
    problems_.add(*table_.find("order"), fmt::format("trace.order: '{}' is no condition and no column", *name), "",
                  did_you_mean(*name, names));
  }

  void redone() {
    const auto* sets = table_.array("redone");
    if (!sets) return;
    out_.redone.emplace();
    for (std::size_t i = 0; i < sets->size(); ++i) {
      const Node& node = (*sets)[i];
      const std::string path = fmt::format("trace.redone[{}]", i + 1);
      const std::vector<Node> one{node};
      const bool listed = node.kind == Node::Kind::array;
      std::vector<std::string> labels;
      for (const Node& item : listed ? node.items : one)
        if (const auto label = read_text(item, path, problems_); label && is_label(item, path, *label)) {
          if (std::ranges::find(labels, *label) != labels.end())
            problems_.add(item, fmt::format("{}: '{}' stands twice", path, *label));
          labels.push_back(*label);
        }
      if (listed && node.items.empty()) problems_.add(node, path + ": empty", "an act has labels");
      out_.redone->push_back(std::move(labels));
    }
  }

  Table table_;
  const TraceScope& scope_;
  Context& context_;
  Problems& problems_;
  TraceOptions out_;
};

} // namespace

TraceOptions read_trace(Table table, const TraceScope& scope, Context& context) {
  return TraceReader(std::move(table), scope, context).read();
}

} // namespace gumshoe::scenario
