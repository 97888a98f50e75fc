#include "scenario/starter_names.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "formula/operation.h"
#include "scenario/column_words.h"

namespace gumshoe::scenario {
namespace {

/// Letters of European languages as one spells them without their marks: Kuehlmittel, temperature (from température).
std::string in_ascii(std::string text) {
  static constexpr std::pair<std::string_view, std::string_view> letters[] = {
      {"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"}, {"Ü", "Ue"}, {"ß", "ss"}, {"é", "e"},
      {"è", "e"},  {"ê", "e"},  {"à", "a"},  {"â", "a"},  {"á", "a"},  {"í", "i"},  {"ó", "o"},  {"ú", "u"},
      {"ñ", "n"},  {"ç", "c"},  {"å", "a"},  {"ø", "o"},  {"æ", "ae"}, {"É", "E"},  {"Å", "A"},  {"Ø", "O"},
      {"Æ", "Ae"}, {"č", "c"},  {"š", "s"},  {"ž", "z"},  {"ł", "l"},  {"ř", "r"},  {"ě", "e"},  {"ý", "y"}};
  for (const auto& [marked, plain] : letters)
    for (std::size_t at = text.find(marked); at != std::string::npos; at = text.find(marked, at + plain.size()))
      text.replace(at, marked.size(), plain);
  return text;
}

/// The words of a text, joined; empty if none has a letter or digit of ASCII.
std::string joined_words(const std::string& text) {
  std::string out;
  for (const std::string& word : words_of(in_ascii(text))) out += (out.empty() ? "" : "_") + word;
  std::erase_if(out, [](unsigned char c) { return c >= 0x80; });
  return out;
}

} // namespace

std::string_view meaning_in_formulas(const std::string& text) { return formula::reserved_as(joined_words(text)); }

std::string plain_name(const std::string& text) {
  const std::string out = joined_words(text);
  if (out.find_first_not_of('_') == std::string::npos) return "column";
  const bool legal = std::isdigit(static_cast<unsigned char>(out[0])) == 0 && formula::reserved_as(out).empty();
  return legal ? out : "column_" + out;
}

std::string Names::add(const std::string& text) {
  const std::string name = plain_name(text);
  std::string out = name;
  for (int n = 2; !taken_.insert(out).second; ++n) out = fmt::format("{}_{}", name, n);
  return out;
}

} // namespace gumshoe::scenario
