// Many tips, each with its own model, drag velocity and start, advanced together: in lanes where the machine has them
// (AVX2 or AVX-512, asked for when the program runs), on threads. Every tip gives bit for bit what it gives alone,
// whatever the others, the lanes and the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tip.h"

namespace afm {

namespace lanes {
struct LaneTip;
}

// How many tips are flown in one instruction. `widest`: as many as the machine can.
enum class LaneUse : std::uint8_t { none, four, widest };

class Ensemble {
 public:
  explicit Ensemble(int threads = 1, LaneUse lanes = LaneUse::widest);
  ~Ensemble();
  Ensemble(Ensemble&&) noexcept;
  Ensemble& operator=(Ensemble&&) noexcept;

  void add(const Tip& tip);  // wherever it is; the copy keeps its time
  void reserve(std::size_t tips);
  std::size_t size() const { return members_.size(); }

  // Every tip does what `events` calls of Tip::advance(limit) would, or fewer where one would return time_limit. With a
  // log, room for size() * events records, the i-th tip's are written from log + i * events on.
  void advance(std::uint32_t events, const ModelTime& limit, Impact* log = nullptr);
  void advance(std::uint32_t events, const ModelTime* limits, Impact* log = nullptr);  // to a limit for each
  void advance(const ModelTime& limit);  // whatever happens until then

  // Of the last advance: events, how many of them were searches that gave up (they write no record), and how many a tip
  // went through by itself, whatever lanes there are: bursts, contact, starts in the air, grazes.
  std::uint32_t events(std::size_t i) const;
  std::uint32_t search_failures(std::size_t i) const { return members_[i].search_failures; }
  std::uint32_t events_alone(std::size_t i) const { return members_[i].events_alone; }
  int lanes() const;  // 1: the machine has none, or none were asked for

  const Impact& last_impact(std::size_t i) const;
  // The tip as it would be alone.
  const Tip& tip(std::size_t i) { return up_to_date(i); }
  void drag(std::size_t i, double eta);

 private:
  struct Member {
    Tip tip;         // behind its row where that has bounced
    ModelTime time;  // to which it has come at least
    std::uint32_t search_failures, events_alone;
  };
  struct Call;

  Tip& up_to_date(std::size_t i);
  void advance_all(const Call& call);
  void fly(const Call& call, std::size_t from, std::size_t to);
  static bool fly_alone(void* call, lanes::LaneTip& row);

  int threads_;
  LaneUse use_;
  std::vector<Member> members_;
  std::vector<lanes::LaneTip> rows_;
};

}  // namespace afm
