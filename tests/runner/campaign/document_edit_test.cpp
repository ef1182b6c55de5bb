// Tests that an edit changes one value and not a blank of the rest.
#include <gtest/gtest.h>

#include "runner/campaign/campaign_file.h"

namespace peclet::runner {
namespace {

struct Case {
  const char* before;
  std::vector<std::string> path;
  Json value;
  const char* after;
};

const Case cases[] = {
    {R"({"t": {"x": 0.05}})", {"t", "x"}, 0.03, R"({"t": {"x": 0.03}})"},
    {R"({ "t" :{"x":5e-2 ,"y" : [1, {"x": 7}]} , "x": 9 })",
     {"t", "x"},
     0.03,
     R"({ "t" :{"x":0.03 ,"y" : [1, {"x": 7}]} , "x": 9 })"},
    {"{\n\t\"x\": 1,\n\t\"t\": {\n\t\t\"a\": \"}\\\"{\", \"x\": -1\n\t}\n}\n",
     {"t", "x"},
     12,
     "{\n\t\"x\": 1,\n\t\"t\": {\n\t\t\"a\": \"}\\\"{\", \"x\": 12\n\t}\n}\n"},
    // Equal keys in another object, in a string or in an array stay.
    {R"({"a": {"t": {"x": 1}}, "s": "\"t\": {\"x\": 1}", "t": {"x": 1}})",
     {"t", "x"},
     2,
     R"({"a": {"t": {"x": 1}}, "s": "\"t\": {\"x\": 1}", "t": {"x": 2}})"},
    {R"({"\u0074": {"x": true}})", {"t", "x"}, 2, R"({"\u0074": {"x": 2}})"},
    {R"({"x": {"deep": [1, 2]}, "y": 1})", {"x"}, 3, R"({"x": 3, "y": 1})"},
    // Absent keys are added last, spaced as the first one.
    {R"({"t": {"x": 1}})", {"t", "y"}, 0.9, R"({"t": {"x": 1, "y": 0.9}})"},
    {R"({"t":{"x":1}})", {"t", "y"}, 0.9, R"({"t":{"x":1, "y":0.9}})"},
    {R"({"t": { "x": 1 }})", {"t", "y"}, 0.9, R"({"t": { "x": 1, "y": 0.9 }})"},
    {"{\n  \"t\": {\n    \"x\" : 1\n  }\n}",
     {"t", "y"},
     2,
     "{\n  \"t\": {\n    \"x\" : 1,\n    \"y\" : 2\n  }\n}"},
    {"{\r\n  \"t\": {\r\n    \"x\": 1\r\n  }\r\n}",
     {"t", "y"},
     2,
     "{\r\n  \"t\": {\r\n    \"x\": 1,\r\n    \"y\": 2\r\n  }\r\n}"},
    {R"({"t": {}})", {"t", "y"}, 2, R"({"t": {"y": 2}})"},
    // Comments stay where they are, whatever they say.
    {"{ // \"t\": {\n  \"t\": { /* } */ \"x\": 0.05// five\n  } }",
     {"t", "x"},
     0.03,
     "{ // \"t\": {\n  \"t\": { /* } */ \"x\": 0.03// five\n  } }"},
    {"{ // of\r\n  \"t\": {\r\n    \"x\": 1 // wide\r\n  }\r\n}",
     {"t", "y"},
     2,
     "{ // of\r\n  \"t\": {\r\n    \"x\": 1, // wide\r\n    \"y\": 2\r\n  }\r\n}"},
    {"{\n  \"t\": {\n    \"x\": 1 /* of\n two lines */\n  }\n}",
     {"t", "y"},
     2,
     "{\n  \"t\": {\n    \"x\": 1, /* of\n two lines */\n    \"y\": 2\n  }\n}"},
    {"\xEF\xBB\xBF{\"x\": 1}", {"x"}, 2, "\xEF\xBB\xBF{\"x\": 2}"},
    {"{\n  // of the curve\n  \"t\": {\n    // x, \"y\"\n    \"x\": \"//\" // last\n  }\n}",
     {"t", "y"},
     2,
     "{\n  // of the curve\n  \"t\": {\n    // x, \"y\"\n    \"x\": \"//\", // last\n    \"y\": 2\n  }\n}"},
};

TEST(DocumentEdit, ReplacesTheTokenOrAddsTheKeyAndKeepsEveryOtherByte) {
  for (const Case& edit : cases) {
    EXPECT_EQ(with_value(edit.before, edit.path, edit.value), edit.after) << edit.before;
    const auto parsed = [](const std::string& text) { return Json::parse(text, nullptr, true, true); };
    Json expected = parsed(edit.before);
    Json* place = &expected;
    for (const std::string& key : edit.path) place = &(*place)[key];
    *place = edit.value;
    EXPECT_EQ(parsed(with_value(edit.before, edit.path, edit.value)), expected) << edit.before;
  }
}

TEST(DocumentEdit, NeedsTheObjectsOnTheWay) {
  EXPECT_THROW(with_value(R"({"t": 1})", {"t", "x"}, 1), std::invalid_argument);
  EXPECT_THROW(with_value(R"({"u": {}})", {"t", "x"}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace peclet::runner
