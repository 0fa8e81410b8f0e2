// What the tip moves before: the surface, a scale of lengths, the key to the colours, and the figures as text.
#pragma once

#include "canvas.h"
#include "run_view.h"
#include "strobe.h"

namespace afm::view {

void draw_surface(Canvas& canvas, const Model& model);
void draw_length_scale(Canvas& canvas, const Units& units);
void draw_key(Canvas& canvas, const Units& units);
void draw_figures(Canvas& canvas, const RunView& run, const Strobe& strobe);

}  // namespace afm::view
