#include "base/progress.h"

#include <mutex>

namespace gumshoe::progress {

namespace {

std::mutex mutex;
Observer observer_;
std::string stage_;
std::atomic<bool> looping{false};

void tell(std::size_t done, std::size_t total) {
  const std::lock_guard lock(mutex);
  if (observer_) observer_(stage_, done, total);
}

} // namespace

void observe(Observer observer) {
  const std::lock_guard lock(mutex);
  observer_ = std::move(observer);
}

void stage(const std::string& name) {
  {
    const std::lock_guard lock(mutex);
    stage_ = name;
  }
  tell(0, 0);
}

Loop::Loop(std::size_t total) : total_(total), counted_(!looping.exchange(true)) {}
Loop::~Loop() {
  if (counted_) looping = false;
}
void Loop::step() {
  const std::size_t done = ++done_;
  if (counted_) tell(done, total_);
}

} // namespace gumshoe::progress
