/// The entry point of libFuzzer: one program for each harness, which CMake names by GUMSHOE_HARNESS.
#include <cstddef>
#include <cstdint>

#include "fuzz/harness.h"

/// What is made once, such as the table of units, is made before the time of inputs is taken.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  gumshoe::fuzz::feed(gumshoe::fuzz::GUMSHOE_HARNESS, {});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gumshoe::fuzz::feed(gumshoe::fuzz::GUMSHOE_HARNESS, {reinterpret_cast<const char*>(data), size});
  return 0;
}
