#pragma once
/// Errors a user can act on, and the exit codes of the program.
///
/// Form of every message: `file:line:column: error: what is wrong (why). What to do?` or `... Try: u = "1 um"`.
#include <exception>
#include <string>
#include <vector>

namespace gumshoe {

/// A place in a file. Line and column count from 1; 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Problem {
  Location where;
  std::string what;   ///< what is wrong, without a full stop: "quantities.rod_radius: '5 N' is not a length"
  std::string why;    ///< the reason, shown in parentheses; may be empty
  std::string remedy; ///< what to do: "use mm or um", "did you mean 'mm'?", or code: `u = "1 um"`; may be empty
};

/// Control characters as escapes, so that text from a file is one line and does nothing to a terminal.
std::string printable(const std::string& text);

/// One line in the form above, without a trailing newline: full stops and the remedy's capital are added here.
std::string format(const Problem& problem);

/// Thrown with every problem found, so that a user corrects a file in one pass. Exit code 2.
class InputError : public std::exception {
public:
  explicit InputError(std::vector<Problem> problems);
  /// One problem, with no place in a file.
  explicit InputError(std::string what, std::string why = {}, std::string remedy = {});

  const std::vector<Problem>& problems() const { return problems_; }
  const char* what() const noexcept override { return text_.c_str(); }

private:
  std::vector<Problem> problems_;
  std::string text_;
};

/// Thrown when the output cannot be written: no permission, a full disk. Exit code 2.
class OutputError : public InputError {
public:
  using InputError::InputError;
};

enum class ExitCode : int {
  done = 0,
  different = 1, ///< `gauge`: a computed figure differs from the published one
  bad_input = 2,
  too_many_failures = 3,
  interrupted = 130,
};

/// The candidate nearest to `word` by edit distance, or empty if none is near enough to be meant.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

} // namespace gumshoe
