#include "cli/command.h"

#include <cmath>
#include <filesystem>

#include "effects/effect.h"

namespace gumshoe::cli {

scenario::Catalogue catalogue() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  return c;
}

std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                           const std::string& example) {
  std::size_t used = 0;
  double x = -1;
  try {
    x = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(x >= static_cast<double>(least)) || x > 1e15 || x != std::floor(x))
    throw InputError(option + ": '" + text + "' is not a whole number of at least " + std::to_string(least) +
                         (x > 1e15 ? " and at most 1e15" : ""),
                     "", "write a number such as " + example);
  return static_cast<std::uint64_t>(x);
}

void require_different(const std::string& out, const std::string& in) {
  std::error_code ignored;
  if (std::filesystem::equivalent(out, in, ignored))
    throw OutputError(out + ": this is the file that is read", "it would be overwritten",
                      "choose another name for the output");
}

std::string default_output(const std::string& scenario, const std::string& ending) {
  const std::string name = std::filesystem::path(scenario).stem().string();
  std::filesystem::create_directories("results");
  // `trace` writes NAME.traced.h5 next to NAME.traced.toml, which may be run.
  return "results/" + name + (ending == ".h5" && name.ends_with(".traced") ? ".run" : "") + ending;
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace the output, even if another scenario or another program wrote it");
}

} // namespace gumshoe::cli
