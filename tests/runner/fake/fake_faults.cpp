#include "tests/runner/fake/fake_faults.h"

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "contract/sha256.h"

namespace peclet::fake {
namespace {

constexpr std::array<std::pair<const char*, Fault>, 20> names{
    {{"crash", Fault::crash},       {"exit", Fault::exit},       {"kill", Fault::kill},
     {"hang", Fault::hang},         {"garble", Fault::garble},   {"refuse", Fault::refuse},
     {"overlap", Fault::overlap},   {"lie", Fault::lie},         {"mute", Fault::mute},
     {"twice", Fault::twice},       {"swap", Fault::swap},       {"nan", Fault::nan},
     {"early", Fault::early},       {"late", Fault::late},       {"truncate", Fault::truncate},
     {"oversize", Fault::oversize}, {"rehello", Fault::rehello}, {"lose", Fault::lose},
     {"tamper", Fault::tamper},     {"escape", Fault::escape}}};

Fault fault_named(const std::string& name) {
  for (const auto& [known, fault] : names) {
    if (known == name) return fault;
  }
  throw std::runtime_error("PECLET_FAKE_FAULTS: unknown fault " + name);
}

}  // namespace

double setting(const char* name, double otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtod(text, nullptr);
}

std::uint64_t mix(std::uint64_t state) {
  state += 0x9e3779b97f4a7c15;
  state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9;
  state = (state ^ (state >> 27)) * 0x94d049bb133111eb;
  return state ^ (state >> 31);
}

std::uint64_t first_bits(const std::string& text) {
  return std::stoull(sha256(text).substr(0, 16), nullptr, 16);
}

int count_try(const std::filesystem::path& folder, const std::string& point, int seed) {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  if (!is_set("PECLET_FAKE_FAULTS") && !is_set("PECLET_FAKE_CRASH_PROBABILITY")) return 1;
  const std::filesystem::path file = folder / ("tries-" + point.substr(0, 16) + "-" + std::to_string(seed));
  int tried = 0;
  std::ifstream(file) >> tried;
  std::ofstream(file) << ++tried;
  return tried;
}

Fault fault_of(const std::string& point, int seed, int tried) {
  const char* const text = std::getenv("PECLET_FAKE_FAULTS");
  std::istringstream entries(text == nullptr ? "" : text);
  for (std::string entry; entries >> entry;) {
    const std::size_t colon = entry.find(':');
    if (colon == std::string::npos) throw std::runtime_error("PECLET_FAKE_FAULTS: no seed in " + entry);
    const std::string rest = entry.substr(colon + 1);
    const std::size_t times = rest.find('x');
    if (std::stoi(rest) != seed) continue;
    if (times == std::string::npos || tried <= std::stoi(rest.substr(times + 1))) {
      return fault_named(entry.substr(0, colon));
    }
  }
  const double probability = setting("PECLET_FAKE_CRASH_PROBABILITY", 0);
  const std::uint64_t dice = mix(first_bits(point) ^ mix(static_cast<std::uint64_t>(seed) * 1000003 +
                                                         static_cast<std::uint64_t>(tried)));
  // Takes the upper 53 bits as a number in [0, 1).
  return static_cast<double>(dice >> 11) * 0x1p-53 < probability ? Fault::crash : Fault::none;
}

}  // namespace peclet::fake
