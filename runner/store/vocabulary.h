// What an engine calls the keys of its scenes and the numbers that follow from a scene.
#pragma once

#include <string>

#include "contract/json.h"
#include "runner/store/database.h"

namespace peclet::runner {

class Vocabulary {
 public:
  // Knows no names.
  Vocabulary() = default;
  // From the members "scene_schema" and "derived" of a checked_frame(), both optional; other members are left
  // out.
  explicit Vocabulary(const Json& hello);

  // {"pointer", "words", "symbol", "unit", "meaning"}: texts, "" where the engine says nothing.
  Json key(const std::string& pointer) const;
  // Numbers by name in the order in which people look for them: [{"name", "words", "symbol", "unit"}].
  Json derived() const { return document_.value("derived", Json::array()); }

  // The two members, as they are kept.
  const Json& document() const { return document_; }

 private:
  Json document_ = Json::object();
};

// Replaces what an earlier engine has said; within a Transaction of its own.
void keep_vocabulary(Database& database, const Vocabulary& vocabulary);

// Knows no names in a campaign that no engine has spoken for.
Vocabulary kept_vocabulary(Database& database);

}  // namespace peclet::runner
