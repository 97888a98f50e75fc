#include "models/plugin/library.h"

#include <cmath>
#include <filesystem>
#include <set>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/units.h"
#include "models/model.h"
#include "models/plugin/crash_guard.h"
#include "models/plugin/diverted_output.h"

namespace gumshoe::models {

void PluginPlace::refuse(const std::string& what, const std::string& why, const std::string& remedy) const {
  throw InputError({{where, fmt::format("model.library: '{}' {}", name, what), why, remedy}});
}

std::string PluginPlace::crashed() const {
  std::string start = format({where, fmt::format("model.library: '{}' crashed", name), "", ""});
  start.pop_back(); // the guard ends the sentence
  return start;
}

const gumshoe_model& open_library(const std::string& path, const PluginPlace& place) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    place.refuse("does not exist", "looked for " + path, "build it, or write its path relative to the scenario's folder");
  if (std::filesystem::is_directory(path, ignored)) place.refuse("is a directory", "", "name the library in it");
  const std::string start = place.crashed();
  // Without a slash the loader would search its own folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  const DivertedOutput diverted;
  const CrashGuard guard(start, unnumbered, 0); // a library runs code when it is loaded
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    place.refuse("cannot be loaded as a library", why ? why : "", "is it a shared library for this computer?");
  }
  void* const symbol = dlsym(library, "gumshoe_plugin");
  if (!symbol)
    place.refuse("is not a plugin", "it does not export a function gumshoe_plugin",
                 "in C++, export it within extern \"C\" (see engine/models/plugin/gumshoe_plugin.h)");
  const gumshoe_model* const model = reinterpret_cast<const gumshoe_model* (*)()>(symbol)();
  if (!model) place.refuse("describes no model", "gumshoe_plugin() returns null", "");
  if (model->abi != GUMSHOE_PLUGIN_ABI)
    place.refuse(fmt::format("has version {} of the plugin interface", model->abi),
                 fmt::format("this program uses version {}", GUMSHOE_PLUGIN_ABI),
                 "rebuild it with this program's gumshoe_plugin.h");
  if (!model->evaluate) place.refuse("has no evaluate", "its pointer is null", "");
  return *model;
}

namespace {

bool is_name(const char* text) {
  if (!text || !*text || (*text >= '0' && *text <= '9')) return false;
  for (const char* c = text; *c; ++c)
    if (!((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') || *c == '_')) return false;
  return true;
}

std::string text_of(const char* text) { return text ? text : ""; }

class CardReader {
public:
  explicit CardReader(const PluginPlace& place) : place_(place) {}

  std::vector<Symbol> read(const gumshoe_variable* variables, std::size_t n, const char* kind,
                           std::set<std::string>& names) {
    std::vector<Symbol> out;
    if (n > 10000 || (n > 0 && !variables)) {
      problem(fmt::format("its {} are missing", kind), fmt::format("{} of them at null", n));
      return out;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const gumshoe_variable& v = variables[i];
      if (!is_name(v.name)) {
        problem(fmt::format("number {} of its {} has no valid name", i + 1, kind),
                "letters, digits and _, not beginning with a digit");
        continue;
      }
      const std::string name = v.name;
      if (!names.insert(name).second) problem(fmt::format("the name '{}' is used twice", name), "");
      try {
        out.push_back(symbol(v, name));
      } catch (const InputError& error) {
        problem(fmt::format("{}: {}", name, error.problems().front().what), error.problems().front().why);
      }
    }
    return out;
  }

  void problem(const std::string& what, const std::string& why) {
    problems_.push_back({place_.where, fmt::format("model.library: '{}': {}", place_.name, what), why,
                         "correct the plugin's description"});
  }
  void raise() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

private:
  static Symbol symbol(const gumshoe_variable& v, const std::string& name) {
    Symbol s{name, v.unit && *v.unit ? v.unit : "1", "", text_of(v.meaning)};
    s.si_unit = units::si_unit_of(s.unit);
    if (!std::isfinite(v.default_value)) throw InputError("its default is not finite");
    s.default_value = units::to_si(v.default_value, s.unit, s.si_unit);
    if (v.low == v.high) return s;
    if (!(v.low < v.high)) throw InputError("its lower limit exceeds its upper limit", fmt::format("{} and {}", v.low, v.high));
    if (!(v.default_value >= v.low && v.default_value <= v.high))
      throw InputError("its default is outside its limits",
                       fmt::format("{} is not in [{}, {}]", v.default_value, v.low, v.high));
    if (std::isfinite(v.low)) s.limits.low = units::to_si(v.low, s.unit, s.si_unit);
    if (std::isfinite(v.high)) s.limits.high = units::to_si(v.high, s.unit, s.si_unit);
    return s;
  }

  const PluginPlace& place_;
  std::vector<Problem> problems_;
};

} // namespace

CardTexts card_of(const gumshoe_model& m, const PluginPlace& place) {
  const std::string start = place.crashed();
  const CrashGuard guard(start, unnumbered, 0); // pointers in it may lead nowhere
  CardReader reader(place);
  CardTexts card;
  if (!is_name(m.name)) reader.problem("it has no valid name", "letters, digits and _, not beginning with a digit");
  card.name = is_name(m.name) ? m.name : "plugin";
  card.title = m.title ? m.title : card.name;
  card.summary = text_of(m.summary);
  card.source = text_of(m.source);
  std::set<std::string> inputs, outputs; // a measurand may be called like the quantity that holds its true value
  card.quantities = reader.read(m.quantities, m.quantity_count, "quantities", inputs);
  card.conditions = reader.read(m.conditions, m.condition_count, "conditions", inputs);
  card.indications = reader.read(m.indications, m.indication_count, "indications", inputs);
  card.measurands = reader.read(m.measurands, m.measurand_count, "measurands", outputs);
  if (m.measurand_count == 0) reader.problem("it has no measurands", "nothing can be evaluated");
  reader.raise();
  return card;
}

} // namespace gumshoe::models
