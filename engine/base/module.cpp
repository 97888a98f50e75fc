#include "base/module.h"

#include <filesystem>

#include <dlfcn.h>

namespace gumshoe {
namespace {

std::string file_of(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path folder = fs::read_symlink("/proc/self/exe", none).parent_path();
  const std::string module = name + ".so";
  for (const fs::path& place : {folder.parent_path() / "lib/gumshoe", folder, folder.parent_path()}) // the last for tests
    if (fs::exists(place / module, none)) return (place / module).string();
  return (folder / module).string();
}

} // namespace

void* module_symbol(const std::string& name, const char* symbol, std::string& why) {
  void* const module = dlopen(file_of(name).c_str(), RTLD_NOW | RTLD_LOCAL); // closed by the end of the process
  void* const found = module ? dlsym(module, symbol) : nullptr;
  if (!found) {
    const char* const said = dlerror();
    why = said ? said : name + " exports no " + symbol;
  }
  return found;
}

} // namespace gumshoe
