#include "contract/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/contract/refusal.h"

namespace peclet {
namespace {

std::string message_of(const std::string& text) {
  return refusal_by([&] { parse_json(text, "f.json"); });
}

// A text, and the beginning and another part of its message.
struct TextFault {
  const char *text, *start, *fragment;
};

void expect_messages(const std::vector<TextFault>& faults) {
  for (const TextFault& fault : faults) {
    const std::string message = message_of(fault.text);
    EXPECT_TRUE(message.starts_with(fault.start)) << message;
    EXPECT_TRUE(contains(message, fault.fragment));
    EXPECT_FALSE(contains(message, "json.exception"));
    EXPECT_NO_THROW(Json(message).dump()) << "not UTF-8: " << message;
  }
}

TEST(Json, FaultsAreNamedWithFileLineAndColumn) {
  expect_messages({
      {"", "f.json: line 1, column 1: ", "unexpected end of input"},
      {"{\"a\": 1,\n \"b\": }", "f.json: line 2, column 7: ", "unexpected '}'"},
      {"{\"a\": 1}\n{}", "f.json: line 2, column 1: ", "expected end of input"},
      {"{\"a\": 1, // no\n}", "f.json: line 1, column 10: ", "invalid literal"},
      {"[1, 2", "f.json: line 1, column 6: ", "unexpected end of input"},
      {"[\"äö\", x]", "f.json: line 1, column 8: ", "invalid literal"},
      {"{\n  \"a\": 1,\n  \"a\": 2\n}", "f.json: line 3, column 5: ", "duplicate key \"a\""},
      {"[{\"x\": {\"y\": 1, \"y\": 1}}]", "f.json: line 1, column 19: ", "duplicate key \"y\""},
      {"[NaN]", "f.json: line 1, column 2: ", "invalid literal"},
      {"[1e999]", "f.json: line 1, column 7: ", "number overflow"},
  });
}

TEST(Json, WhatPeopleUsuallyTypeWrongIsNamedAndTheMessageIsWholeText) {
  expect_messages({
      {"{\n \"a\": \u201cb\u201d}", "f.json: line 2, column 7: ", "typographic quotation mark"},
      {"{\"a\": [1, 2,]}", "f.json: line 1, column 13: ", "; the comma before it is one too many"},
      {"{\"a\": 1,\n}", "f.json: line 2, column 1: ", "; the comma before it is one too many"},
      {"{\"a\": 1, // no\n}", "f.json: line 1, column 10: ", "; JSON has no comments"},
      {"{\"a\": 0,50}", "f.json: line 1, column 10: ", "; decimals have a point, 0.5, and no comma"},
      {"{\"a\": 0,5,\n \"b\": 1}",
       "f.json: line 1, column 9: ", "; decimals have a point, 0.5, and no comma"},
      {"{'a': 1}", "f.json: line 1, column 2: ", "; JSON has double quotation marks"},
  });
  EXPECT_FALSE(contains(message_of("[NaN]"), "too many"));
  EXPECT_FALSE(contains(message_of("[1,5 x]"), "decimals"));
}

// Cases from the grammar of strings and of both kinds of comments; nothing else of the text changes.
TEST(Json, CommentsBecomeBlanks) {
  const std::pair<const char*, const char*> cases[] = {
      {"1 // one\n", "1       \n"},
      {"[/* a\n\"b */ 2]", "[           2]"},
      {R"({"//": "/* \" // */"})", R"({"//": "/* \" // */"})"},
      {"1/**/", "1    "},
      {"1 // one\r\n2", "1       \r\n2"},
      {"1 //", "1   "},
      {"1 /* open", "1 /* open"},
      {"/*/ 1", "/*/ 1"},
      {"\"open // text", "\"open // text"},
  };
  for (const auto& [text, plain] : cases) EXPECT_EQ(without_comments(text), plain) << text;
}

TEST(Json, InputsMayHaveCommentsAndFaultsBehindThemHaveTheirPlace) {
  EXPECT_EQ(parse_json_input("{ // ä\n \"a\": /* 2 */ 1 }", "f")["a"], 1);
  for (const auto& [text, message] : std::initializer_list<std::pair<const char*, const char*>>{
           {"[1, /* äö */ x]", "f: line 1, column 14: "},
           {"[1, // two\n ]", "f: line 2, column 2: must be JSON: unexpected ']'; the comma before it"},
           {"[1 /* never closed", "f: line 1, column 4: must be JSON: the comment is not closed"},
           {"{\"a\": /* ä\n */ 1,\n /* open\n}",
            "f: line 3, column 2: must be JSON: the comment is not closed"},
           {"[x, /* open", "f: line 1, column 2: must be JSON: invalid literal"},
           {"[1] # one", "comments begin with //"},
       }) {
    const std::string said = refusal_by([given = text] { parse_json_input(given, "f"); });
    EXPECT_TRUE(contains(said, message)) << said;
  }
}

TEST(Json, TheSameKeyInTwoObjectsIsNoDuplicate) {
  EXPECT_EQ(parse_json(R"([{"a": {"a": 1}}, {"a": 2}])", "f")[1]["a"], 2);
}

TEST(Json, BottomlessNestingIsRefused) {
  EXPECT_TRUE(contains(message_of(std::string(1000000, '[')), "nested more than"));
}

TEST(Json, AFileThatIsAbsentIsAnInputError) {
  EXPECT_EQ(refusal_by([] { read_json("/nonexistent/scene.json"); }),
            "/nonexistent/scene.json: cannot be read: No such file or directory");
}

TEST(CanonicalJson, EqualNumbersHaveOneSpelling) {
  for (const char* one : {"1", "1.0", "1e0", "10e-1"})
    EXPECT_EQ(canonical_json(Json::parse(one)), "1") << one;
  for (const char* zero : {"0", "-0", "0.0", "-0.0"})
    EXPECT_EQ(canonical_json(Json::parse(zero)), "0") << zero;
  EXPECT_EQ(canonical_json(Json::parse("-3.0")), "-3");
  EXPECT_EQ(canonical_json(Json::parse("0.10")), "0.1");
  EXPECT_EQ(canonical_json(Json::parse("9007199254740991.0")), "9007199254740991");
}

TEST(CanonicalJson, DoesNotDependOnTheOrderOfKeysOrOnBlanks) {
  EXPECT_EQ(canonical_json(Json::parse("{ \"b\" : [1.0, true, null],\n \"a\" : \"x\\u0041\" }")),
            R"({"a":"xA","b":[1,true,null]})");
}

TEST(CanonicalJson, ReadsBackAsTheSameNumber) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  for (int i = 0; i < 10000; ++i) {
    const double number = std::ldexp(mantissa(random), exponent(random));
    EXPECT_EQ(Json::parse(canonical_json(number)).get<double>(), number);
  }
}

TEST(CanonicalJson, RefusesWhatIsNotFinite) {
  EXPECT_THROW(canonical_json(Json{{"a", std::numeric_limits<double>::quiet_NaN()}}), std::invalid_argument);
  EXPECT_THROW(canonical_json(-std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(InputError, LeavesOutWhatIsEmptyAndCanBeSeenFromOutside) {
  const InputError error("", "/viscosity", "-1", "must be a number > 0");
  EXPECT_STREQ(error.what(), "/viscosity: -1: must be a number > 0");
  EXPECT_STREQ(error.within("c.json", "/scene/fluid").what(),
               "c.json: /scene/fluid/viscosity: -1: must be a number > 0");
}

}  // namespace
}  // namespace peclet
