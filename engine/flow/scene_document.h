// SceneDocument reads the values of a scene whose keys are valid, and reports faults of their meaning.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "contract/errors.h"
#include "contract/json.h"
#include "contract/key_table.h"

namespace peclet::engine {

// Pointers start at the top of the document. `file` names it in messages.
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

  // Throws InputError for the value at this pointer. `allowed` and its arguments say what is allowed.
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& pointer, fmt::format_string<Arguments...> allowed,
                           Arguments&&... arguments) const {
    throw InputError(file_, pointer, shortened(at(pointer)),
                     fmt::format(allowed, std::forward<Arguments>(arguments)...));
  }
  // Throws InputError for a value that is missing at this pointer.
  template <class... Arguments>
  [[noreturn]] void miss(const std::string& pointer, fmt::format_string<Arguments...> allowed,
                         Arguments&&... arguments) const {
    throw InputError(file_, pointer, "missing", fmt::format(allowed, std::forward<Arguments>(arguments)...));
  }

 private:
  const Json& document_;
  std::string file_;
};

}  // namespace peclet::engine
