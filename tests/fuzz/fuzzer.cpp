/// The entry point of libFuzzer: one program for each harness, which CMake names by GUMSHOE_HARNESS.
#include <cstddef>
#include <cstdint>

#include "fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gumshoe::fuzz::feed(gumshoe::fuzz::GUMSHOE_HARNESS, {reinterpret_cast<const char*>(data), size});
  return 0;
}
