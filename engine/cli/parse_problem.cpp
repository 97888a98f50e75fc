#include <algorithm>

#include "cli/command.h"

namespace gumshoe::cli {

Problem parse_problem(const CLI::App& app, const std::vector<std::string>& words, const CLI::ParseError& error) {
  const auto guess = [](const std::string& what, const std::string& meant, const std::string& otherwise) {
    return Problem{{}, what, meant.empty() ? otherwise : "", meant.empty() ? "" : "did you mean '" + meant + "'?"};
  };
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands({})) names.push_back(command->get_name());
  const bool command_known = !words.empty() && std::ranges::find(names, words[0]) != names.end();
  if (!words.empty() && !words[0].starts_with('-') && !command_known)
    return guess("unknown command '" + words[0] + "'", nearest(words[0], names), "gumshoe --help lists them");
  if (command_known) {
    std::vector<std::string> options;
    for (const auto* option : app.get_subcommand(words[0])->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    for (std::string word : words) {
      word = word.substr(0, word.find('='));
      if (word.starts_with("--") && word.size() > 2 && std::ranges::find(options, word) == options.end())
        return guess("unknown option '" + word + "' of gumshoe " + words[0], nearest(word, options),
                     "gumshoe " + words[0] + " --help lists the options");
    }
  }
  return {{}, error.what(), command_known ? "gumshoe " + words[0] + " --help lists the options" : "--help lists the options", ""};
}

} // namespace gumshoe::cli
