#include "tracing/scenario_out/traced_scenario.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "calibration/scenario_text.h"
#include "quantities/cells.h"
#include "quantities/effect_of.h"
#include "tracing/matrix.h"
#include "tracing/scenario_out/corrections.h"

namespace gumshoe::tracing {
namespace {

using calibration::measure_node;
using calibration::member;
using calibration::text_node;
using scenario::find_member;
using scenario::Member;
using scenario::Node;

/// Correlations that nearly determine one another, as those of draws that are one and the same or of sizes that only
/// together are known, come out of a fit with eigenvalues below zero by rounding. A factor of the matrix must exist:
/// coefficients are reduced, all by one factor, until none is below this.
constexpr double least_eigenvalue = 1e-9;

void make_definite(Matrix& correlation) {
  const double least = Eigen::SelfAdjointEigenSolver<Matrix>(correlation, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (least < least_eigenvalue) correlation *= (1 - least_eigenvalue) / (1 - least);
  correlation.diagonal().setOnes();
}

std::set<std::string> names(const quantities::Labels& labels) {
  std::set<std::string> out;
  for (const auto& [label, value] : labels) out.insert(label);
  return out;
}

/// Whether a component of an entry is drawn for just the readings that the shift moves: that is what was found off.
bool replaced(Node& component, const quantities::Labels& entry, const quantities::Labels& shift) {
  std::set<std::string> cell = names(entry);
  if (Node* per = find_member(component, "per")) {
    if (per->kind == Node::Kind::text) cell.insert(per->text);
    for (const Node& item : per->items) cell.insert(item.text);
  }
  return cell == names(shift);
}

/// The other components of the leaf, which stay as declared.
std::vector<Node> kept(Node& leaf, const quantities::Labels& entry, const quantities::Labels& shift) {
  std::vector<Node> all;
  if (Node* components = find_member(leaf, "components")) {
    all = components->items;
  } else if (leaf.kind == Node::Kind::table) {
    Node one = leaf;
    for (const char* key : {"value", "unit", "estimated"}) calibration::erase_member(one, key);
    const bool uncertain =
        std::ranges::any_of(one.members, [](const Member& m) { return m.key != "source" && m.key != "evaluation"; });
    if (uncertain) all.push_back(std::move(one));
  }
  std::erase_if(all, [&](Node& component) { return replaced(component, entry, shift); });
  return all;
}

std::string free_name(const std::vector<Node>& components) {
  const auto taken = [&](const std::string& name) {
    return std::ranges::any_of(components, [&](Node c) {
      const Node* own = find_member(c, "name");
      return own && own->text == name;
    });
  };
  std::string name = "trace";
  for (int i = 2; taken(name); ++i) name = fmt::format("trace_{}", i);
  return name;
}

class Writer {
public:
  Writer(const scenario::Scenario& s, const Trace& t, const std::string& folder)
      : s_(s), t_(t), text_(s, folder),
        origin_(fmt::format("gumshoe trace of {}, {} readings, hash of scenario and data {}",
                            std::filesystem::path(s.file).filename().string(), training(), s.hash)) {}

  std::string write() {
    start_earlier();
    state_since();
    for (const Correction& c : t_.corrections) correct(c);
    for (const Correction& c : t_.noise_effects) correct(c);
    for (std::size_t i = 0; i < t_.estimate.parameters.size(); ++i) parameter(i);
    finish_free();
    finish_unconfirmed();
    for (const KnownDraw& k : t_.known) keep_prior(k.quantity);
    for (const KnownDraw& k : t_.known) known(k);
    finish_released();
    finish_jumping();
    tie();
    for (const Addition& a : t_.additions) add(a);
    return text_.text(origin_);
  }

private:
  std::size_t training() const {
    std::set<std::size_t> readings;
    for (const Row& row : t_.rows)
      if (!row.held_out) readings.insert(row.reading);
    return readings.size();
  }

  /// What was known before these data stands where it did; of other data it is what they start from.
  void start_earlier() {
    Node* trace = find_member(text_.document(), "trace");
    Node* priors = trace ? find_member(*trace, "priors") : nullptr;
    if (!priors) return;
    if (s_.data.empty()) {
      for (const Member& prior : priors->members) text_.quantity(prior.key) = prior.value;
      if (Node* ties = find_member(text_.document(), "correlations"))
        std::erase_if(ties->items, [&](Node& tie) { return ties_one_of(tie, *priors); });
    }
    calibration::erase_member(*trace, "priors");
  }

  static bool ties_one_of(Node& tie, const Node& quantities) {
    const Node* tied = find_member(tie, "quantities");
    return tied && std::ranges::any_of(tied->items, [&](const Node& draw) {
             const std::string quantity = draw.text.substr(0, draw.text.find_first_of("[.:"));
             return std::ranges::find(quantities.members, quantity, &Member::key) != quantities.members.end();
           });
  }

  void keep_prior(const std::string& quantity) {
    Node& priors = member(member(text_.document(), "trace"), "priors");
    if (!find_member(priors, quantity)) priors.members.push_back({quantity, 0, 0, text_.quantity(quantity)});
  }

  /// A declared component as these readings know it, in the place of what was declared.
  void known(const KnownDraw& k) {
    Node& place = text_.entry(k.quantity, k.labels);
    Node own;
    own.members = {
        {"u", 0, 0, measure_node(k.u, k.unit, k.si_unit, true)},
        {"evaluation", 0, 0, text_node("A")},
        {"source", 0, 0, text_node(source("what these readings say of what was declared ([trace] priors)"))}};
    std::string draw = k.quantity;
    if (quantities::Labels labels = k.labels; !labels.empty()) {
      std::ranges::sort(labels); // as draws are named
      draw += "[" + quantities::text_of(labels) + "]";
    }
    Node known;
    for (const char* key : {"estimated", "unit"})
      if (const Node* told = find_member(place, key)) known.members.push_back({key, 0, 0, *told});
    known.members.push_back({"value", 0, 0, measure_node(k.value, k.unit, k.si_unit, false)});
    if (Node* components = find_member(place, "components"); components && !k.name.empty()) {
      Node all = *components;
      own.members.insert(own.members.begin(), {"name", 0, 0, text_node(k.name)});
      all.items[k.component] = std::move(own);
      known.members.push_back({"components", 0, 0, std::move(all)});
      draw += (k.labels.empty() ? "." : ": ") + k.name;
    } else {
      known.members.insert(known.members.end(), own.members.begin(), own.members.end());
    }
    place = std::move(known);
    draws_.push_back(draw);
  }

  std::string source(const std::string& what) const { return what + "; " + origin_; }

  /// The stated effect; its size follows as a parameter.
  void correct(const Correction& c) {
    Node& effect = member(member(text_.document(), "stated_effects"), c.name);
    effect.members = {{"indication", 0, 0, text_node(c.indication)},
                      {"unit", 0, 0, text_node(c.unit)},
                      {"meaning", 0, 0, text_node(c.meaning)},
                      {"source", 0, 0, text_node(source(c.source))}};
    if (c.keys.empty()) {
      effect.members.push_back({"formula", 0, 0, text_node("1")});
      return;
    }
    Node table;
    for (const Correction::Key& key : c.keys) {
      if (key.name == "order") count_readings();
      std::vector<Node> levels;
      for (const double x : key.levels) levels.push_back(measure_node(x, key.unit, key.si_unit, false));
      table.members.push_back({key.name, 0, 0, calibration::list_node(std::move(levels))});
    }
    std::vector<Node> loading;
    for (const double x : c.loading) loading.push_back(calibration::number_node(x));
    table.members.push_back({"loading", 0, 0, calibration::list_node(std::move(loading))});
    if (const double margin = margin_of(c); margin > 0)
      table.members.push_back({"margin", 0, 0, calibration::number_node(margin)});
    if (const auto beyond = before_and_after(c))
      table.members.push_back({"beyond", 0, 0, calibration::number_node(*beyond)});
    effect.members.push_back({"table", 0, 0, std::move(table)});
  }

  /// Other readings count their seconds from the same moment.
  void state_since() {
    for (const auto& [path, earliest] : s_.since) {
      Node* node = &text_.document();
      for (std::size_t at = 0; node && at <= path.size();) {
        const std::size_t end = std::min(path.find('.', at), path.size());
        node = find_member(*node, path.substr(at, end - at));
        at = end + 1;
      }
      if (node && find_member(*node, "clock")) member(*node, "since") = text_node(earliest);
    }
  }

  /// The course of data without times is the number of the reading, which has a name from here on.
  void count_readings() {
    if (!s_.trace.order_name.empty()) return;
    Node& trace = member(text_.document(), "trace");
    Node& columns = member(trace, "columns");
    if (find_member(columns, "order")) return;
    member(member(columns, "order"), "counts") = text_node("readings");
    if (!find_member(trace, "order")) member(trace, "order") = text_node("order");
  }

  void parameter(std::size_t i) {
    const calibration::Parameter& p = t_.estimate.parameters[i];
    const Taken& taken = t_.taken[i];
    const auto& quantity = t_.extended.quantities[p.unknown.quantity];
    const auto& labels = quantity.entries[p.unknown.entry].labels;
    Node& place = text_.entry(quantity.name, labels);
    auto components = kept(place, labels, taken.labels);
    if (taken.block_offset && !released_earlier(quantity.name)) free_.insert(quantity.name);
    if (!components.empty()) declared_as_well_.insert(quantity.name);
    Node own;
    const Node u = measure_node(p.standard_uncertainty, p.unknown.unit, p.unknown.si_unit, true);
    own.members = {
        {"u", 0, 0, u}, {"evaluation", 0, 0, text_node("A")}, {"source", 0, 0, text_node(source(taken.source))}};
    Node known;
    known.members = {{"value", 0, 0, measure_node(p.value, p.unknown.unit, p.unknown.si_unit, false)}};
    std::string draw = p.unknown.name;
    if (!(p.standard_uncertainty > 0)) {
      known.members.push_back(own.members.back());
    } else if (components.empty()) {
      known.members.insert(known.members.end(), own.members.begin(), own.members.end());
    } else {
      const std::string name = free_name(components);
      own.members.insert(own.members.begin(), {"name", 0, 0, text_node(name)});
      components.push_back(std::move(own));
      known.members.push_back({"components", 0, 0, calibration::list_node(std::move(components))});
      draw += (labels.empty() ? "." : ": ") + name;
    }
    place = std::move(known);
    if (p.standard_uncertainty > 0) {
      uncertain_.push_back(i);
      draws_.push_back(draw);
    }
  }

  /// Known now, and free again when these data are traced: offsets of blocks, and sizes of effects, so that a further
  /// round starts where this one ended. A quantity with a value left that the data do not determine stays marked.
  void finish_free() {
    for (const auto& q : t_.extended.quantities)
      if (!quantities::effect_of(q.name).empty() && !q.entries.empty() && fitted(q.name) == q.entries.size())
        free_.insert(q.name);
    if (free_.empty()) return;
    Node& list = member(member(text_.document(), "trace"), "free");
    if (list.kind == Node::Kind::text) list = calibration::list_node({list});
    list.kind = Node::Kind::array;
    for (const std::string& name : free_) {
      if (std::ranges::none_of(list.items, [&](const Node& n) { return n.text == name; }))
        list.items.push_back(text_node(name));
      for (const auto& q : t_.extended.quantities)
        if (q.name == name && fitted(name) == q.entries.size())
          calibration::erase_member(text_.quantity(name), "estimated");
    }
  }

  /// A declared value that was found to be off is fitted again when these data are traced: what was declared of it is
  /// released, and what they say of it is no prior. Other data know it as it was found.
  void finish_released() {
    for (std::size_t i = 0; i < t_.estimate.parameters.size(); ++i) {
      const calibration::Parameter& p = t_.estimate.parameters[i];
      const auto& quantity = t_.extended.quantities[p.unknown.quantity];
      const bool whole = quantity.entries.size() == 1 && quantity.entries[0].labels.empty();
      if (!whole || !quantities::effect_of(quantity.name).empty() || free_.contains(quantity.name) ||
          declared_as_well_.contains(quantity.name) || !(p.standard_uncertainty > 0))
        continue;
      Node estimated;
      estimated.kind = Node::Kind::boolean;
      estimated.boolean = true;
      member(member(member(text_.document(), "trace"), "priors"), quantity.name).members = {
          {"value", 0, 0, measure_node(p.value, p.unknown.unit, p.unknown.si_unit, false)},
          {"estimated", 0, 0, std::move(estimated)}};
    }
  }

  /// No derivative leads to the best of these: tracing these data again seeks them as this trace did.
  void finish_jumping() {
    for (const JumpingSize& j : t_.jumping)
      member(member(member(text_.document(), "trace"), "jumping"), j.quantity) =
          measure_node(j.size, j.unit, j.si_unit, true);
  }

  bool released_earlier(const std::string& name) const {
    return std::ranges::find(s_.trace.priors, name, &quantities::InputQuantity::name) != s_.trace.priors.end();
  }

  /// What the hold-out blocks could not judge is nothing to correct a machine by.
  void finish_unconfirmed() {
    std::set<std::string> found;
    for (const Finding& f : t_.findings)
      for (const SizedQuantity& q : f.quantities)
        if (const std::string effect = quantities::effect_of(q.scenario_name); !effect.empty()) found.insert(effect);
    for (const Correction& c : t_.corrections) found.insert(c.name);
    if (!t_.unconfirmed || found.empty()) return;
    Node& list = member(member(text_.document(), "trace"), "unconfirmed");
    list.kind = Node::Kind::array;
    for (const std::string& name : found)
      if (std::ranges::none_of(list.items, [&](const Node& n) { return n.text == name; }))
        list.items.push_back(text_node(name));
  }

  /// How many entries of a quantity are parameters of the estimate; none if all of them are held exactly.
  std::size_t fitted(const std::string& name) const {
    std::size_t count = 0;
    bool any = quantities::effect_of(name).empty();
    for (std::size_t i = 0; i < t_.estimate.parameters.size(); ++i) {
      const calibration::Parameter& p = t_.estimate.parameters[i];
      if (t_.extended.quantities[p.unknown.quantity].name != name) continue;
      any = any || p.standard_uncertainty > 0 || t_.taken[i].fitted;
      ++count;
    }
    return any ? count : 0;
  }

  void tie() {
    std::vector<std::size_t> tied = uncertain_;
    const std::size_t parameters = t_.estimate.parameters.size(), all = parameters + t_.known.size();
    for (std::size_t k = parameters; k < all; ++k) tied.push_back(k);
    const std::size_t n = tied.size();
    if (n < 2) return;
    const auto& correlation = t_.known.empty() ? t_.estimate.correlation : t_.correlation;
    Matrix matrix(index(n), index(n));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        matrix(index(i), index(j)) = i == j ? 1 : correlation[tied[i] * all + tied[j]];
    make_definite(matrix);
    text_.tie(draws_, {matrix.data(), matrix.data() + matrix.size()}, "pearson", source("estimated together"));
  }

  void add(const Addition& a) {
    const bool noise = quantities::effect_of(a.quantity).empty();
    std::vector<Node> per;
    for (const std::string& label : a.per) per.push_back(text_node(label));
    Node one;
    one.members = {{"u", 0, 0, measure_node(a.u, a.unit, a.si_unit, true)}};
    if (!per.empty())
      one.members.push_back({"per", 0, 0, per.size() == 1 ? per[0] : calibration::list_node(per)});
    one.members.push_back({"evaluation", 0, 0, text_node("A")});
    one.members.push_back({"source", 0, 0, text_node(source(a.source))});
    if (std::isfinite(a.degrees_of_freedom))
      one.members.insert(one.members.begin() + 1,
                         {"degrees_of_freedom", 0, 0, calibration::number_node(std::round(a.degrees_of_freedom))});
    if (!noise) {
      one.members.insert(one.members.begin(), {"value", 0, 0, measure_node(a.value, a.unit, a.si_unit, false)});
      if (!(a.u > 0)) one.members = {one.members.front(), one.members.back()};
      text_.entry(a.quantity, a.labels) = std::move(one);
      return;
    }
    Node& components = member(member(member(text_.document(), "indications"), a.quantity), "components");
    components.kind = Node::Kind::array;
    one.members.insert(one.members.begin(), {"name", 0, 0, text_node(free_name(components.items))});
    components.items.push_back(std::move(one));
  }

  const scenario::Scenario& s_;
  const Trace& t_;
  calibration::ScenarioText text_;
  std::string origin_;
  std::set<std::string> free_;
  std::set<std::string> declared_as_well_; ///< quantities of which a declared uncertainty is left
  std::vector<std::size_t> uncertain_;     ///< parameters
  std::vector<std::string> draws_;
};

} // namespace

std::string traced_scenario(const scenario::Scenario& scenario, const Trace& trace, const std::string& folder) {
  if (trace.estimate.parameters.empty() && trace.additions.empty()) return {};
  return Writer(scenario, trace, folder).write();
}

} // namespace gumshoe::tracing
