/// Writes a made-up result in which every study has something to say, or prints it as `gumshoe run` would:
/// gumshoe_made_result FILE | --text | --csv | --json; a made-up trace: --trace NAME FILE | --text | --json.
#include <exception>
#include <iostream>
#include <string>

#include "cli/print.h"
#include "cli/print_trace.h"
#include "made/full_results.h"
#include "made/traces.h"
#include "tracing/findings/verdict_json.h"

namespace {

using namespace gumshoe;

void result(const std::string& word) {
  if (word == "--text")
    cli::print_text(made::full_results(), "made_up.h5");
  else if (word == "--csv")
    cli::print_csv(made::full_results());
  else if (word == "--json")
    cli::print_json(made::full_results(), "made_up.h5");
  else
    made::write_full_result(word);
}

void trace(const std::string& name, const std::string& word) {
  const made::Traced made = made::trace(name);
  if (word == "--text")
    cli::print_trace(made.trace, made.scenario.title, {"made_up.traced.h5"}, "");
  else if (word == "--json")
    std::cout << tracing::verdict_json(made.trace) << '\n';
  else
    made::write_trace(name, word);
}

} // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 4 && std::string(argv[1]) == "--trace")
      trace(argv[2], argv[3]);
    else if (argc == 2)
      result(argv[1]);
    else
      return 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
