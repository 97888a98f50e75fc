#include <algorithm>

#include <fmt/format.h>

#include "formula/lexer.h"

namespace gumshoe::formula {
namespace {

constexpr int deepest = 200; ///< far more than a person writes, far less than the stack holds

class Parser {
public:
  explicit Parser(Formula& formula) : formula_(formula), lexer_(formula) {}

  void parse() {
    if (lexer_.next().kind == Token::Kind::end) fail("the formula is empty", "", "\"a + b\"");
    sum();
    if (lexer_.next().kind == Token::Kind::end) return;
    if (is(")")) fail("this ')' has no matching '('", "", "add a '(' or remove the ')'");
    if (is(",")) fail("',' is allowed only in a function's arguments", "", "use a point as the decimal sign");
    fail(fmt::format("an operator is missing before {}", lexer_.shown()),
         lexer_.next().kind == Token::Kind::name ? "units belong to quantities, not to formulas" : "",
         "write '*' to multiply");
  }

private:
  bool is(std::string_view sign) const { return lexer_.next().kind == Token::Kind::sign && lexer_.next().text == sign; }
  [[noreturn]] void fail(std::string what, std::string why = {}, std::string remedy = {}) const {
    throw InputError({formula_.problem(lexer_.next().at, std::move(what), std::move(why), std::move(remedy))});
  }

  struct Depth {
    explicit Depth(Parser& p) : parser(p) {
      if (++parser.depth_ > deepest)
        parser.fail("the formula is nested too deeply", fmt::format("at most {} levels", deepest));
    }
    ~Depth() { --parser.depth_; }
    Parser& parser;
  };

  std::size_t keep(Node node) {
    formula_.nodes.push_back(std::move(node));
    return formula_.nodes.size() - 1;
  }

  std::size_t sum() {
    std::size_t left = product();
    while (is("+") || is("-")) {
      const Token sign = lexer_.take();
      const std::size_t right = product();
      left = keep({sign.text == "+" ? Operation::add : Operation::subtract, sign.at, left, right, 0, ""});
    }
    return left;
  }

  std::size_t product() {
    std::size_t left = with_sign();
    while (is("*") || is("/")) {
      const Token sign = lexer_.take();
      const std::size_t right = with_sign();
      left = keep({sign.text == "*" ? Operation::multiply : Operation::divide, sign.at, left, right, 0, ""});
    }
    return left;
  }

  std::size_t with_sign() {
    const Depth depth(*this);
    if (!is("+") && !is("-")) return power();
    const Token sign = lexer_.take();
    const std::size_t operand = with_sign();
    return sign.text == "+" ? operand : keep({Operation::negate, sign.at, operand, operand, 0, ""});
  }

  std::size_t power() {
    const std::size_t base = primary();
    if (!is("^")) return base;
    const Token sign = lexer_.take();
    const std::size_t exponent = with_sign();
    return keep({Operation::power, sign.at, base, exponent, 0, ""});
  }

  std::size_t primary() {
    const Token token = lexer_.next();
    if (token.kind == Token::Kind::number) {
      lexer_.take();
      return keep({Operation::number, token.at, 0, 0, token.value, ""});
    }
    if (token.kind == Token::Kind::name) {
      lexer_.take();
      return is("(") ? call(token) : keep({Operation::name, token.at, 0, 0, 0, token.text});
    }
    if (!is("(")) fail(fmt::format("a number, a name or '(' is expected, not {}", lexer_.shown()));
    lexer_.take();
    const std::size_t inner = sum();
    close(token.at);
    return inner;
  }

  std::size_t call(const Token& name) {
    const Function* function = find_function(name.text);
    if (!function) {
      const std::string meant = nearest(name.text, function_names());
      throw InputError({formula_.problem(name.at, fmt::format("'{}' is not a function", name.text), "",
                                         meant.empty() ? fmt::format("use one of {}", fmt::join(function_names(), ", "))
                                                       : fmt::format("did you mean '{}'?", meant))});
    }
    const std::size_t open = lexer_.take().at;
    std::vector<std::size_t> arguments;
    if (!is(")")) {
      arguments.push_back(sum());
      while (is(",")) {
        lexer_.take();
        arguments.push_back(sum());
      }
    }
    close(open);
    if (static_cast<int>(arguments.size()) != function->arguments)
      throw InputError(
          {formula_.problem(name.at, fmt::format("{} takes {} argument{}, not {}", name.text, function->arguments,
                                                 function->arguments == 1 ? "" : "s", arguments.size()))});
    return keep({function->operation, name.at, arguments.front(), arguments.back(), 0, ""});
  }

  void close(std::size_t open) {
    if (is(")")) {
      lexer_.take();
      return;
    }
    if (lexer_.next().kind == Token::Kind::end)
      throw InputError({formula_.problem(open, "this '(' is never closed", "", "add a ')'")});
    fail(fmt::format("an operator or ')' is missing before {}", lexer_.shown()));
  }

  Formula& formula_;
  Lexer lexer_;
  int depth_ = 0;
};

} // namespace

void parse(Formula& formula) {
  formula.nodes.clear();
  Parser(formula).parse();
}

Location Formula::place(std::size_t at) const {
  Location place = where;
  if (place.line == 0 || text.find('\n') != std::string::npos) return place;
  const auto bytes = std::string_view(text).substr(0, at);
  const auto characters =
      std::ranges::count_if(bytes, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
  place.column += static_cast<int>(characters);
  return place;
}

std::size_t Formula::start(std::size_t n) const {
  while (nodes[n].a < n && nodes[n].at > nodes[nodes[n].a].at && is_binary(nodes[n].operation)) n = nodes[n].a;
  return nodes[n].at;
}

Problem Formula::problem(std::size_t at, std::string what, std::string why, std::string remedy) const {
  return {place(at), fmt::format("{}: {}", name, what), std::move(why), std::move(remedy)};
}

} // namespace gumshoe::formula
