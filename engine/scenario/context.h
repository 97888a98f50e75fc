#pragma once
/// What the parts of the parser share: problems, notes, data files and the labels of the readings.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/csv.h"
#include "quantities/cells.h"
#include "quantities/input_quantity.h"
#include "scenario/earlier.h"
#include "scenario/reader.h"

namespace gumshoe::scenario {

/// How the text of a data file becomes a table.
struct TextTable {
  std::string name = {}; ///< equal names stand for equal functions
  std::function<Csv(std::string_view text, const std::string& file)> parse = [](std::string_view text,
                                                                               const std::string& file) {
    return parse_csv(text, file);
  };
};

/// Data files named by a scenario, relative to its folder; each is read once and hashed.
class DataFiles {
public:
  /// `of_readings`: stands for every data file of readings, relative to the current directory; empty: none does.
  /// `notes` take what a reader must know of a file.
  DataFiles(const std::string& scenario_file, std::string of_readings, std::vector<std::string>& notes);
  /// The file named by the text node; null and a problem if it cannot be read or is no table. A name may be a pattern
  /// of several files, which are read as one (file_pattern.h).
  const Csv* open(const Node& name, const std::string& path, const TextTable& form, Problems& problems);
  /// The same for a file of readings.
  const Csv* open_readings(const Node& name, const std::string& path, const TextTable& form, Problems& problems);
  bool readings_replaced() const { return !of_readings_.empty(); }
  /// A file that fixes the numbers in another way (a model's library or script): its bytes enter the hash. No such
  /// file: nothing.
  void include(const std::string& name);
  /// Adds a note on a file, once.
  void note(const std::string& text);
  /// The earliest of a column's clock times, from which its seconds count, as the file writes it. @param path  the
  /// column's place in the scenario
  void count_since(const std::string& path, const std::string& earliest) { since_.emplace(path, earliest); }
  const std::map<std::string, std::string>& since() const { return since_; }
  /// Continues `hash` over the bytes of every file opened, in order.
  std::uint64_t hash(std::uint64_t hash) const;

private:
  struct File {
    std::string name, bytes;
  };
  using NoFile = std::function<void(const Problem&)>;
  const Csv* open_table(const std::string& name, const TextTable& form, const NoFile& no_file, Problems& problems);
  std::unique_ptr<Csv> read_file(const std::string& file, const TextTable& form);
  std::unique_ptr<Csv> read_files(const std::string& pattern, const TextTable& form);
  std::string folder_, of_readings_;
  std::map<std::string, std::string> since_; ///< by path
  std::vector<std::string>& notes_;
  std::vector<File> files_;                           ///< bytes read, in order
  std::map<std::string, std::unique_ptr<Csv>> tables_; ///< by name and form; null if it was no table
};

/// What may be started, and what a scenario names (external.h).
struct External {
  bool trusted = true;
  std::optional<std::string> expected; ///< by a result: only the same code
  std::string code;                    ///< named, with a hash of its files; empty: none
};

struct Context {
  Problems& problems;
  DataFiles& files;
  std::vector<std::string>& notes;
  EarlierResults& earlier;
  /// Labels of every reading; what a `by` or `per` may name.
  std::vector<quantities::Labels> readings;
  /// Label values that occur in the data, also in rows that `where` leaves out.
  std::map<std::string, std::set<std::string>> label_values;
  bool readings_known = true; ///< false if they had problems: then labels are not checked
  External external{};
  const Node* data = nullptr;  ///< [data]: what the readings of all indications share
  const Node* trace = nullptr; ///< [trace]: its columns, and blocks that are stretches of the data
  bool own_quantities = false; ///< the scenario itself declares the quantities: no card knows a default value of theirs

  struct Assumed {
    std::string quantity, value;
  };
  std::vector<Assumed> without_value = {}; ///< uncertain quantities without any value, and the one that is taken
  std::vector<quantities::InputQuantity> unused = {}; ///< with an entry each that no reading uses

  std::vector<std::string> label_names() const;
  /// False, and a problem at the node, if it is known that no reading has a label of this name.
  bool is_label(const Node& node, const std::string& path, const std::string& name) const;
  /// Adds a note, once.
  void note(const std::string& text) const;
};

/// "rod = rod 2, setup = 1"
std::string text_of(const quantities::Labels& labels);

} // namespace gumshoe::scenario
