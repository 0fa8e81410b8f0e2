// dynamic_reconfigure: a change takes effect at the next batch boundary, and the reply follows it. A faulty combination
// puts the old values back; the log and /diagnostics say why.
#pragma once

#include <afm_emulator/EmulatorConfig.h>
#include <dynamic_reconfigure/server.h>

#include <functional>
#include <mutex>
#include <string>

#include "node/params/parameters.h"
#include "node/publisher/refusals.h"

namespace afm::node {

class LiveServer {
 public:
  // Returns why the change did not take effect, or nothing when it has.
  using Apply = std::function<std::string(const Live&)>;

  LiveServer(const ros::NodeHandle& node, const Parameters& parameters, Refusals& refusals, Apply apply);

  void applied(const Live& live);  // by whatever
  void update_clients();           // with what was applied. Not from the publisher, on which a change waits

 private:
  using Config = afm_emulator::EmulatorConfig;

  void change(Config& config);
  Live in_force() const;

  const Parameters start_;
  Refusals& refusals_;
  const Apply apply_;
  mutable std::mutex mutex_;  // of in_force_
  Live in_force_;
  Config shown_;  // to the clients; guarded by server_mutex_
  boost::recursive_mutex server_mutex_;
  dynamic_reconfigure::Server<Config> server_;
};

}  // namespace afm::node
