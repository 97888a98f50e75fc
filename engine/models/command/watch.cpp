#include "models/command/watch.h"

#include <array>
#include <csignal>

#include <fcntl.h>
#include <unistd.h>

namespace gumshoe::models {
namespace {

/// The watching process: hears of groups that begin (pid) and end (-pid), until its pipe ends with the other process.
[[noreturn]] void watch(int pipe) {
  setsid(); // what ends our group does not end it
  dup2(pipe, 0);
  close_range(1, ~0U, 0);
  std::array<pid_t, 1024> groups{};
  for (pid_t said = 0; read(0, &said, sizeof said) == sizeof said;) {
    const pid_t wanted = said > 0 ? 0 : -said, becomes = said > 0 ? said : 0;
    for (pid_t& group : groups)
      if (group == wanted) {
        group = becomes;
        break;
      }
  }
  for (const pid_t group : groups)
    if (group > 0) kill(-group, SIGKILL);
  _exit(0);
}

/// The end of its pipe; -1 if there is none, and then nobody watches.
int watcher() {
  static const int pipe = [] {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return -1;
    const pid_t child = fork();
    if (child == 0) watch(ends[0]);
    close(ends[0]);
    if (child > 0) return ends[1];
    close(ends[1]);
    return -1;
  }();
  return pipe;
}

void tell(pid_t said) {
  if (watcher() >= 0 && write(watcher(), &said, sizeof said) < 0) {
  } // it has gone
}

} // namespace

Watch::Watch(pid_t pid) : pid_(pid) { tell(pid_); }
Watch::~Watch() { tell(-pid_); }

} // namespace gumshoe::models
