// How figures write what results and scenes call things. The page's rules are the same:
// tests/pages/page_rules_test.py has the same table.
#include "runner/figure/label.h"

#include <gtest/gtest.h>

namespace peclet::runner {
namespace {

TEST(FigureLabel, OfASymbolHasWhatIsLoweredAndRaised) {
  EXPECT_EQ(symbol_label("eta_r"), (Label{{"η", 0}, {"r", -1}}));
  EXPECT_EQ(symbol_label("N_1"), (Label{{"N", 0}, {"1", -1}}));
  EXPECT_EQ(symbol_label("P"), (Label{{"P", 0}}));
  EXPECT_EQ(symbol_label("sigma^noise_xy"), (Label{{"σ", 0}, {"xy", -1}, {"noise", 1}}));
  EXPECT_EQ(symbol_label("sigma^contact_normal", "xz"), (Label{{"σ", 0}, {"xz", -1}, {"contact normal", 1}}));
  EXPECT_EQ(symbol_label("eta_r^pairs"), (Label{{"η", 0}, {"r", -1}, {"pairs", 1}}));
  EXPECT_EQ(symbol_label("N_1^noise"), (Label{{"N", 0}, {"1", -1}, {"noise", 1}}));
  EXPECT_EQ(symbol_label("<rate>"), (Label{{"⟨γ̇⟩", 0}}));
  EXPECT_EQ(symbol_label("<delta/a>"), (Label{{"⟨δ/a⟩", 0}}));
  EXPECT_EQ(symbol_label("P(F_n > F_CL)"), (Label{{"P(F", 0}, {"n", -1}, {" > F", 0}, {"CL", -1}, {")", 0}}));
  EXPECT_EQ(symbol_label("u_x(y)"), (Label{{"u", 0}, {"x", -1}, {"(y)", 0}}));
}

TEST(FigureLabel, OfAnAxisHasWordsSymbolAndUnit) {
  const Drawable pressure{"pressure", "pressure", "", "P", "viscosity * shear_rate"};
  EXPECT_EQ(text_of(title_of(pressure)), "pressure P [η γ̇]");
  const Drawable stress{"stress/total/3", "stress/total", "xy", "sigma", "1"};
  EXPECT_EQ(text_of(title_of(stress)), "stress, total, xy σxy");
  EXPECT_EQ(mathtext_of(title_of(stress)), "stress, total, xy σ$_{\\mathrm{xy}}$");
  const Drawable rate{"shear_rate", "shear_rate", "", "<rate>", "1 / time"};
  EXPECT_EQ(text_of(title_of(rate)), "shear rate ⟨γ̇⟩ [scene units]");
  const Drawable of_scene{"pressure", "pressure", "", "P", "stress"};
  EXPECT_EQ(text_of(title_of(of_scene)), "pressure P [scene units]");
  const Drawable of_others{"pressure", "pressure", "", "P", "MPa"};
  EXPECT_EQ(text_of(title_of(of_others)), "pressure P [MPa]");
}

TEST(FigureLabel, OfAParameterIsItsNameInTheField) {
  const Json known{{"pointer", "/fluid/thermal_energy"},
                   {"meaning", "Energy [energy]"},
                   {"words", "thermal energy"},
                   {"symbol", "k_B T"}};
  EXPECT_EQ(text_of(title_of(known)), "thermal energy kBT [scene units]");
  EXPECT_EQ(short_name_of(known), (Label{{"k", 0}, {"B", -1}, {"T", 0}}));
  const Json element{{"pointer", "/particles/species/1/radius"}, {"meaning", ""}};
  EXPECT_EQ(text_of(title_of(element)), "radius");
  const Json indexed{{"pointer", "/flow/wave_vector/2"}, {"meaning", ""}};
  EXPECT_EQ(text_of(short_name_of(indexed)), "wave vector 2");
}

TEST(FigureLabel, OfANumberHasFourDigitsAtMost) {
  EXPECT_EQ(plain_number(0.01), "0.01");
  EXPECT_EQ(plain_number(2000), "2000");
  EXPECT_EQ(plain_number(99999), "100000");
  EXPECT_EQ(plain_number(12346), "12350");
  EXPECT_EQ(plain_number(5e6), "5·10⁶");
  EXPECT_EQ(plain_number(1e-4), "10⁻⁴");
  EXPECT_EQ(plain_number(-2.5e7), "-2.5·10⁷");
  EXPECT_EQ(plain_number(0), "0");
}

TEST(FigureLabel, CannotLeaveTheMathematicsOfMatplotlib) {
  EXPECT_EQ(mathtext_of({{"a$b", 0}, {"x}$\\_y", -1}}), "a\\$b$_{\\mathrm{xy}}$");
}

}  // namespace
}  // namespace peclet::runner
