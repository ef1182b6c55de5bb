// TARGET [--seed K] [--runs N] [--seconds S] [--findings FOLDER] [FILE | FOLDER]...
//
// Reads every file, then N mutations of valid inputs and files, or mutations for S seconds. Mutation n of
// seed K is reproducible. An input that ends the program is saved as K-n in FOLDER (default: current folder).
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/fuzz_target.h"

// Defined by the address sanitizer, otherwise null.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));  // NOLINT

namespace {

namespace fs = std::filesystem;

struct Options {
  std::uint64_t seed = 1, runs = 0;
  double seconds = 0;
  fs::path findings = ".";
  std::vector<fs::path> files;
};

// The input being read, saved if the program ends in it.
std::string present_input, present_name;

// Saves the present input; uses only async-signal-safe calls.
void leave_finding() {
  const int file = ::open(present_name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  const ssize_t written = ::write(file, present_input.data(), present_input.size());
  ::close(file);
  constexpr char words[] = "\nthe input is left in ";
  if (written >= 0 && ::write(2, words, sizeof words - 1) > 0 &&
      ::write(2, present_name.data(), present_name.size()) > 0) {
    [[maybe_unused]] const ssize_t end = ::write(2, "\n", 1);
  }
}

void leave_finding_of_signal(int number) {
  leave_finding();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

void watch_for_the_end() {
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(leave_finding);
  for (const int number : {SIGABRT, SIGPROF}) std::signal(number, leave_finding_of_signal);
  if (__sanitizer_set_death_callback != nullptr) return;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(number, leave_finding_of_signal);
}

// Sends SIGPROF after `seconds` of processor time, independent of the machine's load; never if 0.
void end_after(long seconds) {
  const itimerval limit{.it_interval = {}, .it_value = {.tv_sec = seconds, .tv_usec = 0}};
  ::setitimer(ITIMER_PROF, &limit, nullptr);
}

void read(std::string input, std::string name) {
  present_input = std::move(input);
  present_name = std::move(name);
  end_after(20);  // ends an endless loop as a finding
  // A separate buffer, so that sanitizers see reads behind its end.
  const std::vector<std::uint8_t> bytes(present_input.begin(), present_input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  end_after(0);
}

class Mutation {
 public:
  Mutation(const std::vector<std::string>& inputs, std::uint64_t seed, std::uint64_t number)
      : inputs_(inputs), random_((seed << 40U) ^ number) {}

  std::string make() {
    std::string bytes = inputs_[below(inputs_.size())];
    for (std::size_t left = 1 + below(4); left > 0; --left) change(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

  // Overwrites bytes with a number at which integers and floats of files tend to go wrong.
  template <class Value>
  void put_number(std::string& bytes, std::size_t place) {
    constexpr Value half = static_cast<Value>(Value{1} << (8 * sizeof(Value) - 1));
    constexpr std::array<Value, 8> integers = {
        0, 1, 2, 255, 65535, static_cast<Value>(-1), half, static_cast<Value>(~half)};
    const Value value = integers[below(integers.size())];
    std::memcpy(bytes.data() + place, &value, std::min(sizeof value, bytes.size() - place));
  }
  template <class Value>
  void put_float(std::string& bytes, std::size_t place) {
    constexpr std::array<Value, 8> floats = {Value{0},    Value{-1},    Value(1e30),     Value(-1e-38),
                                             Value{0.5F}, Value(1e-30), Value(INFINITY), Value(NAN)};
    const Value value = floats[below(floats.size())];
    std::memcpy(bytes.data() + place, &value, std::min(sizeof value, bytes.size() - place));
  }

  // Replaces a word of a text.
  void put_word(std::string& bytes, std::size_t place) {
    // clang-format off
    constexpr std::array<const char*, 24> words = {
        "nan", "-1", "1e300", "inf", "0", "99999999999999999999", "1e-300", "2147483648", "-2147483649", "+1",
        "\"", "'", "=", ":", "\r\n", "\n\n", "\t", "4294967296", "1e30", "0.5", "id:I:1:", "pos:R:3:",
        "Lattice=\"1 0 0 0 1 0 0 0 1\" ", "Time=1 "};
    // clang-format on
    std::size_t end = place;
    while (end < bytes.size() && std::strchr(" \t\n\":=", bytes[end]) == nullptr) ++end;
    if (below(3) == 0) end = place;
    bytes.replace(place, end - place, words[below(words.size())]);
  }

  void change(std::string& bytes) {
    const std::size_t place = below(bytes.size() + 1), left = bytes.size() - place;
    const std::size_t length = std::min(left, 1 + below(1U << below(9)));
    if (left == 0) {
      bytes += static_cast<char>(below(256));
      return;
    }
    // clang-format off
    switch (below(12)) {
      case 0: bytes[place] = static_cast<char>(bytes[place] ^ (1 << below(8))); break;
      case 1: bytes[place] = static_cast<char>(below(256)); break;
      case 2: put_number<std::uint16_t>(bytes, place); break;
      case 3: put_number<std::uint32_t>(bytes, place & ~std::size_t{3}); break;
      case 4: put_number<std::uint64_t>(bytes, place & ~std::size_t{7}); break;
      case 5: put_float<float>(bytes, place & ~std::size_t{3}); break;
      case 6: put_float<double>(bytes, place & ~std::size_t{7}); break;
      case 7: bytes.erase(place, length); break;
      case 8: bytes.insert(place, bytes.substr(below(bytes.size()), length)); break;
      case 9: copy_within(bytes, place, length); break;
      case 10: splice(bytes, place); break;
      default: put_word(bytes, place);
    }
    // clang-format on
    constexpr std::size_t longest = 1U << 16U;
    if (bytes.size() > longest) bytes.resize(longest);
  }

  void copy_within(std::string& bytes, std::size_t place, std::size_t length) {
    const std::string piece = bytes.substr(below(bytes.size() - length + 1), length);
    bytes.replace(place, piece.size(), piece);
  }

  void splice(std::string& bytes, std::size_t place) {
    const std::string& other = inputs_[below(inputs_.size())];
    bytes = bytes.substr(0, place) + other.substr(below(other.size() + 1));
  }

  const std::vector<std::string>& inputs_;
  std::mt19937_64 random_;
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const auto value = [&]() -> std::string {
      if (++k < argc) return argv[k];
      std::fprintf(stderr, "%s: must have a value\n", word.c_str());
      std::exit(2);
    };
    if (word == "--seed") {
      options.seed = std::stoull(value());
    } else if (word == "--runs") {
      options.runs = std::stoull(value());
    } else if (word == "--seconds") {
      options.seconds = std::stod(value());
    } else if (word == "--findings") {
      options.findings = value();
    } else if (fs::is_directory(word)) {
      for (const auto& entry : fs::directory_iterator(word)) options.files.push_back(entry.path());
    } else {
      options.files.emplace_back(word);
    }
  }
  std::sort(options.files.begin(), options.files.end());
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  watch_for_the_end();
  std::vector<std::string> inputs = valid_inputs();
  for (const std::string& input : inputs) read(input, (options.findings / "valid").string());
  if (inputs_accepted != inputs.size()) {
    std::fprintf(stderr, "%zu of %zu valid inputs are refused\n", inputs.size() - inputs_accepted,
                 inputs.size());
    return 1;
  }
  for (const fs::path& file : options.files) {
    inputs.push_back(content(file));
    read(inputs.back(), file.string());
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::uint64_t number = 0;
  for (; number < options.runs || seconds() < options.seconds; ++number) {
    read(Mutation(inputs, options.seed, number).make(),
         (options.findings / (std::to_string(options.seed) + "-" + std::to_string(number))).string());
  }
  std::printf("%zu inputs and %llu mutations of seed %llu in %.1f s: nothing found\n", inputs.size(),
              static_cast<unsigned long long>(number), static_cast<unsigned long long>(options.seed),
              seconds());
  return 0;
}
