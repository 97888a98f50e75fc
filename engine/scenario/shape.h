#pragma once
/// What may stand in a place of a scenario, as a fragment of JSON Schema (draft 7).
///
/// A fragment is text: the members of a schema object without its braces, such as `"type": "string"`. Fragments that
/// several sections share are definitions of schema.cpp, named by reference().
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gumshoe::scenario {

using Shape = std::string;

/// A key of a table: what editors show of it, and what the reader may ask for.
struct Key {
  std::string name;
  Shape shape;
  std::string meaning = {}; ///< one sentence or noun phrase, for people; may be empty
  bool required = false;
  std::string usual = {}; ///< the default, as JSON; empty: none, or told by the meaning
};

namespace shape {

/// A JSON string, quotes included.
std::string json_string(std::string_view text);
/// A JSON array of strings.
std::string json_string(const std::vector<std::string>& texts);

Shape text();
Shape flag();
Shape number();
/// A number between `low` and `high`; `open` excludes both ends.
Shape interval(double low, double high, bool open);
Shape at_least(double low);
/// A number above 0, up to `high`.
Shape positive_up_to(double high);
/// A whole number, also written 1e6.
Shape whole(std::int64_t low, std::int64_t high);
Shape words(const std::vector<std::string>& words);
/// A definition of schema.cpp: "measure", "width" (above 0), "positive", "source", "labels", "formula", "quantity" ...
Shape reference(std::string_view definition);
Shape any_of(const std::vector<Shape>& shapes);
/// `more`: further members, such as `"minItems": 1`.
Shape list(const Shape& item, const std::string& more = {});
/// A text or a list of texts.
Shape texts(const std::string& more = {});
/// A table whose keys are names of the user's own.
Shape map(const Shape& value, const std::string& more = {});
/// A table of these keys; `others`: shape of keys that are none of them, which are refused without it.
Shape table(const std::vector<Key>& keys, const std::string& more = {}, const Shape& others = {});

/// A key's shape with its meaning as description and its default: a complete schema object.
std::string described(const Key& key);

} // namespace shape
} // namespace gumshoe::scenario
