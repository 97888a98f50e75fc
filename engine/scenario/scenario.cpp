#include "scenario/scenario.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/hash.h"
#include "base/text_file.h"
#include "base/version.h"
#include "quantities/effect_of.h"
#include "scenario/analysis.h"
#include "scenario/choose.h"
#include "scenario/correlations.h"
#include "scenario/expected.h"
#include "scenario/machine.h"
#include "scenario/made_models.h"
#include "scenario/options.h"
#include "scenario/plan.h"
#include "scenario/quantity.h"
#include "scenario/readings.h"
#include "scenario/readouts_file.h"
#include "scenario/schema.h"
#include "scenario/set_points.h"
#include "scenario/stated_effects.h"
#include "scenario/trace.h"
#include "scenario/volume.h"

namespace gumshoe::scenario {
namespace {

using quantities::InputQuantity;

constexpr std::size_t largest_scenario = std::size_t{4} << 20;

class ScenarioReader {
public:
  ScenarioReader(const std::string& path, const Catalogue& catalogue, const Overrides& overrides)
      : catalogue_(catalogue), problems_(path), files_(path, overrides.data, out_.notes),
        earlier_(std::filesystem::path(path).parent_path().string(), catalogue.read_output),
        context_{problems_, files_, out_.notes, earlier_,
                 {},        {},     true,       {!catalogue.trusts || catalogue.trusts(path), overrides.external, {}}} {
    out_.file = path;
    out_.data = overrides.data;
    out_.text = read_text_file(path, largest_scenario);
  }

  Scenario read() {
    document_ = parse_document(out_.text, out_.file);
    if (document_.members.empty())
      throw InputError({{{out_.file, 0, 0}, "the scenario is empty", "", "write schema = 1 and a [model] table"}});
    Table top(document_, "", problems_);
    top.declare(sections());
    check_schema(top);
    refuse_misplaced(top);
    top.refuse_undeclared();
    const std::size_t unknown_sections = problems_.size();
    expand_set_points(document_, files_, problems_);
    earlier_.state_units(document_, problems_);
    if (problems_.size() > unknown_sections) problems_.raise();
    out_.title = top.text("title").value_or("");
    if (!out_.title.empty() && !out_.data.empty()) out_.title += fmt::format(" ({})", out_.data);
    context_.data = top.find("data");
    context_.trace = top.find("trace");
    const std::size_t before = problems_.size();
    check_data(top, context_);
    if (problems_.size() > before) { // formulas have no dimension without the units of the data
      top.members();
      problems_.raise();
    }
    const ModelCard* model = read_model(top);
    if (!model) { // nothing below has a meaning without its model
      top.members();
      problems_.raise();
    }
    const ModelCard &own = *model, seen = evaluated_card(own, out_.evaluation);
    model = &seen;
    Readings readings = read_readings(top, *model, out_.method, context_);
    if (problems_.size() == before)
      refuse_unread_data(top, context_); // else what is wrong with an indication tells why
    out_.readings = std::move(readings.readings);
    out_.spreads = std::move(readings.spreads);
    read_quantities(top, *model);
    read_effects(top, *model);
    out_.quantities.insert(out_.quantities.end(), readings.noise.begin(), readings.noise.end());
    if (auto trace = top.table("trace"))
      out_.trace = read_trace(*trace, {own, out_.readings, readings.readouts}, context_);
    if (auto stated = top.table("stated_effects")) read_stated(*stated, own);
    if (!out_.trace.free.empty()) check_free(top, own);
    if (!out_.trace.unconfirmed.empty()) check_unconfirmed(top);
    if (out_.trace.stated) read_jumping(top);
    out_.correlations = read_correlations(top, out_.quantities, context_);
    for (auto& tied : tie_results(out_.quantities, document_, context_)) out_.correlations.push_back(std::move(tied));
    if (auto run = top.table("run")) out_.run = read_run(*run);
    if (auto analysis = top.table("analysis")) {
      out_.analysis = read_analysis(*analysis, {*model, out_.quantities}, context_);
      if (!out_.correlations.empty()) refuse_one_at_a_time(*analysis);
      if (out_.analysis.sensitivity.shapley > 0) note_conditional_draws();
    }
    out_.expected = read_expected(top, *model, context_);
    if (auto estimate = top.table("estimate")) out_.estimate = read_estimate(*estimate);
    if (auto choose = top.table("choose")) {
      out_.choose = read_choose(*choose, {own, out_, catalogue_}, context_);
      for (const StatedEffect& e : out_.stated_effects)
        if (e.freed && e.of_columns)
          choose->refuse(fmt::format("stated_effects.{} reads columns", e.name),
                         "their values at other settings are unknown", "use conditions only");
    }
    if (auto plan = top.table("plan"))
      out_.plan = std::make_shared<const Plan>(
          read_plan(*plan, {own, out_, catalogue_, readings.readouts, top.find("indications")}, context_));
    if (auto volume = top.table("volume")) read_volume(*volume, top, problems_);
    top.refuse_unknown();
    problems_.raise();
    out_.since = files_.since();
    out_.hash = fmt::format("{:016x}", earlier_.hash(files_.hash(hash64(out_.text))));
    return std::move(out_);
  }

private:
  /// Shapley effects need some quantities given others, which samples of an earlier run do not hold.
  void note_conditional_draws() {
    for (const quantities::Correlation& c : out_.correlations)
      if (!c.together.empty())
        context_.note(fmt::format("Shapley effects: {} are drawn given one another as by a Gaussian copula with the "
                                  "correlation of their samples. Where they depend on each other in another way, the "
                                  "effects are approximate",
                                  fmt::join(c.quantities, ", ")));
  }

  /// A key of one section that stands outside of it, unless its name resembles a section's more.
  void refuse_misplaced(Table& top) {
    std::vector<std::string> names;
    for (const Key& section : sections()) names.push_back(section.name);
    for (const Member& m : document_.members) {
      if (std::ranges::find(names, m.key) != names.end() || did_you_mean(m.key, names).starts_with("did you")) continue;
      const std::vector<std::string> homes = sections_with(m.key);
      if (homes.empty()) continue;
      const bool list = m.value.kind == Node::Kind::array, inner = m.value.kind == Node::Kind::table;
      std::vector<std::string> paths;
      for (const std::string& home : homes)
        paths.push_back(list    ? fmt::format("[[{}.{}]]", home, m.key)
                        : inner ? fmt::format("[{}.{}]", home, m.key)
                                : home);
      top.refuse_stray(m, fmt::format("it belongs to [{}]", fmt::join(homes, "] or [")),
                       list || inner ? fmt::format("write {}", fmt::join(paths, " or "))
                                     : fmt::format("move it under [{}]", fmt::join(paths, "] or [")));
    }
  }

  /// What a newer format calls unknown here would only mislead.
  void check_schema(Table& top) {
    if (!top.require("schema", "schema = 1")) return;
    const auto stated = top.number("schema");
    if (!stated || *stated == 1) return;
    const bool newer = *stated > 1;
    top.refuse_key("schema", fmt::format("this program does not know version {} of the format", *stated),
                   fmt::format("Gumshoe {} reads version 1", version),
                   newer ? "use a newer Gumshoe, or write schema = 1 if the scenario is of version 1"
                         : "write schema = 1");
    if (newer) problems_.raise();
  }

  /// Studies in which one input moves and the others stay: correlated inputs do not.
  void refuse_one_at_a_time(Table& analysis) {
    const SensitivityOptions& wanted = out_.analysis.sensitivity;
    if (wanted.sobol == 0 && wanted.morris == 0) return;
    Table table(*analysis.find("sensitivity"), analysis.path("sensitivity"), problems_);
    const char *correlated = "the inputs are correlated", *remedy = "sensitivity = { shapley = 4096 }";
    if (wanted.sobol > 0)
      table.refuse_key("sobol", correlated, "Sobol' indices need independent inputs, Shapley effects do not", remedy);
    if (wanted.morris > 0)
      table.refuse_key("morris", correlated, "an elementary effect moves one input alone, Shapley effects do not",
                       remedy);
  }

  void check_free(Table& top, const ModelCard& model) {
    std::vector<std::string> names;
    for (const quantities::InputQuantity& q : out_.quantities)
      if (std::ranges::none_of(model.indications, [&](const auto& i) { return i.name == q.name; }))
        names.push_back(q.name);
    Table trace(*top.find("trace"), "trace", problems_);
    for (const std::string& name : out_.trace.free)
      if (std::ranges::find(names, name) == names.end())
        trace.refuse_key("free", fmt::format("'{}' is not a quantity of the scenario", name), "",
                         did_you_mean(name, names));
  }

  void check_unconfirmed(Table& top) {
    std::vector<std::string> effects;
    for (const quantities::InputQuantity& q : out_.quantities)
      if (const std::string effect = quantities::effect_of(q.name); !effect.empty()) effects.push_back(effect);
    Table trace(*top.find("trace"), "trace", problems_);
    for (const std::string& name : out_.trace.unconfirmed)
      if (std::ranges::find(effects, name) == effects.end())
        trace.refuse_key("unconfirmed", fmt::format("'{}' is no effect with a size", name), "",
                         did_you_mean(name, effects));
  }

  void read_jumping(Table& top) {
    Table trace(*top.find("trace"), "trace", problems_);
    auto table = trace.table("jumping");
    if (!table) return;
    for (const quantities::InputQuantity& q : out_.quantities)
      if (const auto size = table->width(q.name, q.si_unit)) out_.trace.jumping.emplace_back(q.name, *size);
    table->refuse_unknown();
  }

  const ModelCard* read_model(Table& top) {
    if (!top.require("model", "[model] name = \"...\"")) return nullptr;
    auto table = top.table("model");
    if (!table) return nullptr;
    table->declare(model_keys());
    const auto index = table->require("name") ? table->choice("name", model_names(catalogue_.models)) : std::nullopt;
    if (const auto method = table->choice("method", {"propagation", "virtual_experiment"}))
      out_.method = static_cast<Method>(*method);
    const ModelCard* model = nullptr;
    if (index && *index < catalogue_.models.size()) {
      model = catalogue_.models[*index];
      if (const models::Model* row = models::find(model->name); row && row->on_machine && top.find("machine"))
        if (const auto machine = read_machine(top, context_.problems)) {
          std::string why;
          if ((out_.made = row->on_machine(*machine, why))) model = out_.made->card;
          if (!out_.made) problems_.add(*top.find("machine"), "machine: " + why, "");
        }
    } else if (index) {
      const std::string folder = std::filesystem::path(out_.file).parent_path().string();
      out_.made = made_models()[*index - catalogue_.models.size()].make({*table, top, folder, context_});
      if (!out_.made) { // nothing below has a meaning without its model
        table->refuse_unknown();
        problems_.raise();
      }
      model = out_.made->card;
      out_.external = context_.external.code;
    }
    const auto evaluations = model ? names_of(model->evaluations) : std::vector<std::string>{};
    if (model) out_.model = model->name;
    if (!evaluations.empty()) out_.evaluation = evaluations.front();
    if (!model)
      table->find("evaluation");
    else if (const auto e = table->choice("evaluation", evaluations))
      out_.evaluation = evaluations[*e];
    table->refuse_unknown();
    return model;
  }

  void read_quantities(Table& top, const ModelCard& model) {
    auto table = top.table("quantities");
    for (const QuantityCard& card : model.quantities) {
      const std::string name(card.name);
      const Node* node = table ? table->find(name) : nullptr;
      out_.quantities.push_back(node ? read_quantity(*node, "quantities." + name, card, name, context_)
                                     : default_quantity(card, name));
    }
    if (table) table->refuse_unknown();
    if (context_.own_quantities) note_assumed_values();
  }

  /// A correction of zero may be meant; a value that was forgotten is not.
  void note_assumed_values() {
    const auto& all = context_.without_value;
    if (all.empty()) return;
    std::vector<std::string> names, values;
    for (const auto& [quantity, value] : all) names.push_back(quantity), values.push_back(value);
    context_.note(fmt::format("{} {} no value: {} taken as {}", fmt::join(names, ", "), all.size() > 1 ? "have" : "has",
                              all.size() > 1 ? "their estimates are" : "its estimate is", fmt::join(values, ", ")));
  }

  void read_effects(Table& top, const ModelCard& model) {
    auto table = top.table("effects");
    if (!table) return;
    for (const EffectCard* effect : catalogue_.effects) {
      const std::string name(effect->name);
      const bool applies = !catalogue_.applies || catalogue_.applies(model, *effect);
      if (!applies && !find_member(table->node(), name)) continue; // nor is it what was meant by another name
      auto own = table->table(name);
      if (!own) continue;
      if (!applies) {
        own->refuse(fmt::format("{} cannot carry it", model.name),
                    fmt::format("it has no stage '{}'", gumshoe::name(effect->stage)));
        continue;
      }
      bool any = false;
      std::vector<InputQuantity> freed;
      for (const QuantityCard& card : effect->quantities) {
        const std::string key(card.name), full = name + '.' + key;
        const Node* node = own->find(key);
        any |= node != nullptr;
        freed.push_back(node ? read_quantity(*node, "effects." + full, card, full, context_)
                             : default_quantity(card, full));
      }
      own->refuse_unknown();
      if (any) out_.quantities.insert(out_.quantities.end(), freed.begin(), freed.end());
    }
    refuse_names_of_sizes(*table, model);
    table->refuse_unknown();
  }

  /// Refuses the name of a size where that of its effect is expected.
  void refuse_names_of_sizes(Table& table, const ModelCard& model) {
    for (const Member& m : table.node().members) {
      std::vector<std::string_view> effects;
      for (const EffectCard* effect : catalogue_.effects)
        if ((!catalogue_.applies || catalogue_.applies(model, *effect)) &&
            std::ranges::any_of(effect->quantities, [&](const QuantityCard& q) { return q.name == m.key; }))
          effects.push_back(effect->name);
      const bool known = std::ranges::any_of(catalogue_.effects, [&](const auto* e) { return e->name == m.key; });
      if (!known && !effects.empty())
        table.refuse_stray(m, fmt::format("it is a quantity of {}", fmt::join(effects, ", ")),
                           fmt::format("write {} under [effects.{}]", m.key, effects.front()));
    }
  }

  void read_stated(Table& table, const ModelCard& model) {
    std::vector<std::string> effects;
    for (const EffectCard* effect : catalogue_.effects) effects.emplace_back(effect->name);
    StatedEffects stated = read_stated_effects(table, {model, out_.readings, out_.trace.columns, effects}, context_);
    out_.stated_effects = std::move(stated.effects);
    out_.quantities.insert(out_.quantities.end(), stated.sizes.begin(), stated.sizes.end());
  }

  const Catalogue& catalogue_;
  Scenario out_;
  Problems problems_;
  DataFiles files_;
  EarlierResults earlier_;
  Context context_;
  Node document_;
};

} // namespace

ModelCard evaluated_card(const ModelCard& model, const std::string& evaluation) {
  ModelCard card = model;
  for (const EvaluationCard& e : model.evaluations)
    if (e.name == evaluation && e.joint()) card.measurands = e.measurands;
  return card;
}

std::vector<std::string> notes_of_a_run(const Scenario& s) {
  std::vector<std::string> notes = s.notes;
  for (const quantities::InputQuantity& q : s.quantities)
    if (q.estimated && std::ranges::all_of(q.entries, [](const auto& entry) { return entry.components.empty(); }))
      notes.push_back(q.name + ": estimated, without a distribution; treated as exact at its start value until gumshoe "
                               "estimate has fitted it");
  return notes;
}

void predict_readings(Scenario& s) {
  s.method = Method::prediction;
  AnalysisOptions kept;
  kept.coverage_probability = s.analysis.coverage_probability;
  kept.validation_digits = s.analysis.validation_digits;
  kept.sensitivity = s.analysis.sensitivity;
  s.analysis = std::move(kept);
}

Scenario read(const std::string& path, const Catalogue& catalogue, const Overrides& overrides) {
  return ScenarioReader(path, catalogue, overrides).read();
}

} // namespace gumshoe::scenario
