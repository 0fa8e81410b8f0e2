// Chatter: many short bounces under a pressing surface, computed as one sequence instead of one by one. The averaged
// law (docs/algorithm.md, "Chatter") runs along the reference slide, the slide that the tip would make without
// bouncing. Below the cutoff the restitution law (paper, section III) makes the loss of a bounce proportional to its
// speed, so a bounce-by-bounce computation would not end.
#pragma once

#include <cstdint>
#include <optional>

#include "afm/flight.h"
#include "afm/model.h"
#include "afm/state.h"
#include "contact_step.h"
#include "slide_segment.h"

namespace afm::detail {

template <class T>
struct ChatterOf {
  T v;               // normal speed after a bounce [a/tau]
  T n;               // bounces since the sequence began; whole at a bounce
  T sigma = T(0.0);  // displacement from the reference slide along the surface, at a bounce [a]
  T p = T(0.0);      // speed along the surface beyond that of the reference slide [a/tau]
  T drift = T(0.0);  // time integral of x minus that of the reference slide, bounces included [a tau]
  T loss = T(0.0);   // energy lost in the impacts; never falls [m_tip a^2/tau^2]
};
using Chatter = ChatterOf<double>;

// Normal speeds up to it are contact [a/tau]: a hundredth of the contact tolerance.
double chatter_threshold(double contact_tolerance);

// Slower bounces may begin a chatter sequence [a/tau]: 2 tolerance^(5/8), which is 0.027 at the default.
double chatter_entry_speed(double contact_tolerance);

enum class ChatterEnd : std::uint8_t {
  time,  // the time asked for was reached; the sequence goes on
  died,  // the normal speed has fallen to the threshold: contact begins
  exits  // at a whole n the bounces become too long for the law: the tip flies on bounce by bounce
};

template <class T>
struct ChatterRunOf {
  ChatterEnd end;
  T s;                   // time of the end, since the start of the reference slide [tau]
  ChatterOf<T> chatter;  // at that time
};
using ChatterRun = ChatterRunOf<double>;

// The constants of the law, with the symbols of docs/algorithm.md.
struct ChatterConstants {
  double threshold;        // normal speeds up to it are contact [a/tau]
  bool constant_loss;      // no cutoff above the threshold: every bounce loses the same part w of v
  double max_entry_speed;  // of a bounce that may begin a sequence, by the tolerance, w and the cutoff [a/tau]
  double dw_dv;            // below the cutoff: (1 - gamma)/v_c [tau/a]
  double w, M;             // with a constant loss
  double fineness;         // factor of all limits: 1 at the default tolerance, less at a smaller one
  double end_x;            // x (chatter_law.h) that the last step aims at, a little below the threshold
};

class ChatterLaw {
 public:
  // Precondition: a model without faults.
  ChatterLaw(const Model& model, double contact_tolerance);

  // Can a sequence begin with this bounce? The surface must press, and its duration be short against every change of
  // the reaction.
  bool holds(const Flight<double>& bounce) const;

  // From the start of the reference slide to `until` [tau], or to the end of the sequence.
  ChatterRun run(const SlideSegment<double>& reference, double until, const Chatter& start) const;

  // From the start of the reference slide to a time s before the end of the sequence.
  Chatter at(const SlideSegment<double>& reference, double s, const Chatter& start) const;

  // The last bounce before that time, at a whole n. If none is found: that time itself.
  ChatterRun last_bounce(const SlideSegment<double>& reference, double s, const Chatter& start) const;

  // The end of a sequence that begins with the normal speed v on a slide from `at`, as if it took no time. Nothing if
  // it moves the tip by more than `allowed` [a/tau], lasts longer than `time` [tau], or outlasts the reaction.
  std::optional<Chatter> collapsed(const SpringConstants<double>& springs, double eta, const SlideState<double>& at,
                                   double v, double allowed, double time) const;

  const ChatterConstants& constants() const { return constants_; }

 private:
  ChatterConstants constants_;
  double loss_, cutoff_;  // of the restitution: 1 - gamma, and v_c [a/tau]
};

// The duration of a bounce times the fastest rate of the springs and of the slope. Precondition: the surface presses.
double turn_of(const Flight<double>& bounce);

// The tip at a bounce without its normal velocity. The tangential velocity stays.
template <class T>
struct ProjectionOf {
  SlideState<T> reference;
  T normal_speed;         // of the gap rate taken out, |n.v| [a/tau]
  T tangential_velocity;  // t.v [a/tau]
};
using Projection = ProjectionOf<double>;
// Precondition of both: the tip is on the surface. They are inverse to each other.
Projection project_onto_surface(const Model& model, const TipState& state);
TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed);

// The reference slide, displaced along the surface by chatter.sigma and faster by chatter.p.
SlideState<double> displaced_reference(const Model& model, const SlideState<double>& reference, const Chatter& chatter);

}  // namespace afm::detail
