#pragma once
/// Opening a plugin's library, and its card.
#include <string>

#include "base/error.h"
#include "models/made_card.h"
#include "models/plugin/gumshoe_plugin.h"

namespace gumshoe::models {

/// Start of the messages about a plugin.
struct PluginPlace {
  std::string name; ///< name of the library in the scenario
  Location where;
  /// For CrashGuard: "s.toml:3:11: error: model.library: 'libmine.so' crashed".
  std::string crashed() const;
  [[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& remedy) const;
};

/// The description that the library exports, of our version, with functions in it.
const gumshoe_model& open_library(const std::string& path, const PluginPlace& place);

/// The card's texts; throws InputError with every contradiction.
CardTexts card_of(const gumshoe_model& model, const PluginPlace& place);

} // namespace gumshoe::models
