#include <gtest/gtest.h>

#include <thread>

#include "contract/errors.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

TEST(ResultText, ComesBackAsItWas) {
  const std::string dictionary = R"({"mean":{"relative_viscosity":1.25},"seed":0})";
  for (const std::string& text : {std::string(), std::string("{}"), dictionary, noise(100'000)}) {
    for (const std::string& used : {std::string(), dictionary, noise(50'000)}) {
      EXPECT_EQ(inflated(deflated(text, used), used), text) << text.size() << ' ' << used.size();
    }
  }
}

// The first text of a thread meets a stream that has never run.
TEST(ResultText, DoesNotDependOnWhatWasDeflatedBefore) {
  const std::vector<std::string> texts{noise(40'000), "", noise(300), noise(40'000).substr(100) + "{}"};
  for (const std::string& dictionary : {std::string(), texts[0], noise(70'000)}) {
    for (const std::string& text : texts) {
      for (const std::string& before : texts) {
        deflated(before, noise(1000));
        const std::string bytes = deflated(text, dictionary);
        std::string fresh;
        std::thread([&] { fresh = deflated(text, dictionary); }).join();
        EXPECT_EQ(bytes, fresh) << before.size() << ' ' << text.size() << ' ' << dictionary.size();
      }
    }
  }
}

TEST(ResultText, TakesWhatItRepeatsFromTheDictionary) {
  const std::string text = noise(5000);
  EXPECT_GT(deflated(text, "").size(), 3750U);  // six bits a letter
  EXPECT_LT(deflated(text, text).size(), 100U);
}

TEST(ResultText, OfOtherBytesIsAnError) {
  const std::string dictionary = noise(300), text = noise(500);
  const std::string bytes = deflated(text, dictionary);
  EXPECT_THROW(inflated(bytes, ""), IntegrityError);
  EXPECT_THROW(inflated(bytes, noise(299)), IntegrityError);
  EXPECT_THROW(inflated("no stream", dictionary), IntegrityError);
  EXPECT_THROW(inflated("", dictionary), IntegrityError);
  EXPECT_THROW(inflated(bytes + "x", dictionary), IntegrityError);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(inflated(bytes.substr(0, size), dictionary), IntegrityError) << size;
  }
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    std::string changed = bytes;
    changed[place] ^= 1;
    EXPECT_THROW(inflated(changed, dictionary), IntegrityError) << place;
  }
}

// 128 MiB of zeros take 128 kB deflated; a stored text must not make a reader take all memory.
TEST(ResultText, OfABombIsAnErrorBeforeItHasGoneOff) {
  const std::string bytes = deflated(std::string(128 << 20, '0'), "");
  EXPECT_LT(bytes.size(), 200'000U);
  try {
    inflated(bytes, "");
    FAIL() << "inflated";
  } catch (const IntegrityError& error) {
    EXPECT_STREQ(error.what(), "inflates to more than 67108864 bytes");
  }
}

class StoredTexts : public testing::Test {
 protected:
  StoredTexts() {
    PointStore(database_).adopt(plain_campaign(1, 4, 40, 0.05));
    SeedStore(database_).enqueue(1, 4);
  }
  std::string text_of(int seed) {
    Statement query(
        database_.connection(),
        "SELECT document, text FROM result LEFT JOIN dictionary USING (point_id) WHERE point_id = 1 "
        "AND seed = ?");
    query.bind(seed);
    return query.step() ? result_text(query, 0, 1) : "none";
  }
  std::string dictionary() {
    return database_.connection().text("SELECT coalesce(group_concat(text, '|'), '') FROM dictionary");
  }
  void store(int seed, const std::string& text, bool completed) {
    store_result_text(database_.connection(), 1, seed, text, completed);
  }

  TemporaryFolder folder_;
  Database database_ = Database::open_owner(folder_.path() / "campaign.db");
};

TEST_F(StoredTexts, LeanOnTheFirstOneThatCompleted) {
  store(3, R"({"seed":3,"lost":true})", false);
  EXPECT_EQ(dictionary(), "");
  const std::string first = R"({"a long name that every result has":1,"seed":1})";
  const std::string second = R"({"a long name that every result has":1,"seed":2})";
  store(1, first, true);
  store(2, second, true);
  store(0, R"({"seed":0,"lost":true})", false);
  EXPECT_EQ(dictionary(), first);
  EXPECT_EQ(text_of(1), first);
  EXPECT_EQ(text_of(2), second);
  EXPECT_EQ(text_of(3), R"({"seed":3,"lost":true})");
  EXPECT_EQ(text_of(0), R"({"seed":0,"lost":true})");
  const std::int64_t bytes =
      database_.connection().integer("SELECT length(document) FROM result WHERE seed = 2");
  EXPECT_LT(bytes, static_cast<std::int64_t>(second.size() / 2));
}

TEST_F(StoredTexts, OutliveTheResultThatTheyLeanOn) {
  store(0, R"({"name":[1,2,3,4,5],"seed":0})", true);
  store(1, R"({"name":[1,2,3,4,5],"seed":1})", true);
  database_.connection().execute("DELETE FROM result WHERE seed = 0");
  EXPECT_EQ(text_of(1), R"({"name":[1,2,3,4,5],"seed":1})");
}

TEST_F(StoredTexts, OfTooManyValuesAreNotRead) {
  std::string list = "[0";
  for (int i = 0; i < 600'000; ++i) list += ",[]";
  store(0, list + "]", false);
  EXPECT_THROW(text_of(0), IntegrityError);
}

}  // namespace
}  // namespace peclet::runner
