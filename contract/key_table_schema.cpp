// What a table of keys looks like to others: in words, as JSON Schema, as a page of the manual.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "contract/key_table.h"

namespace peclet {

namespace {

// " >= 1 and <= 5"; nothing where there is no bound.
std::string range_in_words(const Key& key) {
  std::string words;
  if (std::isfinite(key.minimum)) {
    words += fmt::format(" {} {}", key.above_minimum ? ">" : ">=", key.minimum);
  }
  if (std::isfinite(key.maximum)) {
    words +=
        fmt::format("{} {} {}", words.empty() ? "" : " and", key.below_maximum ? "<" : "<=", key.maximum);
  }
  return words;
}

// " of 1 to 256"; nothing where any number will do.
std::string items_in_words(const Key& key) {
  if (key.maximum_items < std::numeric_limits<std::size_t>::max())
    return fmt::format(" of {} to {}", key.minimum_items, key.maximum_items);
  return key.minimum_items == 0 ? "" : fmt::format(" of {} or more", key.minimum_items);
}

// A bound as people and canonical JSON write it: 1, not 1.0.
Json bound(double number) { return Json::parse(canonical_json(number)); }

void add_range(const Key& key, Json& schema) {
  if (std::isfinite(key.minimum)) {
    schema[key.above_minimum ? "exclusiveMinimum" : "minimum"] = bound(key.minimum);
  }
  if (std::isfinite(key.maximum)) {
    schema[key.below_maximum ? "exclusiveMaximum" : "maximum"] = bound(key.maximum);
  }
}

std::string last_part(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

// The key of the same object that may be given instead of this one; null when there is none.
const Key* alternative_to(const KeyTable& table, const Key& key) {
  const std::vector<const Key*> beside = table.below(key.pointer.substr(0, key.pointer.rfind('/')));
  const auto found = std::find_if(beside.begin(), beside.end(), [&](const Key* other) {
    return other->instead_of == last_part(key.pointer);
  });
  return found == beside.end() ? nullptr : *found;
}

void add_members(const KeyTable& table, const std::string& pointer, Json& schema);

Json schema_of(const KeyTable& table, const Key& key) {
  Json schema = Json::object();
  switch (key.kind) {
    case KeyKind::any:
      break;
    case KeyKind::object:
      add_members(table, key.pointer, schema);
      break;
    case KeyKind::array:
      schema["type"] = "array";
      if (key.minimum_items > 0) schema["minItems"] = key.minimum_items;
      if (key.maximum_items < std::numeric_limits<std::size_t>::max()) schema["maxItems"] = key.maximum_items;
      if (const Key* element = table.find(key.pointer + "/*")) schema["items"] = schema_of(table, *element);
      break;
    case KeyKind::boolean:
      schema["type"] = "boolean";
      break;
    case KeyKind::string:
      schema["type"] = "string";
      break;
    case KeyKind::choice:
      schema["enum"] = key.choices;
      break;
    case KeyKind::integer:
    case KeyKind::number:
      schema["type"] = key.kind == KeyKind::integer ? "integer" : "number";
      add_range(key, schema);
      break;
    case KeyKind::number_or_auto: {
      Json number = {{"type", "number"}};
      add_range(key, number);
      schema["anyOf"] = Json::array({{{"const", "auto"}}, number});
      break;
    }
    case KeyKind::integer_or_object: {
      Json integer = {{"type", "integer"}}, object = Json::object();
      add_range(key, integer);
      add_members(table, key.pointer, object);
      schema["anyOf"] = Json::array({integer, object});
      break;
    }
  }
  for (const auto& [name, text] : {std::pair{"title", &key.words},
                                   {"symbol", &key.symbol},
                                   {"description", &key.meaning},
                                   {"unit", &key.unit}}) {
    if (!text->empty()) schema[name] = *text;
  }
  if (!key.default_value.is_null()) schema["default"] = key.default_value;
  return schema;
}

void add_members(const KeyTable& table, const std::string& pointer, Json& schema) {
  schema["type"] = "object";
  const std::vector<const Key*> keys = table.below(pointer);
  if (keys.empty()) return;  // holds anything
  schema["additionalProperties"] = false;
  for (const Key* key : keys) {
    const std::string name = last_part(key->pointer);
    schema["properties"][name] = schema_of(table, *key);
    if (const Key* const other = alternative_to(table, *key)) {
      schema["oneOf"] = {{{"required", {name}}}, {{"required", {last_part(other->pointer)}}}};
    } else if (key->required) {
      schema["required"].push_back(name);
    }
  }
}

// A cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string allowed_values(const Key& key) {
  switch (key.kind) {
    case KeyKind::any:
      return "may be anything";
    case KeyKind::object:
      return "must be an object";
    case KeyKind::array:
      return "must be an array" + items_in_words(key);
    case KeyKind::boolean:
      return "must be true or false";
    case KeyKind::string:
      return "must be a string";
    case KeyKind::choice:
      return fmt::format("must be one of: {}", fmt::join(key.choices, ", "));
    case KeyKind::integer:
      return "must be an integer" + range_in_words(key);
    case KeyKind::number:
      return "must be a number" + range_in_words(key);
    case KeyKind::number_or_auto:
      return "must be a number" + range_in_words(key) + " or \"auto\"";
    case KeyKind::integer_or_object:
      return "must be an integer" + range_in_words(key) + ", or an object";
  }
  return "";
}

Json KeyTable::json_schema(const std::string& identifier) const {
  Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", identifier}, {"title", title_}};
  add_members(*this, "", schema);
  return schema;
}

std::string KeyTable::markdown() const {
  std::string page = "| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n";
  for (const Key& key : keys_) {
    std::string fallback = key.required ? "required" : "";
    if (!key.instead_of.empty()) fallback = fmt::format("instead of `{}`", key.instead_of);
    if (const Key* const other = alternative_to(*this, key)) {
      fallback += fmt::format(", or `{}`", last_part(other->pointer));
    }
    if (!key.default_value.is_null()) fallback = fmt::format("`{}`", key.default_value.dump());
    std::string allowed = allowed_values(key);
    if (allowed.starts_with("must be ")) allowed = allowed.substr(std::string_view("must be ").size());
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.pointer, cell(key.meaning), cell(key.unit),
                        cell(fallback), cell(allowed));
  }
  return page;
}

}  // namespace peclet
