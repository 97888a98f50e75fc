#pragma once
/// Picks a model's kernels for the processor at hand.
///   GUMSHOE_DECLARE_KERNELS(rod_gauging)  declares the symbols,
///   GUMSHOE_BEST_KERNELS(rod_gauging)     is the best of them.
#include "base/instruction_set.h"
#include "models/model.h"

#define GUMSHOE_DECLARE_KERNELS(model)                                                                                 \
  extern "C" {                                                                                                         \
  extern const gumshoe::models::Kernels gumshoe_##model##_sse2, gumshoe_##model##_avx2, gumshoe_##model##_avx512;      \
  }

#ifdef GUMSHOE_HAS_AVX2
#define GUMSHOE_BEST_KERNELS(model)                                                                                    \
  (best_instruction_set() == InstructionSet::avx512 ? &gumshoe_##model##_avx512                                        \
   : best_instruction_set() == InstructionSet::avx2 ? &gumshoe_##model##_avx2                                          \
                                                    : &gumshoe_##model##_sse2)
#else
#define GUMSHOE_BEST_KERNELS(model) (&gumshoe_##model##_sse2)
#endif
