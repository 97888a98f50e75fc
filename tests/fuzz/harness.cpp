#include "fuzz/harness.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "base/error.h"

namespace gumshoe::fuzz {
namespace {

struct Folder {
  std::string path;
  Folder() {
    path = (std::filesystem::temp_directory_path() / "gumshoe_fuzz_XXXXXX").string();
    if (!mkdtemp(path.data())) throw std::runtime_error("no folder for the inputs' files");
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

} // namespace

void require(bool holds, const char* promise) {
  if (!holds) throw std::logic_error(promise);
}

void feed(Harness harness, std::string_view input) {
  try {
    harness(input);
  } catch (const InputError& error) {
    require(!error.problems().empty(), "an InputError has at least one problem");
    for (const Problem& p : error.problems()) require(!p.what.empty(), "a problem says what is wrong");
  }
}

std::vector<std::pair<std::string, std::string>> parts(std::string_view input) {
  constexpr std::string_view mark = "==== ";
  std::vector<std::pair<std::string, std::string>> out{{}};
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    const std::string_view line = input.substr(0, end);
    if (line.starts_with(mark) && line.ends_with('\n'))
      out.emplace_back(line.substr(mark.size(), line.size() - mark.size() - 1), "");
    else
      out.back().second += line;
    input.remove_prefix(end);
  }
  return out;
}

const std::string& folder() {
  static const Folder folder;
  return folder.path;
}

std::string write(const std::string& name, std::string_view bytes) {
  const std::string path = folder() + '/' + name;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
  return path;
}

} // namespace gumshoe::fuzz
