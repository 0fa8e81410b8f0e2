#include "afm/ensemble.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <system_error>
#include <thread>

namespace afm {
namespace {

// Calls work(i) for all i < n. Threads take shares that are small, so that all end at about the same time.
template <class Work>
void on_threads(int threads, std::size_t n, const Work& work) {
  constexpr std::size_t kSharesPerThread = 8;  // a choice: a thread waits at most an eighth of its time
  const std::size_t all = static_cast<std::size_t>(std::max(1, threads));
  const std::size_t share = std::max<std::size_t>(1, n / (all * kSharesPerThread));
  std::atomic<std::size_t> next{0};
  const auto take_shares = [&] {
    for (std::size_t from; (from = next.fetch_add(share)) < n;) {
      for (std::size_t i = from; i < std::min(from + share, n); ++i) work(i);
    }
  };
  std::vector<std::thread> helpers;
  try {
    for (std::size_t i = 1; i < all && i * share < n; ++i) helpers.emplace_back(take_shares);
  } catch (const std::system_error&) {  // the machine allows no more: those that there are take all
  }
  take_shares();
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace

void Ensemble::advance_all(std::uint32_t events, const ModelTime* limits, std::size_t stride, Impact* log) {
  on_threads(threads_, size(), [&](std::size_t i) {
    Member& m = members_[i];
    Impact* record = log == nullptr ? nullptr : log + i * events;
    for (m.events = 0; m.events < events; ++m.events) {
      const Outcome outcome = m.tip.advance(limits[i * stride]);
      if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) return;
      if (record != nullptr) *record++ = m.tip.last_impact();
    }
  });
}

void Ensemble::advance(std::uint32_t events, const ModelTime& limit, Impact* log) {
  advance_all(events, &limit, 0, log);
}

void Ensemble::advance(std::uint32_t events, const ModelTime* limits, Impact* log) {
  advance_all(events, limits, 1, log);
}

void Ensemble::advance(const ModelTime& limit) { advance(std::numeric_limits<std::uint32_t>::max(), limit); }

}  // namespace afm
