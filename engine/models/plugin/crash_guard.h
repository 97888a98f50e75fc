#pragma once
/// Says whose fault it was when a plugin crashes. A process cannot be trusted to go on after a memory error, so the
/// guard reports and ends it; the result file is then as after a kill: good up to its marker.
#include <cfenv>
#include <cstdint>
#include <string>

namespace gumshoe::models {

/// While it lives, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT and exit() on this thread end the program with exit code 2
/// and "START at samples FIRST to LAST (the signal ...)". It also restores the floating-point environment, which a
/// library built with -ffast-math changes when it is loaded. Do not nest.
class CrashGuard {
public:
  /// `start` must outlive the guard: "s.toml:3:11: error: model.library: 'libmine.so' crashed".
  CrashGuard(const std::string& start, std::uint64_t first_sample, std::size_t samples);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

private:
  std::fenv_t environment_;
};

} // namespace gumshoe::models
