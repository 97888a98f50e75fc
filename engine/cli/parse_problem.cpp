#include <algorithm>
#include <cctype>

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
    for (const auto* option : app.get_subcommand(words[0])->get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
      for (const std::string& name : option->get_snames()) options.push_back("-" + name);
    }
    for (std::string word : words) {
      const bool is_short = word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1]));
      word = is_short ? word.substr(0, 2) : word.substr(0, word.find('='));
      if ((is_short || (word.starts_with("--") && word.size() > 2)) &&
          std::ranges::find(options, word) == options.end())
        return guess("unknown option '" + word + "' of gumshoe " + words[0], is_short ? "" : nearest(word, options),
                     "gumshoe " + words[0] + " --help lists the options");
    }
  }
  return {{}, error.what(), command_known ? "gumshoe " + words[0] + " --help lists the options" : "--help lists the options", ""};
}

void refuse_empty_words(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (std::ranges::find(option->results(), "") != option->results().end())
      throw InputError(option->get_name() + ": the text is empty", "as of a variable of the shell that is not set",
                       "give a text, or leave the option out");
}

} // namespace gumshoe::cli
