// Drives a fuzz target without libFuzzer, as a test: every file of a corpus, and many damaged copies
// of it, always the same ones. Usage: fuzz_NAME CORPUS_FOLDER MUTATIONS_PER_FILE
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// SplitMix64: the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(next() % bound); }

 private:
  std::uint64_t state_;
};

/// What stands for a number where one stood: out of range, negative, fractional, no number.
constexpr const char* kNumbers[] = {
    "-1",   "0",   "1",    "3",  "255", "65536", "4294967295", "4294967296",
    "1e99", "0.5", "null", "[]", "{}",  "true",  "\"a\"",      "18446744073709551615"};

bool isDigit(char c) { return c >= '0' && c <= '9'; }

void replaceNumber(std::string& bytes, Random& random) {
  const std::size_t start = random.below(bytes.size());
  const auto first = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end(), isDigit);
  const auto last = std::find_if_not(first, bytes.end(), isDigit);
  bytes.replace(first, last, kNumbers[random.below(std::size(kNumbers))]);
}

void mutateOnce(std::string& bytes, Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = random.below(bytes.size());
  const std::size_t length = 1 + random.below(std::min<std::size_t>(64, bytes.size() - at));
  switch (random.below(6)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(random.below(256));
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(random.below(bytes.size()), bytes.substr(at, length));
      break;
    default:
      replaceNumber(bytes, random);
      break;
  }
}

int runOne(const std::string& bytes) {
  return LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: %s CORPUS_FOLDER MUTATIONS_PER_FILE\n", argv[0]), 2;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const long mutations = std::strtol(argv[2], nullptr, 10);
  long accepted = 0, refused = 0;
  for (const std::filesystem::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string source{std::istreambuf_iterator<char>(stream), {}};
    if (runOne(source) != 0) return std::printf("%s of the corpus is refused\n", file.c_str()), 1;
    for (long i = 0; i < mutations; ++i) {
      Random random(static_cast<std::uint64_t>(i));
      std::string bytes = source;
      for (std::size_t count = 1 + random.below(4); count > 0; --count) mutateOnce(bytes, random);
      try {
        ++(runOne(bytes) == 0 ? accepted : refused);
      } catch (const std::exception& error) {
        std::printf("%s, mutation %ld: %s\n", file.c_str(), i, error.what());
        std::ofstream("fuzz-failure.bin", std::ios::binary) << bytes;
        return 1;
      }
    }
  }
  std::printf("%zu files, %ld mutations accepted, %ld refused\n", files.size(), accepted, refused);
  return files.empty() || refused == 0 ? 1 : 0;
}
