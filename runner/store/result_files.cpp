#include "runner/store/result_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <regex>
#include <set>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"
#include "runner/store/realisation_result.h"

namespace peclet::runner {

namespace {

constexpr const char* letters_and_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";

// Checks a row that names a file to be read and written, because the database may come from anywhere.
FileRecord checked(FileRecord record) {
  try {
    check_left_files(Json::array(
        {{{"name", record.file.name}, {"bytes", record.file.bytes}, {"sha256", record.file.sha256}}}));
  } catch (const ResultError& error) {
    throw IntegrityError(fmt::format("the table file has an invalid row: {}", error.what()));
  }
  if (record.hash.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw IntegrityError("the table file has a row of a point with an invalid hash: " + plain(record.hash));
  }
  return record;
}

std::vector<FileRecord> files_where(Connection& connection, const char* condition, std::int64_t point_id,
                                    int seed) {
  Statement query(
      connection,
      fmt::format("SELECT hash, point_id, seed, name, bytes, sha256, kept FROM file JOIN point USING "
                  "(point_id) WHERE {} ORDER BY point_id, seed, name",
                  condition),
      point_id, seed);
  return query.rows([](const Statement& row) {
    const LeftFile file{row.text(3), static_cast<std::uint64_t>(row.integer(4)), row.text(5)};
    return checked({row.text(0), row.integer(1), row.number(2), file, row.flag(6)});
  });
}

// Returns PROCESS of a temporary file of write_durably(), NAME.PROCESS.COUNT.tmp; nothing for another name.
std::optional<int> writer_of(const fs::path& temporary) {
  const std::string process = temporary.stem().stem().extension().string();  // ".PROCESS"
  const auto number = process.empty() ? std::nullopt : number_in<int>(process.substr(1));
  return number && *number > 0 ? number : std::nullopt;
}

}  // namespace

bool is_plain_file_name(const std::string& name) {
  const std::string allowed = std::string(letters_and_digits) + "._-";
  return !name.empty() && name.size() <= longest_left_name &&
         name.find_first_not_of(allowed) == std::string::npos &&
         std::string_view(letters_and_digits).find(name.front()) != std::string_view::npos &&
         name.find("..") == std::string::npos && !name.ends_with(".tmp");
}

void check_left_files(const Json& files) {
  std::set<std::string> names;
  for (const Json& file : checked_part(files, "/files")) {
    const std::string& name = file["name"].get_ref<const std::string&>();
    const std::string pointer = fmt::format("/files/{}/name", names.size());
    if (!is_plain_file_name(name)) {
      throw ResultError(fmt::format(
          "{}: must be a name of 1 to {} letters, digits, dots, underscores and hyphens that begins with a "
          "letter or digit, has no two dots in a row and does not end in .tmp",
          pointer, longest_left_name));
    }
    if (!names.insert(name).second) throw ResultError(pointer + ": must not be there twice");
  }
}

std::vector<LeftFile> left_files(const Json& result) {
  std::vector<LeftFile> files;
  for (const Json& file : result.value("files", Json::array())) {
    files.push_back({file.at("name"), file.at("bytes"), file.at("sha256")});
  }
  return files;
}

fs::path left_folder(const fs::path& spool) { return spool.parent_path() / "files"; }

std::string left_stem(const fs::path& spool) { return spool.stem().string() + '@'; }

fs::path left_file(const fs::path& spool, const std::string& name) {
  return left_folder(spool) / (left_stem(spool) + name);
}

std::vector<fs::path> left_files_of(const fs::path& spool) {
  if (kind_of(left_folder(spool)) != "a folder") return {};
  std::vector<fs::path> files = whole_files(left_folder(spool));
  std::erase_if(files, [stem = left_stem(spool)](const fs::path& file) {
    return !file.filename().string().starts_with(stem);
  });
  return files;
}

Descriptor open_left_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256) {
  if (!is_there(path)) throw ResultError("is missing");
  try {
    Descriptor file = open_regular(path, O_RDONLY);
    struct stat about {};
    if (fstat(file.number(), &about) != 0) fail_to("cannot examine", path);
    if (static_cast<std::uint64_t>(about.st_size) != bytes) {
      throw ResultError(fmt::format("has {} bytes instead of {}", about.st_size, bytes));
    }
    if (sha256_of_open(file.number(), path) != sha256) throw ResultError("does not have its hash");
    if (::fsync(file.number()) != 0) fail_to("cannot synchronise", path);
    return file;
  } catch (const UnsuitableFile& error) {
    throw ResultError(error.value());
  } catch (const std::system_error& error) {
    if (means_machine_fault(error.code().value())) throw;
    throw ResultError(plain(error.what()));
  }
}

std::string fault_of_file(const fs::path& path, std::uint64_t bytes, const std::string& sha256) {
  try {
    open_left_file(path, bytes, sha256);
    return "";
  } catch (const ResultError& error) {
    return error.what();
  } catch (const std::system_error& error) {
    return plain(error.what());
  }
}

std::vector<Descriptor> open_files_in_spool(const Json& result, const fs::path& spool) {
  std::vector<Descriptor> opened;
  for (const LeftFile& file : left_files(result)) {
    try {
      opened.push_back(open_left_file(left_file(spool, file.name), file.bytes, file.sha256));
    } catch (const ResultError& error) {
      throw ResultError(fmt::format("its file {} {}", file.name, error.what()));
    }
  }
  return opened;
}

void store_file(Connection& connection, std::int64_t point_id, int seed, const LeftFile& file, bool kept) {
  connection.run("INSERT INTO file (point_id, seed, name, bytes, sha256, kept) VALUES (?, ?, ?, ?, ?, ?)",
                 point_id, seed, file.name, static_cast<std::int64_t>(file.bytes), file.sha256, kept);
}

std::vector<FileRecord> files_in(Connection& connection) { return files_where(connection, "?1 = ?2", 0, 0); }

std::vector<FileRecord> files_of_point(Connection& connection, std::int64_t point_id) {
  return files_where(connection, "point_id = ?1 AND ?2 = 0", point_id, 0);
}

std::vector<FileRecord> files_of_seed(Connection& connection, std::int64_t point_id, int seed) {
  return files_where(connection, "point_id = ?1 AND seed = ?2", point_id, seed);
}

RealisationResult read_spool_file(const fs::path& path, const std::string& sha256) {
  std::string text;
  try {
    text = read_regular(path, largest_result);
  } catch (const UnsuitableFile& error) {
    throw ResultError(fmt::format("it {} and {}", error.value(), error.allowed()));
  } catch (const std::system_error& error) {
    if (means_machine_fault(error.code().value())) throw;
    throw ResultError(error.what());
  }
  if (!sha256.empty() && peclet::sha256(text) != sha256) {
    throw ResultError("its bytes do not have the hash that the engine gave");
  }
  return parse_result(text);
}

bool belongs_to_another(const fs::path& path, const RealisationResult& result) {
  // The form of CampaignDirectory::spool_file(), for any attempt.
  static const std::regex ours("([0-9a-f]{16})-([0-9]{6,9})-[0-9]+[.]json");
  const std::string name = path.filename().string();
  std::smatch parts;
  if (!std::regex_match(name, parts, ours)) return false;
  return parts[1] != result.point.substr(0, 16) || std::stoi(parts[2]) != result.seed;
}

CampaignDirectory home_of_spool_file(const fs::path& path) {
  return CampaignDirectory(path.parent_path().parent_path());
}

std::vector<fs::path> spool_files(const CampaignDirectory& directory) {
  return whole_files(directory.spool());
}

std::vector<fs::path> whole_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (kind_of(folder).empty()) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const bool is_regular = entry.symlink_status().type() == fs::file_type::regular;
    if (is_regular && entry.path().extension() != ".tmp") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

fs::path reject(const CampaignDirectory& directory, const fs::path& path) {
  std::vector<fs::path> files = left_files_of(path);
  files.push_back(path);
  fs::path target;
  fs::create_directories(directory.rejected());
  for (const fs::path& file : files) {
    target = free_name(directory.rejected() / file.filename());
    std::error_code error;
    fs::rename(file, target, error);
    const bool is_gone = error == std::errc::no_such_file_or_directory;
    if (error && !is_gone) throw fs::filesystem_error("cannot move", file, target, error);
  }
  return target;
}

std::vector<fs::path> unfinished_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".tmp" || kind_of(entry.path()) == "a folder") continue;
    const std::optional<int> writer = writer_of(entry.path());
    if (writer && kill(*writer, 0) != 0 && errno == ESRCH) files.push_back(entry.path());
  }
  return files;
}

void remove_unfinished_files(const fs::path& folder) {
  for (const fs::path& file : unfinished_files(folder)) {
    // A copy of a database may have SQLite's files beside it.
    for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(file.string() + suffix);
  }
}

}  // namespace peclet::runner
