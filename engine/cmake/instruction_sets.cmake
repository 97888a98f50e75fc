# Compiles kernel sources once per instruction set and links all copies into one library.
#
# Inline functions and templates are weak symbols, and the linker keeps one copy of each: without
# care an old processor may get the AVX-512 copy of a shared helper. So each set's objects are
# joined into one relocatable object in which only the symbols gumshoe_* stay global; those carry
# the set's name (GUMSHOE_ISA_NAME in math/lanes.h).
#
#   gumshoe_add_kernels(library source...)
set(GUMSHOE_ISA_FLAGS_sse2 -msse2)
set(GUMSHOE_ISA_FLAGS_avx2 -mavx2)
# GCC 12 calls a register of its own AVX-512 headers uninitialised.
set(GUMSHOE_ISA_FLAGS_avx512 -mavx512f -Wno-uninitialized)
if(GUMSHOE_SANITIZE)
  set(GUMSHOE_ISAS sse2) # the sanitizers' own symbols do not survive being made local
else()
  set(GUMSHOE_ISAS sse2 avx2 avx512 CACHE STRING "instruction sets of the kernels; one alone builds faster")
endif()

function(gumshoe_add_kernels library)
  foreach(isa ${GUMSHOE_ISAS})
    set(objects ${library}_${isa})
    add_library(${objects} OBJECT ${ARGN})
    target_compile_options(${objects} PRIVATE ${GUMSHOE_ISA_FLAGS_${isa}} $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
    target_compile_definitions(${objects} PRIVATE GUMSHOE_ISA=${isa})
    target_include_directories(${objects} PRIVATE $<TARGET_PROPERTY:${library},INCLUDE_DIRECTORIES>)
    string(TOUPPER ${isa} upper)
    target_compile_definitions(${library} PRIVATE GUMSHOE_HAS_${upper})
    if(GUMSHOE_SANITIZE)
      target_sources(${library} PRIVATE $<TARGET_OBJECTS:${objects}>)
    else()
      set(joined ${CMAKE_CURRENT_BINARY_DIR}/${objects}.o)
      add_custom_command(
        OUTPUT ${joined}
        COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${joined}.tmp $<TARGET_OBJECTS:${objects}>
        COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=gumshoe_* ${joined}.tmp ${joined}
        DEPENDS ${objects} $<TARGET_OBJECTS:${objects}>
        COMMAND_EXPAND_LISTS VERBATIM)
      target_sources(${library} PRIVATE ${joined})
      set_source_files_properties(${joined} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
    endif()
  endforeach()
endfunction()
