// Runs a fuzz target over inputs that are kept, the corpus and everything that was ever found, and over what is made
// from them by chance. Needs no fuzzer. An input that breaks something is written to replay_fuzz_TARGET.found.
//
// usage: replay_fuzz_TARGET FILE_OR_DIRECTORY... [--mutated N] [--seed S]
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "mutate.h"
#include "target.h"

namespace {

using afm::fuzz::Input;

Input g_input;            // that is being tried
std::string g_file_name;  // for it, if it breaks something

// Only what a signal handler may call.
void keep_input(int signal) {
  const int file = open(g_file_name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && write(file, g_input.data(), g_input.size()) >= 0) {
    const char text[] = "FOUND: the input is in the file *.found\n";
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(3);
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

// [s] for one input; AFM_PATIENCE times as long on a slow machine
unsigned patience() {
  const char* times = std::getenv("AFM_PATIENCE");
  return 30U * static_cast<unsigned>(std::max(1, times ? std::atoi(times) : 1));
}

void try_input(Input input) {
  static const unsigned seconds = patience();
  g_input = std::move(input);
  alarm(seconds);
  LLVMFuzzerTestOneInput(g_input.data(), g_input.size());
}

std::vector<std::filesystem::path> files_in(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Input read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t mutated = 0, seed = 1;
  std::vector<Input> kept;
  g_file_name = std::filesystem::path(argv[0]).filename().string() + ".found";
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM}) std::signal(signal, keep_input);
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--mutated" && i + 1 < argc) mutated = std::stoull(argv[++i]);
    else if (argument == "--seed" && i + 1 < argc) seed = std::stoull(argv[++i]);
    else for (const auto& path : files_in(argument)) {
      std::printf("%s\n", path.c_str());
      std::fflush(stdout);
      kept.push_back(read(path));
      try_input(kept.back());
    }
  }
  if (kept.empty()) return 1;
  afm::fuzz::Mutator mutator(kept, seed);
  for (std::uint64_t n = 0; n < mutated; ++n) try_input(mutator.next());
  std::printf("%zu inputs and %llu made from them\n", kept.size(), static_cast<unsigned long long>(mutated));
}
