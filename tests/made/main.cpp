/// Writes a made-up result in which every study has something to say: gumshoe_made_result FILE.
#include <exception>
#include <iostream>

#include "made/full_results.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    gumshoe::made::write_full_result(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
