// write_schemas FOLDER: writes FOLDER/NAME.schema.json for every table of keys, and replaces the generated
// blocks of FOLDER/README.md (between <!-- NAME keys, generated --> and <!-- end of NAME keys -->).
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include "contract/documents.h"
#include "contract/durable_file.h"
#include "engine/forces/configuration.h"
#include "engine/observables/scene_reading.h"
#include "runner/batch/bundle_files.h"
#include "runner/campaign/campaign.h"
#include "runner/owner/event_stream.h"
#include "runner/owner/request.h"

namespace {

std::string with_block_renewed(std::string page, const std::string& name, const peclet::KeyTable& keys) {
  const std::string begin = "<!-- " + name + " keys, generated -->\n";
  const std::string end = "<!-- end of " + name + " keys -->\n";
  const auto from = page.find(begin);
  const auto to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error("README.md lacks the marks of " + name);
  }
  const auto start = from + begin.size();
  return page.replace(start, to - start, '\n' + keys.markdown() + '\n');
}

void write_schemas(const std::filesystem::path& folder) {
  std::string page = peclet::read_file(folder / "README.md");
  const auto write = [&](const std::string& name, const auto& keys) {
    const std::string file = name + ".schema.json";
    peclet::write_durably(folder / file, keys.json_schema(file).dump(2) + '\n');
  };
  const auto write_both = [&](const std::string& name, const peclet::KeyTable& keys) {
    write(name, keys);
    page = with_block_renewed(page, name, keys);
  };
  write_both("scene", peclet::engine::scene_keys());
  write_both("campaign", peclet::runner::campaign_keys());
  write_both("configuration", peclet::engine::configuration_keys());
  peclet::write_durably(folder / "README.md", page);
  write("result", peclet::result_keys());
  write("frames", peclet::frame_keys());
  write("events", peclet::runner::event_keys());
  write("requests", peclet::runner::request_keys());
  write("manifest", peclet::runner::manifest_keys());
  write("report", peclet::runner::report_keys());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_schemas FOLDER\n";
    return 2;
  }
  try {
    write_schemas(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "write_schemas: " << error.what() << '\n';
    return 1;
  }
}
