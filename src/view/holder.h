// Where the holder is over the surface. No message reports that: it moves with the drag velocity, from where the
// run began or, for who came late, from where an impact shows the tip to be.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "afm/state.h"

namespace afm::view {

class Holder {
 public:
  void begin(const afm_emulator::Configuration& configuration);
  void obey(const afm_emulator::AppliedDrag& command);
  void obey(const afm_emulator::AppliedParameters& change);

  std::uint32_t epoch() const { return epoch_; }

  // The centre was seen at x at this time, give or take whole cells.
  void correct(const ModelTime& time, double x);

  // Along the surface [a], a crest at every whole number. Empty if neither the start nor an impact determines it.
  std::optional<double> position(const ModelTime& time) const;
  // Over mid-surface [a], the latest reported up to that time.
  double height(const ModelTime& time) const;
  double eta(const ModelTime& time) const { return leg(time).eta; }
  // Of the drag velocity, the latest up to that time.
  ModelTime last_change(const ModelTime& time) const { return leg(time).begin; }

 private:
  struct Leg {
    ModelTime begin;
    double x = 0.0, eta = 0.0;
  };
  struct Lift {
    ModelTime begin;
    double height_m = 0.0;
  };
  const Leg& leg(const ModelTime& time) const;
  double travelled(const ModelTime& time) const;
  bool knows_start() const;

  std::deque<Leg> legs_;  // since the first command heard of
  std::deque<Lift> lifts_;  // likewise
  std::uint32_t epoch_ = 0, lifts_epoch_ = 0;
  std::uint32_t start_epoch_ = 0;
  double speed_unit_ = 1.0, length_unit_ = 1.0, start_ = 0.0, start_height_m_ = 0.0;
  bool configured_ = false;
  std::optional<double> correction_;
};

}  // namespace afm::view
