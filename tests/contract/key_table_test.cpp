#include "contract/key_table.h"

#include <gtest/gtest.h>

#include "tests/contract/refusal.h"

namespace peclet {
namespace {

const KeyTable& table() {
  static const KeyTable keys("Example", R"(
/box | object | It.
/box/length | number > 0 | It.
/box/cells | integer >= 1 and <= 64; default 4 | It.
/box/shape | one of cubic, flat; default "cubic" | It.
/balls? | array of 1 or more | It.
/balls/* | object | It.
/balls/*/radius | number >= 0 and < 1; in length | Radius.
/balls/*/heavy | true or false; default false | It.
/step? | number > 0 or one of auto | It.
/guard | object; default {} | It.
/guard/limit | number; default 0.05 | It.
/name? | string | It.
/extra? | anything | It.
/free? | object | It.
)");
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
      {R"({"box": {"length": 1}, "step": "fast"})", "/step", "\"fast\"", "must be a number > 0, or \"auto\""},
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
  EXPECT_TRUE(refusal_by([] {
                table().validate(Json{{"length", -1}}, "f", "/box");
              }).starts_with("f: /length: "));
}

TEST(KeyTable, ADocumentMayBeASingleValue) {
  const KeyTable table("", {Key{.pointer = "", .kind = KeyKind::integer, .minimum = 1}});
  EXPECT_EQ(table.validate(3, "option"), 3);
  EXPECT_THROW(table.validate(0, "option"), InputError);
  EXPECT_THROW(table.validate("3", "option"), InputError);
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
            Json::parse(R"([{"type": "number", "exclusiveMinimum": 0}, {"enum": ["auto"]}])"));
  EXPECT_FALSE(schema["properties"]["free"].contains("additionalProperties"));
  EXPECT_EQ(schema["properties"]["extra"], Json::parse(R"({"description": "It."})"));
}

TEST(KeyTable, SchemaSaysWhatPeopleCallAKey) {
  const KeyTable table("T", "/friction? | number; named coefficient of friction, μ | Sliding.");
  EXPECT_EQ(table.json_schema("t")["properties"]["friction"], Json::parse(R"({"type": "number", "title":
      "coefficient of friction", "symbol": "μ", "description": "Sliding."})"));
}

TEST(KeyTable, ManualHasOneRowForEachKeyAndElementsInTheRowOfTheirArray) {
  const std::string page = table().markdown();
  EXPECT_TRUE(contains(page, "| `/balls` | It. It. |  |  | an array of 1 or more, each an object |\n"));
  EXPECT_FALSE(contains(page, "| `/balls/*` |"));
  EXPECT_TRUE(
      contains(page, "| `/balls/*/radius` | Radius. | length | required | a number >= 0 and < 1 |\n"));
  EXPECT_TRUE(contains(page, "| `/box/shape` | It. |  | `\"cubic\"` | one of: cubic, flat |\n"));
}

TEST(KeyTable, AnArrayMayHaveAMostNumberOfItems) {
  const KeyTable table("T", "/sizes | array of 1 to 3 | They.");
  EXPECT_NO_THROW(table.validate({{"sizes", {1, 2, 3}}}, "f.json"));
  for (const Json& sizes : {Json::array(), Json{1, 2, 3, 4}}) {
    const std::string refusal = refusal_by([&] { table.validate({{"sizes", sizes}}, "f.json"); });
    EXPECT_TRUE(refusal.ends_with(": must be an array of 1 to 3")) << refusal;
  }
  EXPECT_EQ(table.json_schema("t")["properties"]["sizes"]["maxItems"], 3);
}

const KeyTable& words() {
  static const KeyTable table("T", R"(
/hash? | hash or null
/word? | word
/name? | name
/symbol? | name or empty
/when? | integer >= 0 or one of now, never
/one? | integer = 1
/three? | array of 3
/count? | count
/by_name? | object
/by_name/* | number or null
/first? | object
/first/size | number
/second? | object; as /first
)",
                              Unknown::ignored);
  return table;
}

TEST(KeyTable, ValuesOfEachKindAreTakenOrRefused) {
  const std::string hash(64, 'a'), longest_of_words(64, 'w'), longest_of_names(120, 'N');
  const auto quoted = [](const char* key, const std::string& word) { return Json{{key, word}}.dump(); };
  for (const std::string& good :
       {quoted("hash", hash), quoted("word", longest_of_words), quoted("name", longest_of_names),
        std::string(R"({"hash": null, "word": "timestep-2", "name": "P/P0 µ", "symbol": ""})"),
        std::string(R"({"one": 1, "three": [1, 2, 3], "count": 9007199254740991, "when": 0})"),
        std::string(R"({"by_name": {"a/b": 1.5, "*": null}, "when": "never", "unknown": true})"),
        std::string(R"({"first": {"size": 1}, "second": {"size": 2}})")}) {
    EXPECT_NO_THROW(words().validate(Json::parse(good), "f")) << good;
  }
  for (const std::string& bad :
       {quoted("hash", std::string(63, 'a')), quoted("hash", std::string(64, 'A')), quoted("word", ""),
        quoted("word", "-a"), quoted("word", "A"), quoted("word", longest_of_words + "w"), quoted("name", ""),
        quoted("name", "a\nb"), quoted("name", longest_of_names + "N"), quoted("when", "soon"),
        std::string(R"({"word": null})"), std::string(R"({"when": -1})"), std::string(R"({"one": 2})"),
        std::string(R"({"three": [1, 2, 3, 4]})"), std::string(R"({"count": 9007199254740992.0})"),
        std::string(R"({"count": -1})"), std::string(R"({"by_name": {"a": "1"}})"),
        std::string(R"({"second": {}})"), std::string(R"({"second": {"size": "1"}})")}) {
    EXPECT_THROW(words().validate(Json::parse(bad), "f"), InputError) << bad;
  }
}

TEST(KeyTable, SchemaSaysWhatTheKindsAllow) {
  const Json keys = words().json_schema("t")["properties"];
  EXPECT_EQ(keys["hash"]["type"], (Json{"string", "null"}));
  EXPECT_EQ(keys["one"]["const"], 1);
  EXPECT_EQ(keys["when"]["anyOf"][1]["enum"], (Json{"now", "never"}));
  EXPECT_EQ(keys["by_name"]["additionalProperties"]["type"], (Json{"number", "null"}));
  EXPECT_EQ(keys["second"]["required"], Json::array({"size"}));
  EXPECT_FALSE(words().json_schema("t").contains("additionalProperties"));
  EXPECT_TRUE(contains(words().markdown(), "| an object, with the keys of `/first` |"));
}

TEST(KindTables, ADocumentIsJudgedByTheTableOfItsKind) {
  const KindTables tables("T", "verb", R"(
/at | string
-- go | Goes.
/far | number
-- stay | Stays.
)");
  EXPECT_EQ(tables.validate({{"verb", "go"}, {"at", "x"}, {"far", 2}}, "f")["far"], 2);
  EXPECT_NO_THROW(tables.validate({{"verb", "stay"}, {"at", "x"}}, "f"));
  for (const auto& [document, message] : std::vector<std::pair<Json, std::string>>{
           {Json::array(), "f: []: must be an object"},
           {{{"at", "x"}}, "f: /verb: missing: must be one of: go, stay"},
           {{{"verb", "run"}, {"at", "x"}}, "f: /verb: \"run\": must be one of: go, stay"},
           {{{"verb", "go"}, {"at", "x"}}, "f: /far: missing: must be a number"},
           {{{"verb", "stay"}, {"at", "x"}, {"far", 1}}, "f: /far: unknown key: allowed keys: verb, at"}}) {
    EXPECT_EQ(refusal_by([&, &given = document] { tables.validate(given, "f"); }), message);
  }
  const Json kinds = tables.json_schema("t")["oneOf"];
  EXPECT_EQ(kinds[0]["required"], (Json{"verb", "at", "far"}));
  EXPECT_EQ(kinds[1]["description"], "Stays.");
}

TEST(KeyTable, SomeKeysAreOnlyGivenBesideOthers) {
  const KeyTable table("T", R"(
/form | one of round, flat, oval
/radius | number; if form round, oval
/depth | number; default 2; if form flat
/friction? | number
/load? | number; if friction
/slip | object; if friction
/slip/low, /slip/high | number
/slip/width | number; instead of high
/slip/share | number; instead of high
/slip/steps? | count
)");
  const Json slip = {{"low", 0}, {"high", 1}};
  EXPECT_EQ(table.validate({{"form", "oval"}, {"radius", 1}}, "f").size(), 2);
  EXPECT_EQ(table.validate({{"form", "flat"}, {"friction", 1}, {"load", 1}, {"slip", slip}}, "f")["depth"],
            2);
  for (const auto& [document, message] : std::vector<std::pair<Json, std::string>>{
           {{{"form", "round"}}, "f: /radius: missing: must be a number, because form is round"},
           {{{"radius", 1}}, "f: /form: missing: must be one of: round, flat, oval"},
           {{{"form", "flat"}, {"radius", 1}},
            "f: /radius: 1: must be left out unless form is round or oval"},
           {{{"form", "flat"}, {"friction", 1}},
            "f: /slip: missing: must be an object with low, high or width or share, because friction is "
            "given"},
           {{{"form", "flat"}, {"friction", 1}, {"slip", {{"low", 0}, {"width", 1}, {"share", 2}}}},
            "f: /slip/width: 1: must not be given beside share"},
           {{{"form", "flat"}, {"friction", 1}, {"slip", {{"low", 0}}}},
            "f: /slip/high: missing: must be a number"},
           {{{"form", "flat"}, {"load", 1}}, "f: /load: 1: must be left out without friction"}}) {
    EXPECT_EQ(refusal_by([&, &given = document] { table.validate(given, "f"); }), message);
  }
  const Json schema = table.json_schema("t");
  EXPECT_EQ(schema["dependentRequired"],
            (Json::parse(R"({"load": ["friction"], "slip": ["friction"], "friction": ["slip"]})")));
  EXPECT_EQ(schema["dependentSchemas"]["depth"]["properties"]["form"]["enum"], Json::array({"flat"}));
  EXPECT_EQ(schema["allOf"].size(), 1);
}

TEST(KeyTable, ARowSaysWhatItsKeyIs) {
  const Key key = keys_of(R"(
/a/b | number > 0 and <= 1e3 or null; default 2; in length; instead of c | Over | two lines, not
    /three.
)")
                      .at(0);
  EXPECT_EQ(key.pointer, "/a/b");
  EXPECT_EQ(allowed_values(key), "must be a number > 0 and <= 1000, or null");
  EXPECT_EQ(key.default_value, 2);
  EXPECT_EQ(key.unit, "length");
  EXPECT_EQ(key.instead_of, "c");
  EXPECT_EQ(key.meaning, "Over | two lines, not /three.");
  EXPECT_FALSE(key.required);
  for (const char* row :
       {"no slash", "/a | nombre", "/a | number >", "/a | number > x", "/a | number; unit m"})
    EXPECT_THROW(keys_of(row), std::logic_error) << row;
}

}  // namespace
}  // namespace peclet
