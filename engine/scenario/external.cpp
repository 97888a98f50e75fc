#include "scenario/external.h"

#include <fmt/format.h>

namespace gumshoe::scenario {

bool admit(Context& context, const Node& node, const std::string& key, const std::string& code) {
  External& external = context.external;
  external.code = fmt::format("{} {} {:016x}", key, code, context.files.hash(0));
  if (external.expected && *external.expected != external.code) {
    context.problems.add(node, fmt::format("{}: '{}' has changed since this result was made", key, code),
                         "it is not the code that the result was made with", "restore it, or run the scenario again");
    return false;
  }
  if (external.trusted) return true;
  context.problems.add(node, fmt::format("{}: '{}' is not started", key, code), "the scenario belongs to another user",
                       "use --allow-external if you trust it");
  return false;
}

} // namespace gumshoe::scenario
