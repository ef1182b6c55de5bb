// Tests the contents of exports, and that the canonical form does not depend on the course of a run.
#include "runner/reports/export.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "tests/runner/stored_campaign.h"

namespace peclet::runner {
namespace {

const double viscosities[] = {9.9, 10, 10.1, 10};

void fill(StoredCampaign& campaign, int point, const std::vector<int>& order) {
  for (const int seed : order) campaign.complete(point, seed, viscosities[seed]);
}

Json exported(StoredCampaign& campaign, bool canonical) {
  return parse_json(export_json(campaign.database(), canonical), "export");
}

void collect_keys(const Json& value, std::set<std::string>& keys) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      keys.insert(key);
      collect_keys(member, keys);
    }
  } else if (value.is_array()) {
    for (const Json& element : value) collect_keys(element, keys);
  }
}

TEST(Export, CanonicalBytesDoNotDependOnOrderAttemptsAndExtraSeeds) {
  StoredCampaign one(2, 4, 20), other(2, 4, 20);
  fill(one, 0, {0, 1, 2, 3});
  fill(one, 1, {0, 1, 2});
  fill(other, 1, {2, 0, 1});
  fill(other, 0, {3, 1});
  other.complete(0, 6, 1000);
  fill(other, 0, {2, 0});
  EXPECT_NE(export_json(one.database(), false), export_json(other.database(), false));
  EXPECT_EQ(export_json(one.database(), true), export_json(other.database(), true));
  EXPECT_EQ(export_csv(one.database(), true), export_csv(other.database(), true));
}

TEST(Export, CanonicalFormKnowsNothingOfTimeMachinesAndAttempts) {
  StoredCampaign campaign(1, 6, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  campaign.blow_up(0, 4);
  campaign.crash(0, 5);
  campaign.complete(0, 7, 10);
  std::set<std::string> canonical, full;
  collect_keys(exported(campaign, true), canonical);
  collect_keys(exported(campaign, false), full);
  for (const char* const key :
       {"cost", "cpu_seconds", "wall_seconds", "attempts", "worker", "host", "process", "started_at",
        "ended_at", "state", "extra", "engines", "document"}) {
    EXPECT_FALSE(canonical.contains(key)) << key;
    EXPECT_TRUE(full.contains(key)) << key;
  }
}

TEST(Export, CanonicalSpellingIsCanonical) {
  StoredCampaign campaign(2, 4, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  std::string text = export_json(campaign.database(), true);
  std::erase(text, '\n');  // each point is on a line of its own
  EXPECT_EQ(text, canonical_json(parse_json(text, "export")));
}

TEST(Export, EstimatesAreOverTheSeedsOfTheStopTest) {
  StoredCampaign campaign(1, 4, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  campaign.complete(0, 4, 1000);
  const Json point = exported(campaign, true)["points"][0];
  EXPECT_EQ(point["verdict"], "converged");
  EXPECT_EQ(point["realisations"].size(), 4U);
  // The sample variance is (0.1^2 + 0.1^2) / 3. In plain_result() the pressure is twice the viscosity.
  const double standard_error = std::sqrt(0.02 / 3 / 4);
  const Json& viscosity = point["quantities"]["relative_viscosity"];
  EXPECT_EQ(viscosity["count"], 4);
  EXPECT_NEAR(viscosity["mean"].get<double>(), 10.25, 1e-12);
  EXPECT_NEAR(viscosity["plain"]["mean"].get<double>(), 10, 1e-12);
  EXPECT_NEAR(viscosity["standard_error"].get<double>(), standard_error, 1e-12);
  EXPECT_NEAR(point["quantities"]["pressure"]["mean"].get<double>(), 20, 1e-12);
  EXPECT_NEAR(point["quantities"]["pressure"]["standard_error"].get<double>(), 2 * standard_error, 1e-12);
  EXPECT_EQ(point["quantities"]["control_variates/brownian_pairwise"]["mean"], 0.25);
  EXPECT_EQ(exported(campaign, false)["points"][0]["extra"][0]["seed"], 4);
}

TEST(Export, LostSeedsAreThereWithTheirCauseAndWithoutNumbers) {
  StoredCampaign campaign(1, 6, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  campaign.blow_up(0, 4);
  campaign.crash(0, 5);
  const Json point = exported(campaign, true)["points"][0];
  EXPECT_EQ(point["verdict"], "converged-with-losses");
  ASSERT_EQ(point["realisations"].size(), 6U);
  EXPECT_EQ(point["realisations"][4]["ending"]["cause"], "overlap");
  EXPECT_TRUE(point["realisations"][4]["mean"].is_null());
  EXPECT_EQ(point["realisations"][5]["ending"]["cause"], "crashed");
  EXPECT_EQ(point["quantities"]["relative_viscosity"]["count"], 4);
}

TEST(Export, APointBeforeItsFirstStopTestHasNoEstimates) {
  StoredCampaign campaign(1, 4, 20);
  fill(campaign, 0, {0, 1, 2});
  const Json canonical = exported(campaign, true)["points"][0];
  EXPECT_TRUE(canonical["stop_test"].is_null());
  EXPECT_TRUE(canonical["verdict"].is_null());
  EXPECT_TRUE(canonical["realisations"].empty());
  EXPECT_TRUE(canonical["quantities"].empty());
  EXPECT_EQ(exported(campaign, false)["points"][0]["extra"].size(), 3U);
}

TEST(Export, AChangedNumberInTheDatabaseIsAnIntegrityFault) {
  StoredCampaign campaign(1, 4, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  campaign.database().connection().execute(
      "UPDATE numbers SET numbers = json_replace(numbers, '$[0]', 10.5) WHERE seed = 2");
  EXPECT_THROW(export_json(campaign.database(), true), IntegrityError);
  EXPECT_THROW(export_csv(campaign.database(), true), IntegrityError);
}

// plain_result() has a control variate of 0.25: status and every export must give 10.25 as the mean.
TEST(Export, TheEstimateThatDecidesIsTheMeanEverywhere) {
  StoredCampaign campaign(1, 4, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  Database& database = campaign.database();
  const StopTest stop_test = database.stop_tests(database.points().at(0).id).back().stop_test;
  ASSERT_NEAR(stop_test.controlled.mean, 10.25, 1e-12);
  ASSERT_NEAR(stop_test.estimate.mean, 10, 1e-12);
  const auto view = [&](const char* column) {
    return database.connection().integer(std::string("SELECT round(1000 * ") + column + ") FROM estimates");
  };
  EXPECT_EQ(view("mean"), 10250);
  EXPECT_EQ(view("plain_mean"), 10000);
  const std::string csv = export_csv(database, true);
  const std::string row = csv.substr(csv.find('\n') + 1);
  const std::string wanted =
      fmt::format(",converged,4,0,4,{},{},{},{},{},{},", canonical_json(stop_test.controlled.mean),
                  canonical_json(stop_test.controlled.standard_error),
                  canonical_json(stop_test.controlled_half_width), canonical_json(stop_test.estimate.mean),
                  canonical_json(stop_test.estimate.standard_error), canonical_json(stop_test.half_width));
  EXPECT_NE(row.find(wanted), std::string::npos) << row << wanted;
  const Json json = exported(campaign, true)["points"][0]["stop_test"];
  EXPECT_EQ(json["mean"], stop_test.controlled.mean);
  EXPECT_EQ(json["half_width"], stop_test.controlled_half_width);
  EXPECT_EQ(json["plain"]["mean"], stop_test.estimate.mean);
}

TEST(Export, CsvHasARowPerPointWithEmptyFieldsForWhatDoesNotExist) {
  StoredCampaign campaign(2, 4, 20);
  fill(campaign, 0, {0, 1, 2, 3});
  campaign.database().connection().execute("UPDATE point SET label = 'a, \"b\"' WHERE place = 1");
  const std::string csv = export_csv(campaign.database(), true);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "label,hash,/point,verdict,seeds,lost,count,mean,standard_error,half_width,plain_mean,"
            "plain_standard_error,plain_half_width,"
            "control_variates/brownian_pairwise,control_variates/brownian_pairwise standard_error,"
            "control_variates/brownian_pairwise count,pressure,pressure standard_error,pressure count,"
            "relative_viscosity,relative_viscosity standard_error,relative_viscosity count");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find("\npoint=0,"), std::string::npos);
  EXPECT_NE(csv.find(",0,converged,4,0,4,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n\"a, \"\"b\"\"\","), std::string::npos) << csv;
  EXPECT_TRUE(csv.ends_with(",1,,,,,,,,,,,,,,,,,,,\n")) << csv;
  EXPECT_NE(csv.find(",0.25,0,4,20,"), std::string::npos) << csv;  // control variate and pressure
}

// A quantity has the name of a column ("count").
TEST(Export, ColumnsOfACsvAreNotCalledAlike) {
  StoredCampaign campaign(1, 4, 40);
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete_with(0, seed, viscosities[seed], [](Json& result) {
      result.erase("quantities");
      result["mean"]["count"] = 3;  // as other engines may have
    });
  }
  const std::string csv = export_csv(campaign.database(), false);
  std::stringstream titles(csv.substr(0, csv.find('\n')));
  std::set<std::string> seen;
  for (std::string title; std::getline(titles, title, ',');) EXPECT_TRUE(seen.insert(title).second) << title;
  EXPECT_TRUE(seen.count("quantity count"));
}

// An update of the engine describes numbers that earlier results do not: the unit is "1" in both cases.
TEST(Export, ANumberThatOnlySomePointsDescribeHasOneColumnOfACsv) {
  StoredCampaign campaign(2, 4, 40);
  for (int seed = 0; seed < 4; ++seed) {
    for (int point = 0; point < 2; ++point) {
      campaign.complete_with(point, seed, viscosities[seed], [point](Json& result) {
        result["mean"]["x"] = point;
        result.erase("quantities");
        if (point == 0) return;
        const Json about = {{"symbol", ""}, {"unit", "1"}, {"estimator", "mean"}};
        result["quantities"] = {{"relative_viscosity", about}, {"x", about}};
      });
    }
  }
  std::istringstream lines(export_csv(campaign.database(), true));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  ASSERT_EQ(rows.size(), 3U);
  const auto column = std::find(rows[0].begin(), rows[0].end(), "x");
  ASSERT_NE(column, rows[0].end());
  EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), "x"), 1);
  const auto place = static_cast<std::size_t>(column - rows[0].begin());
  EXPECT_EQ(rows[1].at(place), "0");
  EXPECT_EQ(rows[2].at(place), "1");
  EXPECT_EQ(rows[2].at(place + 2), "4");
}

TEST(Export, TheLongTableHasARowForEveryNumber) {
  StoredCampaign campaign(2, 4, 20);
  const auto add = [](Json& result, double v) {
    result["mean"]["profile"] = {v, 2 * v};
    result["mean"]["g"] = {{"counts", {v}}, {"ideal", 2}};
    const Json y = {{{"name", "y"}, {"unit", "length"}, {"values", {0.5, 1.5}}}};
    result["quantities"] = {
        {"relative_viscosity", {{"symbol", "eta_r"}, {"unit", "1"}, {"estimator", "mean"}}},
        {"pressure", {{"symbol", "P"}, {"unit", "stress"}, {"estimator", "mean"}}},
        {"profile", {{"symbol", "u"}, {"unit", "length / time"}, {"estimator", "mean"}, {"axes", y}}},
        {"g", described_ratio({"all"})}};
  };
  for (int seed = 0; seed < 4; ++seed) {
    campaign.complete_with(0, seed, viscosities[seed], [&](Json& result) { add(result, viscosities[seed]); });
  }
  const std::string table = export_long_csv(campaign.database());
  const std::string hash = campaign.database().points().at(0).hash;
  // The sample variance is 0.02 / 3, and Student's t has three degrees of freedom. The level is
  // 1 - 0.05 (1 - 1.4 / 4), for a minimum of four seeds.
  const double error = std::sqrt(0.02 / 3 / 4), half = 3.777447959 * error;
  std::istringstream lines(table);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream cells(line + ",");
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    rows.push_back(fields);
  }
  EXPECT_EQ(rows.at(0),
            (std::vector<std::string>{"label", "hash", "/point", "quantity", "symbol", "unit", "estimator",
                                      "axis_1", "axis_1_unit", "axis_1_value", "count", "mean",
                                      "standard_error", "half_width", "plain_mean", "plain_standard_error"}));
  ASSERT_EQ(rows.size(), 1U + 5U);  // g, pressure, profile twice, viscosity
  const std::vector<std::string>& profile = rows[4];
  EXPECT_EQ((std::vector<std::string>(profile.begin(), profile.begin() + 11)),
            (std::vector<std::string>{"point=0", hash, "0", "profile", "u", "length / time", "mean", "y",
                                      "length", "1.5", "4"}));
  EXPECT_NEAR(std::stod(profile[11]), 20, 1e-12);
  EXPECT_NEAR(std::stod(profile[12]), 2 * error, 1e-12);
  EXPECT_NEAR(std::stod(profile[13]), 2 * half, 1e-8);
  EXPECT_EQ(rows[1][3], "g");
  EXPECT_EQ(rows[1][6], "ratio");
  EXPECT_EQ(rows[1][9], "all");
  EXPECT_NEAR(std::stod(rows[1][11]), 5, 1e-12);
  EXPECT_NEAR(std::stod(rows[1][12]), error / 2, 1e-12);
  const std::string csv = export_csv(campaign.database(), true);
  EXPECT_NE(csv.find(",pressure [stress],pressure [stress] standard_error,"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("profile"), std::string::npos);
}

TEST(Export, NoTextOfACsvIsAFormulaOfASpreadsheet) {
  StoredCampaign campaign(1, 4, 20);
  for (const auto& [text, cell] : {std::pair{"=1+1", "'=1+1"},
                                   {"+1", "'+1"},
                                   {"-x", "'-x"},
                                   {"@SUM(A1)", "'@SUM(A1)"},
                                   {"\tx", "'\tx"},
                                   {"\rx", "\"'\rx\""},
                                   {"x=1", "x=1"},
                                   {"a-b", "a-b"}}) {
    campaign.database().connection().execute("UPDATE point SET label = '" + std::string(text) +
                                             "', settings = json_object('/point', '" + text + "')");
    const std::string csv = export_csv(campaign.database(), true), row = csv.substr(csv.find('\n') + 1);
    EXPECT_TRUE(row.starts_with(std::string(cell) + ',')) << row;
    EXPECT_NE(row.find(',' + std::string(cell) + ','), std::string::npos) << row;
  }
  // A negative number stays a number.
  campaign.database().connection().execute("UPDATE point SET settings = json_object('/point', -1.5)");
  EXPECT_NE(export_csv(campaign.database(), true).find(",-1.5,"), std::string::npos);
}

}  // namespace
}  // namespace peclet::runner
