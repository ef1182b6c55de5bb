#include "runner/store/file_store.h"

#include <fmt/format.h>

#include "contract/integrity_error.h"
#include "runner/store/result_shape.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
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
                  condition));
  query.bind(point_id).bind(seed);
  std::vector<FileRecord> files;
  while (query.step()) {
    files.push_back(checked({query.text(0),
                             query.integer(1),
                             static_cast<int>(query.integer(2)),
                             {query.text(3), static_cast<std::uint64_t>(query.integer(4)), query.text(5)},
                             query.integer(6) != 0}));
  }
  return files;
}

}  // namespace

void store_file(Connection& connection, std::int64_t point_id, int seed, const LeftFile& file, bool kept) {
  Statement(connection,
            "INSERT INTO file (point_id, seed, name, bytes, sha256, kept) VALUES (?, ?, ?, ?, ?, ?)")
      .bind(point_id)
      .bind(seed)
      .bind(file.name)
      .bind(static_cast<std::int64_t>(file.bytes))
      .bind(file.sha256)
      .bind(kept)
      .run();
}

std::vector<FileRecord> files_in(Connection& connection) { return files_where(connection, "?1 = ?2", 0, 0); }

std::vector<FileRecord> files_of_point(Connection& connection, std::int64_t point_id) {
  return files_where(connection, "point_id = ?1 AND ?2 = 0", point_id, 0);
}

std::vector<FileRecord> files_of_seed(Connection& connection, std::int64_t point_id, int seed) {
  return files_where(connection, "point_id = ?1 AND seed = ?2", point_id, seed);
}

}  // namespace peclet::runner
