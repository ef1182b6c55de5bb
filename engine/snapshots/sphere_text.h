// Shared by the readers of texts: faults that name the file, numbers, species, and the order of spheres.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/errors.h"
#include "contract/text.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

class SphereText {
 public:
  // `file` names the text in messages.
  explicit SphereText(std::string file) : file_(std::move(file)) {}

 protected:
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& value, fmt::format_string<Arguments...> rule,
                           Arguments&&... arguments) const {
    throw InputError(file_, "", value, fmt::format(rule, std::forward<Arguments>(arguments)...));
  }

  template <class Number>
  Number number(std::string_view word, const std::string& what) const {
    const std::optional<Number> value = number_in<Number>(word);
    if (!value) refuse(fmt::format("{}: \"{}\"", what, word), "must be a number");
    return *value;
  }

  // Takes the next three words of a line.
  Vector3 vector(std::string_view& words, const std::string& what) const;

  // Returns the index of the species of this name, which is added if it is new.
  std::uint32_t species(std::string_view name, const std::string& where, Snapshot& snapshot) const;

  // Sorts spheres by id, if there are ids, and species by name; makes each radius a species, if the file has
  // none. Throws InputError for no spheres, for an id that occurs twice, and for what check_snapshot()
  // refuses.
  void finish(Snapshot& snapshot, const std::vector<std::int64_t>& id) const;

 private:
  std::string file_;
};

}  // namespace peclet::engine
