// Where the holder is: every batch says its position at the first sample, and every message `Applied` how it moves and how
// high it is from then on.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Deflection.h>

#include <cstdint>
#include <deque>

#include "afm/state.h"
#include "afm/units.h"

namespace afm::view {

class Holder {
 public:
  void set_units(const Units& units) { units_ = units; }
  void take(const afm_emulator::Applied& applied);
  void take(const afm_emulator::Deflection& batch);

  // Whether it knows its place in this epoch. The functions below need it.
  bool knows(std::uint32_t epoch) const { return !legs_.empty() && epoch_ == epoch && place_epoch_ == epoch && placed_; }

  double position(const ModelTime& time) const;  // along the surface [a], a crest at every whole number
  double height(const ModelTime& time) const;    // over mid-surface [a]
  double eta(const ModelTime& time) const;
  ModelTime last_change(const ModelTime& time) const { return leg(time).begin; }  // the latest up to that time

 private:
  // Of even motion, in SI but for the time: messages may come before the units.
  struct Leg {
    ModelTime begin;
    double travelled = 0.0;  // since the first of them [m tau/s]
    double drag_velocity = 0.0, height = 0.0;
  };
  const Leg& leg(const ModelTime& time) const;
  double travelled(const ModelTime& time) const;

  Units units_{SiModel{}};
  std::deque<Leg> legs_;
  ModelTime place_time_;
  double place_ = 0.0;  // position then [m]
  bool placed_ = false;
  std::uint32_t epoch_ = 0, place_epoch_ = 0;
};

}  // namespace afm::view
