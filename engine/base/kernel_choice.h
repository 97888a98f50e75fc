#pragma once
/// Kernels are compiled once per instruction set of the build (GUMSHOE_ISAS), as symbols gumshoe_NAME_sse2, .._avx2 and
/// .._avx512.
///   GUMSHOE_DECLARE_KERNELS(type, name)  declares the symbols,
///   GUMSHOE_KERNELS(name, set)           points to those of a set, which must be available,
///   GUMSHOE_BEST_KERNELS(name)           points to the best for the processor at hand.
#include <type_traits>

#include "base/instruction_set.h"

namespace gumshoe {

/// Null stands for a set that the build lacks.
template <class T>
const T* kernels_of(InstructionSet set, const T* sse2, std::type_identity_t<const T*> avx2,
                    std::type_identity_t<const T*> avx512) {
  return set == InstructionSet::avx512 ? avx512 : set == InstructionSet::avx2 ? avx2 : sse2;
}

} // namespace gumshoe

#define GUMSHOE_DECLARE_KERNELS(type, name)                                                                            \
  extern "C" {                                                                                                         \
  extern const type gumshoe_##name##_sse2, gumshoe_##name##_avx2, gumshoe_##name##_avx512;                             \
  }

#ifdef GUMSHOE_HAS_AVX2
#define GUMSHOE_AVX2_KERNELS(name) &gumshoe_##name##_avx2
#else
#define GUMSHOE_AVX2_KERNELS(name) nullptr
#endif
#ifdef GUMSHOE_HAS_AVX512
#define GUMSHOE_AVX512_KERNELS(name) &gumshoe_##name##_avx512
#else
#define GUMSHOE_AVX512_KERNELS(name) nullptr
#endif

#define GUMSHOE_KERNELS(name, set)                                                                                     \
  gumshoe::kernels_of(set, &gumshoe_##name##_sse2, GUMSHOE_AVX2_KERNELS(name), GUMSHOE_AVX512_KERNELS(name))
#define GUMSHOE_BEST_KERNELS(name) GUMSHOE_KERNELS(name, gumshoe::best_instruction_set())
