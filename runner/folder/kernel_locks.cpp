#include "runner/folder/kernel_locks.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "contract/text_lines.h"

namespace peclet::runner {

// "1: POSIX  ADVISORY  WRITE 4711 fe:01:1234 120 120", "2: FLOCK  ADVISORY  WRITE 4711 fe:01:1234 0 EOF".
std::int64_t process_that_locks(std::uint64_t inode, const std::string& kind, std::uint64_t at) {
  const std::string place_ends = fmt::format(":{}", inode);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string count, its_kind, mode, access, process, place, first, last;
    words >> count >> its_kind >> mode >> access >> process >> place >> first >> last;
    if (its_kind != kind || access != "WRITE" || !place.ends_with(place_ends)) continue;
    const auto end =
        number_in<std::uint64_t>(last).value_or(std::numeric_limits<std::uint64_t>::max());  // "EOF"
    if (number_in<std::uint64_t>(first).value_or(0) <= at && at <= end) {
      return number_in<std::int64_t>(process).value_or(0);
    }
  }
  return 0;
}

}  // namespace peclet::runner
