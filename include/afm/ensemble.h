// Many tips, each with its own model, drag velocity and start, advanced on threads. Guarantee: each tip gives the same
// bits as alone, for every number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tip.h"

namespace afm {

class Ensemble {
 public:
  explicit Ensemble(int threads = 1) : threads_(threads) {}

  void add(const Tip& tip) { members_.push_back({tip, 0}); }  // in any state; the copy keeps its time
  void reserve(std::size_t tips) { members_.reserve(tips); }
  std::size_t size() const { return members_.size(); }

  // Each tip makes up to `events` events until the limit. One whose search cannot go on (Outcome::search_failed) stays
  // behind: tip(i).now() is then before the limit, with fewer events. A log needs room for size() * events records;
  // those of the i-th tip start at log + i * events.
  void advance(std::uint32_t events, const ModelTime& limit, Impact* log = nullptr);
  void advance(std::uint32_t events, const ModelTime* limits, Impact* log = nullptr);  // to a limit for each
  void advance(const ModelTime& limit);                                                // all events until then

  std::uint32_t events(std::size_t i) const { return members_[i].events; }  // of the last advance

  const Impact& last_impact(std::size_t i) const { return members_[i].tip.last_impact(); }
  const Tip& tip(std::size_t i) const { return members_[i].tip; }
  void drag(std::size_t i, double eta) { members_[i].tip.drag(eta); }

 private:
  struct Member {
    Tip tip;
    std::uint32_t events;
  };

  // The limit of the i-th tip is limits[i * stride].
  void advance_all(std::uint32_t events, const ModelTime* limits, std::size_t stride, Impact* log);

  int threads_;
  std::vector<Member> members_;
};

}  // namespace afm
