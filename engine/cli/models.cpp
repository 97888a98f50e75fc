/// `gumshoe models` and `gumshoe effects`: the cards.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/units.h"
#include "cli/command.h"
#include "cli/effects_markdown.h"
#include "effects/effect.h"
#include "scenario/made_models.h"

namespace gumshoe::cli {

namespace {

using Json = nlohmann::ordered_json;

double shown(double value, const QuantityCard& q) {
  return units::from_si(value, std::string(q.unit), std::string(q.si_unit));
}

/// With its note: "0.1-5 ms: 0.07 um/ms at 4 mm/min".
std::string typical(const QuantityCard& q) {
  return typical_text(q) + (q.typical.note.empty() ? "" : fmt::format(": {}", q.typical.note));
}

Json number_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string role_name(Role role) {
  switch (role) {
  case Role::amplitude:
    return "amplitude";
  case Role::shape:
    return "shape";
  case Role::pair:
    return "pair";
  default:
    return "plain";
  }
}

Json to_json(const QuantityCard& q, const char* default_name) {
  return {{"name", q.name},
          {"unit", q.unit},
          {"si_unit", q.si_unit},
          {default_name, shown(q.default_value, q)},
          {"low", number_or_null(shown(q.limits.low, q))},
          {"low_open", q.limits.low_open},
          {"high", number_or_null(shown(q.limits.high, q))},
          {"high_open", q.limits.high_open},
          {"symbol", q.symbol},
          {"meaning", q.meaning},
          {"role", role_name(q.role)},
          {"typical", typical(q)}};
}
template <class Cards> Json variables(const Cards& cards) {
  Json list = Json::array();
  for (const VariableCard& v : cards)
    list.push_back({{"name", v.name}, {"unit", v.unit}, {"si_unit", v.si_unit}, {"meaning", v.meaning}});
  return list;
}
Json text_or_null(std::string_view text) { return text.empty() ? Json(nullptr) : Json(text); }
Json to_json(const ModelCard& card) {
  Json j{{"name", card.name}, {"title", card.title}, {"summary", card.summary}, {"source", card.source}};
  for (const QuantityCard& q : card.quantities) j["quantities"].push_back(to_json(q, "default"));
  j["conditions"] = variables(card.conditions);
  j["indications"] = variables(card.indications);
  j["measurands"] = variables(card.measurands);
  for (const EvaluationCard& e : card.evaluations)
    j["evaluations"].push_back({{"name", e.name},
                                {"meaning", e.meaning},
                                {"joint", e.joint()},
                                {"measurands", variables(e.measurands)},
                                {"time_per_reading", text_or_null(e.time_per_reading)},
                                {"time_once", text_or_null(e.time_once)}});
  j["time_constants"] = Json::array();
  for (const QuantityCard& q : card.timing) j["time_constants"].push_back(to_json(q, "default"));
  for (const EffectCard* e : effects::cards())
    if (effects::applies(card, *e)) j["effects"].push_back(e->name);
  return j;
}
Json to_json(const EffectCard& card) {
  Json j{
      {"name", card.name},       {"title", card.title}, {"stage", name(card.stage)},           {"iso_230", card.iso230},
      {"meaning", card.meaning}, {"adds", card.adds},   {"confused_with", card.confused_with}, {"source", card.source}};
  for (const QuantityCard& q : card.quantities) j["quantities"].push_back(to_json(q, "null_value"));
  return j;
}

void print(const QuantityCard& q, const char* default_word) {
  std::cout << fmt::format("  {:<24} {:<8} {} {:g}; limits {}{:g}, {:g}{}{}\n", q.name, q.unit, default_word,
                           shown(q.default_value, q), q.limits.low_open ? "(" : "[", shown(q.limits.low, q),
                           shown(q.limits.high, q), q.limits.high_open ? ")" : "]",
                           q.typical.high == 0 ? "" : fmt::format("; typical {}", typical(q)));
  std::cout << fmt::format("  {:<24} {}{}\n", "", q.symbol.empty() ? "" : fmt::format("{}: ", q.symbol), q.meaning);
}
/// The formulas that `gumshoe choose` minimises, each with the evaluations that have it, and their constants.
void print_time(const ModelCard& card) {
  std::vector<std::pair<std::string, std::vector<std::string_view>>> formulas;
  for (const EvaluationCard& e : card.evaluations) {
    std::string text;
    if (!e.time_per_reading.empty()) text += fmt::format("    per_reading = {}\n", e.time_per_reading);
    if (!e.time_once.empty()) text += fmt::format("    once = {}\n", e.time_once);
    if (text.empty()) continue;
    auto at = std::ranges::find(formulas, text, [](const auto& f) { return f.first; });
    if (at == formulas.end()) at = formulas.insert(at, {text, {}});
    at->second.push_back(e.name);
  }
  if (formulas.empty()) return;
  std::cout << "\nmeasuring time (gumshoe choose): once, and per_reading for every readout of every reading\n";
  for (const auto& [text, evaluations] : formulas)
    std::cout << fmt::format("  {}\n{}", fmt::join(evaluations, ", "), text);
  if (card.timing.empty()) return;
  std::cout << "\nconstants of the measuring time ([choose.time] changes them)\n";
  for (const QuantityCard& q : card.timing) print(q, "default");
}
void print(const ModelCard& card) {
  std::cout << fmt::format("{}: {}\n\n{}\n\nquantities\n", card.name, card.title, card.summary);
  for (const QuantityCard& q : card.quantities) print(q, "default");
  const auto list = [](const char* title, const auto& variables) {
    std::cout << '\n' << title << '\n';
    for (const VariableCard& v : variables) std::cout << fmt::format("  {:<24} {:<8} {}\n", v.name, v.unit, v.meaning);
  };
  list("conditions", card.conditions);
  list("indications", card.indications);
  list("measurands", card.measurands);
  std::cout << "\nevaluations\n";
  for (const EvaluationCard& e : card.evaluations) {
    std::cout << fmt::format("  {:<24} {}{}\n", e.name, e.meaning, e.joint() ? "; from all readings together:" : "");
    for (const VariableCard& v : e.measurands)
      std::cout << fmt::format("    {:<22} {:<8} {}\n", v.name, v.unit, v.meaning);
  }
  print_time(card);
  std::cout << "\neffects that act here\n ";
  for (const EffectCard* e : effects::cards())
    if (effects::applies(card, *e)) std::cout << ' ' << e->name;
  std::cout << fmt::format("\n\nsource: {}\n", card.source);
}
void print(const EffectCard& card) {
  std::cout << fmt::format("{}: {} (stage {}{})\n\n{}\nAdds: {}.\nConfused with: {}.\n\nquantities\n", card.name,
                           card.title, name(card.stage), card.iso230.empty() ? "" : fmt::format(", {}", card.iso230),
                           card.meaning, card.adds, card.confused_with);
  for (const QuantityCard& q : card.quantities) print(q, "null");
  std::cout << fmt::format("\nsource: {}\n", card.source);
}

/// Both commands: all cards a line each, or one in full.
template <class Cards>
ExitCode show(const Cards& cards, const std::string& word, const std::string& name, const std::string& format) {
  std::vector<std::string> names;
  Json all = Json::array();
  for (const auto* card : cards) {
    names.emplace_back(card->name);
    if (name.empty()) {
      if (format == "json")
        all.push_back(to_json(*card));
      else
        std::cout << fmt::format("{:<26} {}\n", card->name, card->title);
    } else if (card->name == name) {
      if (format == "json")
        std::cout << json_text(to_json(*card)) << '\n';
      else
        print(*card);
      return ExitCode::done;
    }
  }
  if (!name.empty()) {
    const std::string meant = nearest(name, names);
    throw InputError("unknown " + word + " '" + name + "'", "", meant.empty() ? "" : "did you mean '" + meant + "'?");
  }
  if (format == "json") std::cout << json_text(all) << '\n';
  return ExitCode::done;
}

struct ModelsOptions {
  std::string name, format = "text";
};

template <class Body>
void add(CLI::App& app, const char* name, const char* help, const std::vector<std::string>& formats, Action& action,
         Body body) {
  auto* command = app.add_subcommand(name, help);
  const auto o = std::make_shared<ModelsOptions>();
  command->add_option("name", o->name, "one of them, in full");
  command->add_option("--format", o->format, fmt::format("{}", fmt::join(formats, " or ")))
      ->check(CLI::IsMember(formats));
  command->callback([=, &action] { action = [=] { return body(*o); }; });
}

} // namespace

void add_models(CLI::App& app, Action& action) {
  add(app, "models", "lists the models, or one model's card: quantities, units, defaults, limits, meaning, source",
      {"text", "json"}, action, [](const ModelsOptions& o) {
        const auto made = scenario::made_models();
        if (std::ranges::find(made, o.name, &scenario::MadeModelRow::name) != made.end())
          throw InputError("'" + o.name + "' has no card", "the scenario defines its quantities",
                           "see engine/models/" + o.name + "/README.md");
        const ExitCode code = show(catalogue().models, "model", o.name, o.format);
        if (o.name.empty() && o.format == "text") {
          std::cout << "A scenario can also state its model (see scenarios/README.md):\n";
          for (const auto& row : made) std::cout << fmt::format("  {:<15} {}\n", row.name, row.what);
        }
        return code;
      });
}
void add_effects(CLI::App& app, Action& action) {
  add(app, "effects", "lists the effects, or one effect's card", {"text", "json", "markdown"}, action,
      [](const ModelsOptions& o) {
        if (o.format != "markdown") return show(effects::cards(), "effect", o.name, o.format);
        if (!o.name.empty()) throw InputError("markdown is a table of all effects", "", "leave the name out");
        std::cout << effects_markdown(catalogue().models, effects::cards());
        return ExitCode::done;
      });
}

} // namespace gumshoe::cli
