// Keys of a scene: how they are described, and how their values are read.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "contract/errors.h"
#include "contract/json.h"
#include "contract/key_table.h"

namespace peclet::engine {

// How keys of a scene are written down.
inline constexpr bool required = true;

inline Key positive(std::string pointer, std::string unit, std::string meaning, bool is_required = false) {
  return {.pointer = std::move(pointer),
          .kind = KeyKind::number,
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .required = is_required,
          .minimum = 0,
          .above_minimum = true};
}

inline Key not_negative(std::string pointer, std::string unit, std::string meaning,
                        bool is_required = false) {
  Key key = positive(std::move(pointer), std::move(unit), std::move(meaning), is_required);
  key.above_minimum = false;
  return key;
}

inline Key block(std::string pointer, std::string meaning, bool is_required = false) {
  return {.pointer = std::move(pointer),
          .kind = KeyKind::object,
          .meaning = std::move(meaning),
          .required = is_required};
}

inline Key choice(std::string pointer, std::string meaning, std::vector<std::string> choices) {
  return {.pointer = std::move(pointer),
          .kind = KeyKind::choice,
          .meaning = std::move(meaning),
          .choices = std::move(choices)};
}

// A number strictly between 0 and `below`.
inline Key fraction(Key key, double below) {
  key.maximum = below;
  key.below_maximum = true;
  return key;
}

// A number above 0 and up to `most`.
inline Key fraction_up_to(Key key, double most) {
  key.maximum = most;
  return key;
}

inline Key with_default(Key key, Json value) {
  key.default_value = std::move(value);
  return key;
}

// A key with what people call it: words, and a symbol if it has one.
inline Key named(Key key, std::string words, std::string symbol = "") {
  key.words = std::move(words);
  key.symbol = std::move(symbol);
  return key;
}

inline Key must_be_given(Key key) {
  key.required = true;
  return key;
}

using Keys = std::vector<Key>;

// The values of a scene whose keys are valid, and the faults of their meaning.
//
// Pointers are from the document's top; `file` names it in messages. Functions that refuse or miss throw
// InputError.
class SceneDocument {
 public:
  SceneDocument(const Json& document, std::string file) : document_(document), file_(std::move(file)) {}

  const std::string& file() const { return file_; }

  bool has(const std::string& pointer) const { return document_.contains(Json::json_pointer(pointer)); }
  const Json& at(const std::string& pointer) const { return document_.at(Json::json_pointer(pointer)); }
  double number(const std::string& pointer) const { return at(pointer).get<double>(); }
  double number_or(const std::string& pointer, double fallback) const {
    return has(pointer) ? number(pointer) : fallback;
  }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& allowed) const {
    throw InputError(file_, pointer, shortened(at(pointer)), allowed);
  }
  [[noreturn]] void miss(const std::string& pointer, const std::string& allowed) const {
    throw InputError(file_, pointer, "missing", allowed);
  }

 private:
  const Json& document_;
  std::string file_;
};

}  // namespace peclet::engine
