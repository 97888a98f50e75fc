#pragma once
/// Names that stand for several data files: "logs/axis_{run}.csv".
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gumshoe::scenario {

/// Whether a name is a pattern. A file that exists under the very name is meant itself.
bool is_pattern(const std::string& name);

/// `*` in a file's name stands for any text; `{run}` does too, and gives the text as the column `run`. The folder is
/// spelled out.
class FilePattern {
public:
  struct Match {
    std::string file;
    std::vector<std::string> texts; ///< by names()
  };
  /// Throws InputError: a pattern in a folder's name, a brace that is not closed or holds no name, a name twice, a name
  /// that no file can have.
  explicit FilePattern(const std::string& pattern);
  const std::vector<std::string>& names() const { return names_; }
  /// The files that match, sorted by name with numbers in their order (run2 before run10). Throws InputError if there
  /// is none.
  std::vector<Match> matches() const;

private:
  using Tried = std::set<std::pair<std::size_t, std::size_t>>; ///< pieces that were sought at these places
  bool match(const std::string& name, std::size_t piece, std::size_t at, Tried& tried, Match& out) const;

  std::string pattern_, folder_;
  std::vector<std::string> fixed_; ///< texts around the gaps, one more than them
  std::vector<int> gaps_;          ///< index into names_, or -1 for *
  std::vector<std::string> names_;
};

} // namespace gumshoe::scenario
