#pragma once
/// How far long work has come, for one line on a terminal. Work names its stages; loops over parts count themselves.
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

namespace gumshoe::progress {

/// Called from any thread, one call at a time; `total` 0: unknown.
using Observer = std::function<void(const std::string& stage, std::size_t done, std::size_t total)>;

/// Replaces the observer; an empty one is none.
void observe(Observer observer);

/// Names what follows.
void stage(const std::string& name);

/// A loop over parts, while it runs. Loops inside a loop are not counted.
class Loop {
public:
  explicit Loop(std::size_t total);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  void step();

private:
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
  bool counted_;
};

} // namespace gumshoe::progress
