// Drives a fuzz target without libFuzzer, as a test: every file of a corpus, and damaged copies of it,
// always the same ones in the same order; how many depends on the time, but never fewer than kFewest.
//   fuzz_NAME CORPUS_FOLDER SECONDS
//   fuzz_NAME FILE MUTATION           one again: its number is told where a target fails
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
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

constexpr long kFewest = 100;

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

std::string readAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What once broke something stays in the corpus as refused_NAME; everything else there can be read.
bool isToBeRefused(const std::filesystem::path& file) {
  return file.filename().string().starts_with("refused_");
}

/// What is being run, for the signal handlers.
const char* g_file = "";
long g_mutation = 0;

constexpr unsigned kMostSecondsAnInput = 30;

void tellAndEnd(int signal) {
  char line[300];
  const int length =
      std::snprintf(line, sizeof line, "signal %d at %s, mutation %ld\n", signal, g_file, g_mutation);
  [[maybe_unused]] const auto written = write(STDOUT_FILENO, line, static_cast<std::size_t>(length));
  std::_Exit(1);
}

/// Mutation `number` of a file; always the same.
std::string mutated(const std::string& source, long number) {
  Random random(static_cast<std::uint64_t>(number));
  std::string bytes = source;
  for (std::size_t count = 1 + random.below(4); count > 0; --count) mutateOnce(bytes, random);
  return bytes;
}

struct Tally {
  long accepted = 0, refused = 0;
};

/// Runs one mutation; a message where the target lets an exception through.
bool runMutation(const std::filesystem::path& file, const std::string& source, long number, Tally& tally) {
  const std::string bytes = mutated(source, number);
  g_file = file.c_str();
  g_mutation = number;
  alarm(kMostSecondsAnInput);
  try {
    ++(runOne(bytes) == 0 ? tally.accepted : tally.refused);
    return true;
  } catch (const std::exception& error) {
    std::printf("%s, mutation %ld: %s\n", file.c_str(), number, error.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CORPUS_FOLDER SECONDS | FILE MUTATION\n", argv[0]);
    return 2;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM})
    std::signal(signal, tellAndEnd);
  Tally tally;
  if (std::filesystem::is_regular_file(argv[1])) {  // one again, that failed
    return runMutation(argv[1], readAll(argv[1]), std::strtol(argv[2], nullptr, 10), tally) ? 0 : 1;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> sources;
  for (const std::filesystem::path& file : files) {
    sources.push_back(readAll(file));
    const bool is_refused = runOne(sources.back()) != 0;
    if (is_refused != isToBeRefused(file)) {
      return std::printf("%s of the corpus is %s\n", file.c_str(), is_refused ? "refused" : "accepted"), 1;
    }
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::strtol(argv[2], nullptr, 10));
  for (long number = 0; number < kFewest || std::chrono::steady_clock::now() < end; ++number) {
    for (std::size_t f = 0; f < files.size(); ++f) {
      if (!runMutation(files[f], sources[f], number, tally)) return 1;
    }
  }
  std::printf("%zu files, %ld mutations accepted, %ld refused\n", files.size(), tally.accepted,
              tally.refused);
  return files.empty() || tally.refused == 0 ? 1 : 0;
}
