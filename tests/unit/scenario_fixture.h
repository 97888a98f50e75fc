#pragma once
/// A small catalogue for the tests of the parser, and scenarios written to files on the fly.
#include <cmath>
#include <string>

#include "base/error.h"
#include "folder.h"
#include "scenario/scenario.h"

namespace scenario_fixture {

using namespace gumshoe;

inline constexpr double huge = HUGE_VAL;
inline constexpr double degree = 3.14159265358979323846 / 180;

inline constexpr QuantityCard quantity_cards[] = {
    {"rod_radius", "mm", "m", 5e-3, {0, huge, true, true}, "R_r", "radius"},
    {"rod_length", "mm", "m", 0.15, {0, huge, true, true}, "L_r", "length"},
    {"beam_pitch", "deg", "rad", 0, {-90 * degree, 90 * degree, true, true}, "beta", "pitch"},
    {"trigger_fraction", "1", "1", 0.5, {0, 1, true, true}, "", "share"},
};
inline constexpr VariableCard condition_cards[] = {{"feed", "mm/min", "m/s", 4e-3 / 60, "feed"},
                                                   {"time", "s", "s", 0, "time"}};
inline constexpr VariableCard indication_cards[] = {{"spindle_z", "mm", "m", 0, "height"}};
inline constexpr VariableCard measurand_cards[] = {{"laser_z", "mm", "m", 0, "height"}};
inline constexpr EvaluationCard evaluation_cards[] = {{"full", ""}, {"conventional", ""}};
inline constexpr ModelCard model{
    "rod", "a rod", "", "", quantity_cards, condition_cards, indication_cards, measurand_cards, evaluation_cards, {}};

inline constexpr QuantityCard latency_cards[] = {{"delay", "s", "s", 0, {-1e-2, 1e-2}, "", "delay", Role::amplitude}};
inline constexpr QuantityCard runout_cards[] = {{"x", "um", "m", 0, {-1e-3, 1e-3}, "", "", Role::pair},
                                                {"y", "um", "m", 0, {-1e-3, 1e-3}, "", "", Role::pair}};
constexpr EffectCard effect(std::string_view name, Stage stage, std::span<const QuantityCard> quantities) {
  return {.name = name, .title = "", .stage = stage, .meaning = "", .adds = "", .confused_with = "", .source = "",
          .quantities = quantities};
}
inline constexpr EffectCard latency = effect("trigger_latency", Stage::trigger, latency_cards);
inline constexpr EffectCard runout = effect("rod_runout", Stage::pose, runout_cards);
inline constexpr EffectCard orientation = effect("orientation", Stage::spindle, latency_cards);

inline scenario::Catalogue catalogue() {
  return {{&model}, {&runout, &latency, &orientation}, [](const ModelCard&, const EffectCard& e) {
            return e.stage != Stage::spindle;
          }};
}

using fixture::Folder;

inline const std::string head = "schema = 1\nmodel = { name = \"rod\" }\n";
inline const std::string one_reading = "[indications.spindle_z]\nreadings = [\"-329.932 mm\"]\n";

inline scenario::Scenario read_text(const std::string& text) {
  const Folder folder;
  return scenario::read(folder.write("s.toml", text), catalogue());
}

/// What the parser says of a text, with the file called s.toml; empty if it accepts it.
inline std::string complaint(const std::string& text) {
  const Folder folder;
  try {
    scenario::read(folder.write("s.toml", text), catalogue());
  } catch (const InputError& error) {
    std::string out = error.what();
    for (std::size_t at; (at = out.find(folder.path() + '/')) != std::string::npos;)
      out.erase(at, folder.path().size() + 1);
    return out;
  }
  return {};
}

inline const quantities::InputQuantity& quantity(const scenario::Scenario& s, const std::string& name) {
  for (const auto& q : s.quantities)
    if (q.name == name) return q;
  throw InputError("no quantity " + name);
}

} // namespace scenario_fixture
