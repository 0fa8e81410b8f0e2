#include "strobe.h"

#include <cmath>

namespace afm::view {
namespace {

constexpr double kFollowed = 0.5;    // cells a picture
constexpr double kSmoothing = 0.1;   // of the pace, as batches and pictures keep different time
constexpr double kHysteresis = 0.8;  // so that it does not go to and fro between the two

bool above(double value, bool was_above) { return value > (was_above ? kHysteresis * kFollowed : kFollowed); }

}  // namespace

void Strobe::look(const RunView& run) {
  measure_pace(run);
  const double cells = pace_ * std::abs(run.holder().eta(run.now()));
  frozen_ = above(cells, frozen_);
  too_fast_ = above(pace_, too_fast_) || frozen_;
  choose_moment(run);
}

void Strobe::measure_pace(const RunView& run) {
  const double advance = run.now() - last_;
  if (!begun_ || advance < 0.0) {
    const auto& configuration = run.configuration();
    pace_ = configuration.time_scale / (kPictureRate * run.units().time());
  } else {
    pace_ += kSmoothing * (advance - pace_);
  }
  begun_ = true;
  last_ = run.now();
}

void Strobe::choose_moment(const RunView& run) {
  moment_ = run.now();
  origin_ = run.holder().position(moment_);
  if (!frozen_) return;
  const double eta = run.holder().eta(moment_);
  const double crest = eta > 0.0 ? std::floor(origin_) : std::ceil(origin_);
  const ModelTime passed = moment_ + (crest - origin_) / eta;
  const bool known = run.trace().samples().front().time < passed && run.holder().last_change(moment_) <= passed;
  if (known) moment_ = passed;
  origin_ = known ? crest : std::round(origin_);
}

}  // namespace afm::view
