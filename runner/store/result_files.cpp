#include "runner/store/result_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <set>
#include <system_error>

#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/store/realisation_result.h"
#include "runner/store/spool.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr const char* letters_and_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";

// Neither hidden nor an option, no path, and not how unfinished files are called.
bool is_plain_file_name(const std::string& name) {
  const std::string allowed = std::string(letters_and_digits) + "._-";
  return !name.empty() && name.size() <= longest_left_name &&
         name.find_first_not_of(allowed) == std::string::npos &&
         std::string_view(letters_and_digits).find(name.front()) != std::string_view::npos &&
         name.find("..") == std::string::npos && !name.ends_with(".tmp");
}

}  // namespace

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

namespace {

// A row becomes the name of a file that is read and written, and the database may come from anywhere.
FileRecord checked(FileRecord record) {
  try {
    check_left_files(Json::array(
        {{{"name", record.file.name}, {"bytes", record.file.bytes}, {"sha256", record.file.sha256}}}));
  } catch (const ResultError& error) {
    throw IntegrityError(fmt::format("the table file has a row that is none: {}", error.what()));
  }
  if (record.hash.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw IntegrityError("the table file has a row of a point whose hash is none: " + plain(record.hash));
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
    return checked({row.text(0), row.integer(1), row.number(2), file, row.integer(6) != 0});
  });
}

}  // namespace

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

}  // namespace peclet::runner
