#pragma once
/// Runs a program once: text in, text out, within a time limit. Independent of models.
#include <cstddef>
#include <string>
#include <vector>

namespace gumshoe::models {

struct ProcessRun {
  enum class End {
    exited,      ///< code: its exit status
    killed,      ///< code: the signal that ended it
    timed_out,   ///< killed by us, with everything it started
    talkative,   ///< likewise, having written more than `most_output`
    not_started, ///< code: errno
  };
  End end = End::not_started;
  int code = 0;
  std::string output; ///< all of stdout
  std::string errors; ///< the end of stderr
};

/// Runs `words` (found by PATH) in `folder`, in a process group of its own. Input and output are passed at the same
/// time, so neither side waits for the other for ever. Ignores SIGPIPE in this process.
ProcessRun run_process(const std::vector<std::string>& words, const std::string& folder, const std::string& input,
                       double seconds, std::size_t most_output);

} // namespace gumshoe::models
