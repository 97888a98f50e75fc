#include "base/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/encoding.h"
#include "base/error.h"
#include "base/inputs.h"

namespace gumshoe {

namespace {

template <class Convert> std::string read(const std::string& path, std::size_t limit, const Convert& convert) {
  const auto refuse = [&](std::string what, std::string why = {}, std::string remedy = {}) {
    throw InputError(std::vector<Problem>{{{path, 0, 0}, std::move(what), std::move(why), std::move(remedy)}});
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) refuse("the file does not exist");
  if (std::filesystem::is_directory(status)) refuse("this is a directory, not a file");
  inputs::note(path);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::string text;
  char buffer[1 << 16];
  while (in.read(buffer, sizeof buffer), in.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (text.size() > limit) {
      refuse("the file is too large", fmt::format("more than {} bytes", limit), "is it the right file?");
    }
  }
  if (!in.is_open() || in.bad()) refuse(unreadable_file, std::strerror(errno));
  text = convert(std::move(text));
  if (text.find('\0') != std::string::npos) {
    refuse("the file is not text", "it contains NUL bytes", "is it the right file?");
  }
  return text;
}

} // namespace

std::string read_text_file(const std::string& path, std::size_t limit) {
  return read(path, limit, [](std::string text) { return text; });
}

std::string read_data_file(const std::string& path, std::size_t limit) { return read(path, limit, as_utf8); }

} // namespace gumshoe
