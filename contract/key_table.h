// One typed table of keys describes a JSON document: it validates it, fills its defaults,
// prints its JSON Schema and its page in the manual. Scene, campaign and configuration each have one.
#pragma once

#include <limits>
#include <string>
#include <string_view>
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
  choice,
  number_or_auto,
  integer_or_object,  // the range is that of the integer
  any
};

// One key of a document. `pointer` uses * for every element of an array: "/particles/species/*/radius".
// An object or array with no key below it in the table may hold anything.
struct Key {
  std::string pointer;
  KeyKind kind = KeyKind::object;
  std::string meaning;
  std::string unit = {};        // "" where the key has none
  std::string words = {};       // what people call it: "coefficient of friction"; "" where its name says it
  std::string symbol = {};      // "μ_r", as symbols are written (schema/README.md, symbols)
  bool required = false;        // whenever the object that holds it is present
  std::string instead_of = {};  // the name of a required key of the same object: exactly one of both is given
  Json default_value = nullptr;  // null: no default, the key stays absent
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;             // strictly greater than `minimum`
  bool below_maximum = false;             // strictly less than `maximum`
  std::vector<std::string> choices = {};  // of KeyKind::choice
  std::size_t minimum_items = 0;          // of KeyKind::array
  std::size_t maximum_items = std::numeric_limits<std::size_t>::max();
};

class KeyTable {
 public:
  KeyTable(std::string title, std::vector<Key> keys);

  // Checks `document` against the table: unknown keys, types, ranges, required keys; then fills the defaults.
  // An absent object is filled in only when it has a default itself ({}); whole numbers become integers where
  // the table says so.
  // Keys are matched below `root` of the table ("" for a whole document; "/contact" for that block alone).
  // Throws InputError with `file` and the JSON pointer, from `document`, of the first fault: keys in their
  // (sorted) order, then those that are missing, in the order of the table.
  Json validate(const Json& document, const std::string& file, const std::string& root = "") const;

  // JSON Schema, draft 2020-12, of the whole document; unknown keys are refused.
  Json json_schema(const std::string& identifier) const;

  // A Markdown table: key, meaning, unit, default, allowed.
  std::string markdown() const;

  const std::vector<Key>& keys() const { return keys_; }

  // The key of that pointer; null when there is none.
  const Key* find(std::string_view pointer) const;
  // The keys directly below `pointer`, in the order of the table.
  std::vector<const Key*> below(std::string_view pointer) const;

 private:
  std::string title_;
  std::vector<Key> keys_;
};

// "must be a number > 0", "must be one of: a, b": what a key allows, in words.
std::string allowed_values(const Key& key);

// `value` as compact JSON for a message, shortened beyond 60 characters.
std::string shortened(const Json& value);

}  // namespace peclet
