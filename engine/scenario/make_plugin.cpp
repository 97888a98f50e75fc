#include <filesystem>

#include "models/plugin/plugin.h"
#include "scenario/external.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {

models::MadeModel make_plugin(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const Node* node = model.require("library", "library = \"libmine.so\"");
  const auto library = model.text("library");
  if (!library) return nullptr;
  context.files.include(*library);
  if (!admit(context, *node, "model.library", *library)) return nullptr;
  try {
    return models::load_plugin((std::filesystem::path(folder) / *library).string(), *library,
                                      {context.problems.file(), node->line, node->column});
  } catch (const InputError& error) {
    context.problems.add(error);
    return nullptr;
  }
}

} // namespace gumshoe::scenario
