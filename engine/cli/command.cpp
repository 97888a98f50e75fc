#include "cli/command.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/chrono.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/print.h"
#include "effects/effect.h"
#include "store/draft.h"
#include "store/earlier_output.h"

namespace gumshoe::cli {

namespace {

bool external_allowed = false;

/// One's own scenarios, those that came with the system, and those in a folder that the user trusts.
bool trusts(const std::string& scenario) {
  struct stat status {};
  if (external_allowed || stat(scenario.c_str(), &status) != 0 || status.st_uid == geteuid() || status.st_uid == 0)
    return true;
  const char* folders = std::getenv("GUMSHOE_TRUSTED");
  std::istringstream list(folders ? folders : "");
  const std::string file = std::filesystem::weakly_canonical(std::filesystem::absolute(scenario)).string();
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty() && file.starts_with(std::filesystem::weakly_canonical(folder).string() + '/')) return true;
  return false;
}

} // namespace

scenario::Catalogue catalogue() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  c.trusts = &trusts;
  c.read_output = &store::read_output;
  return c;
}

std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t least,
                           const std::string& example, std::uint64_t most) {
  std::size_t used = 0;
  double x = -1;
  try {
    x = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  const bool large = x > static_cast<double>(most);
  if (used == 0 || used != text.size() || !(x >= static_cast<double>(least)) || large || x != std::floor(x))
    throw InputError(fmt::format("{}: '{}' is not a whole number of at least {}{}", option, text, least,
                                 large ? fmt::format(" and at most {}", most) : ""),
                     "", "write a number such as " + example);
  return static_cast<std::uint64_t>(x);
}

void write_table(const std::string& path, const std::string& text, bool force) {
  const store::Claim claim(path);
  std::ifstream in(claim.target(), std::ios::binary);
  const std::string there{std::istreambuf_iterator<char>(in), {}};
  if (there == text) return;
  if (!there.empty() && !force)
    throw OutputError("'" + path + "': not overwritten", "another file stands there",
                      "choose another name, or use --force to replace it");
  store::Draft draft;
  draft.add(claim, text);
  draft.publish();
}

std::string date_text(std::time_t moment) {
  const char* given = std::getenv("SOURCE_DATE_EPOCH");
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(given ? std::time_t(std::atoll(given)) : moment));
}

std::string default_output(const std::string& scenario, const std::string& ending) {
  const std::string name = std::filesystem::path(scenario).stem().string();
  std::error_code failed;
  if (!std::filesystem::create_directories("results", failed) && failed)
    throw OutputError("the folder 'results' cannot be made", failed.message(), "name an output elsewhere with --out");
  // `trace` writes NAME.traced.h5 next to NAME.traced.toml, which may be run.
  return "results/" + name + (ending == ".h5" && name.ends_with(".traced") ? ".run" : "") + ending;
}

void add_external(CLI::App& command) {
  command.add_flag("--allow-external", external_allowed,
                   "let a scenario of another user start its command or load its plugin, with your rights");
}

void add_threads(CLI::App& command, int& threads) {
  static constexpr int most = 1024;
  const auto whole = [](const std::string& text) -> std::string {
    int n = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error == std::errc() && end == text.data() + text.size() && n >= 0 && n <= most) return {};
    return fmt::format("'{}' is not a whole number from 0 to {}", text, most);
  };
  command.add_option("--threads", threads, "0: all processors")
      ->check(CLI::Validator(whole, fmt::format("INT in [0 - {}]", most)));
}

void add_force(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace the output, even if another scenario or another program wrote it");
}

void add_print(CLI::App& command, PrintOptions& print) {
  command.add_option("--format", print.format, "text, csv or json")->check(CLI::IsMember({"text", "csv", "json"}));
  command.add_flag("--budget", print.budget, "text: with the uncertainty budgets; csv: these instead of the summary");
  command.add_flag("--all", print.all, "text: every output, where one line would stand for many readings");
}

} // namespace gumshoe::cli
