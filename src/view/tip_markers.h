// The tip, its spring, and the way it came.
#pragma once

#include <vector>

#include "canvas.h"
#include "trace.h"

namespace afm::view {

void draw_path(Canvas& canvas, const std::vector<Corner>& path);
// The tip is the apex of the cone: that point is where it is.
void draw_tip(Canvas& canvas, const Corner& tip);
void draw_spring(Canvas& canvas, const Corner& tip, double centre_x, double centre_y);

}  // namespace afm::view
