// A run that is killed (kill -9) leaves a file from which the same command goes on, whatever it was writing: every
// write, truncation and renaming of a short run is made its last in turn.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "folder.h"
#include "made/full_results.h"
#include "store/result_file.h"

using namespace gumshoe;
using fixture::Folder;
using propagation::ResultBlock;
using store::ResultFile;
namespace fs = std::filesystem;

namespace {

/// Calls left until the process dies in the middle of one; 0: it lives.
int calls_left = 0;
bool dies_now() { return calls_left > 0 && --calls_left == 0; }
[[noreturn]] void die() {
  raise(SIGKILL);
  std::abort();
}

} // namespace

// HDF5 and the store call these instead of the C library's.
extern "C" ssize_t pwrite(int file, const void* data, size_t size, off_t at) {
  if (dies_now()) {
    syscall(SYS_pwrite64, file, data, size / 2, at);
    die();
  }
  return syscall(SYS_pwrite64, file, data, size, at);
}
extern "C" int ftruncate(int file, off_t size) noexcept {
  if (dies_now()) die();
  return static_cast<int>(syscall(SYS_ftruncate, file, size));
}
extern "C" int rename(const char* from, const char* to) noexcept {
  if (dies_now()) die();
  return static_cast<int>(syscall(SYS_rename, from, to));
}

namespace {

constexpr std::uint64_t block_samples = made::samples, most = 4 * block_samples, needed = 3 * block_samples;

store::Identity identity() {
  store::Identity id;
  id.scenario_hash = "0123456789abcdef";
  id.scenario_place = "fedcba9876543210";
  id.scenario_text = "schema = 1\n";
  id.adaptive = "stein 2 100000";
  id.samples = block_samples;
  return id;
}

ResultBlock block(std::uint64_t first) {
  ResultBlock b{first, block_samples, {}, std::vector<std::uint8_t>(block_samples, 0)};
  for (std::size_t k = 0; k < made::outputs().size(); ++k)
    for (std::uint64_t i = 0; i < block_samples; ++i) b.outputs.push_back(made::value(k, first + i));
  return b;
}

/// An adaptive run: room is made as it goes, and what is too many is given up at the end. Opened anew for every block,
/// because closing moves the marker. Throws what the store throws; `remark` is of the first opening.
void run(const std::string& path, std::string* remark = nullptr) {
  for (bool first = true;; first = false) {
    ResultFile file(path, identity(), made::outputs(), {"1"});
    if (first && remark) *remark = file.remark();
    const std::uint64_t done = file.samples_done();
    if (done < most) {
      if (file.samples() < done + block_samples) file.resize(std::min(most, 2 * done));
      file.write(block(done));
      continue;
    }
    file.resize(needed);
    analysis::Results results;
    results.samples = needed;
    results.notes = {"enough of it to be written in many pieces"};
    for (const auto& output : made::outputs()) {
      results.summaries.emplace_back().output = output;
      results.budgets.emplace_back().output = output;
    }
    file.finish(results);
    return;
  }
}

std::string bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether a run in a process of its own, killed at its n-th call, was through before.
bool killed_at(int n, const std::string& path) {
  const pid_t child = fork();
  if (child == 0) {
    calls_left = n;
    try {
      run(path);
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) REQUIRE(WEXITSTATUS(status) == 0);
  return !WIFEXITED(status);
}

} // namespace

TEST_CASE("a run killed at any moment goes on to the same bytes", "[store]") {
  const Folder folder;
  run(folder / "whole.h5");
  const std::string whole = bytes(folder / "whole.h5");
  int n = 1;
  for (bool killed = true; killed; ++n) {
    const fs::path path = folder / "run.h5";
    fs::remove(path);
    killed = killed_at(n, path);
    INFO("killed at call " << n);
    if (fs::exists(path)) CHECK_NOTHROW(store::read_identity(path)); // readable for whoever looks at it
    std::string remark;
    CHECK_NOTHROW(run(path, &remark));
    CHECK(remark.empty());
    CHECK((bytes(path) == whole));                                        // bracketed: not to be printed
    CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 2); // what was half made is gone
  }
  CHECK(n > 100); // it was about something
}

TEST_CASE("a result of ours that cannot be read gives way to a run from the start", "[store]") {
  const Folder folder;
  const fs::path path = folder / "run.h5";
  run(path);
  const std::string whole = bytes(path);
  for (int part = 15; part > 1; --part) {
    INFO("cut to " << part << "/16 of its length");
    fs::resize_file(path, whole.size() * static_cast<std::size_t>(part) / 16);
    CHECK_THROWS_AS(store::read_identity(path), InputError);
    store::Identity other = identity();
    other.scenario_place = "of another scenario";
    CHECK_THROWS_AS(ResultFile(path, other, made::outputs(), {"1"}), OutputError);
    std::string remark;
    run(path, &remark);
    CHECK(remark.find("truncated") != std::string::npos);
    CHECK(remark.find("from the beginning") != std::string::npos);
    CHECK((bytes(path) == whole)); // bracketed: not to be printed
  }
}
