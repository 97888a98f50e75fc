// The only door to toml++.
#include <stdexcept>

namespace {
// Some malformed text reaches assertions of toml++ 3.3: they must end in a message, not in an abort.
struct ParserGaveUp : std::runtime_error {
  ParserGaveUp() : std::runtime_error("not understood") {}
};
constexpr void expect(bool holds) {
  if (!holds) throw ParserGaveUp();
}
} // namespace
#undef NDEBUG // or toml++ would promise the compiler that they hold
#define TOML_ASSERT(expr) expect(static_cast<bool>(expr))
#define TOML_EXCEPTIONS 1
#define TOML_ENABLE_FORMATTERS 1
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "scenario/document.h"

namespace gumshoe::scenario {
namespace {

Node convert(const toml::node& in) {
  Node out;
  out.line = static_cast<int>(in.source().begin.line);
  out.column = static_cast<int>(in.source().begin.column);
  const auto as_text = [&](const auto& value) {
    std::ostringstream stream;
    stream << value;
    out.kind = Node::Kind::date;
    out.text = stream.str();
  };
  if (const auto* table = in.as_table()) {
    out.kind = Node::Kind::table;
    for (const auto& [key, value] : *table) {
      const auto place = key.source().begin;
      out.members.push_back(
          {std::string(key.str()), static_cast<int>(place.line), static_cast<int>(place.column), convert(value)});
    }
    // toml++ sorts by name; file order is what a reader expects of labels.
    std::stable_sort(out.members.begin(), out.members.end(), [](const Member& a, const Member& b) {
      return a.line != b.line ? a.line < b.line : a.column < b.column;
    });
  } else if (const auto* array = in.as_array()) {
    out.kind = Node::Kind::array;
    for (const auto& item : *array) out.items.push_back(convert(item));
  } else if (const auto* text = in.as_string()) {
    out.kind = Node::Kind::text;
    out.text = text->get();
  } else if (const auto* integer = in.as_integer()) {
    out.kind = Node::Kind::integer;
    out.integer = integer->get();
    out.number = static_cast<double>(out.integer);
  } else if (const auto* real = in.as_floating_point()) {
    out.kind = Node::Kind::real;
    out.number = real->get();
  } else if (const auto* boolean = in.as_boolean()) {
    out.kind = Node::Kind::boolean;
    out.boolean = boolean->get();
  } else if (const auto* date = in.as_date()) {
    as_text(date->get());
  } else if (const auto* time = in.as_time()) {
    as_text(time->get());
  } else if (const auto* moment = in.as_date_time()) {
    as_text(moment->get());
  }
  return out;
}

} // namespace

Node parse_document(const std::string& text, const std::string& file) {
  try {
    return convert(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    const auto place = error.source().begin;
    std::string what(error.description());
    if (const std::size_t at = what.find(": "); what.starts_with("Error while parsing") && at != std::string::npos)
      what.erase(0, at + 2); // where it happened says the place already
    throw InputError(std::vector<Problem>{
        {{file, static_cast<int>(place.line), static_cast<int>(place.column)}, std::move(what), "TOML", ""}});
  } catch (const ParserGaveUp&) {
    throw InputError(std::vector<Problem>{
        {{file, 0, 0}, "the file is not valid TOML", "the parser gave up", "is a quote or a bracket missing?"}});
  }
}

std::string describe(Node::Kind kind) {
  switch (kind) {
  case Node::Kind::table:
    return "a table";
  case Node::Kind::array:
    return "an array";
  case Node::Kind::text:
    return "text";
  case Node::Kind::integer:
    return "an integer";
  case Node::Kind::real:
    return "a number";
  case Node::Kind::boolean:
    return "true or false";
  case Node::Kind::date:
    return "a date";
  }
  return "?";
}

} // namespace gumshoe::scenario
