// The values of a scene whose keys are valid, and the faults of their meaning.
#pragma once

#include <string>
#include <utility>

#include "contract/errors.h"
#include "contract/json.h"
#include "contract/key_table.h"

namespace peclet::engine {

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
