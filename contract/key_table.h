// One typed table of keys describes a JSON document: it validates it, fills its defaults,
// prints its JSON Schema and its page in the manual. Every document that is read has one.
//
// A table is text, a row for each key: its pointer, what it allows, what it means. Indented lines continue a
// row.
//
//   /fluid | object | The solvent.
//   /fluid/viscosity | number > 0; in mass / (length time) | Viscosity of the solvent.
//   /fluid/thermal_energy? | number >= 0 | k_B T; absent: no Brownian motion.
//
// What a key allows begins with its kind, and bounds:
//
//   object, array, array of 3, array of 1 to 64, array of 1 or more
//   number, number > 0 and <= 1, integer >= 1, integer = 1
//   count (an integer from 0 to 2^53 - 1), true or false, string, one of A, B, anything
//   hash (SHA-256 in lower-case hexadecimal)
//   word (letters a-z, digits and hyphens, at most longest_word of them, no hyphen first)
//   name (1 to longest_name bytes without control characters)
//
// Another kind without bounds may follow: "or null", "or empty" (text), "or name", "or one of auto".
// Semicolons begin what else the table says of the key:
//
//   in UNIT
//   named WORDS, SYMBOL   as people call it; a symbol may be missing (schema/README.md, symbols)
//   default JSON
//   instead of NAME   NAME is a required key of the same object: exactly one of both is given
//   if NAME           only beside that key of the same object
//   if NAME A, B      only where that key has one of these words
//   as POINTER        the rows below POINTER are also those below this key
//
// Keys without a meaning of their own may share a row: "/at, /until | number".
//
// A key is required where it may be given, unless its pointer is followed by ? or ends in *, or it has a
// default or stands instead of another. In a pointer * is every element of an array, and every member of an
// object that has no row of its own. An object or array without rows below it may hold anything.
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
// Bound of counts: a double represents every integer below it.
constexpr double largest_count = 9007199254740992.0;  // 2^53

// A row of a table.
struct Key {
  std::string pointer;
  KeyKind kind = KeyKind::object;
  std::string meaning = {};
  std::string unit = {};                // "" where the key has none
  std::string words = {}, symbol = {};  // what people call it; "" where its name says it
  bool required = false;
  std::vector<KeyKind> others = {};  // allowed besides `kind`
  std::string same_as = {}, instead_of = {}, only_if = {};
  std::vector<std::string> if_words = {};  // values of `only_if`; none: any value
  Json default_value = nullptr;            // null: no default, the key stays absent
  // Bounds of the number, or of the number of an array's items.
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;             // strictly greater than `minimum`
  bool below_maximum = false;             // strictly less than `maximum`
  std::vector<std::string> choices = {};  // words that KeyKind::choice allows
};

// Reads rows. Throws std::logic_error for a row that is not written as above.
std::vector<Key> keys_of(std::string_view rows);

// What validation does with keys that are not in a table.
enum class Unknown { refused, ignored };

class KeyTable {
 public:
  KeyTable(std::string title, std::vector<Key> keys, Unknown unknown = Unknown::refused);
  KeyTable(std::string title, std::string_view rows, Unknown unknown = Unknown::refused)
      : KeyTable(std::move(title), keys_of(rows), unknown) {}

  // Checks `document` against the table: keys, types, ranges, required keys; then fills the defaults.
  // An absent object is filled in only when it has a default itself ({}); whole numbers become integers where
  // the table says so.
  // Keys are matched below `root` of the table ("" for a whole document; "/contact" for that block alone).
  // Throws InputError with `file` and the JSON pointer, from `document`, of the first fault: keys in their
  // (sorted) order, then those that do not go together, then those that are missing, in the order of the
  // table.
  Json validate(Json document, const std::string& file, const std::string& root = "") const;

  // JSON Schema, draft 2020-12, of the whole document.
  Json json_schema(const std::string& identifier) const;

  // A Markdown table: key, meaning, unit, default, allowed.
  std::string markdown() const;

  // The key of that pointer; null when there is none.
  const Key* find(std::string_view pointer) const;
  // The key `name` of the object at pointer `object` of the table; null when there is none.
  const Key* find(std::string_view object, std::string_view name) const;
  // The keys directly below `pointer`, in the order of the table.
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

// Documents of several kinds, which the value of one key tells apart: frames by "type", events by "event".
class KindTables {
 public:
  // A line "-- NAME | MEANING" begins the rows of a kind. Every kind also has the rows before the first of
  // these lines, and that of `key`.
  KindTables(std::string title, const std::string& key, std::string_view rows,
             Unknown unknown = Unknown::refused);

  // KeyTable::validate() by the table of the document's kind.
  Json validate(Json document, const std::string& file) const;
  Json json_schema(const std::string& identifier) const;

 private:
  std::string title_;
  Key key_;
  KeyTable kind_;                 // of key_ alone
  std::vector<KeyTable> tables_;  // ordered as key_.choices
};

// "must be a number > 0", "must be one of: a, b": what a key allows, in words.
std::string allowed_values(const Key& key);

bool is_hash(std::string_view text);
// Returns whether KeyKind::name allows the text.
bool is_name(std::string_view text);

// `value` as compact JSON for a message, shortened beyond 60 characters.
std::string shortened(const Json& value);

}  // namespace peclet
