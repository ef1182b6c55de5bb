// Tests that every fault of a campaign has one message: where, what, and what is allowed.
#include <gtest/gtest.h>

#include <fstream>

#include "contract/errors.h"
#include "runner/campaign/campaign.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

const char* const whole_campaign = R"({
  "name": "flow-curve",
  "scene": {"fluid": {"viscosity": 1}, "species": [{"radius": 1}, {"radius": 1.4}]},
  "sweep": [{"set": "/peclet", "values": [1, 10]}],
  "target": {"observable": "relative_viscosity", "relative_tolerance": 0.05},
  "realisations": {"minimum": 10, "maximum": 100}})";

// An edit of the campaign as a merge patch (RFC 7396: null removes a key), and the complaint about it.
struct Fault {
  const char* edit;
  const char* pointer;
  const char* value;    // a part of it
  const char* allowed;  // a part of it
};

const Fault faults[] = {
    {R"({"name": null})", "/name", "missing", "must be a string"},
    {R"({"name": ""})", "/name", "\"\"", "letters, digits"},
    {R"({"name": "a/b"})", "/name", "a/b", "letters, digits"},
    {R"({"name": 7})", "/name", "7", "must be a string"},
    {R"({"target": {"relative_tolerance": null}})", "/target/relative_tolerance", "missing",
     "must be a number"},
    {R"({"target": {"absolute_tolerance": 1}})", "/target/absolute_tolerance", "1",
     "must not be given beside relative_tolerance"},
    {R"({"target": {"relative_tolerance": null, "absolute_tolerance": 0}})", "/target/absolute_tolerance",
     "0", "must be a number > 0"},
    {R"({"target": {"relative_tolerance": null, "absolute_tolerance": 1, "relative_to": "pressure"}})",
     "/target/relative_to", "pressure", "must be left out without relative_tolerance"},
    {R"({"target": {"relative_tolerance": null, "absolute_tolerance": 1, "absolute_floor": 2}})",
     "/target/absolute_floor", "2", "must be left out without relative_tolerance"},
    {R"({"target": {"absolute_floor": 0}})", "/target/absolute_floor", "0", "must be a number > 0"},
    {R"({"target": {"also": {}}})", "/target/also", "{}", "must be an array"},
    {R"({"target": {"also": [{"relative_tolerance": 0.1}]}})", "/target/also/0/observable", "missing",
     "must be a string"},
    {R"({"target": {"also": [{"observable": "pressure"}]}})", "/target/also/0/relative_tolerance", "missing",
     "must be a number"},
    {R"({"target": {"also": [{"observable": "pressure", "relative_tolerance": 2}]}})",
     "/target/also/0/relative_tolerance", "2", "must be a number > 0 and < 1"},
    {R"({"target": {"also": [{"observable": "pressure", "absolute_tolerance": 1, "relative_to": "a"}]}})",
     "/target/also/0/relative_to", "a", "must be left out without relative_tolerance"},
    {R"({"target": {"also": [{"observable": "relative_viscosity", "relative_tolerance": 0.1}]}})",
     "/target/also/0/observable", "relative_viscosity", "must differ from the observables before it"},
    {R"({"target": {"also": [{"observable": "pressure", "relative_tolerance": 0.1},
                             {"observable": "pressure", "absolute_tolerance": 1}]}})",
     "/target/also/1/observable", "pressure", "must differ from the observables before it"},
    {R"({"target": {"curve": {"over": "/peclet", "relative_tolerance": 0.1}}})", "/target/curve", "{",
     "must not be given beside relative_tolerance"},
    {R"({"target": {"relative_tolerance": null, "absolute_tolerance": 1,
                    "curve": {"over": "/peclet", "relative_tolerance": 0.1}}})",
     "/target/absolute_tolerance", "1", "must not be given beside curve"},
    {R"({"target": {"relative_tolerance": null, "curve": {"relative_tolerance": 0.1}}})",
     "/target/curve/over", "missing", "must be a string"},
    {R"({"target": {"relative_tolerance": null, "curve": {"over": "/peclet", "absolute_tolerance": 1}}})",
     "/target/curve/absolute_tolerance", "unknown key", "allowed keys: over, relative_tolerance, even"},
    {R"({"target": {"relative_tolerance": null, "curve": {"over": "/friction", "relative_tolerance": 0.1}}})",
     "/target/curve/over", "/friction", "must be a pointer that the sweep sets"},
    {R"({"target": {"relative_tolerance": null, "curve": {"over": "/peclet", "relative_tolerance": 0.1}}})",
     "/sweep/0/values", "2 values", "must be 4 or more, because curves run along /peclet"},
    {R"({"sweep": [{"set": "/peclet", "values": [1, 2, 3, "fast"]}],
         "target": {"relative_tolerance": null, "curve": {"over": "/peclet", "relative_tolerance": 0.1}}})",
     "/sweep/0/values/3", "fast", "must be a number: it is the axis of curves"},
    {R"({"sweep": [{"set": ["/peclet", "/x"], "values": [[1, 1], [2, 1], [3, 1], [2, 2]]}],
         "target": {"relative_tolerance": null, "curve": {"over": "/peclet", "relative_tolerance": 0.1}}})",
     "/sweep/0/values/3", "2", "must differ from the others: it is the axis of curves"},
    {R"({"sweep": [{"set": ["/peclet", "/x"], "values": [[1, 1], [2, 2], [3, 3], [4, 4]]}],
         "target": {"relative_tolerance": null, "curve": {"over": "/peclet", "relative_tolerance": 0.1},
                    "also": [{"observable": "pressure", "curve": {"over": "/x", "relative_tolerance": 0.1}}]}})",
     "/target/also/0/curve/over", "/x", "must be that of the other curves, /peclet"},
    {R"({"choose": {"points": 8}})", "/choose", "points", "needs a curve in the target"},
    {R"({"choose": {"points": 3}})", "/choose/points", "3", "must be an integer >= 4"},
    {R"({"choose": {"points": 8, "values": [1, "2"]}})", "/choose/values/1", "2", "must be a number"},
    {R"({"sweep": [{"set": "/peclet", "values": [1, 2, 3, 4]}], "choose": {"points": 8, "values": [4]},
         "target": {"relative_tolerance": null, "curve": {"over": "/peclet", "relative_tolerance": 0.1}}})",
     "/sweep/0/values/4", "4", "must differ from the others: it is the axis of curves"},
    {R"({"scene": null})", "/scene", "missing", "must be an object, or a string"},
    {R"({"scene": 7})", "/scene", "7", "must be an object, or a string"},
    {R"({"scene": "dense.json"})", "/scene", "dense.json", "dense.json: cannot be read: No such file"},
    {R"({"scene": "."})", "/scene", ".", "must name a file"},
    {R"({"scene": "list.json"})", "/scene", "list.json",
     "must name a file with a scene, an object; it has [1]"},
    {R"({"scene": "open.json"})", "/scene", "open.json", "open.json: line 1, column 2: must be JSON"},
    {R"({"seeds": 10})", "/seeds", "unknown key", "allowed keys: name, scene, sweep"},
    {R"({"sweep": {"set": "/peclet"}})", "/sweep", "{", "must be an array"},
    {R"({"sweep": [{"values": [1]}]})", "/sweep/0/set", "missing", ""},
    {R"({"sweep": [{"set": "/peclet"}]})", "/sweep/0/values", "missing", "must be an array of 1 or more"},
    {R"({"sweep": [{"set": "/peclet", "values": []}]})", "/sweep/0/values", "[]", "array of 1 or more"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 1, "to": 9, "points": 1, "spaced": "log"}}]})",
     "/sweep/0/values/points", "1", "must be an integer >= 2"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 1, "to": 9, "points": 3}}]})",
     "/sweep/0/values/spaced", "missing", "one of: log, linear"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 0, "to": 9, "points": 3, "spaced": "log"}}]})",
     "/sweep/0/values/from", "0", "must be above 0 for logarithmic spacing"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 9, "to": -1, "points": 3, "spaced": "log"}}]})",
     "/sweep/0/values/to", "-1", "must be above 0"},
    {R"({"sweep": [{"set": ["/a"], "values": {"from": 1, "to": 9, "points": 3, "spaced": "log"}}]})",
     "/sweep/0/values", "{", "must be a list if set is one"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 1, "to": 1, "points": 2, "spaced": "linear"}}]})",
     "/sweep/0/values", "{", "must have values that differ"},
    {R"({"sweep": [{"set": "/peclet", "values": {"from": 1, "to": 2, "points": 1000, "spaced": "linear"}},
                   {"set": "/x", "values": {"from": 1, "to": 2, "points": 1000, "spaced": "linear"}}]})",
     "/sweep", "more than 100000 points", "must make at most"},
    {R"({"sweep": [{"set": "peclet", "values": [1]}]})", "/sweep/0/set", "peclet", "JSON pointer"},
    {R"({"sweep": [{"set": "", "values": [1]}]})", "/sweep/0/set", "\"\"", "JSON pointer"},
    {R"({"sweep": [{"set": "/a~b", "values": [1]}]})", "/sweep/0/set", "/a~b", "JSON pointer"},
    {R"({"sweep": [{"set": [], "values": [1]}]})", "/sweep/0/set", "[]", "JSON pointer"},
    {R"({"sweep": [{"set": ["/a", 3], "values": [[1, 2]]}]})", "/sweep/0/set/1", "3", "JSON pointer"},
    {R"({"sweep": [{"set": ["/a", "/b"], "values": [[1, 2], [3]]}]})", "/sweep/0/values/1", "[3]",
     "an array with one value for each pointer of set, 2 in all"},
    {R"({"sweep": [{"set": ["/a", "/b"], "values": [1, 2]}]})", "/sweep/0/values/0", "1", "2 in all"},
    {R"({"sweep": [{"set": "/peclet", "values": [1, 10, 1.0]}]})", "/sweep/0/values/2", "peclet=1",
     "must differ from the other points: the scene equals that of peclet=1, from value 0"},
    {R"({"sweep": [{"set": "/peclet", "values": [1]}, {"set": "/peclet", "values": [2]}]})", "/sweep/1/set",
     "/peclet", "once only"},
    {R"({"sweep": [{"set": "/fluid", "values": [{}]}, {"set": "/fluid/viscosity", "values": [2]}]})",
     "/sweep/1/set", "/fluid/viscosity", "must not overlap with /fluid"},
    {R"({"sweep": [{"set": "/species/2/radius", "values": [1]}]})", "/sweep/0/set", "/species/2/radius",
     "an array of length 2 has no element 2"},
    {R"({"sweep": [{"set": "/species/01/radius", "values": [1]}]})", "/sweep/0/set", "/species/01/radius",
     "has no element 01"},
    {R"({"sweep": [{"set": "/species/-", "values": [1]}]})", "/sweep/0/set", "/species/-",
     "has no element -"},
    {R"({"sweep": [{"set": "/fluid/viscosity/x", "values": [1]}]})", "/sweep/0/set", "/fluid/viscosity/x",
     "1 is neither an object nor an array"},
    {R"({"target": null})", "/target", "missing",
     "must be an object, unless /realisations is the number of seeds"},
    {R"({"realisations": 16})", "/target", "observable", "must not be given beside a fixed number"},
    {R"({"show": ["pressure"]})", "/show", "pressure", "must not be given beside a target"},
    {R"({"target": null, "realisations": 0})", "/realisations", "0",
     "must be an integer >= 1 and <= 1000000, or an object"},
    {R"({"target": null, "realisations": -1})", "/realisations", "-1", "must be an integer >= 1"},
    {R"({"target": null, "realisations": 2.5})", "/realisations", "2.5", "must be an integer >= 1"},
    {R"({"target": null, "realisations": "16"})", "/realisations", "16", "must be an integer >= 1"},
    {R"({"target": null, "realisations": 1000001})", "/realisations", "1000001", "<= 1000000"},
    {R"({"target": null, "realisations": 4, "show": "pressure"})", "/show", "pressure",
     "must be an array of 1 to 101"},
    {R"({"target": null, "realisations": 4, "show": []})", "/show", "[]", "must be an array of 1 to 101"},
    {R"({"target": null, "realisations": 4, "show": [4]})", "/show/0", "4", "must be a string"},
    {R"({"target": null, "realisations": 4, "show": ["pressure", "pressure"]})", "/show/1", "pressure",
     "must differ from the observables before it"},
    {R"({"target": {"relative_tolerance": 5}})", "/target/relative_tolerance", "5",
     "must be a number > 0 and < 1; 5 % is written 0.05"},
    {R"({"target": {"relative_tolerance": 0}})", "/target/relative_tolerance", "0", "> 0 and < 1"},
    {R"({"target": {"relative_tolerance": "5%"}})", "/target/relative_tolerance", "5%", "must be a number"},
    {R"({"target": {"relative_tolerance": null}})", "/target/relative_tolerance", "missing",
     "must be a number"},
    {R"({"target": {"confidence": 95}})", "/target/confidence", "95", "> 0.5 and < 1"},
    {R"({"target": {"observable": 1}})", "/target/observable", "1", "must be a string"},
    {R"({"realisations": {"minimum": 1}})", "/realisations/minimum", "1", "integer >= 2 and <= 1000000"},
    {R"({"realisations": {"minimum": 7}})", "/realisations/minimum", "7",
     "must be an integer >= 8, or equal to maximum"},
    {R"({"realisations": {"minimum": 10.5}})", "/realisations/minimum", "10.5", "must be an integer"},
    {R"({"realisations": {"maximum": 9}})", "/realisations/maximum", "9", "integer >= minimum, 10"},
    {R"({"realisations": {"maximum": 2000000}})", "/realisations/maximum", "2000000", "<= 1000000"},
    {R"({"realisations": {"maximum": null}})", "/realisations/maximum", "missing", "must be an integer"},
    {R"({"keep_files": "some"})", "/keep_files", "some",
     "must be an integer >= 0 and <= 1000000, or one of: all, none"},
    {R"({"keep_files": -1})", "/keep_files", "-1", "an integer >= 0"},
    {R"({"keep_files": 1.5})", "/keep_files", "1.5", "an integer >= 0"},
    {R"({"keep_files": 1000001})", "/keep_files", "1000001", "<= 1000000"},
    {R"({"keep_files": true})", "/keep_files", "true", "an integer >= 0"},
    {R"({"engine": "peclet-engine"})", "/engine", "peclet-engine", "must be an array"},
    {R"({"engine": []})", "/engine", "[]", "array of 1 or more"},
    {R"({"engine": ["peclet-engine", 1]})", "/engine/1", "1", "must be a string"},
};

std::filesystem::path write(const TemporaryFolder& folder, const std::string& text) {
  std::filesystem::path path = folder.path() / "campaign.json";
  std::ofstream(path) << text;
  return path;
}

TEST(CampaignFaults, EachIsNamedWithPointerValueAndWhatIsAllowed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "list.json") << "[1]";
  std::ofstream(folder.path() / "open.json") << "{";
  for (const Fault& fault : faults) {
    Json document = Json::parse(whole_campaign);
    document.merge_patch(Json::parse(fault.edit));
    const std::filesystem::path path = write(folder, document.dump());
    try {
      read_campaign(path);
      ADD_FAILURE() << "accepted: " << fault.edit;
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), path.string()) << fault.edit;
      EXPECT_EQ(error.pointer(), fault.pointer) << fault.edit;
      EXPECT_NE(error.value().find(fault.value), std::string::npos) << error.what();
      EXPECT_NE(error.allowed().find(fault.allowed), std::string::npos) << error.what();
    }
  }
}

TEST(CampaignFaults, AGridBeyondAHundredThousandPointsIsRefused) {
  const TemporaryFolder folder;
  Json document = Json::parse(whole_campaign);
  Json values = Json::array();
  for (int i = 0; i < 400; ++i) values.push_back(i);
  document["sweep"] = Json::array({{{"set", "/a"}, {"values", values}}, {{"set", "/b"}, {"values", values}}});
  EXPECT_THROW(read_campaign(write(folder, document.dump())), InputError);
}

TEST(CampaignFaults, AFileThatIsAbsentOrNoJsonIsNamed) {
  const TemporaryFolder folder;
  for (const char* const text : {"", "{", "{} {}", R"({"name": "a", "name": "b"})", R"({"name": 1e999})"}) {
    EXPECT_THROW(read_campaign(write(folder, text)), InputError) << text;
  }
  EXPECT_THROW(read_campaign(folder.path() / "absent.json"), InputError);
}

}  // namespace
}  // namespace peclet::runner
