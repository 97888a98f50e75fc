#include <iostream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "cli/command.h"
#include "scenario/schema.h"

namespace gumshoe::cli {
namespace {

using Json = nlohmann::ordered_json;

/// "0 to 1", "from 2", "huber, cauchy" or "": what the value may be; limits beyond 1e9 are only a guard.
std::string limits(const Json& key) {
  std::string out;
  for (const Json& word : key.value("enum", Json::array())) out += (out.empty() ? "" : ", ") + word.get<std::string>();
  if (key.contains("minimum") && key["maximum"] > 1e9) return fmt::format("from {}", key["minimum"].dump());
  if (key.contains("minimum")) return fmt::format("{} to {}", key["minimum"].dump(), key["maximum"].dump());
  if (key.contains("exclusiveMinimum"))
    return fmt::format("between {} and {}", key["exclusiveMinimum"].dump(), key["exclusiveMaximum"].dump());
  return out;
}

/// The plain options of a section, "run.adaptive", as a Markdown table.
void print_options(const Json& schema, const std::string& section) {
  const Json* at = &schema;
  std::stringstream path(section);
  for (std::string name; std::getline(path, name, '.');) {
    const auto found = at->find("properties");
    if (found == at->end() || !found->contains(name))
      throw InputError("schema: there is no section '" + section + "' of plain options");
    at = &(*found)[name];
  }
  std::cout << "| key | default | values | meaning |\n|---|---|---|---|\n";
  for (const auto& [name, key] : at->at("properties").items()) {
    if (!key.contains("default")) continue;
    const Json& usual = key["default"];
    std::cout << fmt::format("| `{}` | {} | {} | {} |\n", name,
                             usual.is_string() ? usual.get<std::string>() : usual.dump(), limits(key),
                             key.value("description", ""));
  }
}

} // namespace

void add_schema(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("schema", "prints the JSON Schema of scenarios, for editors");
  const auto section = std::make_shared<std::string>();
  command->add_option("--options", *section, "a section: print its plain options as a Markdown table instead");
  command->callback([=, &action] {
    action = [=] {
      const Json schema = Json::parse(scenario::schema(catalogue()));
      if (section->empty())
        std::cout << json_text(schema) << '\n';
      else
        print_options(schema, *section);
      return ExitCode::done;
    };
  });
}

} // namespace gumshoe::cli
