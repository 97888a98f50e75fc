#include "scenario/rtl_log.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

/// "Target-count : 11" -> 11, of any line that begins so.
std::optional<std::size_t> count_after(const std::string& line, const std::string& key) {
  if (!line.starts_with(key)) return std::nullopt;
  const std::size_t digit = line.find_first_of("0123456789", key.size());
  std::size_t out = 0;
  for (std::size_t i = digit;
       i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])) != 0 && out < 1'000'000; ++i)
    out = 10 * out + static_cast<std::size_t>(line[i] - '0');
  return digit == std::string::npos ? std::nullopt : std::optional(out);
}

std::vector<std::string> words_of_line(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

/// What the sections of a file hold.
struct Rtl {
  std::size_t target_count = 0;
  bool angular = false;
  std::vector<std::string> targets;
  struct Reading {
    std::size_t target;
    std::string deviation;
  };
  std::map<std::size_t, std::vector<Reading>> runs;

  explicit Rtl(const std::string& text) {
    enum { elsewhere, in_targets, in_deviations } at = elsewhere;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.ends_with('\r')) line.pop_back();
      if (const auto n = count_after(line, "Target-count")) target_count = *n;
      std::string lower = line;
      std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      angular |= lower.starts_with("filetype") && lower.find("angular") != std::string::npos;
      if (line.starts_with("Targets")) {
        at = in_targets;
        line = line.substr(std::min(line.find(':'), line.size() - 1) + 1);
      } else if (line.starts_with("Run Target Data")) {
        at = in_deviations;
        continue;
      } else if (line.find("::") != std::string::npos) {
        at = elsewhere;
      }
      const auto words = words_of_line(line);
      if (at == in_targets)
        for (const std::string& word : words)
          if (targets.size() < target_count) targets.push_back(word);
      if (at == in_deviations && words.size() == 3) add(words);
    }
  }
  bool whole() const { return target_count > 0 && targets.size() == target_count && !runs.empty(); }

private:
  void add(const std::vector<std::string>& words) {
    const auto run = count_after(words[0], ""), target = count_after(words[1], "");
    if (run && target && *target >= 1 && *target <= targets.size()) runs[*run].push_back({*target - 1, words[2]});
  }
};

} // namespace

std::string rows_of_rtl(const std::string& text) {
  if (text.find("Run Target Data") == std::string::npos) return "";
  Rtl log(text);
  if (!log.whole()) return "";
  const bool ways = log.runs.size() % 2 == 0;
  std::string out = fmt::format("run;{}target{};deviation{}\n", ways ? "direction;" : "", log.angular ? "" : " [mm]",
                                log.angular ? "" : " [um]");
  for (auto& [run, readings] : log.runs) {
    const bool down = ways && run % 2 == 0;
    if (down && readings.front().target < readings.back().target) std::ranges::reverse(readings);
    for (const auto& [target, deviation] : readings)
      out += fmt::format("{};{}{};{}\n", run, !ways ? "" : down ? "-;" : "+;", log.targets[target], deviation);
  }
  return out;
}

} // namespace gumshoe::scenario
