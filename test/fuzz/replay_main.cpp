// Runs a fuzz target over inputs that are kept, the corpus and everything that was ever found. Needs no fuzzer. The
// last file that it names is the one that breaks something.
//
// usage: replay_fuzz_TARGET FILE_OR_DIRECTORY...
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "target.h"

namespace {

// [s] for one input; AFM_PATIENCE times as long on a slow machine
unsigned patience() {
  const char* times = std::getenv("AFM_PATIENCE");
  return 30U * static_cast<unsigned>(std::max(1, times ? std::atoi(times) : 1));
}

void try_input(const std::filesystem::path& path) {
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> input{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  alarm(patience());  // a signal that ends the test
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

std::vector<std::filesystem::path> files_in(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t tried = 0;
  for (int i = 1; i < argc; ++i) {
    for (const std::filesystem::path& path : files_in(argv[i])) try_input(path), ++tried;
  }
  std::printf("%zu inputs\n", tried);
  return tried == 0;
}
