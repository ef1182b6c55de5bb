// Every term of single configurations equals the numbers of an independent program (tests/reference/forces).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "contract/json.h"
#include "engine/forces/configuration.h"
#include "engine/kernels/instruction_set.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

constexpr double tolerance = 1e-10;

std::vector<Json> reference_documents() {
  std::vector<Json> documents;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(PECLET_SOURCE_DIR) / "tests/reference/forces")) {
    if (entry.path().extension() == ".json") {
      Json document = read_json(entry.path());
      const bool has_waves = document.at("configuration").at("scene").at("flow").contains("waves");
      if (has_waves && emulated_card_is_chosen()) continue;  // engine/forces/card_pass.h
      documents.push_back(std::move(document));
      documents.back()["name"] = entry.path().filename().string();
    }
  }
  return documents;
}

double largest_component(const Json& value) {
  if (value.is_number()) return std::abs(value.get<double>());
  double largest = 0;
  for (const Json& part : value) largest = std::max(largest, largest_component(part));
  return largest;
}

double largest_difference(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) return std::abs(a.get<double>() - b.get<double>());
  if (!a.is_array() || !b.is_array() || a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, largest_difference(a[k], b[k]));
  return largest;
}

// Terms that are zero up to rounding are compared on the scale of the largest term of their block.
void expect_equal_terms(const Json& expected, const Json& answer, const std::string& where) {
  double scale = 0;
  for (const Json& value : expected) scale = std::max(scale, largest_component(value));
  for (const auto& [term, value] : expected.items()) {
    ASSERT_TRUE(answer.contains(term)) << where << '.' << term;
    const double size = largest_component(value);
    EXPECT_LE(largest_difference(value, answer[term]), tolerance * (size > 1e-12 * scale ? size : scale))
        << where << '.' << term;
  }
}

TEST(ReferenceForces, EveryTermOfEveryMixtureEqualsTheIndependentEvaluation) {
  const std::vector<Json> documents = reference_documents();
  ASSERT_GE(documents.size(), 12u);
  for (const Json& document : documents) {
    const std::string name = document.at("name");
    const Json answer = evaluate_configuration(read_configuration(document.at("configuration"), name));
    for (const char* block : {"force", "torque", "stress"}) {
      expect_equal_terms(document.at("expected").at(block), answer.at(block), name + ": " + block);
    }
  }
}

TEST(ReferenceForces, AdvancedSpringsEqualTheIndependentEvaluation) {
  for (const Json& document : reference_documents()) {
    const std::string name = document.at("name");
    const Json answer = evaluate_configuration(read_configuration(document.at("configuration"), name));
    std::map<std::string, Json> found;
    const auto key = [](const Json& spring) {
      return Json({spring["i"], spring["j"], spring["image"]}).dump();
    };
    for (const Json& spring : answer.at("springs")) found[key(spring)] = spring;
    const Json& expected = document.at("expected").at("springs");
    EXPECT_EQ(found.size(), expected.size()) << name;
    for (const char* kind : {"tangential", "rolling"}) {
      double longest = 0;
      for (const Json& spring : expected) longest = std::max(longest, largest_component(spring.at(kind)));
      ASSERT_GT(longest, 0) << name;
      for (const Json& spring : expected) {
        ASSERT_TRUE(found.count(key(spring))) << name << ": " << key(spring);
        EXPECT_LE(largest_difference(spring.at(kind), found[key(spring)].at(kind)), tolerance * longest)
            << name << ": " << kind << ' ' << key(spring);
      }
    }
  }
}

// The comparison above is meaningful only where the terms act.
TEST(ReferenceForces, ConfigurationsExerciseEveryTermAndTheShearedBoundary) {
  for (const Json& document : reference_documents()) {
    const Json& force = document.at("expected").at("force");
    const Json& configuration = document.at("configuration");
    const bool noise = configuration.at("scene").at("fluid").contains("thermal_energy");
    std::vector<const char*> terms = {"contact_normal", "contact_damping", "friction",
                                      "drag",           "lubrication",     "repulsion"};
    if (noise) terms.insert(terms.end(), {"brownian_drag", "brownian_lubrication"});
    for (const char* term : terms) {
      EXPECT_GT(largest_component(force.at(term)), 0) << document.at("name") << ": " << term;
    }
    EXPECT_GT(largest_component(document.at("expected").at("torque").at("rolling")), 0)
        << document.at("name");
    const Json& state = configuration.at("state");
    const Json& pairs = noise ? state.at("noise").at("pairs") : state.at("springs");
    EXPECT_TRUE(std::any_of(pairs.begin(), pairs.end(), [](const Json& pair) {
      return pair["image"][1] != 0;
    })) << document.at("name");
  }
}

}  // namespace
}  // namespace peclet::engine
