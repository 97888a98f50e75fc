#pragma once
/// Sends what foreign code prints to standard error: standard output has the numbers of the command. Private to this
/// folder.

namespace gumshoe::models {

/// While one lives, on any thread, standard output of the process is standard error.
class DivertedOutput {
public:
  DivertedOutput();
  ~DivertedOutput();
  DivertedOutput(const DivertedOutput&) = delete;
  DivertedOutput& operator=(const DivertedOutput&) = delete;
};

} // namespace gumshoe::models
