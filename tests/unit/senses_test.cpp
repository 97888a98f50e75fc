#include <catch2/catch.hpp>

#include "math/senses.h"

using gumshoe::senses;
using Numbers = std::vector<double>;

TEST_CASE("a sequence of numbers goes up or down, and turns in the middle of equal ones", "[math]") {
  // Load on and off, twice: the zero between them is met once after falling and once before rising.
  const Numbers load = {0, 1, 2, 3, 2, 1, 0, 0, 1, 2, 3, 2, 1, 0};
  CHECK(senses(load) == Numbers{1, 1, 1, 1, -1, -1, -1, 1, 1, 1, 1, -1, -1, -1});
  CHECK(senses(Numbers{0, 1, 2, 2, 1, 0}) == Numbers{1, 1, 1, -1, -1, -1});
  CHECK(senses(Numbers{5, 5, 5}) == Numbers{0, 0, 0});
  CHECK(senses(Numbers{}).empty());
}

TEST_CASE("passes that all go up have one sense: a step back over half of the positions starts anew", "[math]") {
  Numbers up, down;
  for (int pass = 0; pass < 3; ++pass)
    for (int i = 0; i < 6; ++i) up.push_back(0.1 * i), down.push_back(-0.1 * i);
  CHECK(senses(up) == Numbers(up.size(), 1.0));
  CHECK(senses(down) == Numbers(down.size(), -1.0));
  // From the top back to the second of six, and up once more.
  CHECK(senses(Numbers{0, 1, 2, 3, 4, 5, 1, 2}) == Numbers(8, 1.0));
  // In any order, each is approached from where the one before was.
  CHECK(senses(Numbers{0, 5, 1, 4, 3, 2}) == Numbers{1, 1, -1, 1, -1, -1});
  // Two positions in turn are what they seem.
  CHECK(senses(Numbers{0, 1, 0, 1}) == Numbers{1, 1, -1, 1});
}
