// How keys of a scene are written down.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "contract/key_table.h"

namespace peclet::engine {

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

}  // namespace peclet::engine
