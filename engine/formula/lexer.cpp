#include "formula/lexer.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::formula {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }
bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

struct Misread {
  std::string_view sign, meant;
};
/// Signs of mathematics and of other languages that people paste.
constexpr Misread misread[] = {
    {"×", "*"}, {"·", "*"},  {"⋅", "*"},  {"−", "-"},      {"–", "-"},
    {"÷", "/"}, {"²", "^2"}, {"³", "^3"}, {"√", "sqrt()"}, {"°", "deg in the quantity's unit"},
    {"**", "^"}};

const Misread* find_misread(std::string_view rest) {
  for (const Misread& m : misread)
    if (rest.starts_with(m.sign)) return &m;
  return nullptr;
}

} // namespace

bool is_name(std::string_view word) {
  if (word.empty() || !letter(word.front())) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((!letter(word[i]) && !digit(word[i])) || find_misread(word.substr(i))) return false;
  return true;
}

std::string Lexer::shown() const {
  return next_.kind == Token::Kind::end ? "the end of the formula" : "'" + next_.text + "'";
}

void Lexer::advance() {
  const std::string_view text = formula_.text;
  while (at_ < text.size() && (text[at_] == ' ' || text[at_] == '\t' || text[at_] == '\n' || text[at_] == '\r')) ++at_;
  next_ = {Token::Kind::end, at_, "", 0};
  if (at_ == text.size()) return;
  const std::string_view rest = text.substr(at_);
  if (const Misread* m = find_misread(rest))
    throw InputError({formula_.problem(at_, fmt::format("'{}' is not allowed in a formula", m->sign), "",
                                       fmt::format("use {}", m->meant))});
  std::size_t length = 1;
  if (digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && digit(rest[1]))) {
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), next_.value);
    if (error != std::errc() || !std::isfinite(next_.value))
      throw InputError({formula_.problem(at_, "this is not a number", "too large or too small")});
    length = static_cast<std::size_t>(stop - rest.data());
    next_.kind = Token::Kind::number;
  } else if (letter(rest[0])) {
    while (length < rest.size() && (letter(rest[length]) || digit(rest[length])) && !find_misread(rest.substr(length)))
      ++length;
    next_.kind = Token::Kind::name;
  } else if (std::string_view("+-*/^(),").find(rest[0]) != std::string_view::npos) {
    next_.kind = Token::Kind::sign;
  } else {
    throw InputError({formula_.problem(at_, fmt::format("'{}' is not allowed in a formula", rest[0]), "",
                                       "use + - * / ^ and parentheses")});
  }
  next_.text = rest.substr(0, length);
  at_ += length;
}

} // namespace gumshoe::formula
