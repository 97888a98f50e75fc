// Files that are read are known by whatever name, and no output takes their place.
#include <filesystem>

#include <catch2/catch.hpp>

#include "base/inputs.h"
#include "base/text_file.h"
#include "folder.h"
#include "store/draft.h"

using namespace gumshoe;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("a file that is read is known by every name", "[inputs]") {
  const fixture::Folder folder;
  const std::string read = folder.write("read.csv", "x\n"), other = folder.write("other.csv", "x\n");
  CHECK(inputs::same_file(read).empty());
  read_text_file(read, 100);
  fs::create_symlink(read, folder / "soft");
  fs::create_hard_link(read, folder / "hard");
  for (const std::string& name : {read, folder / "soft", folder / "hard", folder / "./read.csv"})
    CHECK(inputs::same_file(name) == read);
  for (const std::string& name : {other, folder / "none", folder.path()}) CHECK(inputs::same_file(name).empty());
  fs::remove(read); // its number may be given to the next file
  folder.write("new.csv", "x\n");
  CHECK(inputs::same_file(folder / "new.csv").empty());
  CHECK_NOTHROW(inputs::note(folder / "none"));
}

TEST_CASE("no output takes the place of a file that is read", "[inputs]") {
  const fixture::Folder folder;
  const std::string read = folder.write("read.csv", "x\n");
  CHECK_NOTHROW(store::Claim(read));
  read_data_file(read, 100);
  CHECK_THROWS_WITH(store::Claim(read), Contains("read.csv: this is the file that is read (it would be overwritten)"));
  fs::create_hard_link(read, folder / "hard.csv");
  CHECK_THROWS_WITH(store::Claim(folder / "hard.csv"), Contains("it is " + read + ", which would be overwritten"));
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 2); // no lock is left
}
