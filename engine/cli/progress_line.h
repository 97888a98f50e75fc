#pragma once
/// One line on stderr, rewritten: what goes on, its share, the time left. Silent where stderr is no terminal.
#include <chrono>
#include <cstdint>
#include <string>

namespace gumshoe::cli {

class ProgressLine {
public:
  ProgressLine();
  ~ProgressLine(); ///< removes the line: nothing stands at 100 %
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `done` of `total` parts; total 0: not known. `rate_unit`: shows a rate, such as "samples/s".
  void show(const std::string& what, std::uint64_t done = 0, std::uint64_t total = 0,
            const std::string& rate_unit = {});
  void clear();

private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  std::string what_;
  std::uint64_t first_ = 0, last_ = 0;
  Clock::time_point started_, shown_;
};

/// While it lives, the line shows the stages of the engine's work (base/progress.h).
class StudyProgress {
public:
  explicit StudyProgress(ProgressLine& line);
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;
};

} // namespace gumshoe::cli
