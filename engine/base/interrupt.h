#pragma once
/// SIGINT, SIGTERM and, but under nohup, SIGHUP (a terminal that is closed) end every command: where work can stop it
/// stops, and after two seconds, or at the second signal, the process ends whatever runs in it (a plugin that never
/// returns).
#include <atomic>
#include <exception>

namespace gumshoe {

/// Thrown where work notices that it is to stop. Exit code 130.
class Interrupted : public std::exception {
public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// From here on these signals are caught. Further calls change nothing.
void catch_interrupts();

/// What remains of the work, as one sentence or two; said after "interrupted.". A literal: signal handlers read it.
void when_interrupted(const char* sentence);
const char* said_when_interrupted();

/// True after the first signal.
const std::atomic<bool>& interrupted();

/// Throws Interrupted after the first signal.
void stop_if_interrupted();

} // namespace gumshoe
