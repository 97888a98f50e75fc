/// Feeds every file of the corpus, and the same mutations of it every time, to its harness: gumshoe_corpus FOLDER
/// [HARNESS FILE...]. Without clang, it finds what the fuzzers found once, and what is near it. An input that is a
/// fault is kept as gumshoe_corpus_fault in the current directory.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include "base/hash.h"
#include "fuzz/harness.h"

namespace {

using namespace gumshoe;

constexpr int mutations_a_file = 40;
constexpr long longest_seconds = 10; ///< of the processor, for one input: more is an endless loop

std::string now_input, now_name;

/// Only calls that a signal's handler may make.
void keep_input(int signal) {
  const auto say = [](const char* text, std::size_t size) { (void)!::write(STDERR_FILENO, text, size); };
  const int file = open("gumshoe_corpus_fault", O_CREAT | O_TRUNC | O_WRONLY, 0644);
  (void)!::write(file, now_input.data(), now_input.size());
  close(file);
  const char* const what = signal == SIGPROF ? "takes too long" : "crashes";
  say(now_name.data(), now_name.size()), say(" ", 1), say(what, std::strlen(what));
  say("; the input is gumshoe_corpus_fault\n", 36);
  _exit(1);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Up to four changes: a bit, a part left out, doubled or overwritten by one of another file, a token that readers
/// stumble over.
std::string mutated(std::string text, const std::string& other, std::mt19937_64& random) {
  static const std::string tokens[] = {"",
                                       "\n",
                                       "\"",
                                       "'",
                                       "[",
                                       "]]",
                                       "{",
                                       "}",
                                       "=",
                                       ".",
                                       ",",
                                       "#",
                                       "\\",
                                       "-1",
                                       "0",
                                       "1e308",
                                       "-0",
                                       "nan",
                                       "inf",
                                       "9223372036854775807",
                                       "99999999999999999999",
                                       "*",
                                       "\xff",
                                       "\xe2\x82",
                                       "((((",
                                       "^",
                                       "==== x\n",
                                       "1e-400"};
  const auto below = [&](std::size_t end) { return end == 0 ? 0 : random() % end; };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(text.size()), length = below(std::min<std::size_t>(text.size() - at, 64));
    switch (random() % 5) {
    case 0:
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(below(text.size()), text.substr(at, length));
      break;
    case 3:
      text.replace(at, length, other, std::min(below(other.size()), other.size()), below(64));
      break;
    default:
      text.insert(at, tokens[below(std::size(tokens))]);
    }
  }
  return text;
}

void limit_time(long seconds) {
  const itimerval limit{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

bool sound(const fuzz::Row& row, const std::string& name, std::string input) {
  now_name = name;
  now_input = std::move(input);
  limit_time(longest_seconds);
  try {
    fuzz::feed(row.harness, now_input);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "; the input is gumshoe_corpus_fault\n";
    std::ofstream("gumshoe_corpus_fault", std::ios::binary) << now_input;
    return false;
  }
  limit_time(0);
  return true;
}

/// The number of inputs; throws at the first fault.
std::size_t feed_corpus(const fuzz::Row& row, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) throw std::runtime_error(folder.string() + " is empty");
  std::size_t inputs = 0;
  for (std::size_t i = 0; i < files.size(); ++i, ++inputs) {
    const std::string text = bytes_of(files[i]), other = bytes_of(files[(i + 1) % files.size()]);
    const std::string name = std::string(row.name) + '/' + files[i].filename().string();
    if (!sound(row, name, text)) throw std::runtime_error("a fault");
    std::mt19937_64 random(hash64(name));
    for (int m = 1; m <= mutations_a_file; ++m, ++inputs)
      if (!sound(row, name + ", mutation " + std::to_string(m), mutated(text, other, random)))
        throw std::runtime_error("a fault");
  }
  return inputs;
}

void run(int argc, char** argv) {
  const std::filesystem::path corpus = argv[1];
  for (const fuzz::Row& row : fuzz::harnesses) {
    if (argc > 2) {
      for (int i = 3; i < argc && row.name == std::string(argv[2]); ++i)
        if (!sound(row, argv[i], bytes_of(argv[i]))) throw std::runtime_error("a fault");
      continue;
    }
    std::cout << row.name << ": " << std::flush << feed_corpus(row, corpus / row.name) << " inputs\n";
  }
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: gumshoe_corpus FOLDER [HARNESS FILE...]\n";
    return 2;
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF}) std::signal(signal, keep_input);
  try {
    run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
