#pragma once
/// Errors a user can act on, and the exit codes of the program.
///
/// Grammar of every message: `file:line:column: error: what is wrong (why) what would be right?`
#include <exception>
#include <string>
#include <vector>

namespace gumshoe {

/// Where in a file something stands; line and column count from 1, 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

struct Problem {
  Location where;
  std::string what;   ///< what is wrong: "quantities.rod_radius: '5 N' is not a length"
  std::string why;    ///< the reason, shown in parentheses; may be empty
  std::string remedy; ///< what would be right; may be empty
};

/// One line in the grammar above, without a trailing newline.
std::string format(const Problem& problem);

/// Thrown with every problem found, so that a user mends a file in one pass. Exit code 2.
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

/// The machine failed us, not the input: an unwritable file, a full disk. Exit code 2.
class OutputError : public InputError {
public:
  using InputError::InputError;
};

enum class ExitCode : int {
  done = 0,
  different = 1, ///< `gauge`: ours is not the published figure
  bad_input = 2,
  too_many_failures = 3,
  interrupted = 130,
};

/// The candidate nearest to `word` by edit distance, or empty if none is near enough to be meant.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

} // namespace gumshoe
