#include "contract/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/errors.h"
#include "contract/text.h"

namespace peclet {
namespace {

std::string_view name_of(const Key& key) {
  return std::string_view(key.pointer).substr(key.pointer.rfind('/') + 1);
}

// A key's name as a segment of a JSON pointer (RFC 6901).
std::string escaped(std::string_view name) {
  std::string segment;
  for (const char c : name) {
    if (c == '~') {
      segment += "~0";
    } else if (c == '/') {
      segment += "~1";
    } else {
      segment += c;
    }
  }
  return segment;
}

bool is_whole(const Json& value) {
  if (value.is_number_integer()) return true;
  constexpr double first_inexact_integer = 9007199254740992.0;  // 2^53
  if (!value.is_number_float()) return false;
  const auto number = value.get<double>();
  return std::trunc(number) == number && std::abs(number) < first_inexact_integer;
}

bool in_range(const Key& key, double number) {
  const bool high_enough = key.above_minimum ? number > key.minimum : number >= key.minimum;
  const bool low_enough = key.below_maximum ? number < key.maximum : number <= key.maximum;
  return std::isfinite(number) && high_enough && low_enough;
}

// Whether the value itself is allowed, whatever may be wrong below it.
bool is_allowed(const Key& key, const Json& value) {
  switch (key.kind) {
    case KeyKind::any:
      return true;
    case KeyKind::object:
      return value.is_object();
    case KeyKind::array:
      return value.is_array() && value.size() >= key.minimum_items && value.size() <= key.maximum_items;
    case KeyKind::boolean:
      return value.is_boolean();
    case KeyKind::string:
      return value.is_string();
    case KeyKind::choice:
      return value.is_string() &&
             std::count(key.choices.begin(), key.choices.end(), value.get<std::string>()) > 0;
    case KeyKind::integer_or_object:
      if (value.is_object()) return true;
      [[fallthrough]];
    case KeyKind::integer:
      return is_whole(value) && in_range(key, value.get<double>());
    case KeyKind::number_or_auto:
      if (value == "auto") return true;
      [[fallthrough]];
    case KeyKind::number:
      return value.is_number() && in_range(key, value.get<double>());
  }
  return false;
}

// A share that was given in per cent, as 5 for 5 %.
std::string hint_at_percent(const Key& key, const Json& value) {
  const bool is_share = key.kind == KeyKind::number && key.minimum >= 0 && key.maximum <= 1;
  if (!is_share || !value.is_number()) return "";
  const double percent = value.get<double>();
  if (percent < 1 || !in_range(key, percent / 100)) return "";
  return fmt::format("; {:g} % is written {:g}", percent, percent / 100);
}

// One pass over a document. `pattern` is where we are in the table, `pointer` where we are in the document.
class Validation {
 public:
  Validation(const KeyTable& table, const std::string& file) : table_(table), file_(file) {}

  void check_value(Json& value, const Key& key, const std::string& pointer) const {
    if (!is_allowed(key, value)) {
      throw InputError(file_, pointer, shortened(value), allowed_values(key) + hint_at_percent(key, value));
    }
    const bool is_either = key.kind == KeyKind::integer_or_object;
    if (key.kind == KeyKind::array) check_array(value, key.pointer, pointer);
    if (key.kind == KeyKind::object || (is_either && value.is_object())) {
      check_object(value, key.pointer, pointer);
    } else if (key.kind == KeyKind::integer || is_either) {
      value = static_cast<long long>(value.get<double>());
    }
  }

  void check_object(Json& object, const std::string& pattern, const std::string& pointer) const {
    const std::vector<const Key*> keys = table_.below(pattern);
    if (keys.empty()) return;
    for (const auto& [name, value] : object.items()) {
      const bool is_plain = name != "*" && name.find('/') == std::string::npos;
      const Key* key = is_plain ? table_.find(pattern + '/' + name) : nullptr;
      if (key == nullptr) refuse_unknown(keys, name, pointer + '/' + escaped(name));
      check_value(value, *key, pointer + '/' + escaped(name));
    }
    for (const Key* key : keys) {
      const std::string name(name_of(*key));
      const std::string below = pointer + '/' + name;
      if (object.contains(name)) {
        refuse_both(object, *key, below);
        continue;
      }
      if (has_alternative(keys, object, name)) continue;
      if (key->required) throw InputError(file_, below, "missing", allowed_values(*key));
      if (key->default_value.is_null()) continue;
      object[name] = key->default_value;
      check_value(object[name], *key, below);
    }
  }

 private:
  void check_array(Json& array, const std::string& pattern, const std::string& pointer) const {
    const Key* element = table_.find(pattern + "/*");
    if (element == nullptr) return;
    for (std::size_t i = 0; i < array.size(); ++i) {
      check_value(array[i], *element, fmt::format("{}/{}", pointer, i));
    }
  }

  static bool has_alternative(const std::vector<const Key*>& keys, const Json& object,
                              const std::string& name) {
    return std::any_of(keys.begin(), keys.end(), [&](const Key* key) {
      return key->instead_of == name && object.contains(name_of(*key));
    });
  }

  void refuse_both(const Json& object, const Key& key, const std::string& pointer) const {
    if (key.instead_of.empty() || !object.contains(key.instead_of)) return;
    throw InputError(file_, pointer, shortened(object[std::string(name_of(key))]),
                     fmt::format("must not be given beside {}", key.instead_of));
  }

  [[noreturn]] void refuse_unknown(const std::vector<const Key*>& keys, const std::string& name,
                                   const std::string& pointer) const {
    std::vector<std::string> names;
    names.reserve(keys.size());
    for (const Key* key : keys) names.emplace_back(name_of(*key));
    throw InputError(file_, pointer, "unknown key",
                     fmt::format("allowed keys: {}{}", fmt::join(names, ", "), suggestion(name, names)));
  }

  const KeyTable& table_;
  const std::string& file_;
};

}  // namespace

KeyTable::KeyTable(std::string title, std::vector<Key> keys)
    : title_(std::move(title)), keys_(std::move(keys)) {}

const Key* KeyTable::find(std::string_view pointer) const {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.pointer == pointer; });
  return found == keys_.end() ? nullptr : &*found;
}

std::vector<const Key*> KeyTable::below(std::string_view pointer) const {
  std::vector<const Key*> found;
  for (const Key& key : keys_) {
    if (std::string_view(key.pointer).substr(0, key.pointer.rfind('/')) == pointer) found.push_back(&key);
  }
  return found;
}

Json KeyTable::validate(const Json& document, const std::string& file, const std::string& root) const {
  const Validation validation(*this, file);
  Json filled = document;
  if (const Key* key = find(root)) {
    validation.check_value(filled, *key, "");
  } else {
    if (!document.is_object()) throw InputError(file, "", shortened(document), "must be an object");
    validation.check_object(filled, root, "");
  }
  return filled;
}

std::string shortened(const Json& value) {
  constexpr std::size_t longest = 60;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= longest) return text;
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // not inside a character
  return text.substr(0, end) + "...";
}

// What a table of keys looks like to others: in words, as JSON Schema, as a page of the manual.

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
