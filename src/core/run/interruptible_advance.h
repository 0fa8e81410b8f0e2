// A tip in a long computation that can be stopped (afm/interruption.h).
#pragma once

#include "afm/interruption.h"
#include "afm/tip.h"

namespace afm::detail {

// As Tip::advance(), with an interruption_point() at least every so many tau: a tip that is held down may have no event
// for ever. No bit changes, as a limit splits no motion.
inline Outcome advance_interruptibly(Tip& tip, const ModelTime& limit) {
  constexpr double kLongest = 1000.0;  // [tau] a choice: up to a tenth of a second in contact
  for (;;) {
    interruption_point();
    const ModelTime stop = tip.now() + kLongest;
    if (limit <= stop) return tip.advance(limit);
    const Outcome outcome = tip.advance(stop);
    if (outcome != Outcome::time_limit) return outcome;
  }
}

// Through all events, to `end` or to where a search cannot go on.
inline void bring_to(Tip& tip, const ModelTime& end) {
  for (;;) {
    const Outcome outcome = advance_interruptibly(tip, end);
    if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) return;
  }
}

}  // namespace afm::detail
