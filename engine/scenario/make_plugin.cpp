#include <filesystem>

#include "models/plugin/plugin.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {

models::MadeModel make_plugin(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const Node* node = model.require("library", "library = \"libmine.so\"");
  const auto library = model.text("library");
  if (!library) return nullptr;
  try {
    auto plugin = models::load_plugin((std::filesystem::path(folder) / *library).string(), *library,
                                      {context.problems.file(), node->line, node->column});
    context.files.include(*library);
    return plugin;
  } catch (const InputError& error) {
    context.problems.add(error);
    return nullptr;
  }
}

} // namespace gumshoe::scenario
