#include "engine/realisation/checkpoint.h"

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"

namespace peclet::engine {
namespace {

constexpr std::string_view magic = "PCLTCKPT";
constexpr std::uint32_t version = 4;
constexpr std::size_t header_size = 20;
constexpr std::size_t checksum_size = 64;

// A particle has some 100 bytes and up to some thirty neighbours; blocks and correlations are of the scene.
// What is larger is not read: it may be a terabyte of nothing.
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
    throw CheckpointError("is torn: its length is not the one that it states");
  }
  const std::string_view payload = bytes.substr(header_size, bytes.size() - header_size - checksum_size);
  if (sha256(payload) != bytes.substr(bytes.size() - checksum_size)) {
    throw CheckpointError("is damaged: its checksum does not match");
  }
  return payload;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const Spent& spent, const Simulation& simulation) {
  ArchiveWriter payload;
  payload.put(identity.scene_sha256);
  payload.put(identity.seed);
  payload.put(identity.binary_sha256);
  payload.put(spent);
  simulation.save(payload);
  ArchiveWriter file;
  file.put(version);
  file.put(static_cast<std::uint64_t>(payload.bytes().size()));
  write_durably(path, std::string(magic) + file.bytes() + payload.bytes() + sha256(payload.bytes()));
}

Spent read_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      Simulation& simulation) {
  try {
    const std::string bytes = read_regular(path, largest_checkpoint(simulation.system().particles.count()));
    ArchiveReader payload(checked_payload(bytes));
    CheckpointIdentity found;
    found.scene_sha256 = payload.get_string();
    found.seed = payload.get<std::uint64_t>();
    found.binary_sha256 = payload.get_string();
    if (found != identity) {
      const char* what = found.scene_sha256 != identity.scene_sha256 ? "another scene"
                         : found.seed != identity.seed               ? "another seed"
                                                                     : "another build of this program";
      throw CheckpointError(std::string("belongs to ") + what);
    }
    const Spent spent = payload.get<Spent>();
    simulation.load(payload);
    if (!payload.at_end()) {
      throw CheckpointError("holds more than belongs there");
    }
    return spent;
  } catch (const UnsuitableFile& error) {
    throw CheckpointError(error.what());
  } catch (const std::runtime_error& error) {  // also what may not be read
    throw CheckpointError(path.string() + ": " + error.what());
  }
}

}  // namespace peclet::engine
