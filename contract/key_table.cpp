#include "contract/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "contract/key_validation.h"
#include "contract/text.h"

namespace peclet {
namespace {

struct KindText {
  KeyKind kind;
  std::string_view row;
  const char *message, *type, *pattern = nullptr;
};

// clang-format off
constexpr KindText kind_texts[] = {
    {KeyKind::object, "object", "an object", "object"},
    {KeyKind::array, "array", "an array", "array"},
    {KeyKind::number, "number", "a number", "number"},
    {KeyKind::integer, "integer", "an integer", "integer"},
    {KeyKind::integer, "count", "an integer", "integer"},
    {KeyKind::boolean, "true or false", "true or false", "boolean"},
    {KeyKind::string, "string", "a string", "string"},
    {KeyKind::hash, "hash", "a SHA-256 in lower-case hexadecimal", "string", "^[0-9a-f]{64}$"},
    {KeyKind::word, "word", "a word of at most 64 letters a-z, digits and hyphens", "string",
     "^[a-z0-9][a-z0-9-]{0,63}$"},
    {KeyKind::name, "name", "a name of 1 to 120 bytes without control characters", "string",
     "^[^\\u0000-\\u001f\\u007f]{1,120}$"},
    {KeyKind::choice, "one of ", nullptr, nullptr},
    {KeyKind::null, "null", "null", "null"},
    {KeyKind::empty, "empty", "\"\"", nullptr},
    {KeyKind::any, "anything", "anything", nullptr},
};
// clang-format on
static_assert(longest_word == 64 && longest_name == 120);

const KindText& text_of(KeyKind kind) {
  return *std::ranges::find_if(kind_texts, [kind](const KindText& text) { return text.kind == kind; });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

// Removes the text before the first `mark` and the mark itself; returns what was before it, trimmed.
std::string_view cut(std::string_view& text, std::string_view mark) {
  const std::size_t end = text.find(mark);
  const std::string_view part = trimmed(text.substr(0, end));
  text = end == std::string_view::npos ? "" : text.substr(end + mark.size());
  return part;
}

bool cut_begin(std::string_view& text, std::string_view begin) {
  if (!text.starts_with(begin)) return false;
  text.remove_prefix(begin.size());
  return true;
}

bool cut_end(std::string_view& text, std::string_view end) {
  if (!text.ends_with(end)) return false;
  text.remove_suffix(end.size());
  return true;
}

// Reads bounds: "> 0 and <= 1", "= 1", "of 3", "of 1 to 64", "of 1 or more".
void read_bounds(Key& key, std::string_view text) {
  const bool is_open = cut_end(text, " or more");
  std::istringstream words{std::string(text)};
  std::string relation;
  for (double bound = 0; words >> relation;) {
    if (relation == "and") continue;
    if (!(words >> bound)) throw std::logic_error("a bound is missing");
    const bool is_exact = relation == "=" || relation == "of";
    if (is_exact || relation.front() == '>') key.minimum = bound;
    if (is_exact || relation.front() == '<' || relation == "to") key.maximum = bound;
    key.above_minimum = key.above_minimum || relation == ">";
    key.below_maximum = key.below_maximum || relation == "<";
  }
  if (is_open) key.maximum = std::numeric_limits<double>::infinity();
}

void read_choices(Key& key, std::string_view text) {
  while (!text.empty()) key.choices.emplace_back(cut(text, ", "));
}

void read_kind(Key& key, std::string_view text) {
  for (std::size_t at = text.rfind(" or "); at != std::string_view::npos; at = text.rfind(" or ")) {
    std::string_view other = text.substr(at + 4);
    const bool is_choice = cut_begin(other, text_of(KeyKind::choice).row);
    const auto* const found = std::ranges::find(kind_texts, other, &KindText::row);
    if (!is_choice && found == std::end(kind_texts)) break;
    key.others.push_back(is_choice ? KeyKind::choice : found->kind);
    if (is_choice) read_choices(key, other);
    text = text.substr(0, at);
  }
  const auto* const found =
      std::ranges::find_if(kind_texts, [&](const KindText& kind) { return text.starts_with(kind.row); });
  if (found == std::end(kind_texts)) throw std::logic_error("the kind is not known");
  key.kind = found->kind;
  text.remove_prefix(found->row.size());
  if (key.kind == KeyKind::choice) {
    read_choices(key, text);
  } else if (found->row == "count") {
    key.minimum = 0;
    key.maximum = largest_count - 1;
  } else {
    read_bounds(key, text);
  }
}

void read_row(std::string_view row, std::vector<Key>& keys) {
  std::string_view rest = row, pointers = cut(rest, " | "), allowed = cut(rest, " | ");
  Key key;
  key.meaning = trimmed(rest);
  read_kind(key, cut(allowed, "; "));
  while (!allowed.empty()) {
    std::string_view more = cut(allowed, "; ");
    if (cut_begin(more, "in ")) {
      key.unit = more;
    } else if (cut_begin(more, "named ")) {
      key.words = cut(more, ", ");
      key.symbol = more;
    } else if (cut_begin(more, "default ")) {
      key.default_value = Json::parse(more);
    } else if (cut_begin(more, "instead of ")) {
      key.instead_of = more;
    } else if (cut_begin(more, "if ")) {
      key.only_if = cut(more, " ");
      while (!more.empty()) key.if_words.emplace_back(cut(more, ", "));
    } else if (cut_begin(more, "as ")) {
      key.same_as = more;
    } else {
      throw std::logic_error(fmt::format("\"{}\" is not known", more));
    }
  }
  while (!pointers.empty()) {
    std::string_view pointer = cut(pointers, ", ");
    key.required = !cut_end(pointer, "?") && !pointer.ends_with('*') && key.default_value.is_null() &&
                   key.instead_of.empty();
    key.pointer = pointer;
    keys.push_back(key);
  }
}

// Returns the rows and the lines that begin a kind, each joined into one line.
std::vector<std::string> rows_in(std::string_view text) {
  std::vector<std::string> rows;
  while (!text.empty()) {
    const bool is_row = text.starts_with('/') || text.starts_with("-- ");
    const std::string_view line = cut(text, "\n");
    if (is_row) {
      rows.emplace_back(line);
    } else if (!line.empty()) {
      if (rows.empty()) throw std::logic_error(fmt::format("a table of keys begins with {}", line));
      rows.back() += fmt::format(" {}", line);
    }
  }
  return rows;
}

std::string bounds_in_words(const Key& key) {
  const bool is_array = key.kind == KeyKind::array, has_least = std::isfinite(key.minimum);
  if (key.minimum == key.maximum) return fmt::format(" {} {}", is_array ? "of" : "=", key.minimum);
  if (is_array && std::isfinite(key.maximum))
    return fmt::format(" of {} to {}", has_least ? key.minimum : 0, key.maximum);
  if (is_array) return has_least ? fmt::format(" of {} or more", key.minimum) : "";
  std::string words;
  if (has_least) words += fmt::format(" {} {}", key.above_minimum ? ">" : ">=", key.minimum);
  if (std::isfinite(key.maximum)) {
    words += fmt::format("{} {} {}", has_least ? " and" : "", key.below_maximum ? "<" : "<=", key.maximum);
  }
  return words;
}

// Returns a bound as canonical JSON has it: 1, not 1.0.
Json bound(double number) { return Json::parse(canonical_json(number)); }

void add_range(const Key& key, Json& schema) {
  if (key.kind == KeyKind::array) {
    if (key.minimum > 0) schema["minItems"] = bound(key.minimum);
    if (std::isfinite(key.maximum)) schema["maxItems"] = bound(key.maximum);
  } else if (key.minimum == key.maximum) {
    schema["const"] = bound(key.minimum);
  } else {
    if (std::isfinite(key.minimum))
      schema[key.above_minimum ? "exclusiveMinimum" : "minimum"] = bound(key.minimum);
    if (std::isfinite(key.maximum))
      schema[key.below_maximum ? "exclusiveMaximum" : "maximum"] = bound(key.maximum);
  }
}

void add_members(const KeyTable& table, const std::string& pointer, Json& schema);

Json schema_of(const KeyTable& table, const Key& key) {
  const KindText& kind = text_of(key.kind);
  const std::string& pattern = key.same_as.empty() ? key.pointer : key.same_as;
  Json schema = Json::object();
  if (kind.type != nullptr) schema["type"] = kind.type;
  if (kind.pattern != nullptr) schema["pattern"] = kind.pattern;
  if (key.kind == KeyKind::choice) schema["enum"] = key.choices;
  if (key.kind == KeyKind::empty) schema["const"] = "";
  if (key.kind == KeyKind::object) add_members(table, pattern, schema);
  if (const Key* element = key.kind == KeyKind::array ? table.find(pattern + "/*") : nullptr)
    schema["items"] = schema_of(table, *element);
  add_range(key, schema);
  if (key.others == std::vector{KeyKind::null} && kind.type != nullptr) {
    schema["type"] = {kind.type, "null"};
  } else if (!key.others.empty()) {
    Json all = Json::array({schema});
    for (const KeyKind other : key.others)
      all.push_back(schema_of(table, {.pointer = pattern, .kind = other, .choices = key.choices}));
    schema = {{"anyOf", all}};
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
  if (!table.ignores_unknown()) schema["additionalProperties"] = false;
  for (const Key* key : keys) {
    const std::string name(name_of(*key));
    if (name == "*") {
      schema["additionalProperties"] = schema_of(table, *key);
      continue;
    }
    schema["properties"][name] = schema_of(table, *key);
    if (const std::vector<const Key*> others = alternatives_to(keys, *key); !others.empty()) {
      schema["oneOf"] = {{{"required", {name}}}};
      for (const Key* const other : others) schema["oneOf"].push_back({{"required", {name_of(*other)}}});
    } else if (!key->only_if.empty()) {
      const Json where = {{"properties", {{key->only_if, {{"enum", key->if_words}}}}}};
      if (key->if_words.empty()) {
        schema["dependentRequired"][name].push_back(key->only_if);
        if (key->required) schema["dependentRequired"][key->only_if].push_back(name);
      } else {
        schema["dependentSchemas"][name] = where;
        if (key->required) schema["allOf"].push_back({{"if", where}, {"then", {{"required", {name}}}}});
      }
    } else if (key->required) {
      schema["required"].push_back(name);
    }
  }
}

// Returns the key of the elements of an array, or null.
const Key* element_of(const KeyTable& table, const Key& key) {
  if (key.kind != KeyKind::array) return nullptr;
  return table.find(key.same_as.empty() ? key.pointer : key.same_as, "*");
}

bool is_element(const KeyTable& table, const Key& key) {
  if (name_of(key) != "*") return false;
  const Key* const above = table.find(std::string_view(key.pointer).substr(0, key.pointer.rfind('/')));
  return above != nullptr && above->kind == KeyKind::array;
}

// Returns what the manual says of a key: "an array of 3, each a number > 0".
std::string allowed_in_manual(const KeyTable& table, const Key& key) {
  std::string allowed = allowed_values(key);
  if (allowed.starts_with("must be ")) allowed = allowed.substr(std::string_view("must be ").size());
  if (const Key* const element = element_of(table, key))
    return fmt::format("{}, each {}", allowed, allowed_in_manual(table, *element));
  if (!key.same_as.empty()) allowed += fmt::format(", with the keys of `{}`", key.same_as);
  return allowed;
}

// Returns the text as a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string_view name_of(const Key& key) {
  return std::string_view(key.pointer).substr(key.pointer.rfind('/') + 1);
}

std::vector<const Key*> alternatives_to(const std::vector<const Key*>& keys, const Key& key) {
  std::vector<const Key*> found;
  std::ranges::copy_if(keys, std::back_inserter(found),
                       [&](const Key* other) { return other->instead_of == name_of(key); });
  return found;
}

KeyTable::KeyTable(std::string title, std::vector<Key> keys, Unknown unknown)
    : title_(std::move(title)), keys_(std::move(keys)), unknown_(unknown) {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    Object& object = objects_[keys_[i].pointer.substr(0, keys_[i].pointer.rfind('/'))];
    object.keys.push_back(i);
    object.by_name.emplace(name_of(keys_[i]), i);
  }
}

const Key* KeyTable::find(std::string_view pointer) const {
  const std::size_t end = pointer.rfind('/');
  return end == std::string_view::npos ? find(pointer, pointer)
                                       : find(pointer.substr(0, end), pointer.substr(end + 1));
}

const Key* KeyTable::find(std::string_view object, std::string_view name) const {
  const auto keys = objects_.find(object);
  if (keys == objects_.end()) return nullptr;
  const auto found = keys->second.by_name.find(name);
  return found == keys->second.by_name.end() ? nullptr : &keys_[found->second];
}

std::vector<const Key*> KeyTable::below(std::string_view pointer) const {
  std::vector<const Key*> keys;
  if (const auto found = objects_.find(pointer); found != objects_.end()) {
    for (const std::size_t place : found->second.keys) keys.push_back(&keys_[place]);
  }
  return keys;
}

Json KeyTable::validate(Json document, const std::string& file, const std::string& root) const {
  validate_keys(*this, file, root, document);
  return document;
}

Json KindTables::validate(Json document, const std::string& file) const {
  // The key that tells the kinds apart is checked first.
  document = kind_.validate(std::move(document), file);
  const std::string name = document[name_of(key_)];
  const auto found = std::ranges::find(key_.choices, name);
  return tables_[static_cast<std::size_t>(found - key_.choices.begin())].validate(std::move(document), file);
}

bool is_hash(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_name(std::string_view text) { return !text.empty() && printable(text, longest_name) == text; }

std::string shortened(const Json& value) {
  constexpr std::size_t longest = 60;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= longest) return text;
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // not inside a character
  return text.substr(0, end) + "...";
}

std::vector<Key> keys_of(std::string_view rows) {
  std::vector<Key> keys;
  for (const std::string& row : rows_in(rows)) {
    try {
      read_row(row, keys);
    } catch (const std::exception& error) {
      throw std::logic_error(fmt::format("faulty row of a table of keys: {}: {}", row, error.what()));
    }
  }
  return keys;
}

KindTables::KindTables(std::string title, const std::string& key, std::string_view rows, Unknown unknown)
    : title_(std::move(title)),
      key_{.pointer = '/' + key, .kind = KeyKind::choice, .required = true},
      kind_("", "") {
  std::string shared, meaning, own;
  const auto add = [&] {
    if (key_.choices.empty()) return;
    const std::string kind = fmt::format("/{} | one of {}\n", key, key_.choices.back());
    tables_.emplace_back(meaning, kind + shared + own, unknown);
  };
  for (const std::string& row : rows_in(rows)) {
    std::string_view rest = row;
    if (cut_begin(rest, "-- ")) {
      add();
      key_.choices.emplace_back(cut(rest, " | "));
      meaning = rest;
      own.clear();
    } else {
      (key_.choices.empty() ? shared : own) += row + '\n';
    }
  }
  add();
  kind_ = KeyTable("", std::vector{key_}, Unknown::ignored);
}

std::string allowed_values(const Key& key) {
  if (key.kind == KeyKind::any) return "may be anything";
  const auto words = [&](KeyKind kind) -> std::string {
    if (kind != KeyKind::choice) return text_of(kind).message;
    if (key.choices.size() == 1) return '"' + key.choices[0] + '"';
    return fmt::format("one of: {}", fmt::join(key.choices, ", "));
  };
  std::string all = "must be " + words(key.kind) + bounds_in_words(key);
  for (const KeyKind other : key.others) all += ", or " + words(other);
  return all;
}

Json KeyTable::json_schema(const std::string& identifier) const {
  Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", identifier}, {"title", title_}};
  add_members(*this, "", schema);
  return schema;
}

Json KindTables::json_schema(const std::string& identifier) const {
  Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", identifier}, {"title", title_}};
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    Json kind = {{"title", key_.choices[i]}, {"description", tables_[i].title()}};
    add_members(tables_[i], "", kind);
    schema["oneOf"].push_back(std::move(kind));
  }
  return schema;
}

std::string KeyTable::markdown() const {
  std::string page = "| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n";
  for (const Key& key : keys_) {
    if (is_element(*this, key)) continue;
    std::string fallback = key.required && key.only_if.empty() ? "required" : "";
    if (!key.instead_of.empty()) fallback = fmt::format("instead of `{}`", key.instead_of);
    for (const Key* const other :
         alternatives_to(below(key.pointer.substr(0, key.pointer.rfind('/'))), key)) {
      fallback += fmt::format(", or `{}`", name_of(*other));
    }
    if (!key.default_value.is_null()) fallback = fmt::format("`{}`", key.default_value.dump());
    std::string meaning = key.meaning, unit = key.unit;
    if (const Key* const element = key.same_as.empty() ? element_of(*this, key) : nullptr) {
      if (!element->meaning.empty()) meaning += ' ' + element->meaning;
      if (unit.empty()) unit = element->unit;
    }
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.pointer, cell(meaning), cell(unit),
                        cell(fallback), cell(allowed_in_manual(*this, key)));
  }
  return page;
}

}  // namespace peclet
