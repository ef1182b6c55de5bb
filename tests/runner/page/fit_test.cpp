// `peclet fit`: its text, JSON, figure and refusals. tests/python/laws_test.py tests the fits.
#include "runner/page/fit.h"

#include <gtest/gtest.h>

#include "contract/errors.h"
#include "runner/page/figure.h"
#include "tests/contract/refusal.h"
#include "tests/runner/page/jamming_campaign.h"

namespace peclet::runner {
namespace {

class Fits : public PythonOfDebian {
 protected:
  Fits() : campaign_(jamming_document(fractions)) {
    for (int point = 0; point < 6; ++point)
      campaign_.complete(point, TrueLaw{}.at(fractions[static_cast<std::size_t>(point)]));
    campaign_.jam(6);
    choice.law = "divergence";
  }
  FitAnswer answer(bool in_json = false) { return fit_law(campaign_.stored().database(), choice, in_json); }
  std::string refusal() {
    return refusal_by([&] { answer(); });
  }

  const std::vector<double> fractions{0.45, 0.50, 0.54, 0.57, 0.60, 0.62, 0.66};
  FitChoice choice;

 private:
  JammingCampaign campaign_;
};

TEST_F(Fits, GiveTheLawOfTheSeedsBackToPeopleAndPrograms) {
  const std::string text = answer().text;
  EXPECT_TRUE(says(text, "jam: relative_viscosity over /volume_fraction, 1 curve\ndivergence: ")) << text;
  EXPECT_TRUE(says(text, "left out, jammed: volume_fraction=0.66")) << text;
  const Json read = Json::parse(answer(true).text);
  const Json& law = read["curves"].at(0)["law"];
  EXPECT_EQ(read["schema_version"], 1);
  EXPECT_NEAR(law["parameters"]["phi_m"]["value"].get<double>(), TrueLaw{}.fraction, 1e-6);
  EXPECT_NEAR(law["parameters"]["exponent"]["value"].get<double>(), TrueLaw{}.exponent, 1e-4);
  EXPECT_EQ(law["degrees"], 3);
}

TEST_F(Fits, KeepGivenParametersAndTheRangeOfTheAxis) {
  choice.fixed = {"exponent=1.6"};
  choice.from = 0.5;
  const Json read = Json::parse(answer(true).text);
  EXPECT_EQ(read["given"]["fixed"], Json({{"exponent", 1.6}}));
  EXPECT_EQ(read["curves"].at(0)["points"].size(), 6U);
  EXPECT_EQ(read["curves"].at(0)["law"]["parameters"]["exponent"]["standard_error"], 0);
}

TEST_F(Fits, HaveAFigureThatDrawsItself) {
  const std::string script = figure_script(answer().figure);
  EXPECT_TRUE(is_own_script(script));
  const Picture picture = drawn(script, PictureForm::svg);
  EXPECT_TRUE(says(picture.bytes, "<svg"));
  EXPECT_EQ(picture.said, "");
}

TEST_F(Fits, RefuseOptionsThatDoNotSuitTheLaw) {
  choice.fixed = {"exponent"};
  EXPECT_EQ(refusal(), "--fix: exponent: must be NAME=VALUE, such as exponent=2");
  choice.fixed = {"exponent=two"};
  EXPECT_EQ(refusal(), "--fix: exponent=two: must be NAME=VALUE, such as exponent=2");
  choice.fixed = {"beta=2"};
  EXPECT_EQ(refusal(), "--fix: beta=2: is no parameter of divergence; there are phi_m, exponent, prefactor");
  choice.fixed.clear();
  choice.law = "wyart-cates";
  EXPECT_TRUE(says(refusal(), "--law: wyart-cates: is a law of the given stress, too")) << refusal();
  choice.law = "maxwell";
  EXPECT_TRUE(says(refusal(), "--quantity: storage_modulus: must be a measured quantity")) << refusal();
}

TEST_F(Fits, SayWhatTheyWouldHaveRunWithoutPython) {
  const TemporaryFolder empty;
  std::filesystem::create_symlink("/usr/bin/env", empty.path() / "env");
  setenv("PATH", empty.path().c_str(), 1);
  std::string said;
  try {
    answer();
  } catch (const InputError&) {
  } catch (const std::runtime_error& fault) {
    said = fault.what();
  }
  EXPECT_TRUE(says(said, "fit: the fits need python3 with NumPy and SciPy (Debian: python3-numpy, ")) << said;
}

}  // namespace
}  // namespace peclet::runner
