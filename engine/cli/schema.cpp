#include <iostream>

#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "scenario/schema.h"

namespace gumshoe::cli {

void add_schema(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("schema", "prints the JSON Schema of scenarios, for editors");
  command->callback([&action] {
    action = [] {
      std::cout << nlohmann::ordered_json::parse(scenario::schema(catalogue())).dump(2) << '\n';
      return ExitCode::done;
    };
  });
}

} // namespace gumshoe::cli
