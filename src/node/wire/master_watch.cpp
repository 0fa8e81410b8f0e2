#include "master_watch.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include <chrono>
#include <utility>

#include "node/stepping/scheduling.h"

namespace afm::node {
namespace {

constexpr std::chrono::seconds kBetweenLooks{2};

// One question to the master, without waiting for one that is not there. Whether it answered, and well.
template <class... Text>
bool ask(const char* method, const Text&... arguments) {
  XmlRpc::XmlRpcValue request, response, payload;
  int i = 0;
  request[i++] = ros::this_node::getName();
  ((request[i++] = arguments), ...);
  return ros::master::execute(method, request, response, payload, false);
}

void register_again(const std::vector<std::string>& services) {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  ros::V_string topics;
  ros::this_node::getAdvertisedTopics(topics);
  for (const std::string& topic : topics) {
    const auto publication = ros::TopicManager::instance()->lookupPublication(topic);
    if (publication) ask("registerPublisher", topic, publication->getDataType(), uri);
  }
  topics.clear();
  ros::this_node::getSubscribedTopics(topics);
  for (const std::string& topic : topics) ask("registerSubscriber", topic, std::string("*"), uri);
  const std::string port = std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services) {
    if (!ros::ServiceManager::instance()->lookupServicePublication(service)) continue;
    ask("registerService", service, "rosrpc://" + ros::network::getHost() + ":" + port, uri);
  }
}

}  // namespace

MasterWatch::MasterWatch(std::vector<std::string> services)
    : services_(std::move(services)), thread_([this] { run(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  thread_.join();
}

void MasterWatch::run() {
  name_thread("afm_master");
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_.wait_for(lock, kBetweenLooks, [this] { return stopping_; })) {
    lock.unlock();
    look();
    lock.lock();
  }
}

// A master that knows another node by our name is left alone: it has ordered us to end.
void MasterWatch::look() {
  const bool was_reachable = std::exchange(reachable_, ask("getPid"));
  if (!reachable_) {
    if (was_reachable) ROS_WARN("the ROS master is gone: the emulator goes on, but nobody new finds it");
    return;
  }
  if (ask("lookupNode", ros::this_node::getName())) return;
  ROS_WARN("the ROS master has forgotten this node: registering again");
  register_again(services_);
}

}  // namespace afm::node
