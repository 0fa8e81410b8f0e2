// Results that threads compute and one takes in order: the same table for any number of threads.
#pragma once

#include <algorithm>
#include <boost/asio/packaged_task.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

namespace afm {

// take(i, compute(i)) for i from 0 to n - 1, and watch() ten times a second while it waits for one. threads 0: one for
// each processor.
template <class Compute, class Take, class Watch>
void in_order(std::size_t n, std::size_t threads, const Compute& compute, const Take& take, const Watch& watch) {
  using Result = decltype(compute(n));
  std::vector<std::future<Result>> results;
  boost::asio::thread_pool pool(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency()));
  for (std::size_t i = 0; i < n; ++i) {
    results.push_back(boost::asio::post(pool, std::packaged_task<Result()>([&compute, i] { return compute(i); })));
  }
  for (std::size_t i = 0; i < n; ++i) {
    while (results[i].wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) watch();
    take(i, results[i].get());
  }
}

}  // namespace afm
