#include "models/plugin/diverted_output.h"

#include <cstdio>
#include <ios>
#include <iostream>
#include <mutex>

#include <fcntl.h>
#include <unistd.h>

namespace gumshoe::models {
namespace {

struct Diversion {
  std::mutex guard;
  int living = 0;
  int own = -1;          ///< standard output meanwhile; -1: it is closed, or no descriptor is left
  std::ios::iostate was; ///< of std::cout: what the library cannot print is no error of ours
} diversion;

/// What was printed until now goes where it was meant to go.
void flush_output() {
  std::cout.flush();
  std::fflush(stdout);
}

} // namespace

DivertedOutput::DivertedOutput() {
  const std::lock_guard lock(diversion.guard);
  if (diversion.living++ > 0) return;
  flush_output();
  diversion.was = std::cout.rdstate();
  diversion.own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (diversion.own >= 0) dup2(STDERR_FILENO, STDOUT_FILENO);
}

DivertedOutput::~DivertedOutput() {
  const std::lock_guard lock(diversion.guard);
  if (--diversion.living > 0) return;
  flush_output();
  std::cout.clear(diversion.was);
  if (diversion.own < 0) return;
  dup2(diversion.own, STDOUT_FILENO);
  close(diversion.own);
}

} // namespace gumshoe::models
