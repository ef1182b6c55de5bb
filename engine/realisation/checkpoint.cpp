#include "engine/realisation/checkpoint.h"

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"

namespace peclet::engine {
namespace {

constexpr std::string_view magic = "PCLTCKPT";
constexpr std::uint32_t version = 10;
constexpr std::size_t header_size = 20;
constexpr std::size_t checksum_size = 64;

// Largest checkpoint that is read [bytes]; a sparse file could be a terabyte. A particle takes some 100 bytes
// and has up to thirty neighbours; blocks and correlations depend on the scene.
std::uint64_t largest_checkpoint(std::size_t particles) {
  return (std::uint64_t{64} << 20) + (std::uint64_t{16} << 10) * particles;
}

std::string_view checked_payload(std::string_view bytes) {
  if (bytes.size() < header_size + checksum_size || bytes.substr(0, magic.size()) != magic) {
    throw CheckpointError("is no checkpoint");
  }
  ArchiveReader header(bytes.substr(magic.size(), header_size - magic.size()));
  if (const auto found = header.get<std::uint32_t>(); found != version) {
    throw CheckpointError("has layout version " + std::to_string(found) + "; this program reads " +
                          std::to_string(version));
  }
  if (header.get<std::uint64_t>() != bytes.size() - header_size - checksum_size) {
    throw CheckpointError("is torn: its length is not the one in its header");
  }
  const std::string_view payload = bytes.substr(header_size, bytes.size() - header_size - checksum_size);
  if (sha256(payload) != bytes.substr(bytes.size() - checksum_size)) {
    throw CheckpointError("is damaged: its checksum does not match");
  }
  return payload;
}

CheckpointIdentity get_identity(ArchiveReader& payload) {
  CheckpointIdentity found;
  payload.get_all(found.scene_sha256, found.seed, found.binary_sha256, found.motion_sha256);
  return found;
}

// Calls use(payload) with the payload of a file. Every fault becomes a CheckpointError that names the file.
template <class Use>
void with_payload(const std::filesystem::path& path, std::size_t particles, const Use& use) {
  try {
    const std::string bytes = read_regular(path, largest_checkpoint(particles));
    ArchiveReader payload(checked_payload(bytes));
    use(payload);
  } catch (const UnsuitableFile& error) {
    throw CheckpointError(error.what());
  } catch (const std::bad_alloc&) {
    throw;                                 // lack of memory is not a fault of the file
  } catch (const std::exception& error) {  // includes a cell smaller than the range of the forces
    throw CheckpointError(path.string() + ": " + error.what());
  }
}

[[noreturn]] void refuse(const char* what) { throw CheckpointError(std::string("belongs to ") + what); }

void require_same_motion(const CheckpointIdentity& found, const CheckpointIdentity& identity) {
  if (found.seed != identity.seed) refuse("another seed");
  if (found.binary_sha256 != identity.binary_sha256)
    refuse("another build of this program or another device");
  if (found.motion_sha256 != identity.motion_sha256) {
    refuse("a scene that differs in more than durations, observables and files, or has another time step");
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const Spent& spent, const Simulation& simulation) {
  ArchiveWriter payload;
  payload.put_all(identity.scene_sha256, identity.seed, identity.binary_sha256, identity.motion_sha256,
                  spent);
  simulation.save(payload);
  ArchiveWriter file;
  file.put(version);
  file.put(static_cast<std::uint64_t>(payload.bytes().size()));
  write_durably(path, std::string(magic) + file.bytes() + payload.bytes() + sha256(payload.bytes()));
}

Spent read_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      Simulation& simulation) {
  Spent spent;
  with_payload(path, simulation.system().particles.count(), [&](ArchiveReader& payload) {
    const CheckpointIdentity found = get_identity(payload);
    if (found.scene_sha256 != identity.scene_sha256) refuse("another scene");
    require_same_motion(found, identity);
    spent = payload.get<Spent>();
    simulation.load(payload);
    if (!payload.at_end()) throw CheckpointError("has unexpected bytes at its end");
  });
  return spent;
}

Progressed read_progress(const std::filesystem::path& path, const CheckpointIdentity& identity,
                         std::size_t particles) {
  Progressed progressed;
  with_payload(path, particles, [&](ArchiveReader& payload) {
    require_same_motion(get_identity(payload), identity);
    progressed.spent = payload.get<Spent>();
    payload.get<Matrix3>();  // the cell at the start
    progressed.step = payload.get<std::uint64_t>();
  });
  return progressed;
}

void extend_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                       Simulation& simulation) {
  with_payload(path, simulation.system().particles.count(), [&](ArchiveReader& payload) {
    require_same_motion(get_identity(payload), identity);
    payload.get<Spent>();
    simulation.load_motion(payload);
  });
}

}  // namespace peclet::engine
