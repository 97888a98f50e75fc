#include "base/error.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gumshoe {
namespace {

std::string ended(std::string sentence) {
  if (sentence.empty() || std::string_view(".?!").find(sentence.back()) == std::string_view::npos) sentence += '.';
  return sentence;
}

std::string capitalised(std::string sentence) {
  if (sentence[0] >= 'a' && sentence[0] <= 'z') sentence[0] = static_cast<char>(sentence[0] - 'a' + 'A');
  return sentence;
}

/// A message is one that people read: what a file repeats in it is cut.
constexpr std::size_t longest = 1000, most_problems = 50;

std::string cut(const std::string& said) {
  std::string text = printable(said);
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end; // between characters
  return text.substr(0, end) + "...";
}

/// True for something to write into a file, which keeps its letters and takes no full stop: `u = "1 um"`, `[model]`.
bool is_code(std::string_view remedy) {
  const std::size_t key = remedy.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.");
  return key != remedy.npos &&
         (remedy.substr(key).starts_with(" = ") || std::string_view("[{\"").find(remedy[0]) != remedy.npos);
}

} // namespace

std::string printable(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    if (c < 0x20 || c == 0x7f)
      out += fmt::format("\\x{:02x}", c);
    else if (c == 0xc2 && next >= 0x80 && next < 0xa0) // U+0080 to U+009F, one of which begins commands as ESC [ does
      out += fmt::format("\\x{:02x}", next), ++i;
    else
      out += text[i];
  }
  return out;
}

std::string format(const Problem& p) {
  std::string text;
  if (!p.where.file.empty()) {
    text += p.where.file + ':';
    if (p.where.line > 0) text += fmt::format("{}:{}:", p.where.line, p.where.column);
    text += ' ';
  }
  text += "error: " + ended(p.why.empty() ? cut(p.what) : cut(p.what) + " (" + cut(p.why) + ')');
  if (is_code(p.remedy)) return text + " Try: " + p.remedy;
  if (!p.remedy.empty()) text += ' ' + ended(capitalised(p.remedy));
  return text;
}

InputError::InputError(std::vector<Problem> problems) : problems_(std::move(problems)) {
  for (std::size_t i = 0; i < std::min(most_problems, problems_.size()); ++i)
    text_ += (i == 0 ? "" : "\n") + format(problems_[i]);
  if (problems_.size() > most_problems)
    text_ += fmt::format("\nerror: there are {} more problems.", problems_.size() - most_problems);
}

InputError::InputError(std::string what, std::string why, std::string remedy)
    : InputError(std::vector<Problem>{{{}, std::move(what), std::move(why), std::move(remedy)}}) {}

namespace {
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}
} // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  if (word.size() > 100) return {}; // no misspelling
  std::string best;
  // Two edits of a word of two letters leave nothing of it.
  const std::size_t too_far = word.size() <= 2 ? 2 : std::max<std::size_t>(2, word.size() / 2) + 1;
  std::pair best_order{too_far, false};
  for (const std::string& candidate : candidates) {
    // If two names are equally near, take the one with the word's first letter, which is seldom the wrong one.
    const std::pair order{edit_distance(word, candidate), candidate.substr(0, 1) != word.substr(0, 1)};
    if (order < best_order) best = candidate, best_order = order;
  }
  return best;
}

} // namespace gumshoe
