/// Results and histories whose digests are right, but whose contents another program, or another version, wrote.
#include <catch2/catch.hpp>

#include <fstream>

#include "folder.h"
#include "made/full_results.h"
#include "store/hdf5.h"
#include "store/history_file.h"
#include "store/identity.h"
#include "store/record.h"
#include "store/stored_results.h"

using namespace gumshoe;
namespace hdf5 = store::hdf5;

namespace {

/// Replaces a data set by numbers or texts, and seals the file again.
template <class Values> void replace(const std::string& path, const std::string& name, const Values& values) {
  const std::lock_guard lock(hdf5::library());
  const store::Record record = store::read_record(path);
  hdf5::Handle file = store::open_file(path, H5F_ACC_RDWR);
  REQUIRE(H5Ldelete(file, name.c_str(), H5P_DEFAULT) >= 0);
  if constexpr (std::is_same_v<typename Values::value_type, std::string>) {
    hdf5::write_texts(hdf5::create_dataset(file, name, hdf5::text_type(), {values.size()}, "1", ""), values);
  } else {
    const auto data = hdf5::create_dataset(file, name, H5T_NATIVE_DOUBLE, {values.size()}, "1", "");
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  store::close_file(file);
  store::seal(path, record);
}

using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

std::string history_in(const fixture::Folder& folder) {
  const tracing::Score one{
      "scale", 0, {{"scale.size", "um/m", "1"}}, tracing::Vector::Ones(1), tracing::Matrix::Ones(1, 1)};
  const tracing::Campaign campaign{"0123", "a title", "2026-02-03", 12, 10.5, 9, {one}, "linear_axis", "an axis",
                                   "d = gain * x\n"};
  const store::Claim claim(folder / "h.h5");
  store::Draft draft;
  store::write_history(draft, claim, {campaign}, {});
  draft.publish();
  return folder / "h.h5";
}

} // namespace

TEST_CASE("columns of a result that differ in length are refused", "[store]") {
  const fixture::Folder folder;
  for (const char* name : {"name", "measurand", "units", "diagnostic", "estimate", "certificate"}) {
    const std::string path = folder / (std::string(name) + ".h5"), column = std::string("summary/") + name;
    made::write_full_result(path);
    CHECK(store::read_results(path).summaries.size() == 4);
    if (name == std::string("diagnostic") || name == std::string("estimate"))
      replace(path, column, Numbers{1, 2});
    else
      replace(path, column, Texts{"a"});
    CHECK_THROWS_WITH(store::read_results(path), Catch::Contains("does not have a value for each row"));
  }
}

TEST_CASE("values that a data set only promises are not read", "[store]") {
  const fixture::Folder folder;
  const std::string path = folder / "r.h5";
  made::write_full_result(path);
  {
    const std::lock_guard lock(hdf5::library());
    hdf5::Handle file = store::open_file(path, H5F_ACC_RDWR);
    REQUIRE(H5Ldelete(file, "summary/estimate", H5P_DEFAULT) >= 0);
    hdf5::create_dimension(file, "summary/estimate", hsize_t{1} << 50); // takes no room
    store::close_file(file);
  }
  CHECK_THROWS_WITH(store::read_results(path), Catch::Contains("its values are not in the file"));
}

TEST_CASE("a history is as it was written, or it is refused", "[store]") {
  const fixture::Folder folder;
  const std::string path = history_in(folder);
  REQUIRE(store::read_history(path).size() == 1);
  CHECK(store::read_history(path).front().scores.front().sizes.front().unit == "um/m");
  CHECK(store::read_history(path).front().model == "linear_axis");
  CHECK(store::read_history(path).front().model_title == "an axis");
  CHECK(store::read_history(path).front().model_equations == "d = gain * x\n");
  CHECK_THROWS_WITH(store::read_identity(path), Catch::Contains("it is a history of gumshoe trace --append"));

  replace(path, "campaigns/000/information", Numbers{});
  CHECK_THROWS_WITH(store::read_history(path), Catch::Contains("a matrix of information is cut short"));
  replace(path, "campaigns/000/information", Numbers{1});
  replace(path, "campaigns/000/variant",
          Numbers{std::nan("")}); // equal to none, not even to itself: a loop without end
  CHECK_THROWS_WITH(store::read_history(path), Catch::Contains("a variant of a candidate has no number"));
  replace(path, "campaigns/000/unit", Texts{});
  CHECK_THROWS_WITH(store::read_history(path), Catch::Contains("the columns of a campaign differ in length"));

  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).seekp(600).put('\x7f');
  CHECK_THROWS_WITH(store::read_history(path), Catch::Contains("its contents are not those that were written"));
}
