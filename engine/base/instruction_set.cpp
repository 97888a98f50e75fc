#include "base/instruction_set.h"

#include <cstdlib>
#include <string>

#include "base/error.h"

namespace gumshoe {
namespace {

constexpr InstructionSet all_sets[] = {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512};

InstructionSet choose() {
  InstructionSet limit = InstructionSet::avx512;
  if (const char* wish = std::getenv("GUMSHOE_ISA"); wish && *wish) {
    bool known = false;
    for (const InstructionSet set : all_sets)
      if (std::string_view(wish) == name(set)) limit = set, known = true;
    if (!known)
      throw InputError("GUMSHOE_ISA: '" + std::string(wish) + "' is not an instruction set", "", "use sse2, avx2 or avx512");
  }
  InstructionSet best = InstructionSet::sse2;
  for (const InstructionSet set : all_sets)
    if (set <= limit && available(set)) best = set;
  return best;
}

} // namespace

InstructionSet best_instruction_set() {
  static const InstructionSet best = choose();
  return best;
}

bool available(InstructionSet set) {
  switch (set) {
  case InstructionSet::sse2:
    return true;
  case InstructionSet::avx2:
#ifdef GUMSHOE_HAS_AVX2
    return __builtin_cpu_supports("avx2");
#else
    return false;
#endif
  case InstructionSet::avx512:
#ifdef GUMSHOE_HAS_AVX512
    return __builtin_cpu_supports("avx512f");
#else
    return false;
#endif
  }
  return false;
}

const char* name(InstructionSet set) {
  return set == InstructionSet::sse2 ? "sse2" : set == InstructionSet::avx2 ? "avx2" : "avx512";
}

} // namespace gumshoe
