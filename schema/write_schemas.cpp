// write_schemas FOLDER: writes FOLDER/NAME.schema.json of every table of keys, and renews the table's block
// in FOLDER/README.md (between <!-- NAME keys, generated --> and <!-- end of NAME keys -->).
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include "contract/durable_file.h"
#include "contract/key_table.h"
#include "engine/forces/configuration.h"
#include "engine/observables/scene_reading.h"
#include "runner/campaign/campaign.h"

namespace {

struct Document {
  std::string name;
  const peclet::KeyTable& keys;
};

std::string with_block_renewed(std::string page, const Document& document) {
  const std::string begin = "<!-- " + document.name + " keys, generated -->\n";
  const std::string end = "<!-- end of " + document.name + " keys -->\n";
  const auto from = page.find(begin);
  const auto to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error("README.md lacks the marks of " + document.name);
  }
  const auto start = from + begin.size();
  return page.replace(start, to - start, '\n' + document.keys.markdown() + '\n');
}

void write_schemas(const std::filesystem::path& folder) {
  const Document documents[] = {
      {"scene", peclet::engine::scene_keys()},
      {"campaign", peclet::runner::campaign_keys()},
      {"configuration", peclet::engine::configuration_keys()},
  };
  std::string page = peclet::read_file(folder / "README.md");
  for (const Document& document : documents) {
    const std::string name = document.name + ".schema.json";
    peclet::write_durably(folder / name, document.keys.json_schema(name).dump(2) + '\n');
    page = with_block_renewed(page, document);
  }
  peclet::write_durably(folder / "README.md", page);
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
