/// Writes a made-up result in which every study has something to say, or prints it as `gumshoe run` would:
/// gumshoe_made_result FILE | --text | --csv | --json.
#include <exception>
#include <iostream>
#include <string>

#include "cli/print.h"
#include "made/full_results.h"

int main(int argc, char** argv) {
  using namespace gumshoe;
  if (argc != 2) return 2;
  const std::string word = argv[1];
  try {
    if (word == "--text")
      cli::print_text(made::full_results(), "made_up.h5");
    else if (word == "--csv" || word == "--json")
      cli::print_table(made::full_results(), word == "--json");
    else
      made::write_full_result(word);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
