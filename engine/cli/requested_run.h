#pragma once
/// What `run` and `merge` share: the run that was asked for, and its end.
#include <chrono>
#include <ctime>
#include <optional>
#include <string>

#include "analysis/results.h"
#include "cli/print.h"
#include "cli/progress_line.h"
#include "propagation/experiment.h"
#include "propagation/work.h"
#include "scenario/scenario.h"
#include "store/result_file.h"

namespace gumshoe::cli {

/// The options of `run` that determine its numbers.
struct RunRequest {
  std::optional<std::string> samples, seed;
  bool predict = false;
  /// "--samples 100000 --seed 7": what a shard records. Equal requests have equal words.
  std::string words() const;
  static RunRequest of(const std::string& words);
};

/// The scenario of a file as the run takes it. An adaptive one begins with the samples of a block.
scenario::Scenario scenario_of_run(const std::string& file, const RunRequest& request,
                                   const scenario::Overrides& overrides = {});

/// What fixes the numbers of the run, and its file.
store::Identity identity_of_run(const propagation::Experiment& experiment);

/// When a command began.
struct Begun {
  std::time_t date = std::time(nullptr);
  std::chrono::steady_clock::time_point clock = std::chrono::steady_clock::now();
};

/// Analyses the samples of the file, which are all there, completes it and prints the result.
ExitCode complete_run(const propagation::Experiment& experiment, store::ResultFile& file,
                      const analysis::StoppingRecord& stopping, const Begun& begun, const std::string& out,
                      const propagation::Workers& workers, PrintOptions print, ProgressLine& line);

} // namespace gumshoe::cli
