#include "engine/realisation/growing_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <system_error>
#include <vector>

#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "engine/realisation/checkpoint.h"
#include "engine/snapshots/conversion.h"

namespace peclet::engine {
namespace {

Descriptor opened(const std::filesystem::path& path, bool has_name) {
  Descriptor file = open_regular(path, O_RDWR | O_CREAT | (has_name ? 0 : O_EXCL));
  if (!has_name) std::filesystem::remove(path);
  return file;
}

}  // namespace

GrowingFile::GrowingFile(const std::filesystem::path& path, bool has_name)
    : path_(path), file_(opened(path, has_name)) {}

void GrowingFile::go_on(const gsd::Frames& frames) const {
  if (const std::string wrong = fault(frames); !wrong.empty()) throw CheckpointError(wrong);
}

void GrowingFile::take(gsd::Frames& frames) const {
  write_at(frames.written(), frames.pending());
  frames.hand_over();
}

void GrowingFile::synchronise() const { peclet::synchronise(file_.number(), path_); }

void GrowingFile::finish(const gsd::Frames& frames, const std::filesystem::path& target) const {
  if (const std::string wrong = fault(frames); !wrong.empty()) throw IntegrityError(wrong);
  const std::string tail = frames.tail();
  write_at(frames.length(), tail);
  write_at(0, frames.head());
  cut(frames.length() + tail.size());
  move_to(0);
  copy_durably(file_.number(), frames.length() + tail.size(), target);
}

void GrowingFile::write_at(std::uint64_t place, std::string_view bytes) const {
  try {
    move_to(place);
    write_all(file_.number(), bytes, path_);
  } catch (const std::system_error& error) {
    const int number = error.code().value();
    if (means_no_room(number))
      throw NoRoomError(number, "cannot write " + path_.string(), path_, bytes.size());
    throw;
  }
}

void GrowingFile::cut(std::uint64_t length) const {
  if (::ftruncate(file_.number(), static_cast<off_t>(length)) != 0) fail_to("cannot cut", path_);
}

void GrowingFile::move_to(std::uint64_t place) const {
  if (::lseek(file_.number(), static_cast<off_t>(place), SEEK_SET) < 0) fail_to("cannot move in", path_);
}

std::string GrowingFile::fault(const gsd::Frames& frames) const {
  for (std::size_t k = 0; k < frames.whole().size(); ++k) {
    const gsd::FrameBytes& frame = frames.whole()[k];
    if (frame.end > frames.written()) break;
    std::string bytes(frame.end - frame.begin, '\0');
    if (read_at(file_.number(), frame.begin, std::as_writable_bytes(std::span(bytes)), path_) <
        bytes.size()) {
      return fmt::format("{}: has no frame {}", path_.string(), k);
    }
    if (!std::ranges::equal(sha256(bytes), frame.sha256)) {
      return fmt::format("{}: frame {} is damaged: its checksum does not match", path_.string(), k);
    }
  }
  return "";
}

std::string extended_xyz(const System& system) {
  const ParticleState& particles = system.particles;
  std::vector<std::size_t> order(particles.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return particles.id[i] < particles.id[j]; });
  const auto &edges = system.box.edges().column, &gradient = system.box.velocity_gradient().column;
  std::string text = fmt::format(
      "{}\nLattice=\"{} {} {}\" Properties=id:I:1:pos:R:3:radius:R:1:velo:R:3:angular_velocity:R:3 pbc=\"T T "
      "T\" Time={} Strain={} Velocity_gradient=\"{} {} {}\"\n",
      particles.count(), spaced(edges[0]), spaced(edges[1]), spaced(edges[2]), system.clock.time(),
      system.box.net_strain(), spaced(gradient[0]), spaced(gradient[1]), spaced(gradient[2]));
  for (const std::size_t i : order) {
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", particles.id[i],
                   spaced(particles.position[i]), particles.radius[i], spaced(particles.velocity[i]),
                   spaced(particles.angular_velocity[i]));
  }
  return text;
}

}  // namespace peclet::engine
