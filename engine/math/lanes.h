#pragma once
/// SIMD lanes. The only door to xsimd. Kernel sources are compiled once per instruction set
/// (engine/cmake/instruction_sets.cmake) and see here the lanes of their own set.
#include <cmath>
#include <cstddef>

#include <xsimd/xsimd.hpp>

#ifndef GUMSHOE_ISA
#define GUMSHOE_ISA sse2
#endif
#define GUMSHOE_CONCAT_(a, b) a##b
#define GUMSHOE_CONCAT(a, b) GUMSHOE_CONCAT_(a, b)
/// GUMSHOE_KERNEL(gumshoe_draw_) -> gumshoe_draw_avx2: the one symbol that stays visible per set.
#define GUMSHOE_KERNEL(prefix) GUMSHOE_CONCAT(prefix, GUMSHOE_ISA)

namespace gumshoe {

namespace isa {
using sse2 = xsimd::sse2;
using avx2 = xsimd::avx2;
using avx512 = xsimd::avx512f;
} // namespace isa

template <class Arch> using LanesOf = xsimd::batch<double, Arch>;

/// The lanes of the instruction set this source is compiled for.
using Lanes = LanesOf<isa::GUMSHOE_ISA>;

} // namespace gumshoe
