#include "strobe.h"

#include <cmath>

namespace afm::view {
namespace {

constexpr double kFollowed = 0.5;    // cells a picture
constexpr double kSmoothing = 0.1;   // of the pace, as batches and pictures keep different time
constexpr double kHysteresis = 0.8;  // so that it does not go to and fro between the two

bool above(double value, bool was_above) { return value > (was_above ? kHysteresis * kFollowed : kFollowed); }

}  // namespace

void Strobe::look(const Heard& heard) {
  measure_pace(heard);
  const double cells = pace_ * std::abs(heard.holder().eta(heard.now()));
  frozen_ = above(cells, frozen_);
  too_fast_ = above(pace_, too_fast_) || frozen_;
  choose_moment(heard);
}

void Strobe::measure_pace(const Heard& heard) {
  const double advance = heard.now() - last_;
  if (!begun_ || advance < 0.0) {
    const auto& configuration = heard.configuration();
    pace_ = configuration.time_scale / (kPictureRate * heard.units().time());
  } else {
    pace_ += kSmoothing * (advance - pace_);
  }
  begun_ = true;
  last_ = heard.now();
}

void Strobe::choose_moment(const Heard& heard) {
  moment_ = heard.now();
  origin_ = heard.holder().position(moment_).value_or(0.0);
  if (!frozen_) return;
  const double eta = heard.holder().eta(moment_);
  const double crest = eta > 0.0 ? std::floor(origin_) : std::ceil(origin_);
  const ModelTime passed = moment_ + (crest - origin_) / eta;
  const bool known = heard.trace().samples().front().time < passed && heard.holder().last_change(moment_) <= passed;
  if (known) moment_ = passed;
  origin_ = known ? crest : std::round(origin_);
}

}  // namespace afm::view
