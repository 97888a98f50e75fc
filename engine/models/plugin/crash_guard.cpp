#include "models/plugin/crash_guard.h"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "models/model.h"

namespace gumshoe::models {
namespace {

struct Call {
  const char* start = nullptr; ///< null: no plugin is running on this thread
  std::size_t length = 0;
  std::uint64_t first = 0, samples = 0;
};
thread_local Call current;

struct Caught {
  int signal;
  const char* words;
};
constexpr Caught caught[] = {{SIGSEGV, "SIGSEGV: invalid memory address, or stack overflow"},
                             {SIGBUS, "SIGBUS: invalid memory address"},
                             {SIGFPE, "SIGFPE: integer division by zero"},
                             {SIGILL, "SIGILL: instruction not available on this processor"},
                             {SIGABRT, "SIGABRT: it called abort()"}};
struct sigaction before[std::size(caught)];

// Only what is safe in a signal handler from here on.

void say(const char* text, std::size_t length) {
  while (length > 0) {
    const ssize_t n = write(2, text, length);
    if (n <= 0) return;
    text += n;
    length -= static_cast<std::size_t>(n);
  }
}
void say(const char* text) { say(text, std::strlen(text)); }
void say(std::uint64_t number) {
  char digits[20];
  std::size_t at = sizeof digits;
  do digits[--at] = static_cast<char>('0' + number % 10);
  while (number /= 10);
  say(digits + at, sizeof digits - at);
}

[[noreturn]] void report(const char* why) {
  say(current.start, current.length);
  if (current.first == unnumbered) {
    say(" outside the run");
  } else {
    say(" at samples ");
    say(current.first);
    say(" to ");
    say(current.first + current.samples - 1);
  }
  say(" (");
  say(why);
  say("; samples already in the result file are kept). Correct the library.\n");
  _exit(static_cast<int>(ExitCode::bad_input));
}

void on_signal(int number) {
  for (std::size_t i = 0; i < std::size(caught); ++i) {
    if (caught[i].signal != number) continue;
    if (current.start) report(caught[i].words);
    sigaction(number, &before[i], nullptr); // not a plugin's fault: as if we were not here
    if (number == SIGABRT) raise(number);
    return; // the faulting instruction runs again
  }
}

void on_exit() {
  if (current.start) report("it called exit()");
}

/// A handler needs a stack of its own when the thread's is full.
struct SignalStack {
  SignalStack() : memory(std::size_t{64} << 10) {
    const stack_t stack{memory.data(), 0, memory.size()};
    sigaltstack(&stack, nullptr);
  }
  ~SignalStack() {
    stack_t off{};
    off.ss_flags = SS_DISABLE;
    sigaltstack(&off, nullptr);
  }
  std::vector<char> memory;
};

void install() {
  static std::once_flag once;
  std::call_once(once, [] {
    for (std::size_t i = 0; i < std::size(caught); ++i) {
      struct sigaction action {};
      action.sa_handler = on_signal;
      action.sa_flags = SA_ONSTACK;
      sigemptyset(&action.sa_mask);
      sigaction(caught[i].signal, &action, &before[i]);
    }
    std::atexit(on_exit);
  });
  static thread_local const SignalStack stack;
}

} // namespace

CrashGuard::CrashGuard(const std::string& start, std::uint64_t first_sample, std::size_t samples) {
  install();
  std::fegetenv(&environment_);
  current.length = start.size();
  current.first = first_sample;
  current.samples = samples;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  current.start = start.c_str();
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

CrashGuard::~CrashGuard() {
  std::atomic_signal_fence(std::memory_order_seq_cst);
  current.start = nullptr;
  std::fesetenv(&environment_);
}

} // namespace gumshoe::models
