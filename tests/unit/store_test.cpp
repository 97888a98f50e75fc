// The result file: what is written comes back, a run resumes where it stood, and nothing that is not
// ours is overwritten.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/error.h"
#include "folder.h"
#include "made/full_results.h"
#include "store/raw_file.h"
#include "store/result_file.h"

using namespace gumshoe;
using fixture::Folder;
using propagation::Output;
using propagation::ResultBlock;
using store::Identity;
using store::ResultFile;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t block_samples = 640, blocks = 3, samples = block_samples * blocks;

Identity identity() {
  return {"0123456789abcdef",
          "# Frage: wie groß?\nschema = 1\n",
          "rod.toml",
          "rod_gauging",
          "propagation",
          "exact",
          "monte_carlo",
          "0.1.0",
          "avx2",
          "",
          7,
          samples,
          true,
          "fedcba9876543210",
          "run",
          "8899aabbccddeeff",
          "",
          "",
          ""};
}

const std::vector<Output> outputs = {{"laser_z[1]", "laser_z", 0, "mm", "m"}, {"laser_z[2]", "laser_z", 1, "mm", "m"}};
const std::vector<std::string> labels = {"setup 1", "setup 2"};

double value(std::size_t row, std::uint64_t sample) {
  return sample % 100 == 7 ? std::numeric_limits<double>::quiet_NaN()
                           : 0.1 * static_cast<double>(row) + 1e-6 * static_cast<double>(sample);
}

ResultBlock block(std::uint64_t k) {
  ResultBlock b{k * block_samples, block_samples, {}, {}};
  for (std::size_t row = 0; row < outputs.size(); ++row)
    for (std::uint64_t i = 0; i < block_samples; ++i) b.outputs.push_back(value(row, b.first_sample + i));
  for (std::uint64_t i = 0; i < block_samples; ++i) b.status.push_back((b.first_sample + i) % 100 == 7 ? 1 : 0);
  return b;
}

void check_values(const ResultFile& file, std::uint64_t first, std::uint64_t count) {
  for (std::size_t row = 0; row < outputs.size(); ++row) {
    const auto values = file.read(row, first, count);
    REQUIRE(values.size() == count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double expected = value(row, first + i);
      const bool same = std::isnan(expected) ? std::isnan(values[i]) : values[i] == expected;
      if (!same) FAIL("row " << row << ", sample " << first + i << ": " << values[i]);
    }
  }
  const auto status = file.read_status(first, count);
  for (std::uint64_t i = 0; i < count; ++i) REQUIRE(status[i] == ((first + i) % 100 == 7 ? 1 : 0));
}

analysis::Results results() {
  analysis::Results r;
  r.title = "how high is the beam?";
  r.samples = samples;
  for (const Output& output : outputs) {
    analysis::Summary s;
    s.output = output;
    s.estimate = 0.1;
    s.statement = "laser_z = 100 mm";
    s.bin_edges = {0, 1, 2};
    s.density = {0.5, 0.5};
    r.summaries.push_back(s);
  }
  analysis::Budget budget;
  budget.output = outputs[0];
  budget.contributions.resize(2);
  r.budgets = {budget};
  r.notes = {"three readouts have no standard uncertainty"};
  return r;
}

std::string message(const std::string& path, const Identity& id) {
  try {
    ResultFile file(path, id, outputs, labels);
  } catch (const OutputError& error) {
    return error.what();
  }
  return "";
}

std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("a result file resumes where it stood and completes", "[store]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  {
    ResultFile file(path, identity(), outputs, labels);
    REQUIRE(file.samples_done() == 0);
    file.write(block(0));
    file.write(block(1));
    check_values(file, 0, 2 * block_samples);
    CHECK_THROWS_AS(file.read(0, 0, samples), std::out_of_range);
    CHECK_THROWS_AS(file.write(block(1)), std::logic_error); // out of order
    CHECK_THROWS_AS(file.finish(results()), std::logic_error);
  } // as Ctrl-C leaves it
  auto stored = store::read_identity(path);
  CHECK(stored.samples_done == 2 * block_samples);
  CHECK_FALSE(stored.complete);
  CHECK(stored.identity.scenario_text == identity().scenario_text);
  CHECK(stored.identity.samples == samples);
  {
    ResultFile file(path, identity(), outputs, labels);
    REQUIRE(file.samples_done() == 2 * block_samples);
    file.write(block(2));
    check_values(file, 0, samples);
    check_values(file, block_samples - 3, 7); // across two blocks
    file.finish(results());
    check_values(file, 0, samples);
  }
  stored = store::read_identity(path);
  CHECK(stored.complete);
  CHECK(stored.samples_done == samples);
  SECTION("a complete result is replaced, not resumed") {
    ResultFile file(path, identity(), outputs, labels);
    CHECK(file.samples_done() == 0);
  }
}

TEST_CASE("only a run of the same identity is resumed", "[store]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  { ResultFile(path, identity(), outputs, labels).write(block(0)); }
  Identity other = identity();
  SECTION("same") { CHECK(ResultFile(path, other, outputs, labels).samples_done() == block_samples); }
  SECTION("another seed") {
    other.seed = 8;
    CHECK(ResultFile(path, other, outputs, labels).samples_done() == 0);
  }
  SECTION("another instruction set") {
    other.instruction_set = "sse2";
    CHECK(ResultFile(path, other, outputs, labels).samples_done() == 0);
  }
  SECTION("more samples") {
    other.samples += 64;
    CHECK(ResultFile(path, other, outputs, labels).samples_done() == 0);
  }
  SECTION("other outputs") {
    auto more = outputs;
    more.push_back({"bottom_height[1]", "bottom_height", 0, "mm", "m"});
    CHECK(ResultFile(path, other, more, labels).samples_done() == 0);
  }
}

TEST_CASE("a run without stored samples keeps them until it is complete", "[store]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  Identity id = identity();
  id.store_samples = false;
  { ResultFile(path, id, outputs, labels).write(block(0)); }
  ResultFile file(path, id, outputs, labels);
  REQUIRE(file.samples_done() == block_samples);
  for (std::uint64_t k = 1; k < blocks; ++k) file.write(block(k));
  check_values(file, 0, samples);
  file.finish(results());
  CHECK_THROWS_AS(file.read(0, 0, 1), std::out_of_range);
  CHECK(store::read_identity(path).samples_done == samples);
}

TEST_CASE("samples are there as soon as they are written, however short the blocks", "[store]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  constexpr std::uint64_t many = 40; // of which some are gathered to a long write, and the last ones are not yet
  Identity id = identity();
  id.samples = many * block_samples;
  { ResultFile(path, id, outputs, labels).write(block(0)); } // what goes on goes on in the file
  {
    ResultFile file(path, id, outputs, labels);
    for (std::uint64_t k = 1; k < many; ++k) {
      file.write(block(k));
      if (k % 7 != 0) continue;
      const analysis::Samples seen = file.view();
      const double last = seen.values(1)[(k + 1) * block_samples - 1];
      CHECK(last == value(1, (k + 1) * block_samples - 1));
    }
    check_values(file, 0, id.samples);
  } // as Ctrl-C leaves it
  ResultFile file(path, id, outputs, labels);
  REQUIRE(file.samples_done() == id.samples); // all digests hold
  check_values(file, 0, id.samples);
}

TEST_CASE("bytes that are not there are an error", "[store][errors]") {
  const Folder folder;
  const store::RawFile file(folder.write("short", "abc"), O_RDONLY);
  char bytes[4];
  CHECK_NOTHROW(file.read(bytes, 3, 0));
  CHECK_THROWS_WITH(file.read(bytes, 4, 0), Catch::Contains("cannot read the file") && Catch::Contains("too short"));
  CHECK_THROWS_WITH(file.write(bytes, 4, 0), Catch::Contains("cannot write the file"));
}

TEST_CASE("one process writes a file at a time", "[store][errors]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  {
    const ResultFile first(path, identity(), outputs, labels);
    CHECK(message(path, identity()).find("two outputs of this command would be written to it") != std::string::npos);
  }
  CHECK(message(path, identity()).empty());
}

TEST_CASE("nothing that is not ours is overwritten", "[store][errors]") {
  const Folder folder;
  std::string path = folder / "there.h5";
  SECTION("text") { std::ofstream(path) << "a letter to a friend, long enough to be no accident\n"; }
  SECTION("garbage with HDF5's signature") {
    std::ofstream(path, std::ios::binary) << "\x89HDF\r\n\x1a\n" << std::string(4000, '\x5a');
  }
  SECTION("a truncated result of ours") {
    { ResultFile(path, identity(), outputs, labels).write(block(0)); }
    fs::resize_file(path, 1500);
  }
  SECTION("a result of another scenario cut by a byte") {
    Identity other = identity();
    other.scenario_place = "0011223344556677";
    { ResultFile(path, other, outputs, labels).write(block(0)); }
    fs::resize_file(path, fs::file_size(path) - 1);
  }
  const std::string before = bytes(path);
  CHECK(message(path, identity()).find("not a Gumshoe result") != std::string::npos);
  CHECK(message(path, identity()).find(path) != std::string::npos);
  CHECK((bytes(path) == before)); // bracketed: not to be printed
  CHECK_THROWS_AS(store::read_identity(path), InputError);
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1); // no litter
}

TEST_CASE("relative names, links and empty files are good places", "[store]") {
  const Folder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  { ResultFile("bare.h5", identity(), outputs, labels).write(block(0)); }
  std::ofstream("empty.h5").close();
  { ResultFile("empty.h5", identity(), outputs, labels).write(block(0)); }
  fs::create_symlink("bare.h5", "link.h5");
  { ResultFile("link.h5", identity(), outputs, labels).write(block(1)); }
  fs::current_path(before);
  CHECK(fs::is_symlink(folder / "link.h5"));
  CHECK(store::read_identity(folder / "bare.h5").samples_done == 2 * block_samples);
  CHECK(store::read_identity(folder / "empty.h5").samples_done == block_samples);
}

TEST_CASE("a place that cannot hold a file is an error with its reason", "[store][errors]") {
  const Folder folder;
  CHECK(message(folder.path(), identity()).find("directory") != std::string::npos);
  CHECK(message(folder / "missing/run.h5", identity()).find("does not exist") != std::string::npos);
  CHECK(message("/dev/full", identity()).find("not a regular file") != std::string::npos);
  CHECK(message("", identity()).find("no name") != std::string::npos);
  CHECK_THROWS_AS(store::read_identity(folder.path()), InputError);
  CHECK_THROWS_AS(store::read_identity(folder / "missing.h5"), InputError);
  if (geteuid() != 0) { // root may write anywhere
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    CHECK(message(folder / "run.h5", identity()).find("Permission denied") != std::string::npos);
    fs::permissions(folder.path(), fs::perms::owner_all);
  }
}

TEST_CASE("a disk too small is an error before the run, and the older result stays", "[store][errors]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  {
    ResultFile file(path, identity(), outputs, labels);
    for (std::uint64_t k = 0; k < blocks; ++k) file.write(block(k));
    file.finish(results());
  }
  Identity huge = identity();
  huge.samples = std::uint64_t(1) << 46; // a petabyte
  CHECK(message(path, huge).find("cannot allocate") != std::string::npos);
  CHECK(store::read_identity(path).complete);
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a limit on file sizes is an error, not a signal", "[store][errors]") {
  const Folder folder;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 1 << 16;
  Identity id = identity();
  id.samples = 1 << 20;
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string text = message(folder / "run.h5", id);
  setrlimit(RLIMIT_FSIZE, &before);
  CHECK(text.find(std::strerror(EFBIG)) != std::string::npos);
}

TEST_CASE("groups stand only where a study was made, also after another was", "[store]") {
  const Folder folder;
  const std::string path = folder / "run.h5";
  made::write_full_result(path);
  const auto holds = [&](const std::string& group) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const bool there = H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0;
    H5Fclose(file);
    return there;
  };
  const char* studies[] = {"sensitivity", "shapley",  "given_data", "morris", "dgsm",    "one_at_a_time",
                           "joint",       "circular", "conformity", "target", "stopping"};
  for (const char* study : studies) CHECK(holds(study));
  {
    ResultFile file(path, identity(), outputs, labels, true);
    for (std::uint64_t k = 0; k < blocks; ++k) file.write(block(k));
    file.finish(results());
  }
  for (const char* study : studies) CHECK_FALSE(holds(study));
  CHECK(holds("budget"));
}
