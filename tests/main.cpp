#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

/// HDF5 never frees a file that it could not flush; the tests of full disks leave some behind.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\nleak:^H5"; } // shared or static
