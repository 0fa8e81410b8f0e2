// A client for controllers: commands that wait until they hold, and what is measured over a control period.
//
// In lockstep (parameter pace) the emulator advances one period at a time and waits for the controller: the same
// controller gives the same bits each time. In real time the same calls measure while the clock goes on. The controller
// need not know which it is. Header only; callbacks run inside its functions alone.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Control.h>
#include <afm_emulator/ModelTime.h>
#include <afm_emulator/connection.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace afm_emulator {

// Thrown when something did not come in time, or the emulator refused: with the reason.
class EmulatorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The node is shut down while it waits, by Ctrl-C or its launch file.
class Shutdown : public std::exception {
 public:
  const char* what() const noexcept override { return "afm_emulator::Shutdown: the node is shut down"; }
};

inline std_msgs::Float64 to_message(double value) {
  std_msgs::Float64 message;
  message.data = value;
  return message;
}

// A parameter of a node. Throws EmulatorError if it is no number: roscpp alone would take the default in place of a
// text, such as 8e-12 in YAML.
inline double number_parameter(const ros::NodeHandle& node, const std::string& name, double usual) {
  double value = usual;
  XmlRpc::XmlRpcValue given;
  if (node.getParam(name, value) || !node.getParam(name, given)) return value;
  std::ostringstream text;
  text << node.resolveName(name) << " = ";
  given.write(text);
  text << ": must be a number; YAML needs 1.0e-12 for 1e-12";
  throw EmulatorError(text.str());
}

// Model time from one to the other [tau].
inline double tau_between(const ModelTime& begin, const ModelTime& end) {
  return static_cast<double>(end.tau - begin.tau) + (end.phase - begin.phase);
}

// For one thread at a time.
class Client {
 public:
  static constexpr std::nullopt_t kAsItIs = std::nullopt;
  using Command = std::optional<double>;

  // name: of the node; timeout: of wall time that everything waits for an answer before it throws [s], in real time
  // longer by three times the period. The default is longer than the 12 s after which the emulator itself answers that
  // a control period in lockstep takes too long.
  explicit Client(const std::string& name = "afm", double timeout = 15.0)
      : name_(ros::names::resolve(name)), timeout_(timeout) {
    check_not_negative("timeout", timeout);
    if (timeout > kLongest) throw EmulatorError("timeout = " + text(timeout) + ": must be at most 1e9 s");
    node_.setCallbackQueue(&queue_);
    connect();
  }

  // Of the epoch under way: the latest message.
  Configuration configuration() const {
    queue_.callAvailable();
    return *configuration_;
  }
  // What is in force: the latest message, none older than what held at the end of the latest control().
  Applied applied() const {
    queue_.callAvailable();
    wait_for([this] { return reported_ <= std::make_pair(applied_->epoch, applied_->number); },
             name_ + "/applied: nothing came");
    return *applied_;
  }
  bool is_lockstep() const { return configuration_->pace == "lockstep"; }
  double tau() const { return 2.0 * M_PI / configuration_->omega_v_rad_per_s; }               // [s]
  double lateral_stiffness() const { return stiffness(configuration_->omega_h_rad_per_s); }   // [N/m]
  double vertical_stiffness() const { return stiffness(configuration_->omega_v_rad_per_s); }  // [N/m]

  // Commands what is given [m/s, m], advances by `duration` [s of model time], and returns what was measured over it
  // (srv/Control.srv). In lockstep the duration is at most 10000 tau; in real time it is rounded up to whole batches.
  // Throws EmulatorError. Whenever a call fails, the next one makes a new connection, also to an emulator that was
  // restarted.
  Control::Response control(double duration, Command drag_velocity = kAsItIs, Command rest_height = kAsItIs) {
    check_not_negative("duration", duration);
    check_finite("drag_velocity", drag_velocity);
    check_finite("rest_height", rest_height);
    if (!control_.is_open()) connect();
    Control call;
    call.request.drag_velocity = drag_velocity.value_or(kNaN);
    call.request.rest_height = rest_height.value_or(kNaN);
    call.request.duration = duration;
    switch (control_.call(call, seconds_for(duration))) {
      case Ending::answered:
        break;
      case Ending::late:
        throw EmulatorError(name_ + "/control: did not answer within " + text(seconds_for(duration)) +
                            " s; it may still come to it");
      case Ending::broken:
        end_with_the_launch();
        throw EmulatorError(name_ + "/control: the connection has ended: was the emulator restarted? " +
                            "The next call connects again");
    }
    if (!call.response.success) {
      if (call.response.message.find("shutting down") != std::string::npos) end_with_the_launch();
      throw EmulatorError(name_ + "/control: " + call.response.message);
    }
    reported_ = {call.response.epoch, call.response.applied};
    queue_.callAvailable();  // messages of topics would pile up in it: nothing else calls them
    return call.response;
  }

  // Commands what is given and waits until it holds. Returns the message of the command, from which on it does; without
  // a command what is in force.
  Applied command_and_wait(Command drag_velocity = kAsItIs, Command rest_height = kAsItIs) {
    check_finite("drag_velocity", drag_velocity);
    check_finite("rest_height", rest_height);
    queue_.callAvailable();
    recently_applied_.clear();
    const Control::Response answer = control(0.0, drag_velocity, rest_height);
    if (!drag_velocity && !rest_height) return applied();
    Applied::ConstPtr mine;  // others may command, too, and theirs come after it
    const auto has_come = [&] {
      for (const Applied::ConstPtr& m : recently_applied_) {
        if (m->epoch == answer.epoch && m->number == answer.applied) mine = m;
      }
      return mine != nullptr;
    };
    wait_for(has_come, name_ + "/applied: nothing came");
    return *mine;
  }

  // Mean force of the holder on the tip along +x [N] over `duration` [s of model time], which begins `settle` [s] after
  // what is commanded holds. Longer times than a control period can have in lockstep take several periods. Throws
  // EmulatorError if anything else is commanded or changed on the way, also by others.
  double mean_force(double duration, double settle = 0.0, Command drag_velocity = kAsItIs,
                    Command rest_height = kAsItIs) {
    check_not_negative("duration", duration);
    check_not_negative("settle", settle);
    Control::Response last = control(0.0, drag_velocity, rest_height);
    undisturbed(last, settle, [] {});
    double time = 0.0, mean = 0.0;
    undisturbed(last, duration, [&] {
      const double more = tau_between(last.begin, last.end);
      if (!(more > 0.0)) return;
      time += more;
      mean += more / time * (last.mean_lateral_force - mean);
    });
    if (time == 0.0) throw EmulatorError("duration = " + text(duration) + " s: too short, no time passes in it");
    return mean;
  }

 private:
  static constexpr std::size_t kKeptApplied = 1000;  // messages, where nothing is commanded from here
  static constexpr double kLongest = 1e9;            // [s]: times of the clocks stay far within their range
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kMostTau = 9999.0;  // of a period of mean_force: the emulator takes 10000, rounding aside

  double stiffness(double omega) const { return configuration_->tip_mass_kg * omega * omega; }

  static std::string text(double value) {
    std::ostringstream written;
    written.precision(12);
    written << value;
    return written.str();
  }

  static void check_finite(const std::string& name, Command value) {
    if (value && !std::isfinite(*value)) throw EmulatorError(name + " = " + text(*value) + ": must be finite");
  }
  static void check_not_negative(const std::string& name, double value) {
    check_finite(name, value);
    if (value < 0.0) throw EmulatorError(name + " = " + text(value) + ": must not be negative");
  }

  template <class Message>
  void subscribe(const std::string& topic, const boost::function<void(const boost::shared_ptr<const Message>&)>& take) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    subscribers_.push_back(node_.subscribe<Message>(name_ + "/" + topic, 1000, take, {}, hints));
  }

  // Wall time in which a control period is answered. In real time the emulator may fall behind, or be paused.
  double seconds_for(double duration) const {
    constexpr double kPatience = 3.0;  // a choice: an emulator at a third of real time still answers
    if (is_lockstep()) return timeout_;
    return std::min(timeout_ + kPatience * duration / configuration_->time_scale, kLongest);
  }

  // Subscribes anew: the latched messages are then those of the emulator that runs now.
  void connect() {
    const std::string service = name_ + "/control";
    wait_for([&] { return ros::service::exists(service, false); }, service + ": was not there");
    subscribers_.clear();
    reported_ = {};
    const Configuration::ConstPtr former_configuration = configuration_;
    const Applied::ConstPtr former_applied = applied_;
    subscribe<Configuration>("configuration", [this](const Configuration::ConstPtr& m) {
      if (configuration_ && m->epoch <= configuration_->epoch)
        reported_ = {};  // it is of an emulator that was started anew
      configuration_ = m;
    });
    subscribe<Applied>("applied", [this](const Applied::ConstPtr& m) {
      applied_ = m;
      recently_applied_.push_back(m);
      if (recently_applied_.size() > kKeptApplied) recently_applied_.pop_front();
    });
    wait_for([&] { return configuration_ != former_configuration; }, name_ + "/configuration: nothing came");
    wait_for([&] { return applied_ != former_applied; }, name_ + "/applied: nothing came");
    control_.open(node_, service);
  }

  // Runs control periods after `last`, and updates it. Throws if what is in force at its end changes meanwhile.
  template <class Take>
  void undisturbed(Control::Response& last, double duration, Take take) {
    const double count = is_lockstep() ? std::ceil(duration / (kMostTau * tau())) : 1.0;
    for (double i = 0.0; i < count && duration > 0.0; ++i) {
      const Control::Response answer = control(duration / count);
      if (answer.epoch != last.epoch) throw EmulatorError(name_ + ": reset while it was measured");
      if (answer.applied != last.applied) {
        throw EmulatorError(name_ + ": another command or change took effect while it was measured");
      }
      if (is_lockstep() && tau_between(last.end, answer.begin) != 0.0) {
        throw EmulatorError(name_ + ": another controller advanced it while it was measured");
      }
      last = answer;
      take();
    }
  }

  // roslaunch ends its nodes one after another: if the emulator has gone first, our turn comes soon.
  static void end_with_the_launch() {
    for (int i = 0; i < 50; ++i) {
      if (!ros::ok()) throw Shutdown();
      ros::WallDuration(0.02).sleep();
    }
  }

  // Seconds of the monotonic clock, which nobody can set.
  static double steady_seconds() { return ros::SteadyTime::now().toSec(); }

  // Checks after every message.
  template <class Condition>
  void wait_for(Condition is_true, const std::string& what) const {
    const double end = steady_seconds() + timeout_;
    while (ros::ok() && !is_true()) {
      if (steady_seconds() > end) throw EmulatorError(what + " within " + text(timeout_) + " s");
      queue_.callOne(ros::WallDuration(0.05));
    }
    if (!ros::ok()) throw Shutdown();
  }

  ros::NodeHandle node_;
  mutable ros::CallbackQueue queue_;  // it is read where something is asked for
  const std::string name_;
  const double timeout_;
  std::vector<ros::Subscriber> subscribers_;
  Connection<Control> control_;
  Configuration::ConstPtr configuration_;
  Applied::ConstPtr applied_;
  std::pair<std::uint32_t, std::uint64_t> reported_;  // epoch and number of what the latest answer says is in force
  std::deque<Applied::ConstPtr> recently_applied_;    // since the latest command
};

}  // namespace afm_emulator
