// The scenery of the tip: the surface, a scale of lengths, the key to the colours, and the figures as text.
#pragma once

#include "canvas.h"
#include "run_view.h"

namespace afm::view {

void draw_scenery(Canvas& canvas, const RunView& run, bool is_cloud);

}  // namespace afm::view
