// Results that threads compute and one takes in order: the same table for any number of threads.
#pragma once

#include <algorithm>
#include <boost/asio/packaged_task.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <thread>
#include <vector>

namespace afm {

// take(i, compute(i)) for i from 0 to n - 1. threads 0: one for each processor.
template <class Compute, class Take>
void in_order(std::size_t n, std::size_t threads, const Compute& compute, const Take& take) {
  using Result = decltype(compute(n));
  std::vector<std::future<Result>> results;
  boost::asio::thread_pool pool(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency()));
  for (std::size_t i = 0; i < n; ++i) {
    results.push_back(boost::asio::post(pool, std::packaged_task<Result()>([&compute, i] { return compute(i); })));
  }
  for (std::size_t i = 0; i < n; ++i) take(i, results[i].get());
}

}  // namespace afm
