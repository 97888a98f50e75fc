#pragma once
/// Which copy of the kernels to run: they are compiled once per instruction set and give equal bits.
#include <string_view>

namespace gumshoe {

enum class InstructionSet { sse2, avx2, avx512 };

/// The widest set that this build contains and this processor has. The environment variable
/// GUMSHOE_ISA=sse2|avx2|avx512 lowers it (for tests). Fixed at the first call.
/// Throws InputError if GUMSHOE_ISA names none of them.
InstructionSet best_instruction_set();

/// Whether this build contains the set and this processor has it.
bool available(InstructionSet set);

const char* name(InstructionSet set);

} // namespace gumshoe
