// Parts of the result file alone: what no whole run can be made to do.
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "folder.h"
#include "store/draft.h"
#include "store/table.h"

using namespace gumshoe;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("space cannot be claimed for a file that is not there", "[store]") {
  const fixture::Folder folder;
  CHECK_THROWS_WITH(store::claim_space(folder / "none.h5", 1), Contains("cannot open '") && Contains("No such file"));
}

TEST_CASE("files that belong together take their places together or not at all", "[store]") {
  const fixture::Folder folder;
  const auto text = [&](const char* name) {
    std::string content;
    std::getline(std::ifstream(folder / name), content);
    return content;
  };
  std::ofstream(folder / "old.toml") << "before";
  const store::Claim fresh(folder / "fresh.csv"), old(folder / "old.toml"), last(folder / "last.h5");
  const auto fails = [&](const auto& spoil) {
    store::Draft draft;
    draft.add(fresh, "after");
    draft.add(old, "after");
    spoil(draft.add(last, "after"));
    CHECK_THROWS_WITH(draft.publish(), Contains("last.h5': cannot be moved into place"));
    CHECK(!fs::exists(folder / "fresh.csv"));
    CHECK(text("old.toml") == "before");
  };
  fails([](const std::string& draft) { fs::remove(draft); });
  fails([&](const std::string&) { fs::create_directory(folder / "last.h5"); });
  fs::remove(folder / "last.h5");
  {
    store::Draft draft;
    for (const store::Claim* claim : {&fresh, &old, &last}) draft.add(*claim, "after");
    draft.publish();
  }
  for (const char* name : {"fresh.csv", "old.toml", "last.h5"}) CHECK(text(name) == "after");
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 6); // and three locks
}

TEST_CASE("a file that cannot take its place leaves nothing behind", "[store]") {
  const fixture::Folder folder;
  {
    const store::Claim claim(folder / "taken.h5");
    store::Draft draft;
    draft.add(claim, "new");
    fs::create_directory(folder / "taken.h5");
    CHECK_THROWS_WITH(draft.publish(), Contains("cannot be moved into place"));
  }
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a column has a value per row, a matrix one per row and column", "[store]") {
  const fixture::Folder folder;
  const std::lock_guard lock(store::hdf5::library());
  const auto file = store::hdf5::own(H5Fcreate((folder / "t.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                                     H5Fclose, "create a file");
  store::Table rows(file, "row", 3), columns(file, "column", 2);
  CHECK_NOTHROW(rows.numbers("good", std::vector<double>(3), "m", ""));
  CHECK_THROWS_WITH(rows.numbers("short", std::vector<double>(2), "m", ""),
                    Contains("cannot write column 'short'") && Contains("it has another length"));
  CHECK_NOTHROW(rows.matrix("all", columns, std::vector<double>(6), "m", ""));
  CHECK_THROWS_WITH(rows.matrix("some", columns, std::vector<double>(5), "m", ""),
                    Contains("cannot write matrix 'some'") && Contains("it has another shape"));
  CHECK_THROWS_WITH(store::Table(file, "named", 3, {"one", "two"}),
                    Contains("cannot write dimension 'named'") && Contains("it has another length"));
}
