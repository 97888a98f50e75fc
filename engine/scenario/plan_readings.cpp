#include "scenario/plan_readings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "scenario/conditions.h"

namespace gumshoe::scenario {
namespace {

/// Beyond this a search over exchanges takes minutes.
constexpr std::size_t most_allowed = 2000;

/// Something that differs between readings: a condition, a label or a recorded column.
struct Axis {
  enum class Kind { condition, label, column };
  Kind kind = Kind::condition;
  std::string name;
  std::size_t index = 0; ///< of a condition or a column
  std::string si_unit = "1";
  std::vector<double> numbers = {};
  std::vector<std::string> words = {}; ///< values of a label
  std::size_t size() const { return kind == Kind::label ? words.size() : numbers.size(); }
};

std::vector<Key> step_keys() {
  return {{"from", shape::reference("measure"), "first value", true},
          {"to", shape::reference("measure"), "last value", true},
          {"step", shape::reference("measure"), "distance of neighbours", true}};
}

class AllowedReader {
public:
  AllowedReader(Table& plan, const AllowedScope& scope, Context& context)
      : plan_(plan), scope_(scope), context_(context), problems_(context.problems) {}

  std::vector<AllowedReading> read() {
    const bool listed = plan_.has("readings"), in_file = plan_.has("points");
    if (listed == in_file) {
      plan_.refuse(listed ? "readings and points are both given" : "no further readings are allowed",
                   listed ? "each of them lists the readings that are allowed" : "",
                   listed ? "leave one out" : "[plan.readings] with the values of conditions and labels");
      return {};
    }
    if (!context_.readings_known) {
      if (auto table = plan_.table("readings")) table->members();
      return {};
    }
    AllowedReading usual;
    if (auto table = plan_.table("readings")) {
      std::vector<Axis> axes;
      for (const Member& m : table->members())
        if (auto axis = axis_of(m, *table); axis && values(m, *table, *axis)) axes.push_back(std::move(*axis));
      if (problems_.size() == 0 && shared(axes, table->node(), usual)) combine(axes, usual, table->node());
    } else if (const Node* node = plan_.find("points")) {
      rows(*node, usual);
    }
    return std::move(out_);
  }

private:
  std::optional<Axis> axis_named(const std::string& name) const {
    for (std::size_t c = 0; c < scope_.model.conditions.size(); ++c)
      if (scope_.model.conditions[c].name == name)
        return Axis{Axis::Kind::condition, name, c, std::string(scope_.model.conditions[c].si_unit)};
    for (const std::string& label : context_.label_names())
      if (label == name) return Axis{Axis::Kind::label, name};
    for (std::size_t c = 0; c < scope_.scenario.trace.columns.size(); ++c)
      if (scope_.scenario.trace.columns[c].name == name)
        return Axis{Axis::Kind::column, name, c, scope_.scenario.trace.columns[c].si_unit};
    return std::nullopt;
  }

  std::vector<std::string> known() const {
    auto out = names_of(scope_.model.conditions);
    for (const auto& label : context_.label_names()) out.push_back(label);
    for (const auto& column : scope_.scenario.trace.columns) out.push_back(column.name);
    return out;
  }

  std::optional<Axis> axis_of(const Member& m, const Table& table) {
    auto out = axis_named(m.key);
    if (!out)
      problems_.add(m, fmt::format("{}: '{}' is neither a condition nor a label of the readings", table.path(), m.key),
                    "", did_you_mean(m.key, known()));
    return out;
  }

  bool values(const Member& m, Table& table, Axis& axis) {
    const std::string path = table.path(m.key);
    const std::size_t before = problems_.size();
    if (m.value.kind == Node::Kind::table && axis.kind != Axis::Kind::label) {
      steps(*table.table(m.key), axis);
    } else {
      const std::vector<Node> one{m.value};
      const auto& items = m.value.kind == Node::Kind::array ? m.value.items : one;
      for (const Node& item : items) value(item, path, axis);
      if (items.empty()) problems_.add(m.value, path + ": empty", "there is nothing to choose from");
    }
    return problems_.size() == before;
  }

  void value(const Node& item, const std::string& path, Axis& axis) {
    if (axis.kind == Axis::Kind::label) {
      if (item.kind == Node::Kind::integer)
        axis.words.push_back(fmt::format("{}", item.integer));
      else if (const auto text = read_text(item, path, problems_))
        axis.words.push_back(*text);
      if (std::ranges::count(axis.words, axis.words.empty() ? "" : axis.words.back()) > 1)
        problems_.add(item, path + ": the value is listed twice");
    } else if (const auto x = read_measure(item, path, {axis.si_unit}, problems_)) {
      if (std::ranges::find(axis.numbers, *x) != axis.numbers.end())
        problems_.add(item, path + ": the value is listed twice");
      axis.numbers.push_back(*x);
    }
  }

  void steps(Table table, Axis& axis) {
    table.declare(step_keys());
    for (const Key& key : step_keys())
      table.require(key.name, "{ from = \"0 mm\", to = \"400 mm\", step = \"50 mm\" }");
    const auto from = table.measure("from", {axis.si_unit}), to = table.measure("to", {axis.si_unit});
    const auto step = table.measure("step", {axis.si_unit, units::Kind::difference});
    table.refuse_unknown();
    if (!from || !to || !step) return;
    const double count = std::floor((*to - *from) / *step + 1e-9);
    if (!(*step != 0 && count >= 0)) return table.refuse_key("step", "does not lead from `from` to `to`");
    if (count >= static_cast<double>(most_allowed))
      return table.refuse_key("step", fmt::format("gives more than {} values", most_allowed));
    for (int i = 0; i <= static_cast<int>(count); ++i) axis.numbers.push_back(*from + i * *step);
  }

  /// Values of everything that is not listed: those that all readings share.
  bool shared(const std::vector<Axis>& axes, const Node& node, AllowedReading& usual) {
    const auto listed = [&](const std::string& name) {
      return std::ranges::find(axes, name, &Axis::name) != axes.end();
    };
    const auto& readings = scope_.scenario.readings;
    const std::size_t before = problems_.size();
    const auto must_list = [&](const std::string& name) {
      problems_.add(node, fmt::format("plan: {} differs between the readings and is not listed", name),
                    "further readings need a value of it", fmt::format("list its values as plan.readings.{}", name));
    };
    usual.conditions = readings.front().conditions;
    for (std::size_t c = 0; c < usual.conditions.size(); ++c) {
      const std::string name(scope_.model.conditions[c].name);
      if (!listed(name) &&
          std::ranges::any_of(readings, [&](const auto& r) { return r.conditions[c] != usual.conditions[c]; }))
        must_list(name);
    }
    for (const std::string& label : context_.label_names()) {
      const std::string* first = quantities::label_value(readings.front().labels, label);
      usual.labels.emplace_back(label, first ? *first : "");
      const bool of_condition = condition(label) < usual.conditions.size();
      if (!listed(label) && !of_condition && std::ranges::any_of(readings, [&](const auto& r) {
            const std::string* value = quantities::label_value(r.labels, label);
            return !value || *value != usual.labels.back().second;
          }))
        must_list(label);
    }
    for (const TraceColumn& column : scope_.scenario.trace.columns) {
      double sum = 0;
      for (const double x : column.values) sum += x;
      usual.columns.push_back(column.values.empty() ? 0 : sum / static_cast<double>(column.values.size()));
    }
    return problems_.size() == before;
  }

  std::size_t condition(const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::find(scope_.model.conditions, name, &VariableCard::name) -
                                    scope_.model.conditions.begin());
  }

  void set(AllowedReading& reading, const Axis& axis, std::size_t i) const {
    if (axis.kind == Axis::Kind::condition) reading.conditions[axis.index] = axis.numbers[i];
    if (axis.kind == Axis::Kind::column) reading.columns[axis.index] = axis.numbers[i];
    if (axis.kind == Axis::Kind::label)
      std::ranges::find(reading.labels, axis.name, &quantities::Labels::value_type::first)->second = axis.words[i];
  }

  /// A label that only names a condition follows it.
  void name_conditions(AllowedReading& reading) const {
    for (auto& [label, value] : reading.labels)
      if (const std::size_t c = condition(label); c < reading.conditions.size())
        value = condition_text(reading.conditions[c], scope_.model.conditions[c]);
  }

  void combine(const std::vector<Axis>& axes, const AllowedReading& usual, const Node& node) {
    double count = 1;
    for (const Axis& axis : axes) count *= static_cast<double>(axis.size());
    if (count > static_cast<double>(most_allowed))
      return problems_.add(node, fmt::format("plan.readings: {:.0f} combinations are allowed", count),
                           fmt::format("at most {} can be compared", most_allowed), "list fewer values");
    out_.assign(static_cast<std::size_t>(count), usual);
    std::size_t every = out_.size();
    for (const Axis& axis : axes) {
      every /= axis.size();
      for (std::size_t i = 0; i < out_.size(); ++i) set(out_[i], axis, i / every % axis.size());
    }
    for (AllowedReading& reading : out_) {
      reading.cost = scope_.cost;
      name_conditions(reading);
    }
  }

  /// "feed (mm/min)"
  struct Header {
    std::string name, unit;
  };
  static Header header_of(const std::string& text) {
    const std::size_t open = text.find(" (");
    if (open == std::string::npos || !text.ends_with(')')) return {text, "1"};
    return {text.substr(0, open), text.substr(open + 2, text.size() - open - 3)};
  }

  void rows(const Node& node, AllowedReading usual) {
    if (node.kind != Node::Kind::text) return problems_.add(node, "plan.points: must be the name of a CSV file");
    const Csv* csv = context_.files.open(node, "plan.points", {}, problems_);
    if (!csv) return;
    std::vector<Axis> axes;
    int cost = -1;
    const std::size_t before = problems_.size();
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < csv->header.size(); ++c) {
      const auto [name, unit] = header_of(csv->header[c].text);
      if (name == "cost") {
        cost = static_cast<int>(c);
        continue;
      }
      auto axis = axis_named(name);
      if (!axis || (axis->kind != Axis::Kind::label && !units::convertible(unit, axis->si_unit))) {
        problems_.add(Problem{csv->at(csv->header[c]),
                              fmt::format("plan.points: '{}' is no column of allowed readings", csv->header[c].text),
                              "columns are conditions and recorded columns with their unit, labels and cost",
                              axis ? fmt::format("write {} with a unit that converts to {}", name, axis->si_unit)
                                   : did_you_mean(name, known())});
        continue;
      }
      axes.push_back(std::move(*axis));
      columns.push_back(c);
    }
    if (problems_.size() != before || !shared(axes, node, usual)) return;
    if (csv->rows.empty() || csv->rows.size() > most_allowed)
      return problems_.add(node,
                           fmt::format("plan.points: {} readings are listed in '{}'", csv->rows.size(), csv->file),
                           fmt::format("from one to {} readings can be compared", most_allowed));
    for (const auto& row : csv->rows) {
      AllowedReading reading = usual;
      reading.cost = scope_.cost;
      try {
        for (std::size_t a = 0; a < axes.size(); ++a) {
          const CsvCell& cell = row[columns[a]];
          const auto [name, unit] = header_of(csv->header[columns[a]].text);
          Axis one = axes[a];
          if (one.kind == Axis::Kind::label)
            one.words = {cell.text};
          else
            one.numbers = {units::to_si(csv->number(cell), unit, one.si_unit)};
          set(reading, one, 0);
        }
        if (cost >= 0) reading.cost = csv->number(row[static_cast<std::size_t>(cost)]);
      } catch (const InputError& error) {
        problems_.add(error);
        continue;
      }
      if (!(reading.cost > 0))
        problems_.add(
            Problem{csv->at(row[static_cast<std::size_t>(cost)]), "plan.points: the cost is not above 0", "", ""});
      name_conditions(reading);
      out_.push_back(std::move(reading));
    }
  }

  Table& plan_;
  const AllowedScope& scope_;
  Context& context_;
  Problems& problems_;
  std::vector<AllowedReading> out_;
};

} // namespace

Shape allowed_readings_shape() {
  const Shape value = shape::any_of({shape::number(), shape::text()});
  return shape::map(shape::any_of({value, shape::list(value, R"("minItems": 1)"), shape::table(step_keys())}),
                    R"("minProperties": 1)");
}

std::vector<AllowedReading> read_allowed_readings(Table& plan, const AllowedScope& scope, Context& context) {
  return AllowedReader(plan, scope, context).read();
}

} // namespace gumshoe::scenario
