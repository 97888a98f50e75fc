#include "store/origin.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/hash.h"
#include "store/identity.h"

namespace gumshoe::store {
namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw OutputError("not overwritten", why, "choose another name, or use --force to replace it");
}

std::string other_command(const std::string& command) {
  return "it is a result of gumshoe " + command + ", another command";
}

bool nothing_at(const std::string& path) {
  std::error_code error;
  return !fs::exists(path, error) || fs::file_size(path, error) == 0;
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Why a text may not be replaced; empty if it may.
std::string why_kept(const std::string& text, const Origin& origin) {
  const std::size_t at = text.find(signature(origin));
  if (at == std::string::npos) {
    const std::string same = "gumshoe " + origin.command + ' ';
    for (std::size_t i = text.find(same); i != std::string::npos; i = text.find(same, i + 1))
      if (std::min(text.find_first_not_of("0123456789abcdef", i + same.size()), text.size()) >= i + same.size() + 16)
        return "gumshoe wrote it for another scenario";
    return "it was not written by gumshoe " + origin.command;
  }
  const std::size_t line = text.rfind("\n# gumshoe ");
  if (line == std::string::npos || line > at) return "";
  return signed_scenario(text.substr(0, line + 1), origin) == text ? "" : "it was edited after gumshoe had written it";
}

} // namespace

std::string place_of(const std::string& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file, error), error);
  return fmt::format("{:016x}", hash64(error ? file : whole.string()));
}

Origin origin_of(const scenario::Scenario& s, const std::string& command, bool force) {
  return {command, s.file, s.hash, place_of(s.file), force};
}

std::string signature(const Origin& origin) { return "gumshoe " + origin.command + ' ' + origin.place; }

std::string signed_scenario(const std::string& text, const Origin& origin) {
  return text + fmt::format("# {} {:016x}\n", signature(origin), hash64(text));
}

Claim claim_result(const std::string& path, const Origin& origin) {
  Claim claim(path);
  if (origin.force || nothing_at(claim.target())) return claim;
  naming(path, [&] {
    Stored there;
    try {
      there = read_identity(claim.target());
    } catch (const InputError& error) {
      const Problem& p = error.problems().front();
      if (!was_ours(claim.target(), origin.place)) refuse("it" + p.what.substr(claim.target().size() + 2) + ": " + p.why);
      claim.remark = fmt::format("'{}' is a Gumshoe result that cannot be read ({}); {} starts from the beginning", path,
                                 p.why, origin.command);
      return;
    }
    if (there.command() != origin.command) refuse(other_command(there.command()));
    const Identity& i = there.identity;
    if (i.scenario_place != origin.place && i.scenario_hash != origin.scenario_hash)
      refuse("it is the result of another scenario, " + i.scenario_file);
    if (i.shard != origin.shard) refuse(fmt::format("it holds shard {}, and not {}", i.shard, origin.shard));
  });
  return claim;
}

Claim claim_text(const std::string& path, const Origin& origin) {
  Claim claim(path);
  if (origin.force || nothing_at(claim.target())) return claim;
  naming(path, [&] {
    if (const std::string why = why_kept(contents(claim.target()), origin); !why.empty()) refuse(why);
  });
  return claim;
}

} // namespace gumshoe::store
