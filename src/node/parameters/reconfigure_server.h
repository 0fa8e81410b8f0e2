// Live parameters by the protocol of dynamic_reconfigure, for rqt_reconfigure, dynparam and its clients. Its own server
// class would bend a value out of range into it without a word, and write to the parameter server what the next run
// would then start with; here a faulty change is refused as a whole, with its reasons, and who asked gets the old
// values back.
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>

#include <functional>
#include <mutex>

#include "node/control.h"
#include "parameters.h"
#include "node/refusals.h"

namespace afm::node {

class ReconfigureServer {
 public:
  // Asks for a change and waits until it has taken effect.
  using Apply = std::function<ControlReply(const LiveParameters&)>;

  ReconfigureServer(ros::NodeHandle& node, const Parameters& parameters, Refusals& refusals, Apply apply);
  void shutdown() { service_.shutdown(); }

  // These have taken effect; informs the clients. From the publishing thread, before the answer to who asked for them.
  void applied(const LiveParameters& live);

 private:
  bool on_set(dynamic_reconfigure::Reconfigure::Request& request, dynamic_reconfigure::Reconfigure::Response& response);
  Faults change(const dynamic_reconfigure::Config& config);

  Parameters parameters() const;
  dynamic_reconfigure::Config tell() const;

  std::mutex changing_;        // one change after another
  mutable std::mutex values_;  // of the next
  Parameters parameters_;      // as they are now
  Refusals& refusals_;
  const Apply apply_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
};

}  // namespace afm::node
