#include "scenario/trace.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "formula/formula.h"
#include "scenario/number_column.h"
#include "scenario/quantity.h"
#include "scenario/stretches.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most_seed = std::int64_t{1} << 40;

class TraceReader {
public:
  TraceReader(Table table, const TraceScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context), problems_(context.problems) {}

  TraceOptions read() {
    out_.stated = true;
    if (auto columns = table_.table("columns"))
      for (const Member& m : columns->members()) column(m, *columns);
    read_options(table_, trace_options(), out_);
    blocks();
    order();
    redone();
    priors();
    table_.find("jumping"); // of quantities that are not known yet
    table_.refuse_unknown();
    return std::move(out_);
  }

private:
  void refuse(const Member& m, const std::string& what, const std::string& why, const std::string& remedy = {}) {
    problems_.add(m, fmt::format("trace.columns.{}: {}", m.key, what), why, remedy);
  }

  bool writable(const Member& m) {
    const auto is_it = [&](const auto& card) { return card.name == m.key; };
    if (!formula::is_name(m.key))
      refuse(m, "a formula cannot use this name", "use letters, digits and _, with no digit first");
    else if (std::ranges::any_of(scope_.model.conditions, is_it))
      refuse(m, "the name already has a meaning", fmt::format("it is a condition of the model {}", scope_.model.name),
             "write it under [data.conditions], or under conditions of the readings of an indication, in place of "
             "[trace.columns]; or choose another name");
    else if (std::ranges::any_of(scope_.model.indications, is_it) ||
             std::ranges::any_of(scope_.model.quantities, is_it))
      refuse(m, "the name already has a meaning", fmt::format("of the model {}", scope_.model.name),
             "choose another name");
    else
      return true;
    return false;
  }

  /// name = { column = "...", unit = "..." }, or another form of a column of numbers; { counts = "readings" }
  void column(const Member& m, Table& columns) {
    const bool named = writable(m);
    if (std::ranges::find(m.value.members, "counts", &Member::key) != m.value.members.end()) {
      Table own(m.value, columns.path(m.key), problems_);
      columns.find(m.key);
      own.choice("counts", {"readings"});
      own.refuse_unknown();
      TraceColumn out{m.key, "1", "1", std::vector<double>(scope_.readings.size())};
      std::iota(out.values.begin(), out.values.end(), 1.0);
      if (named) out_.columns.push_back(std::move(out));
      return;
    }
    const auto& file = scope_.readouts.empty() ? std::nullopt : scope_.readouts.front().file;
    if (!file) {
      if (context_.readings_known)
        refuse(m, "the readings are not in a data file", "columns belong to the file that holds the readings");
      return;
    }
    const auto column = NumberColumn::read(columns, m.key, *file);
    if (!column || !named) return;
    TraceColumn out{m.key, column->unit(), column->si_unit(), {}};
    if (context_.readings_known && own(m, *file->csv, column->name())) values(*column, out);
    out_.columns.push_back(std::move(out));
  }

  /// Not one of the readings themselves.
  bool own(const Member& m, const Csv& csv, const std::string& column) {
    for (const IndicationReadouts& of_one : scope_.readouts)
      if (of_one.file && of_one.file->csv == &csv && of_one.column == column) {
        refuse(m, fmt::format("'{}' holds readings", of_one.column),
               "a signature computed from what was measured explains itself");
        return false;
      }
    return true;
  }

  /// Means over the readouts of each reading; a cell without a number is a problem at its place, and there are none.
  void values(const NumberColumn& column, TraceColumn& out) {
    const std::size_t before = problems_.size();
    std::vector<std::size_t> rows;
    for (const Readouts& r : scope_.readouts.front().used) rows.insert(rows.end(), r.rows.begin(), r.rows.end());
    std::ranges::sort(rows);
    const auto numbers = column.values(rows, problems_);
    if (problems_.size() != before) return;
    for (const Readouts& r : scope_.readouts.front().used) {
      double sum = 0;
      for (const std::size_t row : r.rows)
        sum += *numbers[static_cast<std::size_t>(std::ranges::lower_bound(rows, row) - rows.begin())];
      out.values.push_back(sum / static_cast<double>(r.rows.size()));
    }
  }

  void blocks() {
    const Node* const node = table_.find("blocks");
    if (node && node->kind == Node::Kind::table)
      stretches(*node);
    else
      out_.blocks = table_.text("blocks").value_or("");
    const Node* const final_node = table_.find("final");
    const std::string& label = out_.blocks;
    if (final_node && !table_.has("blocks"))
      table_.refuse_key("final", "there are no blocks", "blocks are the values of a label", "blocks = \"setup\"");
    if (final_node && final_node->kind == Node::Kind::array && final_node->items.empty())
      table_.refuse_key("final", "empty", "without it the last quarter of the blocks is held out", "leave it out");
    if (!node || label.empty() || !context_.is_label(*node, "trace.blocks", label) || !context_.readings_known) return;
    std::set<std::string> known;
    for (const quantities::Reading& r : scope_.readings) {
      const std::string* value = quantities::label_value(r.labels, label);
      if (!value)
        return table_.refuse_key("blocks", fmt::format("a reading has no label '{}'", label),
                                 "every reading belongs to a block");
      known.insert(*value);
    }
    if (final_node) final_blocks(*final_node, known);
  }

  /// The readings have their stretch as a label (readouts_file.cpp).
  void stretches(const Node& node) {
    const bool in_file =
        std::ranges::any_of(scope_.readouts, [](const auto& of_one) { return of_one.file.has_value(); });
    if (in_file)
      out_.blocks = stretch_label;
    else if (context_.readings_known)
      problems_.add(node, "trace.blocks: the readings are not in a data file", "stretches are of the rows of a file",
                    "name a label: blocks = \"setup\"");
  }

  void final_blocks(const Node& node, const std::set<std::string>& known) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < out_.final_blocks.size(); ++i) {
      const std::string& name = out_.final_blocks[i];
      const Node& at = node.kind == Node::Kind::array ? node.items[i] : node;
      if (!known.contains(name))
        problems_.add(at, fmt::format("trace.final: no reading has {} = '{}'", out_.blocks, name), "",
                      did_you_mean(name, {known.begin(), known.end()}));
      else if (!seen.insert(name).second)
        problems_.add(at, fmt::format("trace.final: '{}' is listed twice", name));
    }
    if (known.size() == out_.final_blocks.size() &&
        std::ranges::all_of(out_.final_blocks, [&](auto& b) { return known.contains(b); }))
      table_.refuse_key("final", "every block is held out", "no block is left for the search", "list fewer of them");
  }

  void order() {
    const auto name = table_.text("order");
    if (!name) return;
    out_.order_known = *name != unknown_order;
    if (!out_.order_known) return;
    std::vector<std::string> names{unknown_order};
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
    if (!context_.readings_known) return; // nor are the columns of their file
    table_.refuse_key("order", fmt::format("'{}' is neither a condition nor a column", *name), "",
                      did_you_mean(*name, names));
  }

  void redone() {
    const Node* const stated = table_.find("redone");
    const std::vector<Node> alone = stated ? std::vector{*stated} : std::vector<Node>{};
    const auto* sets = stated && stated->kind == Node::Kind::text ? &alone : table_.array("redone");
    if (!sets) return;
    out_.redone.emplace();
    for (std::size_t i = 0; i < sets->size(); ++i) {
      const Node& node = (*sets)[i];
      const std::string path = fmt::format("trace.redone[{}]", i + 1);
      const std::vector<Node> one{node};
      const bool listed = node.kind == Node::Kind::array;
      std::vector<std::string> labels;
      for (const Node& item : listed ? node.items : one)
        if (const auto label = read_text(item, path, problems_); label && context_.is_label(item, path, *label)) {
          if (std::ranges::find(labels, *label) != labels.end())
            problems_.add(item, fmt::format("{}: '{}' is listed twice", path, *label));
          labels.push_back(*label);
        }
      if (listed && node.items.empty()) problems_.add(node, path + ": empty", "a set-up step needs at least one label");
      out_.redone->push_back(std::move(labels));
    }
  }

  void priors() {
    auto table = table_.table("priors");
    if (!table) return;
    for (const QuantityCard& card : scope_.model.quantities) {
      const std::string name(card.name);
      if (const Node* node = table->find(name))
        out_.priors.push_back(read_quantity(*node, "trace.priors." + name, card, name, context_));
    }
    table->refuse_unknown();
  }

  Table table_;
  const TraceScope& scope_;
  Context& context_;
  Problems& problems_;
  TraceOptions out_;
};

std::vector<Key> counting_keys() {
  return {{"counts", shape::words({"readings"}), "1, 2, 3, ... for the readings as they stand", true}};
}

} // namespace

Options<TraceOptions> trace_options() {
  const Shape act = shape::texts(R"("minItems": 1)");
  return {
      option::by_hand<TraceOptions>(
          "blocks", shape::any_of({shape::text(), stretches_shape()}),
          "label whose values define the blocks: set-ups, days, clampings; or stretches of the "
          "data, { every = \"30 min\", of = \"time\" } or { count = 6 }, with the label `block`"),
      option::texts("final", &TraceOptions::final_blocks, R"("minItems": 1)",
                    "hold-out blocks; default: the last quarter, at least one"),
      option::by_hand<TraceOptions>("order", shape::text(),
                                    "order of measurement: a condition or a column; default: the order of the "
                                    "readings; \"unknown\" where these are sorted by what was set"),
      option::by_hand<TraceOptions>(
          "redone", shape::any_of({shape::text(), shape::list(act)}),
          "labels that identify one redone set-up step, such as a clamping, which may leave scatter behind. Empty: "
          "none "
          "was redone. Left out: every set of one or two labels with at least six combinations"),
      option::texts("free", &TraceOptions::free, "",
                    "quantities whose stated values come from these data: fitted again, as if marked estimated"),
      option::by_hand<TraceOptions>(
          "priors", shape::map(shape::reference("quantity")),
          "quantities of the model as known before these data, where [quantities] says what is "
          "known with them; written by gumshoe trace"),
      option::texts(
          "unconfirmed", &TraceOptions::unconfirmed, "",
          "effects that held-out readings could neither confirm nor reject; written by gumshoe trace, and left "
          "out by gumshoe compensate"),
      option::by_hand<TraceOptions>("jumping", shape::map(shape::reference("measure")),
                                    "sizes found where readings jump, and how large; written by gumshoe trace, so that "
                                    "tracing these data again seeks them as it did"),
      option::share("alpha", &TraceOptions::alpha, true,
                    "false-alarm rate: probability of any finding if there is nothing to find; each finding after the "
                    "first must pass half of it"),
      option::whole("draws", &TraceOptions::draws, 99, 1'000'000, "number of draws of the parametric bootstrap"),
      option::whole("seed", &TraceOptions::seed, 0, most_seed, "seed of the bootstrap"),
      option::by_hand<TraceOptions>("columns",
                                    shape::map(shape::any_of({number_column_shape(), shape::table(counting_keys())})),
                                    "quantities recorded with the readings, in the same data file, such as a "
                                    "temperature; or the number of each reading"),
  };
}

Shape trace_shape() { return table_shape(trace_options(), R"("dependencies": {"final": ["blocks"]})"); }

TraceOptions read_trace(Table table, const TraceScope& scope, Context& context) {
  return TraceReader(std::move(table), scope, context).read();
}

} // namespace gumshoe::scenario
