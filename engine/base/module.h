#pragma once
/// Parts of the program in files of their own, opened only where they are needed: the libraries that they bring cost
/// every start, not only theirs.
#include <string>

namespace gumshoe {

/// Address of what a module exports; null where the module cannot be opened or exports no such thing. The module stays
/// open to the end of the process.
///
/// @param name  of the module's file without its ending. It lies next to the program where that is built, in
///              lib/gumshoe where it is installed.
/// @param why   on failure, the reason in the words of the loader
void* module_symbol(const std::string& name, const char* symbol, std::string& why);

} // namespace gumshoe
