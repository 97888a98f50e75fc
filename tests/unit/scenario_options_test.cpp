/// The table of options: one row gives reading, its messages, --explain and the schema.
#include <catch2/catch.hpp>

#include "scenario/option.h"

using namespace gumshoe;
using namespace gumshoe::scenario;
using Catch::Contains;

namespace {

struct Drill {
  int turns = 3;
  double share = 0.25;
  bool wet = false;
  std::string name;
  enum class Kind { twist, step } kind = Kind::twist;
};

Options<Drill> drill_options() {
  return {
      option::whole("turns", &Drill::turns, 1, 9, "how often"),
      option::share("share", &Drill::share, true, "of the whole"),
      option::flag("wet", &Drill::wet, "with \"coolant\""),
      option::text("name", &Drill::name, "").needed("name = \"d\"?"),
      option::word("kind", &Drill::kind, {{"twist", Drill::Kind::twist}, {"step", Drill::Kind::step}}, ""),
  };
}

/// The section as read, and what was said of it.
std::pair<Drill, std::string> read(const std::string& text) {
  const Node document = parse_document(text, "d.toml");
  Problems problems("d.toml");
  Table table(document, "drill", problems);
  Drill drill;
  read_options(table, drill_options(), drill);
  table.refuse_unknown();
  try {
    problems.raise();
  } catch (const InputError& error) {
    return {drill, error.what()};
  }
  return {drill, ""};
}

} // namespace

TEST_CASE("options are read into their members, and keep their defaults", "[scenario][options]") {
  const auto [drill, said] = read("name = \"a\"\nturns = 7\nwet = true\nkind = \"step\"\n");
  CHECK(said.empty());
  CHECK(drill.turns == 7);
  CHECK(drill.share == 0.25);
  CHECK(drill.wet);
  CHECK(drill.name == "a");
  CHECK(drill.kind == Drill::Kind::step);
}

TEST_CASE("an option outside its limits, missing or unknown is refused at its place", "[scenario][options]") {
  CHECK_THAT(read("name = \"a\"\nturns = 10\n").second,
             Contains("d.toml:2:9: error: drill.turns: 10 must lie between 1 and 9"));
  CHECK_THAT(read("name = \"a\"\nshare = 1.0\n").second,
             Contains("d.toml:2:9: error: drill.share: 1 must lie between 0 and 1") && Contains("share = 0.25"));
  CHECK_THAT(read("turns = 2\n").second, Contains("drill.name is missing") && Contains("name = \"d\""));
  CHECK_THAT(read("name = \"a\"\nkind = \"spet\"\n").second, Contains("'step'"));
  CHECK_THAT(read("name = \"a\"\nturn = 2\n").second, Contains("unknown key 'turn'") && Contains("'turns'"));
}

TEST_CASE("options explain themselves", "[scenario][options]") {
  Drill drill;
  CHECK(explained(drill_options(), drill) == "turns 3, share 0.25, wet false, kind twist");
  CHECK(explained_changes(drill_options(), drill) == "none");
  drill.turns = 4;
  drill.wet = true;
  CHECK(explained_changes(drill_options(), drill) == "turns 4, wet");
}

TEST_CASE("options have a schema with limits, defaults and meanings", "[scenario][options]") {
  const std::string schema = table_shape(drill_options());
  CHECK_THAT(schema, Contains(R"("turns": {"type": "number", "minimum": 1, "maximum": 9, "multipleOf": 1, )"
                              R"("default": 3, "description": "how often"})"));
  CHECK_THAT(schema, Contains(R"("exclusiveMinimum": 0, "exclusiveMaximum": 1, "default": 0.25)"));
  CHECK_THAT(schema, Contains(R"("description": "with \"coolant\"")"));
  CHECK_THAT(schema, Contains(R"("enum": ["twist", "step"], "default": "twist")"));
  CHECK_THAT(schema, Contains(R"("required": ["name"])") && Contains(R"("additionalProperties": false)"));
}

TEST_CASE("a reader cannot accept a key that the schema lacks", "[scenario][options]") {
  const Node document = parse_document("turns = 2\nhidden = 1\n", "d.toml");
  Problems problems("d.toml");
  Table table(document, "drill", problems);
  table.declare(keys_of(drill_options()));
  table.number("turns");
  CHECK_NOTHROW(table.refuse_unknown());
  table.number("hidden");
  CHECK_THROWS_AS(table.refuse_unknown(), std::logic_error);
}
