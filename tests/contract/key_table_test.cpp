#include "contract/key_table.h"

#include <gtest/gtest.h>

#include "contract/errors.h"

namespace peclet {
namespace {

const KeyTable& table() {
  static const KeyTable keys(
      "Example",
      {
          {.pointer = "/box", .kind = KeyKind::object, .meaning = "It.", .required = true},
          {.pointer = "/box/length",
           .kind = KeyKind::number,
           .meaning = "It.",
           .required = true,
           .minimum = 0,
           .above_minimum = true},
          {.pointer = "/box/cells",
           .kind = KeyKind::integer,
           .meaning = "It.",
           .default_value = 4,
           .minimum = 1,
           .maximum = 64},
          {.pointer = "/box/shape",
           .kind = KeyKind::choice,
           .meaning = "It.",
           .default_value = "cubic",
           .choices = {"cubic", "flat"}},
          {.pointer = "/balls", .kind = KeyKind::array, .meaning = "It.", .minimum_items = 1},
          {.pointer = "/balls/*", .kind = KeyKind::object, .meaning = "It."},
          {.pointer = "/balls/*/radius",
           .kind = KeyKind::number,
           .meaning = "Radius.",
           .unit = "length",
           .required = true,
           .minimum = 0,
           .maximum = 1,
           .below_maximum = true},
          {.pointer = "/balls/*/heavy", .kind = KeyKind::boolean, .meaning = "It.", .default_value = false},
          {.pointer = "/step",
           .kind = KeyKind::number_or_auto,
           .meaning = "It.",
           .minimum = 0,
           .above_minimum = true},
          {.pointer = "/guard", .kind = KeyKind::object, .meaning = "It.", .default_value = Json::object()},
          {.pointer = "/guard/limit", .kind = KeyKind::number, .meaning = "It.", .default_value = 0.05},
          {.pointer = "/name", .kind = KeyKind::string, .meaning = "It."},
          {.pointer = "/extra", .kind = KeyKind::any, .meaning = "It."},
          {.pointer = "/free", .kind = KeyKind::object, .meaning = "It."},
      });
  return keys;
}

InputError fault_of(const char* text) {
  try {
    table().validate(Json::parse(text), "f.json");
  } catch (const InputError& error) {
    return error;
  }
  return {"", "", "", "accepted"};
}

TEST(KeyTable, EachFaultIsNamedWithPointerValueAndWhatIsAllowed) {
  const struct {
    const char* text;
    const char* pointer;
    const char* value;
    const char* allowed;
  } faults[] = {
      {"[]", "", "[]", "must be an object"},
      {"{}", "/box", "missing", "must be an object"},
      {R"({"box": 3})", "/box", "3", "must be an object"},
      {R"({"box": {}})", "/box/length", "missing", "must be a number > 0"},
      {R"({"box": {"length": 0}})", "/box/length", "0", "must be a number > 0"},
      {R"({"box": {"length": "1"}})", "/box/length", "\"1\"", "must be a number > 0"},
      {R"({"box": {"length": null}})", "/box/length", "null", "must be a number > 0"},
      {R"({"box": {"length": 1, "cells": 2.5}})", "/box/cells", "2.5", "must be an integer >= 1 and <= 64"},
      {R"({"box": {"length": 1, "cells": 65}})", "/box/cells", "65", "must be an integer >= 1 and <= 64"},
      {R"({"box": {"length": 1, "shape": "round"}})", "/box/shape", "\"round\"",
       "must be one of: cubic, flat"},
      {R"({"box": {"length": 1}, "balls": []})", "/balls", "[]", "must be an array of 1 or more"},
      {R"({"box": {"length": 1}, "balls": [{"radius": 0.5}, {"radius": 1}]})", "/balls/1/radius", "1",
       "must be a number >= 0 and < 1; 1 % is written 0.01"},
      {R"({"box": {"length": 1}, "balls": [{"radius": 45}]})", "/balls/0/radius", "45",
       "must be a number >= 0 and < 1; 45 % is written 0.45"},
      {R"({"box": {"length": 1}, "balls": [{"radius": 0.5, "heavy": 1}]})", "/balls/0/heavy", "1",
       "must be true or false"},
      {R"({"box": {"length": 1}, "step": "fast"})", "/step", "\"fast\"", "must be a number > 0 or \"auto\""},
      {R"({"box": {"length": 1}, "name": 1})", "/name", "1", "must be a string"},
      {R"({"box": {"length": 1, "lenght": 1}})", "/box/lenght", "unknown key",
       "allowed keys: length, cells, shape; did you mean length?"},
      {R"({"box": {"length": 1}, "a/b~": 1})", "/a~1b~0", "unknown key", "allowed keys: box, balls"},
      {R"({"box": {"length": 1}, "box/cells": 1})", "/box~1cells", "unknown key", "allowed keys: box, balls"},
      {R"({"box": {"length": 1}, "*": 1})", "/*", "unknown key", "allowed keys: box, balls"},
  };
  for (const auto& fault : faults) {
    const InputError error = fault_of(fault.text);
    EXPECT_EQ(error.file(), "f.json") << fault.text;
    EXPECT_EQ(error.pointer(), fault.pointer) << fault.text;
    EXPECT_EQ(error.value(), fault.value) << fault.text;
    EXPECT_TRUE(error.allowed().starts_with(fault.allowed)) << fault.text << ": " << error.allowed();
  }
}

TEST(KeyTable, TheFirstFaultIsReportedAndAMisspeltKeyBeforeTheMissingOne) {
  EXPECT_EQ(fault_of(R"({"zz": 1, "balls": [{"radius": 3}]})").pointer(), "/balls/0/radius");
  EXPECT_EQ(fault_of(R"({"box": {"lenght": 1}})").pointer(), "/box/lenght");
}

TEST(KeyTable, DefaultsAreFilledOnlyInsideWhatIsPresent) {
  const Json filled = table().validate(
      Json::parse(R"({"box": {"length": 2, "cells": 8.0}, "balls": [{"radius": 0}], "step": "auto"})"), "f");
  EXPECT_EQ(filled, Json::parse(R"({"box": {"length": 2, "cells": 8, "shape": "cubic"},
      "balls": [{"radius": 0, "heavy": false}], "step": "auto", "guard": {"limit": 0.05}})"));
  EXPECT_TRUE(filled["box"]["cells"].is_number_integer());
}

TEST(KeyTable, AnythingIsAllowedBelowAnyAndInAnObjectWithoutKeys) {
  const Json document =
      Json::parse(R"({"box": {"length": 1}, "extra": {"a": [1]}, "free": {"b": {"c": null}}})");
  EXPECT_NO_THROW(table().validate(document, "f"));
  EXPECT_EQ(fault_of(R"({"box": {"length": 1}, "free": 3})").pointer(), "/free");
}

TEST(KeyTable, ABlockCanBeCheckedAlone) {
  EXPECT_EQ(table().validate(Json{{"length", 1}}, "f", "/box")["cells"], 4);
  try {
    table().validate(Json{{"length", -1}}, "f", "/box");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/length");
  }
}

TEST(KeyTable, LongValuesAreShortenedBetweenCharacters) {
  EXPECT_EQ(shortened(std::string(58, 'x')).size(), 60U);
  const std::string text = shortened("x" + std::string(100, 'y'));
  EXPECT_EQ(text, "\"x" + std::string(55, 'y') + "...");
  std::string umlauts;
  for (int i = 0; i < 50; ++i) umlauts += "ä";
  EXPECT_NO_THROW(Json(shortened(umlauts)).dump());  // dump() throws inside a cut character
}

TEST(KeyTable, SchemaSaysTheSameAsTheTable) {
  const Json schema = table().json_schema("https://example.org/x");
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["$id"], "https://example.org/x");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], Json::array({"box"}));
  const Json& box = schema["properties"]["box"];
  EXPECT_EQ(box["properties"]["length"],
            Json::parse(R"({"type": "number", "exclusiveMinimum": 0, "description": "It."})"));
  EXPECT_EQ(
      box["properties"]["cells"],
      Json::parse(R"({"type": "integer", "minimum": 1, "maximum": 64, "default": 4, "description": "It."})"));
  EXPECT_EQ(
      schema["properties"]["balls"]["items"]["properties"]["radius"],
      Json::parse(
          R"({"type": "number", "minimum": 0, "exclusiveMaximum": 1, "description": "Radius.", "unit": "length"})"));
  EXPECT_EQ(schema["properties"]["step"]["anyOf"],
            Json::parse(R"([{"const": "auto"}, {"type": "number", "exclusiveMinimum": 0}])"));
  EXPECT_FALSE(schema["properties"]["free"].contains("additionalProperties"));
  EXPECT_EQ(schema["properties"]["extra"], Json::parse(R"({"description": "It."})"));
}

TEST(KeyTable, SchemaSaysWhatPeopleCallAKey) {
  const KeyTable table("T", {{.pointer = "/friction",
                              .kind = KeyKind::number,
                              .meaning = "Sliding.",
                              .words = "coefficient of friction",
                              .symbol = "μ"}});
  EXPECT_EQ(table.json_schema("t")["properties"]["friction"], Json::parse(R"({"type": "number", "title":
      "coefficient of friction", "symbol": "μ", "description": "Sliding."})"));
}

TEST(KeyTable, ManualHasOneRowForEachKey) {
  const std::string page = table().markdown();
  EXPECT_NE(page.find("| `/balls/*/radius` | Radius. | length | required | a number >= 0 and < 1 |\n"),
            std::string::npos);
  EXPECT_NE(page.find("| `/box/shape` | It. |  | `\"cubic\"` | one of: cubic, flat |\n"), std::string::npos);
}

TEST(KeyTable, AnArrayMayHaveAMostNumberOfItems) {
  const KeyTable table("T", {{.pointer = "/sizes",
                              .kind = KeyKind::array,
                              .meaning = "They.",
                              .minimum_items = 1,
                              .maximum_items = 3}});
  EXPECT_NO_THROW(table.validate({{"sizes", {1, 2, 3}}}, "f.json"));
  for (const Json& sizes : {Json::array(), Json{1, 2, 3, 4}}) {
    try {
      table.validate({{"sizes", sizes}}, "f.json");
      ADD_FAILURE() << sizes;
    } catch (const InputError& error) {
      EXPECT_EQ(error.allowed(), "must be an array of 1 to 3");
    }
  }
  EXPECT_EQ(table.json_schema("t")["properties"]["sizes"]["maxItems"], 3);
}

}  // namespace
}  // namespace peclet
