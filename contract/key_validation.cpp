#include "contract/key_validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "contract/errors.h"
#include "contract/text.h"

namespace peclet {
namespace {

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
      if (object.contains(name_of(*key))) refuse_misplaced(object, *key, keys, place);
    }
    for (const Key* key : keys) {
      if (!key->required && key->default_value.is_null()) continue;
      const std::string_view name = name_of(*key);
      if (key == any_member || object.contains(name) || !may_be_given(*key, object)) continue;
      const std::vector<const Key*> others = alternatives_to(keys, *key);
      const auto is_given = [&](const Key* other) { return object.contains(name_of(*other)); };
      if (std::ranges::any_of(others, is_given)) continue;
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
      std::string& names = members.emplace_back(name_of(*member));
      for (const Key* const other : alternatives_to(keys, *member))
        names += fmt::format(" or {}", name_of(*other));
    }
    std::string words = allowed_values(key);
    if (!members.empty()) words += fmt::format(" with {}", fmt::join(members, ", "));
    if (key.only_if.empty()) return words;
    const std::string value = key.if_words.empty() ? "given" : object[key.only_if].get<std::string>();
    return words + fmt::format(", because {} is {}", key.only_if, value);
  }

  void refuse_misplaced(const Json& object, const Key& key, const std::vector<const Key*>& keys,
                        const Place& place) const {
    const auto excludes = [&](const Key* other) {
      const bool is_alternative = name_of(*other) == key.instead_of || other->instead_of == key.instead_of;
      return other != &key && is_alternative && object.contains(name_of(*other));
    };
    const auto excluding = key.instead_of.empty() ? keys.end() : std::ranges::find_if(keys, excludes);
    std::string allowed;
    if (!may_be_given(key, object)) {
      allowed = key.if_words.empty() ? fmt::format("must be left out without {}", key.only_if)
                                     : fmt::format("must be left out unless {} is {}", key.only_if,
                                                   fmt::join(key.if_words, " or "));
    } else if (excluding != keys.end()) {
      allowed = fmt::format("must not be given beside {}", name_of(**excluding));
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

}  // namespace

void validate_keys(const KeyTable& table, const std::string& file, const std::string& root, Json& document) {
  const Validation validation(table, file);
  if (const Key* key = table.find(root)) {
    validation.check_value(document, *key, {});
  } else {
    if (!document.is_object()) throw InputError(file, "", shortened(document), "must be an object");
    validation.check_object(document, root, {});
  }
}

}  // namespace peclet
