// One picture after another of a run, as markers. Where the eye can follow, the picture goes with the holder and shows
// the tip's path and impacts. Where a picture is more than half a tau behind the next, the surface stands still with a
// crest in its middle, and what happened in the last second is a cloud over it.
#pragma once

#include <deque>

#include "canvas.h"
#include "run_view.h"

namespace afm::view {

class Picture {
 public:
  explicit Picture(const Look& look) : look_(look) {}

  visualization_msgs::MarkerArray draw(const RunView& run, ros::Time stamp);

 private:
  // The points that one picture adds to the cloud.
  struct Puff {
    std::vector<Place> positions, impacts;
  };
  void gather(const RunView& run);
  void draw_motion(Canvas& canvas, const RunView& run) const;
  void draw_positions(Canvas& canvas) const;
  void draw_impacts(Canvas& canvas, const Units& units, bool scattered) const;

  const Look look_;
  std::uint32_t epoch_ = 0;
  ModelTime seen_;  // up to here
  std::deque<Puff> cloud_;
};

}  // namespace afm::view
