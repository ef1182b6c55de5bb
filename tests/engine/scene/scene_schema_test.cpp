// The schema files agree with the table of keys.
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "engine/forces/configuration.h"
#include "engine/observables/scene_reading.h"
#include "engine/scene/scene.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

const fs::path source = PECLET_SOURCE_DIR;

TEST(SceneSchema, TheExampleInTheManualIsValid) {
  const std::string page = read_file(source / "schema/README.md");
  const auto begin = page.find("```json\n", page.find("## Scene")) + 8;
  EXPECT_NO_THROW(
      read_scene(parse_json(page.substr(begin, page.find("```", begin) - begin), "README.md"), "README.md"));
}

// schema_agreement.py tests the schema file with these documents.
TEST(SceneSchema, TheTableJudgesTheReferenceDocumentsByTheirNames) {
  int documents = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(source / "tests/reference/scenes")) {
    const Json document = read_json(entry.path());
    const std::string name = entry.path().filename().string();
    if (name.starts_with("valid_")) {
      EXPECT_NO_THROW(read_scene(document, name));
    } else {
      EXPECT_THROW(scene_keys().validate(document, name), InputError) << name;
    }
    ++documents;
  }
  EXPECT_GE(documents, 40);
}

}  // namespace
}  // namespace peclet::engine
