// Chatter under a surface that presses, without its bounces one by one. The tip rides on the slide it would make if it did not
// bounce (a guide, off by the second order of the gap rate v); beside it run v after the bounce and the number n of
// bounces, as smooth functions of time whose values at whole n are those of the bounces.
//
// A bounce lasts 2 v/a under the pressure a, keeps v^3/(a N^2), and ends in v -> v (1 - w), w = (1 - gamma) v / (N v_c) with
// N = sqrt(1 + h'^2). The smooth functions are the flow that interpolates w -> w (1 - w): dv/dn = -v w G(w),
// dt/dn = 2 v/a T(w), so dv/dt = -(a/2) w R(w) + v (a N^2)'/(3 a N^2 T(w)). At and above the cutoff, or without one, v -> gamma v.
#pragma once

#include <cstdint>

#include "afm_emulator/flight.h"
#include "afm_emulator/model.h"
#include "afm_emulator/slide.h"
#include "afm_emulator/state.h"

namespace afm {

struct Chatter {
  double v;  // gap rate after a bounce [a/tau]
  double n;  // bounces since the burst began; whole at a bounce
};

enum class ChatterEnd : std::uint8_t {
  time,  // it goes on
  died,  // the gap rate has fallen to the threshold: contact
  exits  // the surface is about to let go, at a bounce (n whole): what follows is done bounce by bounce
};

struct ChatterRun {
  ChatterEnd end;
  double s;         // when, on the guide
  Chatter chatter;  // then
};

class ChatterLaw {
 public:
  // threshold: gap rates up to it are contact [a/tau].
  ChatterLaw(const Model& model, double threshold);

  // Can a burst begin with the bounce that begins this flight? The bounces must be short against every change, and below the
  // cutoff lose so little each that the series of the interpolation hold.
  bool holds(const Flight<double>& bounce) const;

  // From one time of the guide to another, `until`, or to the end of the chatter.
  ChatterRun run(const SlidePiece<double>& guide, double from, double until, const Chatter& start) const;

  // From the start of the guide to a time before that end.
  Chatter at(const SlidePiece<double>& guide, double s, const Chatter& start) const;

 private:
  struct Rate {
    double v, n;
  };
  struct Surroundings {
    double a, a1;    // pressure and its rate
    double growth;   // of v by itself: that of (a N^2)^(1/3)
    double c;        // (1 - gamma) / (N v_c): w = c v, and at the end of the bounce, half a bounce later than its mean
    double delay;    // times v: the growth of N in half a bounce
    double stretch;  // times v^2: of the duration of a bounce, by what the pressure does in it
    double twist;    // times v^3: of dv/dt, likewise
    double slow_rate;  // of the changes of the slope and of the springs [turns/tau]
  };
  bool smooth(const Surroundings& at, double v) const;
  Surroundings surroundings(double a, double a1, double phase, double u) const;
  Surroundings surroundings(const SlidePiece<double>& guide, double s) const;
  Rate rate(const Surroundings& at, double v) const;
  Chatter step(const SlidePiece<double>& guide, double s, double dt, const Surroundings& at, const Surroundings& end,
               const Chatter& start) const;
  ChatterRun follow(const SlidePiece<double>& guide, double from, double until, const Chatter& start, bool exits) const;
  double step_length(const Surroundings& at, double v) const;
  ChatterRun whole_bounce(const SlidePiece<double>& guide, double s, double dt, const Surroundings& at,
                          const Chatter& start, const Chatter& end) const;

  double gamma_, v_c_, threshold_, H_, ratio_;
  double fineness_;   // of the steps
  double geometric_;  // -log(gamma) / (1 - gamma): 1 / (mean of a bounce's v over its first)
};

// The tip at a bounce with its normal velocity taken out, and put back: tangential velocity kept.
struct Settled {
  SlideState<double> guide;
  double normal_speed;         // |n.v| of the gap rate taken out [a/tau]
  double tangential_velocity;  // [a/tau]
};
Settled settle(const Model& model, const TipState& state);
TipState unsettle(const Model& model, const SlideState<double>& guide, double gap_rate);

}  // namespace afm
