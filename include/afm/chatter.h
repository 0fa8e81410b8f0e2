// Chatter: many short bounces under a pressing surface, computed as one sequence instead of one by one. The averaged
// law of chatter_rates.h runs along the reference slide, the slide that the tip would make without bouncing. At whole n
// it agrees with the bounces (docs/algorithm.md, "Chatter"). Below the cutoff the restitution law (paper, section III)
// makes the loss of a bounce proportional to its speed, so a bounce-by-bounce computation would not end.
#pragma once

#include <cstdint>

#include "afm/detail/chatter_rates.h"
#include "contact.h"
#include "flight.h"
#include "model.h"
#include "state.h"

namespace afm {

enum class ChatterEnd : std::uint8_t {
  time,  // the time asked for was reached; the sequence goes on
  died,  // the normal speed has fallen to the threshold: contact begins
  exits  // at a whole n the bounces become too long for the law: the tip flies on bounce by bounce
};

struct ChatterRun {
  ChatterEnd end;
  double s;         // time of the end, since the start of the reference slide [tau]
  Chatter chatter;  // at that time
};

class ChatterLaw {
 public:
  // threshold: normal speeds up to it are contact [a/tau]. Precondition: a model without faults.
  ChatterLaw(const Model& model, double threshold);

  // Can a sequence begin with this bounce? Its duration must be short against every change of the reaction.
  bool holds(const Flight<double>& bounce) const;

  // From `from` to `until` along the reference slide [tau], or to the end of the sequence.
  ChatterRun run(const SlideSegment<double>& reference, double from, double until, const Chatter& start) const;

  // From the start of the reference slide to a time s before the end of the sequence.
  Chatter at(const SlideSegment<double>& reference, double s, const Chatter& start) const;

  // True: bounces at v lose too large a part of v for the averages. They are made one by one along the reference slide.
  bool takes_single_bounces(double v) const;
  double max_loss() const { return max_loss_; }  // 1 - gamma
  const ChatterRates& rates() const { return rates_; }

 private:
  bool loses_too_much(double v) const;
  double adiabaticity(const ChatterSurroundings& at, double v, bool within) const;
  double step_length(const ChatterPoint& at) const;
  double step_towards_end(const ChatterPoint& at, double dt) const;
  double time_until_limit(const ChatterPoint& at, double ratio) const;
  ChatterRun follow_single_bounces(const SlideSegment<double>& reference, double from, double until,
                                   const Chatter& start, bool exits) const;
  ChatterRun follow(const SlideSegment<double>& reference, double from, double until, const Chatter& start,
                    bool exits) const;
  ChatterRun exit_at(double n, const ChatterPoint& at) const;
  ChatterRun whole_bounce(const SlideSegment<double>& reference, const ChatterPoint& from, const ChatterPoint& to,
                          double last_ratio) const;

  double v_c_, threshold_, max_loss_;
  ChatterRates rates_;
  double end_x_;     // x at the threshold, or a little below it
  double fineness_;  // factor of all step lengths, 1 or less
};

// The tip at a bounce without its normal velocity. The tangential velocity stays.
struct Projection {
  SlideState<double> reference;
  double normal_speed;         // of the gap rate taken out, |n.v| [a/tau]
  double tangential_velocity;  // t.v [a/tau]
};
// Precondition of both: the tip is on the surface. They are inverse to each other.
Projection project_onto_surface(const Model& model, const TipState& state);
TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed);

}  // namespace afm
