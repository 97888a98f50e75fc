#include "scenario/noise.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "scenario/excess_scatter.h"
#include "scenario/number_column.h"
#include "scenario/quantity.h"
#include "scenario/repeatability.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using quantities::Entry;
using quantities::Family;
using quantities::InputQuantity;
using quantities::Labels;

class NoiseReader {
public:
  NoiseReader(Table& table, const VariableCard& card, const IndicationReadouts& readouts, bool several,
              Context& context)
      : table_(table), card_(card), readouts_(readouts), several_(several), context_(context) {}

  InputQuantity read() {
    InputQuantity out{std::string(card_.name), std::string(card_.unit), std::string(card_.si_unit), {}};
    const auto step = table_.width("resolution", std::string(card_.si_unit));
    const Repeatability repeatability = read_repeatability(table_, card_, readouts_, context_);
    const std::vector<double> own = own_uncertainties();
    note_excess(step, repeatability, own);
    refuse_expanded();
    double unused = 0;
    auto further = read_components(table_, std::string(card_.si_unit), true, unused, context_);
    const std::size_t before = context_.problems.size();
    if (several_)
      for (Table& one : table_.tables("components")) need_scope(one);
    const bool scoped = context_.problems.size() == before;
    for (Component& c : further) {
      c.common = true; // stated once
      if (c.name == "resolution" || c.name == "repeatability" || (c.name == "u" && !own.empty()))
        table_.add(fmt::format("{}.components: the name '{}' is already used", table_.path(), c.name), "",
                   "choose another name");
    }
    std::vector<Entry> entries;
    for (std::size_t r = 0; r < readouts_.used.size(); ++r) {
      entries.push_back({readouts_.used[r].labels, 0, choose(readouts_.used[r], step, repeatability), {}});
      if (!own.empty()) entries.back().components.push_back(stated(own[r]));
    }
    number_or_merge(entries);
    if (entries.empty()) entries.push_back({});
    if (std::ranges::all_of(entries, [&](const Entry& e) { return alike(e, entries.front()); })) {
      entries.resize(1);
      entries.front().labels.clear();
    } else if (scoped) {
      refuse_shared(further, entries);
    }
    const auto of_readings = [](const Component& c) { return std::ranges::find(c.per, "reading") != c.per.end(); };
    if (std::ranges::all_of(entries, [](const Entry& e) { return e.components.empty(); }) &&
        std::ranges::any_of(further, of_readings))
      note_means();
    for (Entry& e : entries) e.components.insert(e.components.end(), further.begin(), further.end());
    if (repeatability.kind == Repeatability::Kind::none && own.empty() && std::ranges::none_of(further, of_readings))
      out.display_alone = step.value_or(0);
    if (entries.front().components.empty())
      note("no component of uncertainty is stated: the readings are treated as exact");
    out.entries = std::move(entries);
    return out;
  }

private:
  /// Where nothing is stated but components, the mean of many equal readings has no less noise than one.
  void note_means() {
    const auto most = std::ranges::max_element(readouts_.used, {}, &Readouts::repeats);
    if (most == readouts_.used.end() || most->repeats < 2) return;
    note(fmt::format("equal labels and conditions make one reading, of up to {} indications here, whose mean has the "
                     "noise of the components, however many they are: state u if each indication has it anew, or tell "
                     "them apart by repeats = \"apart\" in [data]",
                     most->repeats));
  }

  /// An expanded uncertainty has a coverage factor, which is a component's.
  void refuse_expanded() {
    for (const Member& m : table_.node().members)
      if (m.key == "U")
        table_.refuse_stray(
            m, "an expanded uncertainty needs its coverage factor",
            "write components = [{ U = \"...\", k = 2, per = \"reading\" }]; u is the standard uncertainty");
  }

  std::string shown(double scatter) const { return shown_scatter(scatter, card_); }
  void note(const std::string& text) { context_.note(std::string(card_.name) + ": " + text); }
  /// Scale and degrees of freedom of the mean of a reading.
  std::optional<Component> repeatability_of(const Readouts& reading, const Repeatability& r, Scatter& scatter) {
    if (r.kind == Repeatability::Kind::none) return std::nullopt;
    scatter = r.scatter;
    if (r.kind == Repeatability::Kind::readings) {
      if (reading.values.size() < 2) return std::nullopt;
      scatter.degrees_of_freedom = static_cast<double>(reading.values.size()) - 1;
      scatter.s = std::sqrt(sum_of_squares(reading.values) / scatter.degrees_of_freedom);
      if (!(scatter.s > 0))
        note(fmt::format("{} identical indications: their Type A uncertainty is zero", reading.repeats));
    }
    if (!(scatter.s > 0)) return std::nullopt;
    const double scale = scatter.s / std::sqrt(static_cast<double>(reading.repeats));
    Component c;
    c.name = "repeatability";
    // A mean with a (pooled) s of finite degrees of freedom is a t, JCGM 101:2008, 6.4.9.
    if (scatter.degrees_of_freedom > 0)
      c.distribution = {Family::t, {0, scale, scatter.degrees_of_freedom}, nullptr, nullptr};
    else
      c.distribution = {Family::normal, {0, scale}, nullptr, nullptr};
    c.evaluation = r.evaluation;
    if (scatter.degrees_of_freedom > 0) c.degrees_of_freedom = scatter.degrees_of_freedom;
    c.common = r.kind == Repeatability::Kind::declared; // or pooled: one s for all readings
    c.per = {"reading"};
    c.source = r.source;
    return c;
  }

  static std::optional<Component> resolution_of(const std::optional<double>& step) {
    if (!step) return std::nullopt;
    Component c;
    c.name = "resolution";
    c.distribution = {Family::rectangular, {-*step / 2, *step / 2}, nullptr, nullptr};
    c.per = {"reading"};
    c.source = "half a step of the indication either way, one draw per mean";
    return c;
  }

  std::vector<Component> choose(const Readouts& reading, const std::optional<double>& step, const Repeatability& r) {
    Scatter scatter;
    const auto repeatability = repeatability_of(reading, r, scatter);
    auto resolution = resolution_of(step);
    if (resolution) resolution->source = fmt::format("step {}, {}", shown(*step), resolution->source);
    if (!repeatability && !resolution) return {};
    if (!repeatability) {
      if (r.kind == Repeatability::Kind::none)
        unused_scatter(reading, *step);
      else
        note("the resolution is used, because the repeatability is zero");
      return {*resolution};
    }
    const double scale = repeatability->distribution.parameters[1];
    if (!resolution) return warned(*repeatability, reading);
    const double u = *step / (2 * std::sqrt(3.0));
    const bool rounding = u >= scale;
    note(fmt::format("{} used, not {}: step/(2 sqrt 3) = {} is {} than s/sqrt(n) = {} (s = {}, n = {}); s of rounded "
                     "indications already contains the rounding",
                     rounding ? "resolution" : "repeatability", rounding ? "repeatability" : "resolution", shown(u),
                     u > scale   ? "larger"
                     : u < scale ? "smaller"
                                 : "not larger",
                     shown(scale), shown(scatter.s), reading.repeats));
    if (rounding) return {*resolution};
    return warned(*repeatability, reading);
  }

  /// Indications that scatter by more than their resolution, of which nothing is stated.
  void unused_scatter(const Readouts& reading, double step) {
    const double n = static_cast<double>(reading.values.size());
    if (n < 2) return;
    const double s = std::sqrt(sum_of_squares(reading.values) / (n - 1)), u = s / std::sqrt(n);
    if (!(u > step / (2 * std::sqrt(3.0)))) return;
    note(
        fmt::format("{} indications scatter by s = {}, s/sqrt(n) = {}, which is not used: repeatability = \"readings\" "
                    "would use it",
                    reading.values.size(), shown(s), shown(u)));
  }

  /// `own`: u of every reading's mean. Where a column states it, the indications differ in u, and no test is made.
  void note_excess(const std::optional<double>& step, const Repeatability& r, const std::vector<double>& own) {
    DeclaredNoise declared{0, r.scatter, step.value_or(0)};
    if (!own.empty()) {
      if (table_.find("u")->kind == Node::Kind::table) return;
      declared.u = own.front() * std::sqrt(static_cast<double>(readouts_.used.front().repeats));
    }
    if (r.kind == Repeatability::Kind::readings || r.pooled) return;
    if (const std::string text = excess_scatter(readouts_.used, declared, card_); !text.empty()) note(text);
  }

  std::vector<Component> warned(const Component& repeatability, const Readouts& reading) {
    if (repeatability.distribution.family == Family::t && repeatability.degrees_of_freedom <= 2)
      note(fmt::format("{} indications give a t distribution with {} degree{} of freedom, which has no standard "
                       "uncertainty: only quantiles are given",
                       reading.repeats, repeatability.degrees_of_freedom,
                       repeatability.degrees_of_freedom == 1 ? "" : "s"));
    return {repeatability};
  }

  static void need_scope(Table& component) {
    if (!component.has("per"))
      component.add(fmt::format("{} is missing", component.path("per")),
                    "all readings would share one draw, and their mean would keep all of its uncertainty",
                    "write per = \"reading\", or per = [] if they do share it");
  }

  static bool alike(const Entry& a, const Entry& b) {
    return std::ranges::equal(a.components, b.components, [](const Component& x, const Component& y) {
      return x.name == y.name && x.distribution.family == y.distribution.family &&
             x.distribution.parameters == y.distribution.parameters;
    });
  }

  /// u of every reading's mean, SI; empty if it is not stated. A column states it for every indication.
  std::vector<double> own_uncertainties() {
    const Node* const node = table_.find("u");
    if (!node) return {};
    const Dimension width{std::string(card_.si_unit), units::Kind::difference};
    std::vector<double> out;
    if (node->kind != Node::Kind::table) {
      const auto u = table_.width("u", std::string(card_.si_unit));
      for (const Readouts& r : readouts_.used)
        if (u) out.push_back(*u / std::sqrt(static_cast<double>(r.repeats)));
      return out;
    }
    if (!readouts_.file) {
      if (context_.readings_known)
        table_.refuse_key("u", "the readings are not in a data file",
                          "the column belongs to the file that holds the readings", "u = \"0.7 um\"");
      return {};
    }
    const std::size_t problems = context_.problems.size();
    const auto column = NumberColumn::read(table_, "u", *readouts_.file, width);
    for (const Readouts& r : readouts_.used) {
      if (!column) break;
      double squares = 0;
      const auto values = column->values(r.rows, context_.problems);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] && !(*values[i] > 0)) refuse_uncertainty(*column, r.rows[i]);
        squares += values[i].value_or(0) * values[i].value_or(0);
      }
      out.push_back(std::sqrt(squares) / static_cast<double>(r.repeats));
    }
    return context_.problems.size() == problems ? out : std::vector<double>{};
  }

  void refuse_uncertainty(const NumberColumn& column, std::size_t row) {
    const Csv& csv = *readouts_.file->csv;
    const CsvCell& cell = csv.rows[row][static_cast<std::size_t>(csv.find(column.name()))];
    context_.problems.add({csv.at(cell), fmt::format("'{}' is no standard uncertainty", cell.text),
                           fmt::format("column '{}': {}.u must be above 0", column.name(), table_.path()),
                           "leave the reading out by where, or correct it"});
  }

  static Component stated(double u) {
    Component c;
    c.name = "u";
    c.distribution = {Family::normal, {0, u}, nullptr, nullptr};
    c.per = {"reading"};
    c.source = "stated for every indication";
    return c;
  }

  /// Entries are told apart by labels, and by the number of the reading where equal labels have different noise.
  void number_or_merge(std::vector<Entry>& entries) const {
    std::map<Labels, std::size_t> first;
    bool numbered = false;
    for (std::size_t r = 0; r < entries.size() && !numbered; ++r) {
      const auto [known, fresh] = first.try_emplace(entries[r].labels, r);
      numbered = !fresh && !alike(entries[known->second], entries[r]);
    }
    std::vector<Entry> kept;
    for (std::size_t r = 0; r < entries.size(); ++r) {
      if (!numbered && first.at(entries[r].labels) != r) continue;
      kept.push_back(std::move(entries[r]));
      if (numbered)
        kept.back().labels.emplace_back(quantities::reading_label, fmt::format("{}", readouts_.used[r].reading + 1));
    }
    entries = std::move(kept);
  }

  void refuse_shared(const std::vector<Component>& further, const std::vector<Entry>& entries) {
    for (const Component& c : further) {
      const auto scoped = [&](const std::string& name) { return std::ranges::find(c.per, name) != c.per.end(); };
      if (scoped("reading")) continue;
      for (const auto& [label, value] : entries.front().labels) {
        if (scoped(label)) continue;
        table_.add(fmt::format("{}.components: '{}' is shared by readings with different noise", table_.path(), c.name),
                   "they cannot share its draws",
                   "pool their s (repeatability = { pooled = true }), or state an input quantity that all share");
        return;
      }
    }
  }

  Table& table_;
  const VariableCard& card_;
  const IndicationReadouts& readouts_;
  const bool several_;
  Context& context_;
};

} // namespace

std::vector<Key> noise_keys() {
  return {
      {"resolution", shape::reference("width"),
       "step of the display: a rectangular distribution of half a step on either side, with one draw per mean. It says "
       "how "
       "well a reading can be known, not how readings repeat: where no more is stated, tracing estimates that"},
      {"u",
       shape::any_of(
           {shape::reference("width"),
            shape::table({{"column", shape::text(), "column name in the first row of the file", true},
                          {"unit", shape::text(), "unit of the numbers in the column; default: that of [data]"}})}),
       "standard uncertainty of one indication, the same for all or a column of their data file; means of n repeats "
       "have "
       "the root of the sum of squares, over n"},
      repeatability_key(),
      {"components", shape::list(shape::reference("component")),
       "further deviations of the mean of the readings; of several readings each "
       "states its scope `per`: [] is one draw for all of them"},
  };
}

quantities::InputQuantity read_noise(Table& table, const VariableCard& card, const IndicationReadouts& readouts,
                                     bool several, Context& context) {
  return NoiseReader(table, card, readouts, several, context).read();
}

} // namespace gumshoe::scenario
