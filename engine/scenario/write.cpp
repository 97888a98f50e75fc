#include "scenario/write.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::scenario {

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += std::string{'\\', c};
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + '"';
}

namespace {

std::string key(const std::string& name) {
  const auto plain = [](unsigned char c) { return (std::isalnum(c) != 0 && c < 0x80) || c == '_' || c == '-'; };
  return !name.empty() && std::all_of(name.begin(), name.end(), plain) ? name : toml_string(name);
}

std::string inlined(const Node& node) {
  std::string out;
  switch (node.kind) {
  case Node::Kind::table:
    for (const Member& m : node.members) out += (out.empty() ? "" : ", ") + key(m.key) + " = " + inlined(m.value);
    return out.empty() ? "{}" : "{ " + out + " }";
  case Node::Kind::array:
    for (const Node& item : node.items) out += (out.empty() ? "" : ", ") + inlined(item);
    return "[" + out + "]";
  case Node::Kind::text:
    return toml_string(node.text);
  case Node::Kind::integer:
    return fmt::format("{}", node.integer);
  case Node::Kind::real:
    out = fmt::format("{}", node.number);
    // TOML tells reals from integers by the point or the exponent.
    return out.find_first_of(".en") == std::string::npos ? out + ".0" : out;
  case Node::Kind::boolean:
    return node.boolean ? "true" : "false";
  case Node::Kind::date:
    return node.text;
  }
  return out;
}

bool tables(const Node& node) {
  return node.kind == Node::Kind::array && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(), [](const Node& n) { return n.kind == Node::Kind::table; });
}

void entries(const Node& table, std::string& out) {
  for (const Member& m : table.members) {
    // Long lists of rows: one a line.
    if (tables(m.value) && m.value.items.size() > 1) {
      out += key(m.key) + " = [\n";
      for (const Node& item : m.value.items) out += "  " + inlined(item) + ",\n";
      out += "]\n";
    } else {
      out += key(m.key) + " = " + inlined(m.value) + '\n';
    }
  }
}

} // namespace

std::string to_toml(const Node& document) {
  std::string out, sections;
  for (const Member& m : document.members) {
    if (tables(m.value)) {
      for (const Node& item : m.value.items) {
        sections += "\n[[" + key(m.key) + "]]\n";
        entries(item, sections);
      }
    } else if (m.value.kind != Node::Kind::table) {
      out += key(m.key) + " = " + inlined(m.value) + '\n';
    } else {
      const bool nested = std::all_of(m.value.members.begin(), m.value.members.end(),
                                      [](const Member& s) { return s.value.kind == Node::Kind::table; });
      if (!nested || m.value.members.empty()) {
        sections += "\n[" + key(m.key) + "]\n";
        entries(m.value, sections);
        continue;
      }
      for (const Member& s : m.value.members) {
        sections += "\n[" + key(m.key) + "." + key(s.key) + "]\n";
        entries(s.value, sections);
      }
    }
  }
  return out + sections;
}

} // namespace gumshoe::scenario
