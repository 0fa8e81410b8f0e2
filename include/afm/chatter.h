// Chatter under a surface that presses, without its bounces one by one: the tip rides on the slide it would make if it
// did not bounce (the reference slide), and beside it run the averages of chatter_rates.h, whose values at whole n are those of
// the bounces.
#pragma once

#include <cstdint>

#include "afm/detail/chatter_rates.h"
#include "flight.h"
#include "model.h"
#include "contact.h"
#include "state.h"

namespace afm {

enum class ChatterEnd : std::uint8_t {
  time,  // it goes on
  died,  // the normal speed has fallen to the threshold: contact
  exits  // the surface is about to let go, at a bounce (n whole): what follows is done bounce by bounce
};

struct ChatterRun {
  ChatterEnd end;
  double s;         // when, on the guide
  Chatter chatter;  // then
};

class ChatterLaw {
 public:
  // threshold: normal speeds up to it are contact [a/tau].
  ChatterLaw(const Model& model, double threshold);

  // Can a burst begin with the bounce that begins this flight? The bounces must be short against every change; those
  // that lose too much each for the series of the interpolation are made one by one along the reference slide.
  bool holds(const Flight<double>& bounce) const;

  // From one time of the reference slide to another, `until`, or to the end of the chatter.
  ChatterRun run(const SlideSegment<double>& reference, double from, double until, const Chatter& start) const;

  // From the start of the reference slide to a time before that end.
  Chatter at(const SlideSegment<double>& reference, double s, const Chatter& start) const;

  // Whether bounces at v lose too large a part of it for the averages, and are made one by one.
  bool takes_single_bounces(double v) const { return most_loss_ >= kLeastSingleLoss && loses_too_much(v); }
  double most_loss() const { return most_loss_; }  // 1 - gamma
  const ChatterRates& rates() const { return rates_; }

 private:
  bool loses_too_much(double v) const;
  double adiabaticity(const ChatterSurroundings& at, double v, bool within) const;
  double step_length(const ChatterPlace& at) const;
  double step_towards_end(const ChatterPlace& at, double dt) const;
  double time_until_limit(const ChatterPlace& at, double ratio) const;
  ChatterRun follow_single_bounces(const SlideSegment<double>& reference, double from, double until, const Chatter& start,
                     bool exits) const;
  ChatterRun follow(const SlideSegment<double>& reference, double from, double until, const Chatter& start, bool exits) const;
  ChatterRun exit_at(double n, const ChatterPlace& at) const;
  ChatterRun whole_bounce(const SlideSegment<double>& reference, const ChatterPlace& from, const ChatterPlace& to,
                          double last_ratio) const;

  // Where bounces above the cutoff lose less than this part of v there are too many to be made one by one.
  static constexpr double kLeastSingleLoss = 0.05;

  double v_c_, threshold_, most_loss_;
  ChatterRates rates_;
  double end_x_;     // x there, or a little below it
  double fineness_;  // of the steps
};

// The tip at a bounce with its normal velocity taken out, and put back: tangential velocity kept.
struct Projection {
  SlideState<double> reference;
  double normal_speed;         // |n.v| of the gap rate taken out [a/tau]
  double tangential_velocity;  // [a/tau]
};
Projection project_onto_surface(const Model& model, const TipState& state);
TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed);

}  // namespace afm
