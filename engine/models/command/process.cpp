#include "models/command/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace gumshoe::models {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t most_errors = 4096;

class Descriptor {
public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  int number() const { return number_; }
  bool open() const { return number_ >= 0; }

private:
  int number_;
};

struct Pipe {
  Descriptor read, write;
  bool make() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return false; // closed in every other program that another thread starts
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
    return true;
  }
};

/// Starts the program; errno if it cannot.
int start(const std::vector<std::string>& words, const std::string& folder, const Pipe& in, const Pipe& out,
          const Pipe& errors, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.read.number(), 0);
  posix_spawn_file_actions_adddup2(&actions, out.write.number(), 1);
  posix_spawn_file_actions_adddup2(&actions, errors.write.number(), 2);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  for (const int s : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) sigaddset(&usual, s);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error = posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

/// The running program; killed with all it started, and waited for, when we leave early.
class Child {
public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() {
    if (pid_ > 0) end();
  }
  void end() {
    kill(-pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
  }
  /// True once it has ended by itself.
  bool ended(int& status) {
    const pid_t got = waitpid(pid_, &status, WNOHANG);
    if (got == pid_) {
      kill(-pid_, SIGKILL); // what it left running
      pid_ = -1;
    }
    return got != 0;
  }

private:
  pid_t pid_;
};

/// Reads what there is; false at the end.
bool take(Descriptor& from, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t n = read(from.number(), buffer.data(), buffer.size());
  if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return true;
  return n > 0;
}

} // namespace

ProcessRun run_process(const std::vector<std::string>& words, const std::string& folder, const std::string& input,
                       double seconds, std::size_t most_output) {
  std::signal(SIGPIPE, SIG_IGN); // a program that does not read its input is no reason to die
  ProcessRun run;
  Pipe in, out, errors;
  if (!in.make() || !out.make() || !errors.make()) {
    run.code = errno;
    return run;
  }
  pid_t pid = 0;
  run.code = start(words, folder, in, out, errors, pid);
  if (run.code != 0) return run;
  Child child(pid);
  in.read.close();
  out.write.close();
  errors.write.close();
  fcntl(in.write.number(), F_SETFL, O_NONBLOCK);
  if (input.empty()) in.write.close();

  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const auto left = [&] {
    return std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  };
  std::size_t written = 0;
  while (out.read.open() || errors.read.open()) {
    if (left() < 0) {
      run.end = ProcessRun::End::timed_out;
      return run;
    }
    pollfd watched[3] = {
        {in.write.number(), POLLOUT, 0}, {out.read.number(), POLLIN, 0}, {errors.read.number(), POLLIN, 0}};
    if (poll(watched, 3, static_cast<int>(std::min<long long>(left() + 1, 60'000))) <= 0) continue;
    if (watched[0].revents != 0) {
      const ssize_t n = write(in.write.number(), input.data() + written, input.size() - written);
      if (n > 0) written += static_cast<std::size_t>(n);
      if (written == input.size() || (n < 0 && errno != EAGAIN && errno != EINTR)) in.write.close();
    }
    if (watched[1].revents != 0 && !take(out.read, run.output)) out.read.close();
    if (watched[2].revents != 0 && !take(errors.read, run.errors)) errors.read.close();
    if (run.errors.size() > 2 * most_errors) run.errors.erase(0, run.errors.size() - most_errors);
    if (run.output.size() > most_output) {
      run.end = ProcessRun::End::talkative;
      return run;
    }
  }
  in.write.close();
  int status = 0;
  while (!child.ended(status)) {
    if (left() < 0) {
      run.end = ProcessRun::End::timed_out;
      return run;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  run.end = WIFEXITED(status) ? ProcessRun::End::exited : ProcessRun::End::killed;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
  return run;
}

} // namespace gumshoe::models
