// Watches the ROS master: if it restarts without knowing us, we register everything again.
// roscpp registers once and never checks again; nobody new would find the node.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace afm::node {

class MasterWatch {
 public:
  // Topics are found by themselves; services are to be named.
  explicit MasterWatch(std::vector<std::string> services);
  ~MasterWatch();

 private:
  void run();
  void look();

  const std::vector<std::string> services_;
  bool reachable_ = true;
  bool stopping_ = false;
  std::mutex mutex_;
  std::condition_variable stop_;
  std::thread thread_;
};

}  // namespace afm::node
