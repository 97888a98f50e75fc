/// `gumshoe fields`: what stands in a result file, for its README and the report's generator. Not listed by --help.
#include <iostream>
#include <memory>

#include "cli/command.h"
#include "store/layout.h"

namespace gumshoe::cli {

void add_fields(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("fields", "the fields of a result file")->group("");
  const auto format = std::make_shared<std::string>("markdown");
  command->add_option("--format", *format, "markdown or json")->check(CLI::IsMember({"markdown", "json"}));
  command->callback([=, &action] {
    action = [=] {
      std::cout << (*format == "json" ? store::csv_columns_json() : store::layout_markdown());
      return ExitCode::done;
    };
  });
}

} // namespace gumshoe::cli
