#include "base/interrupt.h"

#include <csignal>
#include <cstring>

#include <sys/time.h>
#include <unistd.h>

namespace gumshoe {

namespace {

std::atomic<bool> asked{false};
std::atomic<const char*> rest{"Nothing was written. The same command starts from the beginning."};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<const char*>::is_always_lock_free);

/// Ends the process now; the samples of a run lie in its file, which is readable at any moment.
void end_now() {
  const auto write_text = [](const char* text) { return write(2, text, std::strlen(text)) >= 0; };
  if (write_text("\ninterrupted. ") && write_text(rest.load())) write_text("\n");
  _exit(130);
}

void on_alarm(int) { end_now(); }

void on_signal(int) {
  if (asked.exchange(true)) end_now();
  const itimerval patience{{0, 0}, {1, 800'000}};
  setitimer(ITIMER_REAL, &patience, nullptr);
}

} // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_alarm;
  sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = on_signal; // without SA_RESTART: a wait for a child ends, too
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction earlier = {};
  if (sigaction(SIGHUP, nullptr, &earlier) == 0 && earlier.sa_handler != SIG_IGN) // nohup
    sigaction(SIGHUP, &action, nullptr);
}

void when_interrupted(const char* sentence) { rest = sentence; }
const char* said_when_interrupted() { return rest; }
const std::atomic<bool>& interrupted() { return asked; }

void stop_if_interrupted() {
  if (asked) throw Interrupted();
}

} // namespace gumshoe
