// Numbers as people want to read them: no more digits than their errors justify, "-" for what does not exist.
#pragma once

#include <cstddef>
#include <string>

namespace peclet::runner {

// "8.93 ± 0.12": the error to two significant digits, the value to the same place. "8.9 ± -" when there is no
// error yet (NaN), "-" when there is no value either.
std::string with_error(double value, double error);

// "3.0 %", "12 %" of a fraction.
std::string percent(double fraction);

// "1 seed", "3 seeds".
std::string counted(std::size_t number, const char* noun);

// "8 to 100"; "16" for equal ones.
std::string range_text(int least, int most);

// Three significant digits at most: "0.017", "1.2e+06".
std::string rough(double number);

}  // namespace peclet::runner
