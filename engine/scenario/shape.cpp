#include "scenario/shape.h"

#include <fmt/format.h>

namespace gumshoe::scenario::shape {
namespace {

std::string with(const Shape& shape, const std::string& more) { return more.empty() ? shape : shape + ", " + more; }

} // namespace

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string json_string(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& t : texts) out += (out.empty() ? "" : ", ") + json_string(t);
  return '[' + out + ']';
}

Shape text() { return R"("type": "string")"; }
Shape flag() { return R"("type": "boolean")"; }
Shape number() { return R"("type": "number")"; }

Shape interval(double low, double high, bool open) {
  const std::string_view least = open ? "exclusiveMinimum" : "minimum", most = open ? "exclusiveMaximum" : "maximum";
  return fmt::format(R"({}, "{}": {}, "{}": {})", number(), least, low, most, high);
}

Shape at_least(double low) { return fmt::format(R"({}, "minimum": {})", number(), low); }

Shape positive_up_to(double high) { return fmt::format(R"({}, "exclusiveMinimum": 0, "maximum": {})", number(), high); }

Shape whole(std::int64_t low, std::int64_t high) {
  return fmt::format(R"({}, "minimum": {}, "maximum": {}, "multipleOf": 1)", number(), low, high);
}

Shape words(const std::vector<std::string>& words) { return R"("enum": )" + json_string(words); }

Shape reference(std::string_view definition) { return fmt::format(R"("$ref": "#/definitions/{}")", definition); }

Shape any_of(const std::vector<Shape>& shapes) {
  std::string all;
  for (const Shape& s : shapes) all += (all.empty() ? "{" : ", {") + s + '}';
  return R"("anyOf": [)" + all + ']';
}

Shape list(const Shape& item, const std::string& more) {
  return with(R"("type": "array", "items": {)" + item + '}', more);
}

Shape texts(const std::string& more) { return any_of({text(), list(text(), with(R"("uniqueItems": true)", more))}); }

Shape map(const Shape& value, const std::string& more) { return table({}, more, value); }

Shape table(const std::vector<Key>& keys, const std::string& more, const Shape& others) {
  std::string out = R"("type": "object")", properties;
  std::vector<std::string> required;
  for (const Key& k : keys) {
    properties += (properties.empty() ? "" : ", ") + json_string(k.name) + ": " + described(k);
    if (k.required) required.push_back(k.name);
  }
  if (!keys.empty()) out += R"(, "properties": {)" + properties + '}';
  if (!required.empty()) out += R"(, "required": )" + json_string(required);
  if (!more.empty()) out += ", " + more;
  return out + R"(, "additionalProperties": )" + (others.empty() ? "false" : '{' + others + '}');
}

std::string described(const Key& key) {
  std::string more;
  if (!key.usual.empty() && !key.required) more += R"(, "default": )" + key.usual;
  if (!key.meaning.empty()) more += R"(, "description": )" + json_string(key.meaning);
  // Draft 7 ignores what stands next to a reference.
  const bool wrapped = !more.empty() && key.shape.starts_with(R"("$ref")");
  return '{' + (wrapped ? R"("allOf": [{)" + key.shape + "}]" : key.shape) + more + '}';
}

} // namespace gumshoe::scenario::shape
