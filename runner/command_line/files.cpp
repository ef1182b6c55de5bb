#include "runner/command_line/files.h"

#include <fmt/format.h>

#include <utility>

#include "runner/campaign/text_table.h"
#include "runner/owner/retry_plan.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

std::vector<PointRecord> selected(Database& database, const std::string& name) {
  std::vector<PointRecord> points = database.points();
  if (name.empty()) return points;
  const std::size_t found = find_point(points, name);
  return {std::move(points[found])};
}

Json file_json(const PointRecord& point, const FileRecord& record, const CampaignDirectory& directory) {
  return {{"point", point.label},
          {"hash", point.hash},
          {"seed", record.seed},
          {"name", record.file.name},
          {"bytes", record.file.bytes},
          {"sha256", record.file.sha256},
          {"path", record.kept ? Json(record.place(directory).string()) : Json(nullptr)}};
}

}  // namespace

std::string list_files(Database& database, const CampaignDirectory& directory, const FilesOptions& options) {
  TextTable table;
  table.add_column("point", TextTable::Align::left);
  table.add_column("seed");
  table.add_column("name", TextTable::Align::left);
  table.add_column("bytes");
  table.add_column("path", TextTable::Align::left);
  Json all = Json::array();
  std::string paths;
  for (const PointRecord& point : selected(database, options.point)) {
    for (const FileRecord& record : files_of_point(database.connection(), point.id)) {
      const std::string path = record.place(directory).string();
      if (record.kept) paths += path + '\n';
      all.push_back(file_json(point, record, directory));
      table.add_row({point.label, fmt::format("{}", record.seed), record.file.name,
                     fmt::format("{}", record.file.bytes), record.kept ? path : "thrown away"});
    }
  }
  if (options.json) return all.dump(2) + '\n';
  if (options.paths) return paths;
  return all.empty() ? "no realisation has left a file\n" : table.text();
}

}  // namespace peclet::runner
