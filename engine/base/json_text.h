#pragma once
/// JSON as it is printed and written.
#include <string>

#include <nlohmann/json.hpp>

namespace gumshoe {

/// Indented by two. Names of files and labels need not be UTF-8: of what is not, a sign in its place is shown.
template <class Json> std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

} // namespace gumshoe
