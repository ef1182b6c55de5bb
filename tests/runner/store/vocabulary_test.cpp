// Names that an engine gives in its hello.
#include <gtest/gtest.h>

#include "contract/documents.h"
#include "contract/frames.h"
#include "runner/store/point_store.h"

namespace peclet::runner {
namespace {

TEST(Vocabulary, FindsTheKeyOfAPointerInTheSchemaOfScenes) {
  const Vocabulary words(Json::parse(R"({"scene_schema": {"properties": {
      "contact": {"properties": {"friction": {"title": "coefficient of friction", "symbol": "μ"}}},
      "balls": {"items": {"properties": {"radius": {"unit": "length", "description": "Radius."}}}}}}})"));
  EXPECT_EQ(words.key("/contact/friction"),
            Json::parse(R"({"pointer": "/contact/friction", "words": "coefficient of friction", "symbol": "μ",
                            "unit": "", "meaning": ""})"));
  EXPECT_EQ(words.key("/balls/3/radius")["unit"], "length");
  EXPECT_EQ(words.key("/balls/3/radius")["meaning"], "Radius.");
}

TEST(Vocabulary, HasOnlyTheNameOfWhatTheEngineDoesNotDescribe) {
  const Json nothing =
      Json::parse(R"({"pointer": "/a/0/b", "words": "", "symbol": "", "unit": "", "meaning": ""})");
  EXPECT_EQ(Vocabulary().key("/a/0/b"), nothing);
  EXPECT_TRUE(Vocabulary().derived().empty());
  for (const char* const schema :
       {"{}", R"({"properties": 3})", R"({"properties": {"a": []}})",
        R"({"properties": {"a": {"items": {"properties": {"b": {"title": 7}}}}}})"}) {
    Json hello;
    hello["scene_schema"] = Json::parse(schema);
    EXPECT_EQ(Vocabulary(hello).key("/a/0/b"), nothing) << schema;
  }
}

TEST(Vocabulary, TakesNothingThatATerminalCannotShow) {
  const Json good = {{"type", "hello"}, {"protocol", 1}, {"engine", Json::object()}};
  EXPECT_NO_THROW(checked_frame(good));
  for (const char* const bad :
       {R"({"scene_schema": 3})", R"({"derived": [3]})", R"({"derived": [{}]})",
        R"({"derived": [{"name": "a\u001b[2J"}]})", R"({"derived": [{"name": "a", "symbol": "\n"}]})"}) {
    Json hello = good;
    hello.update(Json::parse(bad));
    EXPECT_THROW(checked_frame(hello), FrameError) << bad;
  }
}

}  // namespace
}  // namespace peclet::runner
