// What the marks of a figure mean, and where there is room to say so.
#pragma once

#include <string>
#include <vector>

#include "runner/figure/figure.h"
#include "runner/figure/svg_text.h"

namespace peclet::runner {

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

struct LegendPlace {
  const char* name;  // as of FigureLayout
  Place corner;      // its upper left
};

class Legend {
 public:
  explicit Legend(const Figure& figure);

  bool is_empty() const { return items_.empty(); }
  double width() const { return width_; }
  double height() const;
  // In the corner of the frame where it covers nothing of what is drawn; beside the frame where there is
  // none.
  LegendPlace place(const Box& frame, const std::vector<Box>& drawn) const;
  std::string svg(Place corner) const;

 private:
  enum class Sign { curve, hollow, dashed, cross, band };
  struct Item {
    Sign sign;
    std::size_t curve;
    Label text;
  };

  std::vector<Item> items_;
  double width_ = 0;
};

}  // namespace peclet::runner
