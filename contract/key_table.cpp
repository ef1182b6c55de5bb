#include "contract/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "contract/errors.h"
#include "contract/text.h"

namespace peclet {
namespace {

std::string_view name_of(const Key& key) {
  return std::string_view(key.pointer).substr(key.pointer.rfind('/') + 1);
}

// Returns the one of `keys` that may be given instead of `key`, or null.
const Key* alternative_to(const std::vector<const Key*>& keys, const Key& key) {
  const auto found = std::ranges::find(keys, name_of(key), &Key::instead_of);
  return found == keys.end() ? nullptr : *found;
}

bool is_whole(const Json& value) {
  if (value.is_number_integer()) return true;
  if (!value.is_number_float()) return false;
  const auto number = value.get<double>();
  return std::trunc(number) == number && std::abs(number) < largest_count;
}

bool in_range(const Key& key, double number) {
  const bool high_enough = key.above_minimum ? number > key.minimum : number >= key.minimum;
  const bool low_enough = key.below_maximum ? number < key.maximum : number <= key.maximum;
  return std::isfinite(number) && high_enough && low_enough;
}

bool is_word(std::string_view text) {
  return !text.empty() && text.size() <= longest_word && text.front() != '-' &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
}

// Returns true if the value is of this kind and within the key's bounds; what is below it is not checked.
bool is_of_kind(KeyKind kind, const Key& key, const Json& value) {
  switch (kind) {
    case KeyKind::null:
      return value.is_null();
    case KeyKind::empty:
      return value == "";
    case KeyKind::any:
      return true;
    case KeyKind::object:
      return value.is_object();
    case KeyKind::array:
      return value.is_array() && in_range(key, static_cast<double>(value.size()));
    case KeyKind::boolean:
      return value.is_boolean();
    case KeyKind::string:
      return value.is_string();
    case KeyKind::hash:
      return value.is_string() && is_hash(value.get_ref<const std::string&>());
    case KeyKind::word:
      return value.is_string() && is_word(value.get_ref<const std::string&>());
    case KeyKind::name:
      return value.is_string() && is_name(value.get_ref<const std::string&>());
    case KeyKind::choice:
      return value.is_string() && std::ranges::count(key.choices, value.get_ref<const std::string&>()) > 0;
    case KeyKind::integer:
      return is_whole(value) && in_range(key, value.get<double>());
    case KeyKind::number:
      return value.is_number() && in_range(key, value.get<double>());
  }
  return false;
}

bool is_allowed(const Key& key, const Json& value) {
  return is_of_kind(key.kind, key, value) ||
         std::ranges::any_of(key.others, [&](KeyKind kind) { return is_of_kind(kind, key, value); });
}

// Returns true if the key may be given in this object. If the word that decides is missing, the key may be
// given: the fault is the missing word.
bool may_be_given(const Key& key, const Json& object) {
  if (key.only_if.empty()) return true;
  const auto other = object.find(key.only_if);
  if (key.if_words.empty()) return other != object.end();
  return other == object.end() || std::ranges::count(key.if_words, other->get<std::string>()) > 0;
}

// Returns a hint if a share in [0, 1] was given in per cent, as 5 for 5 %; else "".
std::string hint_at_percent(const Key& key, const Json& value) {
  const bool is_share = key.kind == KeyKind::number && key.minimum >= 0 && key.maximum <= 1;
  if (!is_share || !value.is_number()) return "";
  const double percent = value.get<double>();
  if (percent < 1 || !in_range(key, percent / 100)) return "";
  return fmt::format("; {:g} % is written {:g}", percent, percent / 100);
}

// Place of a value in a document. pointer() makes the text only for messages.
struct Place {
  const Place* above = nullptr;
  std::string_view name = {};             // of a member
  std::optional<std::size_t> index = {};  // of an element

  Json::json_pointer pointer() const {
    if (above == nullptr) return Json::json_pointer();
    return index ? above->pointer() / *index : above->pointer() / std::string(name);
  }
};

// Validates one document. `pattern` is the pointer of an object's key in the table.
class Validation {
 public:
  Validation(const KeyTable& table, const std::string& file) : table_(table), file_(file) {}

  void check_value(Json& value, const Key& key, const Place& place) const {
    if (!is_allowed(key, value)) refuse(place, value, allowed_values(key) + hint_at_percent(key, value));
    if (key.kind == KeyKind::any || value.is_null()) return;
    const std::string& pattern = key.same_as.empty() ? key.pointer : key.same_as;
    if (value.is_object()) {
      check_object(value, pattern, place);
    } else if (const Key* element = value.is_array() ? table_.find(pattern, "*") : nullptr) {
      for (std::size_t i = 0; i < value.size(); ++i) check_value(value[i], *element, {&place, {}, i});
    } else if (key.kind == KeyKind::integer && value.is_number()) {
      value = static_cast<long long>(value.get<double>());
    }
  }

  void check_object(Json& object, const std::string& pattern, const Place& place) const {
    const std::vector<const Key*> keys = table_.below(pattern);
    if (keys.empty()) return;
    const Key* const any_member = table_.find(pattern, "*");
    for (const auto& [name, value] : object.items()) {
      const Key* key = name == "*" ? nullptr : table_.find(pattern, name);
      if (key == nullptr) key = any_member;
      if (key == nullptr && table_.ignores_unknown()) continue;
      const Place below = {&place, name};
      if (key == nullptr) refuse_unknown(keys, below);
      check_value(value, *key, below);
    }
    for (const Key* key : keys) {
      if (object.contains(name_of(*key))) refuse_misplaced(object, *key, place);
    }
    for (const Key* key : keys) {
      if (!key->required && key->default_value.is_null()) continue;
      const std::string_view name = name_of(*key);
      if (key == any_member || object.contains(name) || !may_be_given(*key, object)) continue;
      if (const Key* other = alternative_to(keys, *key); other && object.contains(name_of(*other))) continue;
      const Place below = {&place, name};
      if (key->required)
        throw InputError(file_, below.pointer().to_string(), "missing", wanted(*key, object));
      object[name] = key->default_value;
      check_value(object[name], *key, below);
    }
  }

 private:
  // Returns what a missing key must be, the keys that an object requires, and why the key must be given.
  std::string wanted(const Key& key, const Json& object) const {
    std::vector<std::string> members;
    const std::vector<const Key*> keys = table_.below(key.same_as.empty() ? key.pointer : key.same_as);
    for (const Key* member : keys) {
      if (!member->required || !member->only_if.empty()) continue;
      const Key* const other = alternative_to(keys, *member);
      members.push_back(
          fmt::format("{}{}{}", name_of(*member), other ? " or " : "", other ? name_of(*other) : ""));
    }
    std::string words = allowed_values(key);
    if (!members.empty()) words += fmt::format(" with {}", fmt::join(members, ", "));
    if (key.only_if.empty()) return words;
    const std::string value = key.if_words.empty() ? "given" : object[key.only_if].get<std::string>();
    return words + fmt::format(", because {} is {}", key.only_if, value);
  }

  void refuse_misplaced(const Json& object, const Key& key, const Place& place) const {
    std::string allowed;
    if (!may_be_given(key, object)) {
      allowed = key.if_words.empty() ? fmt::format("must be left out without {}", key.only_if)
                                     : fmt::format("must be left out unless {} is {}", key.only_if,
                                                   fmt::join(key.if_words, " or "));
    } else if (!key.instead_of.empty() && object.contains(key.instead_of)) {
      allowed = fmt::format("must not be given beside {}", key.instead_of);
    } else {
      return;
    }
    const std::string_view name = name_of(key);
    refuse({&place, name}, object[name], allowed);
  }

  [[noreturn]] void refuse(const Place& place, const Json& value, const std::string& allowed) const {
    throw InputError(file_, place.pointer().to_string(), shortened(value), allowed);
  }

  [[noreturn]] void refuse_unknown(const std::vector<const Key*>& keys, const Place& place) const {
    std::vector<std::string> names;
    names.reserve(keys.size());
    for (const Key* key : keys) names.emplace_back(name_of(*key));
    const std::string near = suggestion(std::string(place.name), names);
    throw InputError(file_, place.pointer().to_string(), "unknown key",
                     fmt::format("allowed keys: {}{}", fmt::join(names, ", "), near));
  }

  const KeyTable& table_;
  const std::string& file_;
};

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
    if (const Key* const other = alternative_to(keys, *key)) {
      schema["oneOf"] = {{{"required", {name}}}, {{"required", {name_of(*other)}}}};
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
  const Validation validation(*this, file);
  if (const Key* key = find(root)) {
    validation.check_value(document, *key, {});
  } else {
    if (!document.is_object()) throw InputError(file, "", shortened(document), "must be an object");
    validation.check_object(document, root, {});
  }
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
    if (const Key* const other = alternative_to(below(key.pointer.substr(0, key.pointer.rfind('/'))), key)) {
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
