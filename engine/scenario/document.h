#pragma once
/// A TOML document as a plain tree with places in the file; toml++ stays behind parse_document().
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gumshoe::scenario {

struct Member;

struct Node {
  enum class Kind { table, array, text, integer, real, boolean, date };
  Kind kind = Kind::table;
  int line = 0, column = 0;
  std::string text;         ///< text; a date as written
  double number = 0;        ///< integer and real
  std::int64_t integer = 0; ///< integer
  bool boolean = false;
  std::vector<Member> members; ///< of a table, in file order
  std::vector<Node> items;     ///< of an array
};

struct Member {
  std::string key;
  int line = 0, column = 0; ///< of the key
  Node value;
};

/// The value of a key of a table; null without it.
const Node* find_member(const Node& table, std::string_view key);
Node* find_member(Node& table, std::string_view key);

/// Throws InputError with the place of the first error of syntax.
Node parse_document(const std::string& text, const std::string& file);

/// "a table", "text", "an integer" ...
std::string describe(Node::Kind kind);

} // namespace gumshoe::scenario
