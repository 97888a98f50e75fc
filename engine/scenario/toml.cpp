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
#include <numeric>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/memory.h"
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

/// Refuses keys of very many parts, and tables within tables that come to as many: toml++ and convert() call themselves
/// once for each, and a stack has an end.
class Depth {
public:
  Depth(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  void check() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'')
        skip_string(c);
      else if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        step(c), ++at_;
    }
  }

private:
  static constexpr std::size_t most = 100;

  void step(char c) {
    if (c == '\n' || c == ',') key_ = 0;
    if (c == '.') add(1);
    if (c == '{' || c == '[') {
      add(1);
      open_.push_back(std::exchange(key_, 0));
    }
    if ((c == '}' || c == ']') && !open_.empty()) {
      open_.pop_back();
      key_ = 0;
    }
  }

  void add(std::size_t parts) {
    key_ += parts;
    if (std::accumulate(open_.begin(), open_.end(), key_) <= most) return;
    const auto line = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    const std::size_t begin = at_ == 0 ? std::string::npos : text_.rfind('\n', at_ - 1);
    throw InputError({{{file_, static_cast<int>(line + 1), static_cast<int>(at_ - begin)},
                       fmt::format("keys are nested more than {} deep", most), "every part of a key a.b.c and every bracket counts", ""}});
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool long_one = text_.compare(at_, 3, three) == 0;
    at_ += long_one ? 3 : 1;
    while (at_ < text_.size()) {
      if (text_[at_] == '\\' && quote == '"')
        ++at_;
      else if (long_one ? text_.compare(at_, 3, three) == 0 : text_[at_] == quote || text_[at_] == '\n')
        break;
      ++at_;
    }
    at_ += long_one ? 3 : text_[std::min(at_, text_.size() - 1)] == quote;
    // A long text may end with quotes of its own: """a quoted "word"""".
    for (int own = 0; long_one && own < 2 && at_ < text_.size() && text_[at_] == quote; ++own) ++at_;
  }

  const std::string &text_, &file_;
  std::size_t at_ = 0, key_ = 0;
  std::vector<std::size_t> open_; ///< parts of the keys around this place
};

/// What the parser's words mean to whom TOML is new.
std::string remedy_of(const std::string& what, const std::string& file) {
  for (const char* ending : {".csv", ".tsv", ".txt"})
    if (file.ends_with(ending))
      return fmt::format("a scenario is expected here; gumshoe new --from {} writes one for a data file", file);
  if (what.find("control character") != std::string::npos) return "is a closing quote missing?";
  return "";
}

} // namespace

Node parse_document(const std::string& text, const std::string& file) {
  Depth(text, file).check();
  require_memory((std::size_t{1} << 20) + 32 * text.size()); // toml++ ends the process where its errors get none
  try {
    return convert(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    const auto place = error.source().begin;
    std::string what(error.description());
    if (const std::size_t at = what.find(": "); what.starts_with("Error while parsing") && at != std::string::npos)
      what.erase(0, at + 2); // where it happened says the place already
    throw InputError(std::vector<Problem>{
        {{file, static_cast<int>(place.line), static_cast<int>(place.column)}, what, "TOML", remedy_of(what, file)}});
  } catch (const ParserGaveUp&) {
    throw InputError(std::vector<Problem>{
        {{file, 0, 0}, "the file is not valid TOML", "the parser gave up", "is a quote or a bracket missing?"}});
  }
}

const Node* find_member(const Node& table, std::string_view key) {
  const auto it = std::ranges::find(table.members, key, &Member::key);
  return it == table.members.end() ? nullptr : &it->value;
}

Node* find_member(Node& table, std::string_view key) {
  return const_cast<Node*>(find_member(std::as_const(table), key));
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
