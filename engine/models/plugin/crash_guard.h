#pragma once
/// Reports the cause when a plugin crashes. A process cannot be trusted after a memory error; the guard therefore ends
/// it. The result file is then as after a kill: valid up to its marker.
#include <cfenv>
#include <cstdint>
#include <string>

namespace gumshoe::models {

/// In its lifetime, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT and exit() on this thread end the program with exit code 2
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
