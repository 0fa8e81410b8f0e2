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
  explicit Picture(double cells) : cells_(cells) {}

  visualization_msgs::MarkerArray draw(const RunView& run, ros::Time stamp);

 private:
  const double cells_;
  std::uint32_t epoch_ = 0;
  ModelTime seen_;                                      // up to here
  std::deque<std::vector<Place>> positions_, impacts_;  // what each of the last pictures added to the cloud
};

// The scenery of the tip (scenery.cpp): the surface, a scale of lengths, the key to the colours, and figures as text.
void draw_scenery(Canvas& canvas, const RunView& run, bool is_cloud);

}  // namespace afm::view
