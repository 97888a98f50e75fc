#include "models/command/command.h"

#include <atomic>
#include <cstring>
#include <deque>
#include <mutex>

#include <fmt/format.h>

#include "models/command/exchange.h"
#include "models/command/process.h"

namespace gumshoe::models {
namespace {

/// Answers to the same few points asked again: every measurand of a reading is differentiated by itself.
class Memory {
public:
  bool find(const std::string& input, std::string& output) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [asked, answer] : known_)
      if (asked == input) {
        output = answer;
        return true;
      }
    return false;
  }
  void add(const std::string& input, const std::string& output) const {
    const std::lock_guard lock(mutex_);
    known_.emplace_back(input, output);
    if (known_.size() > 64) known_.pop_front();
  }

private:
  mutable std::mutex mutex_;
  mutable std::deque<std::pair<std::string, std::string>> known_;
};
constexpr std::size_t most_remembered = std::size_t{1} << 20; ///< bytes of input

struct Command {
  explicit Command(const CommandSpec& of) : spec(of), card(of.card) {}
  CommandSpec spec;
  MadeCard card;
  Memory memory;
  mutable std::atomic<bool> tried{false}, remembers{false}; ///< answers: not before the same point was asked twice
  Model model{};

  [[noreturn]] void refuse(const std::string& points, const std::string& what, const std::string& why,
                           const std::string& remedy) const {
    std::string words;
    for (const std::string& w : spec.words) words += (words.empty() ? "" : " ") + w;
    throw InputError({{spec.where, fmt::format("model.command: '{}' at {}: {}", words, points, what), why, remedy}});
  }
};

/// The last lines of stderr on one line.
std::string tail(const std::string& errors) {
  std::vector<std::string> lines(1);
  for (const char c : errors) {
    if (c == '\n')
      lines.emplace_back();
    else if (c != '\r')
      lines.back() += c >= ' ' || c == '\t' || c < 0 ? c : '?';
  }
  std::erase_if(lines, [](const std::string& l) { return l.find_first_not_of(" \t") == std::string::npos; });
  std::string text;
  const std::size_t first = lines.size() > 3 ? lines.size() - 3 : 0;
  for (std::size_t i = first; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const std::string from_start = line.substr(line.find_first_not_of(" \t"));
    text += (text.empty() ? "stderr: " : " | ") + from_start.substr(0, 200);
  }
  return text;
}

std::string why_ended(const ProcessRun& run, const CommandSpec& spec) {
  switch (run.end) {
  case ProcessRun::End::exited:
    return run.code == 0 ? "" : fmt::format("it ended with exit status {}", run.code);
  case ProcessRun::End::killed:
    return fmt::format("signal {} ended it ({})", run.code, strsignal(run.code));
  case ProcessRun::End::timed_out:
    return fmt::format("it took longer than {:g} s and was stopped", spec.time_limit);
  case ProcessRun::End::talkative:
    return "its output did not end and it was stopped";
  default:
    return fmt::format("it cannot be started: {}", std::strerror(run.code));
  }
}

std::string remedy_for(const ProcessRun& run) {
  if (run.end == ProcessRun::End::timed_out) return "increase model.time_limit or reduce model.batch";
  if (run.end == ProcessRun::End::not_started)
    return "name an executable program, relative to the scenario's folder";
  return "";
}

void run_points(const Command& c, const std::string& input, std::size_t n, std::uint64_t first_sample,
                std::size_t offset, double* const* measurands, std::uint8_t* status) {
  const std::string points = span_text(first_sample, offset, n);
  const bool small = c.remembers && first_sample == unnumbered && input.size() <= most_remembered;
  ProcessRun run;
  if (!small || !c.memory.find(input, run.output)) {
    const std::size_t most = (std::size_t{1} << 20) + n * (c.card.card().measurands.size() + 1) * 4096;
    run = run_process(c.spec.words, c.spec.folder, input, c.spec.time_limit, most);
    if (const std::string why = why_ended(run, c.spec); !why.empty())
      c.refuse(points, why, tail(run.errors), remedy_for(run));
    if (small) c.memory.add(input, run.output);
  }
  try {
    read_results(c.card.card(), run.output, n, measurands, status);
  } catch (const InputError& error) {
    const Problem& p = error.problems().front();
    const std::string said = tail(run.errors);
    c.refuse(points, p.what, p.why + (p.why.empty() || said.empty() ? "" : "; ") + said, p.remedy);
  }
}

void evaluate(const BlockCall& call) {
  const Command& c = *static_cast<const Command*>(call.context);
  const ModelCard& card = c.card.card();
  std::vector<double*> rows(card.measurands.size());
  for (std::size_t r = 0; r < call.readings; ++r) {
    const ShownReading reading = shown_reading(card, call, r, true);
    for (std::size_t at = 0; at < call.samples; at += c.spec.batch) {
      const std::size_t n = std::min(c.spec.batch, call.samples - at);
      for (std::size_t m = 0; m < rows.size(); ++m) rows[m] = call.measurands[r * rows.size() + m] + at;
      run_points(c, points_table(card, reading, at, n), n, call.first_sample, at, rows.data(), call.status + at);
    }
  }
}

const Kernels* kernels() {
  static constexpr Kernels kernels{nullptr, &evaluate};
  return &kernels;
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  return explained(static_cast<const Command*>(call.context)->card.card(), call, &evaluate);
}

/// Runs it twice, at the estimates of the first reading.
std::string check(const PointCall<double>& call) {
  const Command& c = *static_cast<const Command*>(call.context);
  if (c.tried.exchange(true)) return {};
  if (const std::string how = differing_answers(c.card.card(), call, &evaluate); !how.empty())
    c.refuse("the estimates", "the same point gives different results",
             how + "; the program draws random numbers of its own, or its rows depend on one another",
             "make it a function of its input: random errors are quantities of the scenario");
  c.remembers = true;
  return {};
}

} // namespace

MadeModel make_command(const CommandSpec& spec) {
  const auto command = std::make_shared<Command>(spec);
  Model& m = command->model;
  m.card = &command->card.card();
  m.kernels = &kernels;
  m.explain = &explain;
  m.check = &check;
  m.solve_reads = [](std::size_t) { return true; };
  m.context = command.get();
  m.block = spec.batch;
  return MadeModel(command, &m);
}

} // namespace gumshoe::models
