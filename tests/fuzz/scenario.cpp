/// Scenarios: the text, then the files that it names, each after a line `==== NAME`. All that `gumshoe check --explain`
/// does. A quantity may be from the result made.h5, which is there.
#include "scenario/scenario.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "effects/effect.h"
#include "fuzz/harness.h"
#include "made/full_results.h"
#include "models/model.h"
#include "propagation/experiment.h"
#include "store/earlier_output.h"

namespace gumshoe::fuzz {
namespace {

scenario::Catalogue catalogue() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  c.read_output = &store::read_output;
  c.trusts = [](const std::string&) { return false; }; // no input starts a program or loads a library
  return c;
}

/// A file's own name, in the folder of the scenario.
bool plain(const std::string& name) {
  return !name.empty() && name.size() < 100 && name.front() != '.' &&
         std::ranges::all_of(name, [](unsigned char c) { return c > ' ' && c < 0x7f && c != '/'; });
}

} // namespace

void scenario(std::string_view input) {
  static const scenario::Catalogue known = catalogue();
  static const std::string place = "scenario.toml", result = "made.h5";
  static const bool made = (made::write_full_result(folder() + '/' + result), true);
  (void)made;
  auto files = parts(input);
  files.front().first = place;
  if (files.size() > 8) return;
  for (const auto& [name, text] : files)
    if (!plain(name) || name == result || (name == place && &name != &files.front().first)) return;
  struct Written {
    std::vector<std::string> paths;
    ~Written() {
      for (const std::string& path : paths) std::filesystem::remove(path);
    }
  } written;
  for (const auto& [name, text] : files) written.paths.push_back(write(name, text));
  const scenario::Scenario s = scenario::read(written.paths.front(), known);
  const propagation::Experiment experiment(s);
  scenario::explain(s, known);
  scenario::notes_of_a_run(s);
}

} // namespace gumshoe::fuzz
