#include <catch2/catch.hpp>

#include "base/csv.h"
#include "base/encoding.h"

using gumshoe::InputError;
using gumshoe::parse_csv;

TEST_CASE("cells know where they stand", "[csv]") {
  const auto csv = parse_csv("\xEF\xBB\xBF"
                             "a, b (mm) ,c\r\n1,\"x, \"\"y\"\"\", 3\r\n\n4,5,6",
                             "t.csv");
  REQUIRE(csv.rows.size() == 2);
  CHECK(csv.find("b (mm)") == 1);
  CHECK(csv.find("d") == -1);
  CHECK(csv.rows[0][1].text == "x, \"y\"");
  CHECK(csv.rows[0][2].text == "3");
  CHECK(csv.rows[1][2].line == 4);
  CHECK(csv.rows[1][2].column == 5);
  CHECK(csv.number(csv.rows[1][0]) == 4);
}

TEST_CASE("quoted cells may span lines", "[csv]") {
  const auto csv = parse_csv("a,b\n\"1\n2\",3\n4,5\n", "t.csv");
  REQUIRE(csv.rows.size() == 2);
  CHECK(csv.rows[0][0].text == "1\n2");
  CHECK(csv.rows[1][0].line == 4);
}

TEST_CASE("comments and semicolons", "[csv]") {
  const auto csv = parse_csv("# made by \"hand\n#\na;\"b,c\";d\n1,5;\"#2\";3\r\n  # 1;2;3\n# only a remark\n#4;5;6", "t.csv");
  REQUIRE(csv.header.size() == 3);
  CHECK(csv.header[1].text == "b,c");
  REQUIRE(csv.rows.size() == 1);
  CHECK(csv.rows[0][1].text == "#2");
  CHECK(csv.comments_like_rows == 2);
  CHECK(csv.number(csv.rows[0][0], ',') == 1.5);
  CHECK(csv.number(csv.rows[0][2], ',') == 3);
  CHECK_THROWS_WITH(csv.number(csv.rows[0][0]), Catch::Contains("t.csv:4:1: error: '1,5' is not a number (the decimal sign must be a point)"));
  // a comma in the header: semicolons are text
  CHECK(parse_csv("a;b,c\n1,2\n", "t.csv").header[0].text == "a;b");
}

TEST_CASE("signs between thousands", "[csv]") {
  const auto large = parse_csv("a;b\n1.234,5;1,234.5\n2.5;x\n-1'234'567.25;+12.345.678,9\n", "t.csv");
  CHECK(large.number(large.rows[0][0], ',') == 1234.5);
  CHECK(large.number(large.rows[0][1], '.') == 1234.5);
  CHECK(large.number(large.rows[2][0], '.') == -1234567.25);
  CHECK(large.number(large.rows[2][1], ',') == 12345678.9);
  // The sign of the other kind of numbers, no decimals, groups of another length: a thousand times too much is possible.
  CHECK_THROWS_AS(large.number(large.rows[0][0], '.'), InputError);
  CHECK_THROWS_AS(large.number(large.rows[0][1], ','), InputError);
  CHECK_THROWS_WITH(large.number(large.rows[1][0], ','), Catch::Contains("the decimal sign must be a comma"));
  for (const char* text : {"1.234", "1.23,5", "1234.567,8", "1.234.56,7", ".234,5", "0.123,4", "1.2e4,5", "1.234'567,8"}) {
    const auto one = parse_csv("a;b\n" + std::string(text) + ";1\n", "t.csv");
    CHECK_THROWS_AS(one.number(one.rows[0][0], ','), InputError);
  }
}

TEST_CASE("a head that comes again is no row", "[csv]") {
  const auto plain = parse_csv("a,b\n1,2\na, b\n3,4\n", "t.csv");
  REQUIRE(plain.rows.size() == 2);
  CHECK(plain.rows[1][0].line == 4);
  const auto units = parse_csv("log\na,b\nmm,um\n1,2\na,b\nmm,um\n3,4\n", "t.csv", {.header = 2, .rows = 4});
  REQUIRE(units.rows.size() == 2);
  CHECK(units.rows[1][1].text == "4");
  CHECK(parse_csv("a\na\n", "t.csv").rows.size() == 1); // a word in the only column is one
}

TEST_CASE("rows may end with a separator where the header does not", "[csv]") {
  const gumshoe::Csv csv =
      gumshoe::parse_csv("a,b\n1,2,\n3,\n5,6\n", "t.csv"); // of the second the last cell is empty, and its own
  REQUIRE(csv.header.size() == 2);
  REQUIRE(csv.rows.size() == 3);
  CHECK(csv.rows[0][1].text == "2");
  CHECK(csv.rows[1][1].text.empty());
  for (const char* bad : {"a,b\n1,2,3\n", "a,b\n1,2,\"\"\n", "a,b\n1,2,,\n"})
    CHECK_THROWS_AS(gumshoe::parse_csv(bad, "t.csv"), gumshoe::InputError);
}

TEST_CASE("malformed tables are refused with their place", "[csv]") {
  CHECK_THROWS_WITH(parse_csv("", "t.csv"), Catch::Contains("t.csv: error: the file is empty"));
  CHECK_THROWS_WITH(parse_csv("a,a\n", "t.csv"), Catch::Contains("t.csv:1:3: error: column 'a' appears twice"));
  CHECK(parse_csv("a,\n1,\n", "t.csv").header.size() == 1); // lines that end with a separator
  CHECK_THROWS_WITH(parse_csv("a,\n1,2\n", "t.csv"), Catch::Contains("t.csv:1:3: error: a column has no name"));
  CHECK_THROWS_WITH(parse_csv("a,b\n1,2\n1\n1,2,3\n", "t.csv"),
                    Catch::Contains("t.csv:3:1: error: the row has 1 cells, the header 2") &&
                        Catch::Contains("t.csv:4:1:"));
  CHECK_THROWS_WITH(parse_csv("a\n\"1\n", "t.csv"), Catch::Contains("t.csv:2:1: error: a quote is not closed"));
  CHECK_THROWS_WITH(parse_csv("a\n\"1\"2\n", "t.csv"), Catch::Contains("t.csv:2:1: error: text follows a closing quote"));
  const auto csv = parse_csv("a,b\n1,x\nnan,\n", "t.csv");
  CHECK_THROWS_WITH(csv.number(csv.rows[0][1]), "t.csv:2:3: error: 'x' is not a number.");
  CHECK_THROWS_AS(csv.number(csv.rows[1][0]), InputError);
  CHECK_THROWS_AS(csv.number(csv.rows[1][1]), InputError);
}

TEST_CASE("tabs and blanks separate cells", "[csv]") {
  const auto tabs = parse_csv("a\tb c\td\n1\t\t3\n", "t.csv");
  REQUIRE(tabs.header.size() == 3);
  CHECK(tabs.header[1].text == "b c");
  CHECK(tabs.rows[0][1].text.empty());
  const auto blanks = parse_csv("  a   b\tc  \n1 2    3\n\n -4   5 6 \r\n", "t.csv", {.separator = ' '});
  REQUIRE(blanks.header.size() == 3);
  REQUIRE(blanks.rows.size() == 2);
  CHECK(blanks.number(blanks.rows[1][0]) == -4);
  CHECK(blanks.rows[1][2].text == "6");
  const auto decimal = parse_csv("a;b,c\n1,5;2\n", "t.csv", {.separator = ';'});
  CHECK(decimal.number(decimal.rows[0][0], ',') == 1.5);
  CHECK(parse_csv("a;b\n1;2\n;\n\t\n", "t.csv").rows.size() == 1); // a row without any text
}

TEST_CASE("several tables are read as one", "[csv]") {
  const auto all = gumshoe::join_csv({parse_csv("a,b\n1,2\n", "1.csv"), parse_csv("b,x,a\n3,9,4\n", "2.csv")}, "*.csv",
                                     {{"run", {"1", "2"}}});
  CHECK(all.names() == std::vector<std::string>{"run", "a", "b"});
  REQUIRE(all.rows.size() == 2);
  CHECK(all.rows[1][0].text == "2");
  CHECK(all.rows[1][1].text == "4");
  CHECK(all.at(all.rows[1][1]).file == "2.csv");
  CHECK(all.at(all.rows[1][1]).column == 5);
  CHECK_THROWS_WITH(gumshoe::join_csv({parse_csv("a,b\n", "1.csv"), parse_csv("a\n", "2.csv")}, "*.csv", {}),
                    Catch::Contains("2.csv:1:1: error: there is no column 'b'"));
  CHECK_THROWS_WITH(gumshoe::join_csv({parse_csv("a,b\n", "1.csv")}, "*.csv", {{"a", {"1"}}}),
                    Catch::Contains("1.csv:1:1: error: the file has a column 'a' itself"));
}

TEST_CASE("texts of other encodings become UTF-8", "[csv]") {
  using gumshoe::as_utf8;
  CHECK(as_utf8("5 \xC2\xB5m, 20 \xC2\xB0" "C \xE2\x82\xAC") == "5 \xC2\xB5m, 20 \xC2\xB0" "C \xE2\x82\xAC");
  // Windows-1252: micro, degree, euro, a dash; not the overlong or truncated forms of UTF-8.
  CHECK(as_utf8("5 \xB5m 20 \xB0" "C \x80 \x96") == "5 \xC2\xB5m 20 \xC2\xB0" "C \xE2\x82\xAC \xE2\x80\x93");
  CHECK(as_utf8("\xC0\x80") == "\xC3\x80\xE2\x82\xAC");
  CHECK(as_utf8("\xC2") == "\xC3\x82");
  // UTF-16 of both orders, with a character beyond the first plane.
  CHECK(as_utf8(std::string("\xFF\xFE" "a\0\xB5\0\x3D\xD8\x00\xDE", 10)) == "a\xC2\xB5\xF0\x9F\x98\x80");
  CHECK(as_utf8(std::string("\xFE\xFF\0a\0\xB5\xD8\x3D\xDE\x00", 10)) == "a\xC2\xB5\xF0\x9F\x98\x80");
}

TEST_CASE("a first line may state the separator", "[csv]") {
  for (const char* line : {"sep=;\n", "SEP=;\r\n"}) {
    const auto csv = parse_csv(std::string(line) + "x;a,b\n1,5;2\n", "t.csv");
    REQUIRE(csv.names() == std::vector<std::string>{"x", "a,b"});
    CHECK(csv.header[0].line == 2);
    CHECK(csv.rows[0][0].line == 3);
    CHECK(csv.number(csv.rows[0][0], ',') == 1.5);
  }
  CHECK(parse_csv("\xEF\xBB\xBFsep=\t\na,b\tc\n1\t2\n", "t.csv").header[0].text == "a,b");
  CHECK(parse_csv("sep=;\nlog\na;b\n1;2\n", "t.csv", {.header = 3}).header[1].text == "b");
  CHECK(parse_csv("sep=,b\n1,2\n", "t.csv").header[0].text == "sep="); // names of columns
  CHECK_THROWS_WITH(parse_csv("sep=;", "t.csv"), Catch::Contains("the file is empty"));
}

TEST_CASE("decimal commas between commas are suspected", "[csv]") {
  const auto hint = Catch::Contains("Is the comma the decimal sign?");
  CHECK_THROWS_WITH(
      parse_csv("x,id\n1,001,1\n-1,003,2\n", "t.csv"),
      hint && Catch::Contains("t.csv:2:1: error: the row has 3 cells, the header 2 (a comma separates cells)") &&
          Catch::Contains("t.csv:3:1: error: the row has 3 cells, the header 2.")); // once
  CHECK_THROWS_WITH(parse_csv("x,y\n1,001,-1,5\n", "t.csv"), hint);
  CHECK_THROWS_WITH(parse_csv("x,id\n1.5,a,1\n", "t.csv"), !hint);
  CHECK_THROWS_WITH(parse_csv("x;id\n1;001;1\n", "t.csv"), !hint);
  CHECK_THROWS_WITH(parse_csv("x,id,z\n1,001\n", "t.csv"), !hint);
  CHECK_THROWS_WITH(parse_csv("x,id\n1,2\n1,001,1\n", "t.csv"), !hint); // the rows before it are good
}

TEST_CASE("no-break spaces around a number are spaces", "[csv]") {
  for (const std::string text : {"\xC2\xA0"
                                 "1.5",
                                 "1.5 \xC2\xA0",
                                 "\xE2\x80\xAF"
                                 "1.5\xE2\x80\xAF",
                                 "\"\xC2\xA0"
                                 "1.5 \""}) {
    const auto csv = parse_csv("a,b\n" + text + ",2\n", "t.csv");
    CHECK(csv.number(csv.rows[0][0]) == 1.5);
  }
  const auto latin = parse_csv(gumshoe::as_utf8("a\xA0,b\n1.5\xA0,\xB5m\n"), "t.csv");
  CHECK(latin.header[0].text == "a");
  CHECK(latin.number(latin.rows[0][0]) == 1.5);
  const auto letter = parse_csv("a\n\xC3\xA0\n", "t.csv"); // ends with the byte 0xA0
  CHECK(letter.rows[0][0].text == "\xC3\xA0");
}
