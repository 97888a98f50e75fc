#include "models/command/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/interrupt.h"
#include "models/command/watch.h"

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
    for (int& end : ends) // 0, 1 and 2 are to be replaced in the program
      if (end < 3) {
        const int moved = fcntl(end, F_DUPFD_CLOEXEC, 3);
        ::close(std::exchange(end, moved));
      }
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
    return true;
  }
};

/// The program itself, in a process that still shares our memory. It inherits nothing but its three pipes, and it is
/// killed when this process ends, however that happens. Returns errno if it cannot be started.
int become(char* const* words, const char* folder, const Pipe& in, const Pipe& out, const Pipe& errors, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) return ESRCH; // we are gone already
  setpgid(0, 0);
  for (const int s : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) std::signal(s, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (dup2(in.read.number(), 0) < 0 || dup2(out.write.number(), 1) < 0 || dup2(errors.write.number(), 2) < 0) return errno;
  close_range(3, ~0U, 0);
  if (*folder && chdir(folder) != 0) return errno;
  execvp(words[0], words);
  return errno;
}

/// Starts the program; errno if it cannot.
int start(const std::vector<std::string>& words, const std::string& folder, const Pipe& in, const Pipe& out,
          const Pipe& errors, pid_t& pid) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); // no handler of ours runs in the new process
  const pid_t self = getpid();
  volatile int error = 0;
  pid = vfork(); // this thread waits until the program runs: its memory need not be copied
  if (pid == 0) {
    error = become(arguments.data(), folder.c_str(), in, out, errors, self);
    _exit(127);
  }
  if (pid < 0) error = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (pid > 0 && error != 0) waitpid(pid, nullptr, 0);
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
  const Watch watch(pid);
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
    stop_if_interrupted(); // the child, in a process group of its own, sees no Ctrl-C
    if (left() < 0) {
      run.end = ProcessRun::End::timed_out;
      return run;
    }
    pollfd watched[3] = {
        {in.write.number(), POLLOUT, 0}, {out.read.number(), POLLIN, 0}, {errors.read.number(), POLLIN, 0}};
    if (poll(watched, 3, static_cast<int>(std::min<long long>(left() + 1, 200))) <= 0) continue;
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
    stop_if_interrupted();
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
