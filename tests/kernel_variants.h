#pragma once
/// The kernels of every instruction set, for tests that compare them: all give the same bits.
///   GUMSHOE_VARIANTS(KernelTable, name) declares name_variants(), which lists the tables of type KernelTable that the
/// build has and the processor runs, the narrowest set first. At global scope.
#include <vector>

#include "base/instruction_set.h"

namespace gumshoe::tests {

template <class Kernels> struct Variant {
  InstructionSet set;
  const Kernels* kernels;
};

template <class Kernels>
std::vector<Variant<Kernels>> variants_of(const Kernels* sse2, const Kernels* avx2, const Kernels* avx512) {
  std::vector<Variant<Kernels>> all{{InstructionSet::sse2, sse2}};
  if (avx2 && available(InstructionSet::avx2)) all.push_back({InstructionSet::avx2, avx2});
  if (avx512 && available(InstructionSet::avx512)) all.push_back({InstructionSet::avx512, avx512});
  return all;
}

} // namespace gumshoe::tests

// Weak: a build may have one instruction set alone.
#define GUMSHOE_VARIANTS(Kernels, name)                                                                                \
  extern "C" {                                                                                                         \
  extern const Kernels gumshoe_##name##_sse2;                                                                          \
  extern const Kernels gumshoe_##name##_avx2 __attribute__((weak));                                                    \
  extern const Kernels gumshoe_##name##_avx512 __attribute__((weak));                                                  \
  }                                                                                                                    \
  inline std::vector<gumshoe::tests::Variant<Kernels>> name##_variants() {                                             \
    return gumshoe::tests::variants_of(&gumshoe_##name##_sse2, &gumshoe_##name##_avx2, &gumshoe_##name##_avx512);      \
  }
