// How a picture a thirtieth of a second shows a motion that may be thousands of times faster. Where the eye can follow,
// the picture goes with the holder. Where a picture would be more than half a cell behind the next, and the
// surface seem to run backwards like the spokes of a wheel in a film, each shows the moment at which the centre was
// last over a crest: the surface stands still, a periodic orbit does too, and a chaotic one is a cloud.
#pragma once

#include "run_view.h"

namespace afm::view {

class Strobe {
 public:
  // Of every picture once, before the questions below. Precondition: the run is complete.
  void look(const RunView& run);

  bool frozen() const { return frozen_; }       // the surface stands still
  bool too_fast() const { return too_fast_; }   // a picture shows a part of the motion only
  ModelTime moment() const { return moment_; }  // that is shown
  // Where the holder is at that moment [a]; on a frozen surface the crest below it.
  double origin() const { return origin_; }

 private:
  void measure_pace(const RunView& run);
  void choose_moment(const RunView& run);

  ModelTime last_, moment_;
  double pace_ = 0.0;  // tau a picture
  double origin_ = 0.0;
  bool begun_ = false, frozen_ = false, too_fast_ = false;
};

}  // namespace afm::view
