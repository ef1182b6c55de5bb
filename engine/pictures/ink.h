// Draws lines and letters with smooth edges, and writes images as PNG.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "engine/pictures/colouring.h"

namespace peclet::engine {

// The strokes of the characters from blank to tilde: Hershey's simplex roman.
//
// The Hershey Fonts were originally created by Dr. A. V. Hershey while working at the U. S. National Bureau
// of Standards. The format of the Font data in this distribution was originally created by James Hurt,
// Cognition, Inc., 900 Technology Park Drive, Billerica, MA 01821 (mit-eddie!ci-dandelion!hurt). This notice
// must go with the data, which anyone may use for any purpose.
//
// A text consists of pairs of letters; their distances from R are x to the right and y downwards. The first
// pair is the left and the right edge of the character; " R" lifts the pen. Capitals reach from y = -12 down
// to the base line at y = 9.
constexpr std::array<const char*, 95> hershey_simplex = {
    R"(JZ)",
    R"(MWRFRT RRYQZR[SZRY)",
    R"(JZNFNM RVFVM)",
    R"(H]SBLb RYBRb RLOZO RKUYU)",
    R"(H\PBP_ RTBT_ RYIWGTFPFMGKIKKLMMNOOUQWRXSYUYXWZT[P[MZKX)",
    R"(F^[FI[ RNFPHPJOLMMKMIKIIJGLFNFPGSHVHYG[F RWTUUTWTYV[X[ZZ[X[VYTWT)",
    R"(E_\O\N[MZMYNXPVUTXRZP[L[JZIYHWHUISJRQNRMSKSIRGPFNGMIMKNNPQUXWZY[[[\Z\Y)",
    R"(MWRHQGRFSGSIRKQL)",
    R"(KYVBTDRGPKOPOTPYR]T`Vb)",
    R"(KYNBPDRGTKUPUTTYR]P`Nb)",
    R"(JZRLRX RMOWU RWOMU)",
    R"(E_RIR[ RIR[R)",
    R"(NVSWRXQWRVSWSYQ[)",
    R"(E_IR[R)",
    R"(NVRVQWRXSWRV)",
    R"(G][BIb)",
    R"(H\QFNGLJKOKRLWNZQ[S[VZXWYRYOXJVGSFQF)",
    R"(H\NJPISFS[)",
    R"(H\LKLJMHNGPFTFVGWHXJXLWNUQK[Y[)",
    R"(H\MFXFRNUNWOXPYSYUXXVZS[P[MZLYKW)",
    R"(H\UFKTZT RUFU[)",
    R"(H\WFMFLOMNPMSMVNXPYSYUXXVZS[P[MZLYKW)",
    R"(H\XIWGTFRFOGMJLOLTMXOZR[S[VZXXYUYTXQVOSNRNOOMQLT)",
    R"(H\YFO[ RKFYF)",
    R"(H\PFMGLILKMMONSOVPXRYTYWXYWZT[P[MZLYKWKTLRNPQOUNWMXKXIWGTFPF)",
    R"(H\XMWPURRSQSNRLPKMKLLINGQFRFUGWIXMXRWWUZR[P[MZLX)",
    R"(NVROQPRQSPRO RRVQWRXSWRV)",
    R"(NVROQPRQSPRO RSWRXQWRVSWSYQ[)",
    R"(F^ZIJRZ[)",
    R"(E_IO[O RIU[U)",
    R"(F^JIZRJ[)",
    R"(I[LKLJMHNGPFTFVGWHXJXLWNVORQRT RRYQZR[SZRY)",
    R"(E`WNVLTKQKOLNMMPMSNUPVSVUUVS RQKOMNPNSOUPV RWKVSVUXVZV\T]Q]O\L[JYHWGTFQFNGLHJJILHOHRIUJWLYNZQ[T[WZYYZX RXKWSWUXV)",
    R"(I[RFJ[ RRFZ[ RMTWT)",
    R"(G\KFK[ RKFTFWGXHYJYLXNWOTP RKPTPWQXRYTYWXYWZT[K[)",
    R"(H]ZKYIWGUFQFOGMILKKNKSLVMXOZQ[U[WZYXZV)",
    R"(G\KFK[ RKFRFUGWIXKYNYSXVWXUZR[K[)",
    R"(H[LFL[ RLFYF RLPTP RL[Y[)",
    R"(HZLFL[ RLFYF RLPTP)",
    R"(H]ZKYIWGUFQFOGMILKKNKSLVMXOZQ[U[WZYXZVZS RUSZS)",
    R"(G]KFK[ RYFY[ RKPYP)",
    R"(NVRFR[)",
    R"(JZVFVVUYTZR[P[NZMYLVLT)",
    R"(G\KFK[ RYFKT RPOY[)",
    R"(HYLFL[ RL[X[)",
    R"(F^JFJ[ RJFR[ RZFR[ RZFZ[)",
    R"(G]KFK[ RKFY[ RYFY[)",
    R"(G]PFNGLIKKJNJSKVLXNZP[T[VZXXYVZSZNYKXIVGTFPF)",
    R"(G\KFK[ RKFTFWGXHYJYMXOWPTQKQ)",
    R"(G]PFNGLIKKJNJSKVLXNZP[T[VZXXYVZSZNYKXIVGTFPF RSWY])",
    R"(G\KFK[ RKFTFWGXHYJYLXNWOTPKP RRPY[)",
    R"(H\YIWGTFPFMGKIKKLMMNOOUQWRXSYUYXWZT[P[MZKX)",
    R"(JZRFR[ RKFYF)",
    R"(G]KFKULXNZQ[S[VZXXYUYF)",
    R"(I[JFR[ RZFR[)",
    R"(F^HFM[ RRFM[ RRFW[ R\FW[)",
    R"(H\KFY[ RYFK[)",
    R"(I[JFRPR[ RZFRP)",
    R"(H\YFK[ RKFYF RK[Y[)",
    R"(KYOBOb RPBPb ROBVB RObVb)",
    R"(KYKFY^)",
    R"(KYTBTb RUBUb RNBUB RNbUb)",
    R"(JZRDJR RRDZR)",
    R"(I[Ib[b)",
    R"(NVSKQMQORPSORNQO)",
    R"(I\XMX[ RXPVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(H[LFL[ RLPNNPMSMUNWPXSXUWXUZS[P[NZLX)",
    R"(I[XPVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(I\XFX[ RXPVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(I[LSXSXQWOVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(MYWFUFSGRJR[ ROMVM)",
    R"(I\XMX]W`VaTbQbOa RXPVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(I\MFM[ RMQPNRMUMWNXQX[)",
    R"(NVQFRGSFREQF RRMR[)",
    R"(MWRFSGTFSERF RSMS^RaPbNb)",
    R"(IZMFM[ RWMMW RQSX[)",
    R"(NVRFR[)",
    R"(CaGMG[ RGQJNLMOMQNRQR[ RRQUNWMZM\N]Q][)",
    R"(I\MMM[ RMQPNRMUMWNXQX[)",
    R"(I\QMONMPLSLUMXOZQ[T[VZXXYUYSXPVNTMQM)",
    R"(H[LMLb RLPNNPMSMUNWPXSXUWXUZS[P[NZLX)",
    R"(I\XMXb RXPVNTMQMONMPLSLUMXOZQ[T[VZXX)",
    R"(KXOMO[ ROSPPRNTMWM)",
    R"(J[XPWNTMQMNNMPNRPSUTWUXWXXWZT[Q[NZMX)",
    R"(MYRFRWSZU[W[ ROMVM)",
    R"(I\MMMWNZP[S[UZXW RXMX[)",
    R"(JZLMR[ RXMR[)",
    R"(G]JMN[ RRMN[ RRMV[ RZMV[)",
    R"(J[MMX[ RXMM[)",
    R"(JZLMR[ RXMR[P_NaLbKb)",
    R"(J[XMM[ RMMXM RM[X[)",
    R"(KYTBRCQDPFPHQJRKSMSOQQ RRCQEQGRISJTLTNSPORSTTVTXSZR[Q]Q_Ra RQSSUSWRYQZP\P^Q`RaTb)",
    R"(NVRBRb)",
    R"(KYPBRCSDTFTHSJRKQMQOSQ RRCSESGRIQJPLPNQPURQTPVPXQZR[S]S_Ra RSSQUQWRYSZT\T^S`RaPb)",
    R"(F^IUISJPLONOPPTSVTXTZS[Q RISJQLPNPPQTTVUXUZT[Q[O)",
};

// A finished image: red, green and blue of sRGB, row after row from the top.
struct Image {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// Returns the PNG file (ISO/IEC 15948) of an image. Requires 3 width height numbers, and sides of 1 to 2^31
// - 1.
std::string png(const Image& image);

// An image in linear light, row after row from the top. Places are in pixels; the first is [0, 1) x [0, 1).
struct Canvas {
  Canvas(std::size_t w, std::size_t h) : width(w), height(h), pixel(w * h, white) {}

  Colour& at(std::size_t x, std::size_t y) { return pixel[y * width + x]; }
  Image image() const;

  std::size_t width, height;
  std::vector<Colour> pixel;
};

struct Spot {
  double x, y;
};

// Draws a stroke with round ends.
void draw_line(Canvas& canvas, Spot from, Spot to, double width, const Colour& colour);
void draw_disc(Canvas& canvas, Spot centre, double radius, const Colour& colour);
// Draws a box; edges on whole pixels are sharp.
void draw_box(Canvas& canvas, Spot corner, Spot opposite, const Colour& colour);

// Returns the width of a text with capitals of this height. Characters other than ASCII are drawn as "?".
double width_of_text(std::string_view text, double height);
// Draws a text; `line` is the left end of its base line.
void draw_text(Canvas& canvas, Spot line, double height, std::string_view text, const Colour& colour);

}  // namespace peclet::engine
