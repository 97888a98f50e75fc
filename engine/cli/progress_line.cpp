#include "cli/progress_line.h"

#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "base/progress.h"

namespace gumshoe::cli {

namespace {

std::string duration(double seconds) {
  return seconds < 99.5    ? fmt::format("{:.0f} s", seconds)
         : seconds < 5970  ? fmt::format("{:.0f} min", seconds / 60)
                           : fmt::format("{:.1f} h", seconds / 3600);
}

} // namespace

ProgressLine::ProgressLine() : terminal_(isatty(2) != 0), started_(Clock::now()) {}
ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  if (terminal_) std::cerr << "\r\033[K" << std::flush;
}

void ProgressLine::show(const std::string& what, std::uint64_t done, std::uint64_t total,
                        const std::string& rate_unit) {
  if (!terminal_) return;
  const auto now = Clock::now();
  const bool anew = what != what_ || done < last_ || total == 0;
  if (anew) what_ = what, first_ = done > 0 && rate_unit.empty() ? done - 1 : done, started_ = now;
  last_ = done;
  if (!anew && now - shown_ < std::chrono::milliseconds(200)) return;
  shown_ = now;
  std::string text = what;
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const double rate = seconds > 0 ? static_cast<double>(done - first_) / seconds : 0;
  if (total > 0) text += fmt::format(": {:.1f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total));
  if (rate > 0 && !rate_unit.empty()) text += fmt::format(", {:.3g} {}", rate, rate_unit);
  if (rate > 0 && total > done) text += ", " + duration(static_cast<double>(total - done) / rate) + " left";
  std::cerr << "\r\033[K" << text << std::flush;
}

StudyProgress::StudyProgress(ProgressLine& line) {
  progress::observe([&line](const std::string& stage, std::size_t done, std::size_t total) {
    if (!stage.empty()) line.show(stage, done, total);
  });
}
StudyProgress::~StudyProgress() { progress::observe({}); }

} // namespace gumshoe::cli
