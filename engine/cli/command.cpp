#include "cli/command.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "effects/effect.h"

namespace gumshoe::cli {

scenario::Catalogue catalogue() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  return c;
}

std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t least) {
  std::size_t used = 0;
  double x = -1;
  try {
    x = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(x >= static_cast<double>(least)) || x > 1e15 || x != std::floor(x))
    throw InputError(option + ": '" + text + "' is not a whole number of at least " + std::to_string(least), "",
                     "write a number such as 1e6");
  return static_cast<std::uint64_t>(x);
}

void require_different(const std::string& out, const std::string& in) {
  std::error_code ignored;
  if (std::filesystem::equivalent(out, in, ignored))
    throw OutputError(out + ": this is the file that is read", "it would be overwritten",
                      "choose another name for the output");
}

void write_text(const std::string& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool wrote = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const bool closed = file && std::fclose(file) == 0;
  if (!wrote || !closed) throw OutputError(path + ": cannot be written", std::strerror(errno));
}

} // namespace gumshoe::cli
