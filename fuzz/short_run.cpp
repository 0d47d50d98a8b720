// Runs a harness without libFuzzer: every file of the folders given, whole, cut off and with bytes changed, so many
// times each. No guidance by coverage; the same inputs on every run. It finds what a change of a parser breaks at once.
//
//   short_NAME ROUNDS FOLDER…
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

std::vector<std::string> inputs_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());  // the order of a folder is nobody's promise
  std::vector<std::string> inputs;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return inputs;
}

class Mutator {
 public:
  // A few of: a byte changed, a bit turned, a number made huge, the end cut off, a part doubled.
  std::string changed(std::string bytes) {
    for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) change(bytes);
    return bytes;
  }

 private:
  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    switch (below(5)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), at + 4)), '\xFF');
        break;
      case 3:
        bytes.resize(at);
        break;
      default:
        bytes.insert(at, bytes.substr(at, 1 + below(16)));
    }
  }
  std::size_t below(std::size_t limit) { return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_); }

  std::mt19937 random_{1};
};

void run(const std::string& bytes) {
  // A copy of its own: reading past the end is seen.
  const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
  LLVMFuzzerTestOneInput(data.data(), data.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: " << argv[0] << " ROUNDS FOLDER...\n";
    return 2;
  }
  const long rounds = std::strtol(argv[1], nullptr, 10);
  std::size_t inputs = 0;
  Mutator mutator;
  for (int i = 2; i < argc; ++i) {
    for (const std::string& input : inputs_in(argv[i])) {
      run(input);
      for (long round = 0; round < rounds; ++round) run(mutator.changed(input));
      ++inputs;
    }
  }
  if (inputs == 0) {
    std::cerr << argv[0] << ": no input\n";
    return 1;
  }
  std::cout << inputs << " inputs, " << rounds << " changes of each\n";
  return 0;
}
