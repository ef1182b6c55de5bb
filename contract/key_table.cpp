#include "contract/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "contract/nearest_name.h"

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

}  // namespace peclet
