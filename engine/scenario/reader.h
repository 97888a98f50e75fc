#pragma once
/// Typed access to tables that records every problem with its place and remembers which keys were
/// asked for, so that keys nobody asked for are found without a list.
#include <functional>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "scenario/document.h"
#include "scenario/shape.h"

namespace gumshoe::scenario {

/// Problems found so far, in one file or in files it names.
class Problems {
public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  void add(int line, int column, std::string what, std::string why = {}, std::string remedy = {});
  void add(const Node& node, std::string what, std::string why = {}, std::string remedy = {}) {
    add(node.line, node.column, std::move(what), std::move(why), std::move(remedy));
  }
  /// A problem of the key itself.
  void add(const Member& key, std::string what, std::string why = {}, std::string remedy = {}) {
    add(key.line, key.column, std::move(what), std::move(why), std::move(remedy));
  }
  void add(Problem problem) { list_.push_back(std::move(problem)); }
  void add(const InputError& error);
  /// Problems of `error` that have no place stand at `node`.
  void add(const InputError& error, const Node& node);
  /// The first problem of `error`, as one of the key that `path` names and that stands at `node`.
  void add(const Node& node, const std::string& path, const InputError& error);
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  const std::string& file() const { return file_; }
  /// Throws InputError if there are any, in the order of the file.
  void raise() const;

private:
  /// Leaves the first problems of data files only.
  void shorten(std::vector<Problem>& sorted) const;
  std::string file_;
  std::vector<Problem> list_;
};

/// How a quantity's numbers are read: "0.6 um" in SI; a bare number only where si_unit is "1".
struct Dimension {
  std::string si_unit;
  units::Kind kind = units::Kind::point;
};

/// Throws InputError where the number in degC or degF is a temperature below absolute zero. In K it may be a
/// difference.
void require_possible_temperature(double number, const std::string& unit, const Dimension& dimension);

/// A value as text with unit or bare number; nullopt and a problem if it is not.
std::optional<double> read_measure(const Node& node, const std::string& path, const Dimension& dimension,
                                   Problems& problems);
/// A bare, finite number.
std::optional<double> read_number(const Node& node, const std::string& path, Problems& problems);
std::optional<std::string> read_text(const Node& node, const std::string& path, Problems& problems);

/// One table of the document. A getter of an absent key gives nullopt and no problem.
class Table {
public:
  /// `path` is how messages call the table: "quantities.rod_radius"; empty for the document.
  Table(const Node& node, std::string path, Problems& problems)
      : node_(&node), path_(std::move(path)), problems_(&problems) {}

  const Node& node() const { return *node_; }
  const std::string& path() const { return path_; }
  std::string path(const std::string& key) const { return path_.empty() ? key : path_ + '.' + key; }
  Problems& problems() const { return *problems_; }

  /// Null if absent. Asking makes the key a known one.
  const Node* find(const std::string& key);
  bool has(const std::string& key) { return find(key) != nullptr; }
  /// As find, with a problem at the table if absent.
  const Node* require(const std::string& key, const std::string& remedy = {});
  std::optional<std::string> text(const std::string& key);
  std::optional<double> number(const std::string& key);
  std::optional<double> positive(const std::string& key);
  std::optional<double> measure(const std::string& key, const Dimension& dimension);
  /// A difference above 0.
  std::optional<double> width(const std::string& key, const std::string& si_unit);
  std::optional<bool> boolean(const std::string& key);
  /// A whole number from low to high; 1e6 counts as one.
  std::optional<std::int64_t> integer(const std::string& key, std::int64_t low, std::int64_t high);
  std::optional<Table> table(const std::string& key);
  /// An array's nodes; null if absent or not an array.
  const std::vector<Node>* array(const std::string& key);
  /// The tables of an array, called "key[1]", "key[2]" ... in messages; none if absent.
  std::vector<Table> tables(const std::string& key);
  /// Text or an array of texts.
  std::vector<std::string> texts(const std::string& key);
  /// Text, or anything else rendered as text: {certificate = "12"} becomes "certificate: 12".
  std::string rendered(const std::string& key);
  /// One of the words; its index.
  std::optional<std::size_t> choice(const std::string& key, const std::vector<std::string>& words);
  /// Every key, each known from now on, declared or not.
  const std::vector<Member>& members();
  void add(std::string what, std::string why = {}, std::string remedy = {}) const {
    problems_->add(*node_, std::move(what), std::move(why), std::move(remedy));
  }
  /// A problem of the table, or of one of its keys: "path: what", "path.key: what".
  void refuse(const std::string& what, std::string why = {}, std::string remedy = {}) const {
    add(path_ + ": " + what, std::move(why), std::move(remedy));
  }
  void refuse_key(const std::string& key, const std::string& what, std::string why = {}, std::string remedy = {});
  /// States the keys that the schema lists for this table: asking for another one is an error of the program.
  void declare(const std::vector<Key>& keys);
  /// Reports the keys that are not declared, before others are read: what is missing there may be their cause.
  void refuse_undeclared();
  /// Reports the keys that were never asked for. Call it last.
  void refuse_unknown();
  /// Reports a key that is none of this table; it is not reported again.
  void refuse_stray(const Member& key, std::string why, std::string remedy);

private:
  void refuse_as_unknown(const Member& key, const std::set<std::string>& names);

  const Node* node_;
  std::string path_;
  Problems* problems_;
  std::set<std::string> known_;
  std::set<std::string> declared_; ///< empty: keys are the user's own
  std::set<std::string> refused_;  ///< undeclared ones, reported
};

/// "did you mean 'high'?", or a list of few candidates, or empty.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// Names of cards, or of what else has a name.
template <class Cards> std::vector<std::string> names_of(const Cards& cards) {
  std::vector<std::string> names;
  for (const auto& card : cards) names.emplace_back(card.name);
  return names;
}

/// The SI unit of a unit in the file; nullopt and a problem if it is none.
std::optional<std::string> read_si_unit(const Node& node, const std::string& path, const std::string& unit,
                                        Problems& problems);

/// The node as a table; nullopt and a problem if it is not.
std::optional<Table> as_table(const Node& node, const std::string& path, Problems& problems);

} // namespace gumshoe::scenario
