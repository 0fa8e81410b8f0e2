// A persistent connection to a service, with a time-out for every call.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace afm_emulator {

enum class Ending { answered, late, broken };

// ros::ServiceClient has no time-out: a thread drops its connection when the time of a call is over, and the call
// fails.
template <class Service>
class Connection {
 public:
  ~Connection() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    news_.notify_one();
    thread_.join();
  }

  void open(ros::NodeHandle& node, const std::string& service) { client_ = node.serviceClient<Service>(service, true); }
  bool is_open() const { return !(client_ == ros::ServiceClient()); }

  // Waits for the answer, at most so long. Closes what ends otherwise.
  Ending call(Service& service, double seconds) {
    begin(seconds);
    const bool success = client_.call(service);
    const bool late = !end();
    if (late || !success) client_ = {};
    return late ? Ending::late : success ? Ending::answered : Ending::broken;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void begin(double seconds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    under_way_ = true;
    deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }
  // False if the time was over.
  bool end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(under_way_, false);
  }

  void watch() {
    constexpr std::chrono::milliseconds kPoll{50};  // so that a call need not wake this thread
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ending_) {
      news_.wait_for(lock, kPoll);
      if (under_way_ && Clock::now() >= deadline_) {
        client_.shutdown();
        under_way_ = false;
      }
    }
  }

  ros::ServiceClient client_;
  std::mutex mutex_;
  std::condition_variable news_;
  bool under_way_ = false, ending_ = false;
  Clock::time_point deadline_;
  std::thread thread_{[this] { watch(); }};  // the last to begin
};

}  // namespace afm_emulator
