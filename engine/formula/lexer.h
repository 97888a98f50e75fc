#pragma once
/// Words of a formula.
#include "formula/formula.h"

namespace gumshoe::formula {

struct Token {
  enum class Kind { end, number, name, sign } kind = Kind::end;
  std::size_t at = 0;
  std::string text; ///< of a sign one of + - * / ^ ( ) ,
  double value = 0;
};

class Lexer {
public:
  explicit Lexer(const Formula& formula) : formula_(formula) { advance(); }
  const Token& next() const { return next_; }
  Token take() {
    Token token = std::move(next_);
    advance();
    return token;
  }
  /// "the end of the formula" or "'x'": for messages.
  std::string shown() const;

private:
  void advance();
  const Formula& formula_;
  std::size_t at_ = 0;
  Token next_;
};

} // namespace gumshoe::formula
