// A typed table of the keys of a JSON document: validates it, fills in defaults, prints its JSON Schema.
//
// A table is text with a row for each key: pointer, allowed values, meaning. Indented lines continue a row.
//
//   /fluid | object | The solvent.
//   /fluid/viscosity | number > 0; in mass / (length time) | Viscosity of the solvent.
//   /fluid/thermal_energy? | number >= 0 | k_B T; absent: no Brownian motion.
//
// The second column begins with the kind of the value, and its bounds:
//
//   object, array, array of 3, array of 1 to 64, array of 1 or more
//   number, number > 0 and <= 1, integer >= 1, integer = 1
//   count (an integer from 0 to 2^53 - 1), true or false, string, one of A, B, anything
//   hash (SHA-256 in lower-case hexadecimal)
//   word (letters a-z, digits and hyphens, at most longest_word of them, no hyphen first)
//   name (1 to longest_name bytes without control characters)
//
// Another kind without bounds may follow: "or null", "or empty" (text), "or name", "or one of auto". Further
// clauses follow semicolons:
//
//   in UNIT
//   named WORDS, SYMBOL   title and symbol for people; a symbol may be missing (schema/README.md, symbols)
//   default JSON
//   instead of NAME   NAME is a required key of the same object: exactly one of it and all such keys is given
//   if NAME           only beside that key of the same object
//   if NAME A, B      only where that key has one of these words
//   as POINTER        the rows below POINTER apply below this key, too
//
// Keys without a meaning of their own may share a row: "/at, /until | number".
//
// A key is required where it may be given, unless its pointer ends in ? or *, or it has a default or stands
// instead of another. In a pointer * stands for every element of an array, and for every member of an object
// without a row of its own. An object or array without rows below it may hold anything.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/json.h"

namespace peclet {

enum class KeyKind {
  object,
  array,
  number,
  integer,
  boolean,
  string,
  hash,
  word,
  name,
  choice,
  null,
  empty,
  any
};
constexpr std::size_t longest_word = 64, longest_name = 120;
// Exclusive bound of counts: a double represents every integer below it.
constexpr double largest_count = 9007199254740992.0;  // 2^53

// A row of a table.
struct Key {
  std::string pointer;
  KeyKind kind = KeyKind::object;
  std::string meaning = {};
  std::string unit = {};                // "" if the key has no unit
  std::string words = {}, symbol = {};  // title and symbol for people; may be ""
  bool required = false;
  std::vector<KeyKind> others = {};  // allowed besides `kind`
  std::string same_as = {}, instead_of = {}, only_if = {};
  std::vector<std::string> if_words = {};  // values of `only_if`; empty: any value
  Json default_value = nullptr;            // null: no default, the key stays absent
  // Bounds of a number, or of the number of items of an array.
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;             // strictly greater than `minimum`
  bool below_maximum = false;             // strictly less than `maximum`
  std::vector<std::string> choices = {};  // words that KeyKind::choice allows
};

// Returns the keys of a table in the format above. Throws std::logic_error if a row does not follow it.
std::vector<Key> keys_of(std::string_view rows);

// Treatment of keys that are not in the table.
enum class Unknown { refused, ignored };

// The keys of one kind of document.
class KeyTable {
 public:
  KeyTable(std::string title, std::vector<Key> keys, Unknown unknown = Unknown::refused);
  KeyTable(std::string title, std::string_view rows, Unknown unknown = Unknown::refused)
      : KeyTable(std::move(title), keys_of(rows), unknown) {}

  // Checks keys, types, ranges and required keys of `document`, and returns it with its defaults filled in.
  // An absent object is filled in only if it has a default itself ({}). Whole numbers become integers where
  // the table has integers. `root` is the pointer of `document` in the table: "" for a whole document,
  // "/contact" for that block.
  //
  // Throws InputError with `file` and the JSON pointer inside `document` of the first fault. The order is:
  // faulty values by sorted keys, then keys that exclude each other, then missing keys by the table.
  Json validate(Json document, const std::string& file, const std::string& root = "") const;

  // Returns the JSON Schema, draft 2020-12, of the whole document.
  Json json_schema(const std::string& identifier) const;

  // Returns a Markdown table: key, meaning, unit, default, allowed. The row of an array has its elements.
  std::string markdown() const;

  // Returns the key with this pointer, or null.
  const Key* find(std::string_view pointer) const;
  // Returns the key `name` of the object at pointer `object`, or null.
  const Key* find(std::string_view object, std::string_view name) const;
  // Returns the keys directly below `pointer`, in the order of the table.
  std::vector<const Key*> below(std::string_view pointer) const;

  const std::string& title() const { return title_; }
  bool ignores_unknown() const { return unknown_ == Unknown::ignored; }

 private:
  std::string title_;
  std::vector<Key> keys_;
  struct Object {
    std::vector<std::size_t> keys;  // places in keys_
    std::map<std::string, std::size_t, std::less<>> by_name;
  };
  std::map<std::string, Object, std::less<>> objects_;  // by pointer
  Unknown unknown_;
};

// Tables of documents of several kinds, told apart by one key: frames by "type", events by "event".
class KindTables {
 public:
  // A line "-- NAME | MEANING" begins the rows of a kind. Rows before the first of these lines belong to
  // every kind, as does the row of `key`.
  KindTables(std::string title, const std::string& key, std::string_view rows,
             Unknown unknown = Unknown::refused);

  // Returns KeyTable::validate() of the table of the document's kind. Throws InputError as that does.
  Json validate(Json document, const std::string& file) const;
  Json json_schema(const std::string& identifier) const;

 private:
  std::string title_;
  Key key_;
  KeyTable kind_;                 // of key_ alone
  std::vector<KeyTable> tables_;  // ordered as key_.choices
};

// Returns the last step of the key's pointer.
std::string_view name_of(const Key& key);

// Returns those of `keys` that may be given instead of `key`, which is required otherwise.
std::vector<const Key*> alternatives_to(const std::vector<const Key*>& keys, const Key& key);

// Returns what a key allows, in words: "must be a number > 0", "must be one of: a, b".
std::string allowed_values(const Key& key);

// Returns true if the text is a SHA-256 in lower-case hexadecimal.
bool is_hash(std::string_view text);
// Returns true if KeyKind::name allows the text.
bool is_name(std::string_view text);

// Returns `value` as compact JSON for a message, shortened to 60 bytes.
std::string shortened(const Json& value);

}  // namespace peclet
