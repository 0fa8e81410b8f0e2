// One picture after another, as markers, of a run.
#pragma once

#include "afterglow.h"
#include "canvas.h"

namespace afm::view {

class Picture {
 public:
  explicit Picture(const Look& look) : look_(look) {}

  visualization_msgs::MarkerArray draw(RunView& run, ros::Time stamp);

 private:
  void draw_motion(Canvas& canvas, const RunView& run) const;
  double drawn_x(const Canvas& canvas, const Spot& spot, std::size_t nth) const;
  void draw_positions(Canvas& canvas) const;
  void draw_impacts(Canvas& canvas, const Units& units) const;

  const Look look_;
  Strobe strobe_;
  Afterglow afterglow_;
};

}  // namespace afm::view
