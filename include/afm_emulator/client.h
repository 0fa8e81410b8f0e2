// A client for controllers: commands that wait until they hold, and what is measured over a control period.
//
// In lockstep (parameter pace) the emulator advances one period at a time and waits for the controller: the same
// controller gives the same bits each time. In real time the same calls measure while the clock goes on. The controller
// need not know which it is. Header only; callbacks run inside its functions alone.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Control.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/connection.h>
#include <afm_emulator/measurement.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
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

// For one thread at a time.
class Client {
 public:
  static constexpr std::nullopt_t kAsItIs = std::nullopt;
  using Command = std::optional<double>;

  // name: of the node; timeout: of wall time that everything waits for an answer before it throws [s]. The default is
  // longer than the 12 s after which the emulator itself answers that a control period takes too long.
  explicit Client(const std::string& name = "afm", double timeout = 15.0)
      : name_(ros::names::resolve(name)),
        timeout_(timeout),
        drag_publisher_(node_.advertise<std_msgs::Float64>(name_ + "/drag_velocity", 10)),
        height_publisher_(node_.advertise<std_msgs::Float64>(name_ + "/rest_height", 10)) {
    constexpr double kLongest = 1e9;  // [s]: times of the clocks stay far within their range
    check_not_negative("timeout", timeout);
    if (timeout > kLongest) throw EmulatorError("timeout = " + text(timeout) + ": must be at most 1e9 s");
    node_.setCallbackQueue(&queue_);
    subscribe<Configuration>("configuration", [this](const Configuration::ConstPtr& m) { configuration_ = m; });
    subscribe<Applied>("applied", [this](const Applied::ConstPtr& m) {
      applied_ = m;
      recently_applied_.push_back(m);
      if (recently_applied_.size() > kKeptApplied) recently_applied_.pop_front();
    });
    wait_for([this] { return configuration_ != nullptr; }, name_ + "/configuration");
    wait_for([this] { return applied_ != nullptr; }, name_ + "/applied");
    if (is_lockstep()) {
      connect();
      return;
    }
    subscribe<Deflection>("deflection", [this](const Deflection::ConstPtr& m) { batches_.push_back(m); });
    subscribe<ImpactArray>("impacts", [this](const ImpactArray::ConstPtr& m) { impacts_.push_back(m); });
    subscribe<Friction>("friction", [this](const Friction::ConstPtr& m) { frictions_.push_back(m); });
    // batches of one topic without those of the other would count
    for (const ros::Subscriber& subscriber : subscribers_) {
      wait_for([&] { return subscriber.getNumPublishers() > 0; }, subscriber.getTopic());
    }
  }

  Configuration configuration() const { return *configuration_; }
  Applied applied() const { return *applied_; }  // what is in force
  bool is_lockstep() const { return configuration_->pace == "lockstep"; }
  double tau() const { return 2.0 * M_PI / configuration_->omega_v_rad_per_s; }              // [s]
  double lateral_stiffness() const { return stiffness(configuration_->omega_h_rad_per_s); }  // [N/m]
  double vertical_stiffness() const { return stiffness(configuration_->omega_v_rad_per_s); }

  // Commands what is given [m/s, m], advances by `duration` [s of model time], and returns what was measured over it
  // (srv/Control.srv). In lockstep the duration is at most 10000 tau; in real time it is rounded up to whole batches.
  // Throws EmulatorError. Whenever a call fails, the next one makes a new connection, also to an emulator that was
  // restarted.
  Control::Response control(double duration, Command drag_velocity = kAsItIs, Command rest_height = kAsItIs) {
    check_not_negative("duration", duration);
    check_finite("drag_velocity", drag_velocity);
    check_finite("rest_height", rest_height);
    if (!is_lockstep()) {
      queue_.callAvailable();
      check_restart();
      return measure(command_and_wait(drag_velocity, rest_height), duration);
    }
    Control call;
    call.request.drag_velocity = drag_velocity.value_or(kNaN);
    call.request.rest_height = rest_height.value_or(kNaN);
    call.request.duration = duration;
    if (!control_.is_open()) connect();
    switch (control_.call(call, timeout_)) {
      case Ending::answered:
        break;
      case Ending::late:
        throw EmulatorError(name_ + "/control: did not answer within " + timeout() + "; it may still come to it");
      case Ending::broken:
        end_with_the_launch();
        throw EmulatorError(name_ + "/control: the connection has ended: was the emulator restarted? " +
                            "The next call connects again");
    }
    if (!call.response.success) throw EmulatorError(name_ + "/control: " + call.response.message);
    queue_.callAvailable();  // configuration() and applied() are the latest that have come
    return call.response;
  }

  // Commands what is given and waits until it holds. Returns the message of the command, from which on it does; without
  // a command the latest one.
  Applied command_and_wait(Command drag_velocity = kAsItIs, Command rest_height = kAsItIs) {
    check_finite("drag_velocity", drag_velocity);
    check_finite("rest_height", rest_height);
    catch_up();  // what came until here is older than the command
    if (!drag_velocity && !rest_height) return *applied_;
    const double most = configuration_->max_drag_velocity;
    if (drag_velocity && std::abs(*drag_velocity) > most) {  // in real time nothing would come back
      throw EmulatorError("drag_velocity = " + text(*drag_velocity) + " m/s: max_drag_velocity is " + text(most));
    }
    const double crest = configuration_->surface_amplitude_m, deepest = -kMostDown * configuration_->lattice_spacing_m;
    if (rest_height && !(deepest <= *rest_height && *rest_height < crest)) {
      throw EmulatorError("rest_height = " + text(*rest_height) + " m: must be below the crests of the surface, " +
                          text(crest) + " m, and at most " + text(kMostDown) + " lattice spacings down");
    }
    Applied::ConstPtr mine;
    if (is_lockstep()) {
      recently_applied_.clear();
      const Control::Response answer = control(0.0, drag_velocity, rest_height);
      const auto is_mine = [&](const Applied& m) { return m.epoch == answer.epoch && m.number == answer.applied; };
      wait_for([&] { return (mine = recently_applied(is_mine)) != nullptr; }, name_ + "/applied");
    } else {
      check_restart();
      if (drag_velocity) mine = command(drag_publisher_, *drag_velocity, &Applied::drag_velocity);
      const std::uint32_t epoch = mine ? mine->epoch : 0;
      if (rest_height) mine = command(height_publisher_, *rest_height, &Applied::rest_height_m);
      check_restart();
      if (drag_velocity && mine->epoch != epoch) throw EmulatorError(name_ + ": reset between two commands");
    }
    return *mine;
  }

  // Mean force of the holder on the tip along +x [N] over `duration` [s of model time], which begins `settle` [s] after
  // what is commanded holds. Longer times than a control period can have in lockstep take several periods. Throws
  // EmulatorError if anything else is commanded or changed on the way, also by others.
  double mean_force(double duration, double settle = 0.0, Command drag_velocity = kAsItIs,
                    Command rest_height = kAsItIs) {
    check_not_negative("duration", duration);
    check_not_negative("settle", settle);
    std::vector<double> lengths = periods(settle);
    const std::size_t settling = lengths.size();
    for (const double length : periods(duration)) lengths.push_back(length);
    double time = 0.0, mean = 0.0;
    undisturbed(lengths, drag_velocity, rest_height, [&](std::size_t number, const Control::Response& answer) {
      const double more = tau_between(answer.begin, answer.end);
      if (number < settling || !(more > 0.0)) return;
      time += more;
      mean += more / time * (answer.mean_lateral_force - mean);
    });
    if (time == 0.0) throw EmulatorError("duration = " + text(duration) + " s: too short, no time passes in it");
    return mean;
  }

 private:
  static constexpr std::size_t kKeptBatches = 100;   // before a measurement: a second at the default rate
  static constexpr std::size_t kKeptApplied = 1000;  // messages, where nothing is commanded from here
  static constexpr const char* kPaused = " (is the emulator paused? What was commanded may hold)";
  static constexpr double kMostDown = 1e5;   // lattice spacings: kMinRestHeight of the core
  static constexpr double kRounding = 1e-9;  // of a sum of batches: ten of 0.01 s are 0.1 s
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kMostTau = 9999.0;  // of a period of mean_force: the emulator takes 10000, rounding aside
  static constexpr double kAgain = 1.0;  // [s] a command without effect is sent again: the emulator may have restarted

  double stiffness(double omega) const { return configuration_->tip_mass_kg * omega * omega; }

  static std::string text(double value) {
    std::ostringstream written;
    written << value;
    return written.str();
  }
  std::string timeout() const { return text(timeout_) + " s"; }

  static void check_finite(const std::string& name, Command value) {
    if (value && !std::isfinite(*value)) throw EmulatorError(name + " = " + text(*value) + ": must be finite");
  }
  static void check_not_negative(const std::string& name, double value) {
    check_finite(name, value);
    if (value < 0.0) throw EmulatorError(name + " = " + text(value) + ": must not be negative");
  }

  void check_restart() {
    if (std::exchange(starts_told_, starts_) < starts_) {
      throw EmulatorError(name_ + ": it was restarted, and its state is lost");
    }
  }

  void connect() {
    const std::string service = name_ + "/control";
    wait_for([&] { return ros::service::exists(service, false); }, service);
    control_.open(node_, service);
  }

  // Control periods of equal length [s].
  std::vector<double> periods(double duration) const {
    const double count = is_lockstep() ? std::max(1.0, std::ceil(duration / (kMostTau * tau()))) : 1.0;
    return std::vector<double>(duration > 0.0 ? static_cast<std::size_t>(count) : 0, duration / count);
  }

  // Hands over the answers of control periods that follow each other, in which what is commanded holds.
  template <class Take>
  void undisturbed(const std::vector<double>& lengths, Command drag_velocity, Command rest_height, Take take) {
    Applied command;
    std::optional<ModelTime> end;  // in real time the clock goes on between two periods
    if (is_lockstep()) {
      const Control::Response answer = control(0.0, drag_velocity, rest_height);
      std::tie(command.epoch, command.number, end) = std::tie(answer.epoch, answer.applied, answer.end);
    } else {
      command = command_and_wait(drag_velocity, rest_height);
    }
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Control::Response answer = control(lengths[i]);
      if (answer.epoch != command.epoch) throw EmulatorError(name_ + ": reset while it was measured");
      if (answer.applied != command.number && (is_lockstep() || !was_sent_again(command, answer.applied))) {
        throw EmulatorError(name_ + ": another command or change took effect while it was measured");
      }
      if (end && tau_between(*end, answer.begin) != 0.0) {
        throw EmulatorError(name_ + ": another controller advanced it while it was measured");
      }
      if (end) end = answer.end;
      take(i, answer);
    }
  }

  // Whether what took effect since then is the same command: it is sent again to an emulator that is slow.
  bool was_sent_again(const Applied& command, std::uint64_t number) const {
    return recently_applied([&](const Applied& m) {
             const bool is_same = m.drag_velocity == command.drag_velocity &&
                                  m.rest_height_m == command.rest_height_m &&
                                  (m.cause == "drag_velocity" || m.cause == "rest_height");
             return command.number < m.number && m.number <= number && !is_same;
           }) == nullptr;
  }

  // A new connection is to a new start of the emulator. Each topic meets it at its own time.
  void note_connection(const std::string& topic, const boost::shared_ptr<ros::M_string>& header) {
    Peer& latest = peers_[topic];
    if (latest.header == header) return;
    latest = {header, latest.count + 1};
    if (latest.count > starts_ || topic == "impacts") impacts_.clear();
    if (latest.count > starts_ || topic == "friction") frictions_.clear();
    starts_ = std::max(starts_, latest.count);
  }

  template <class Message, class Take>
  void subscribe(const std::string& topic, Take take) {
    using Event = ros::MessageEvent<const Message>;
    const boost::function<void(const Event&)> callback = [this, topic, take](const Event& event) {
      note_connection(topic, event.getConnectionHeaderPtr());
      take(event.getConstMessage());
    };
    subscribers_.push_back(
        node_.subscribe<const Event&>(name_ + "/" + topic, 1000, callback, {}, ros::TransportHints().tcpNoDelay()));
  }

  // roslaunch ends its nodes one after another: if the emulator has gone first, our turn comes soon.
  static void end_with_the_launch() {
    for (int i = 0; i < 50; ++i) {
      if (!ros::ok()) throw Shutdown();
      ros::WallDuration(0.02).sleep();
    }
  }

  // Of a clock that nobody sets [s].
  static double steady_seconds() { return ros::SteadyTime::now().toSec(); }

  // True if it came true in that time. Checks after every message.
  template <class Condition>
  bool comes_true(Condition is_true, double seconds) {
    const double end = steady_seconds() + seconds;
    while (ros::ok() && !is_true() && steady_seconds() < end) queue_.callOne(ros::WallDuration(0.05));
    if (!ros::ok()) throw Shutdown();
    return is_true();
  }
  template <class Condition>
  void wait_for(Condition is_true, const std::string& what, double longer = 0.0) {
    if (!comes_true(is_true, timeout_ + longer))
      throw EmulatorError(what + ": nothing came within " + text(timeout_ + longer) + " s");
  }

  // The first of these messages that is so, or nothing: others may command, too, and theirs come after it.
  template <class Condition>
  Applied::ConstPtr recently_applied(Condition is_so) const {
    const auto found = std::find_if(recently_applied_.begin(), recently_applied_.end(),
                                    [&](const Applied::ConstPtr& m) { return is_so(*m); });
    return found == recently_applied_.end() ? nullptr : *found;
  }

  // The emulator reports every command, also one of the value that holds already.
  Applied::ConstPtr command(const ros::Publisher& publisher, double value, double Applied::*field) {
    const auto is_mine = [&](const Applied& m) { return m.*field == value; };
    Applied::ConstPtr mine;
    const double end = steady_seconds() + timeout_;
    const auto left = [&] { return end - steady_seconds(); };
    comes_true([&] { return publisher.getNumSubscribers() > 0; }, timeout_);
    recently_applied_.clear();
    do {
      if (left() < 0.0) {
        throw EmulatorError(publisher.getTopic() + ": " + text(value) + " had no effect within " + timeout() +
                            ": refused, or no emulator there?");
      }
      publisher.publish(to_message(value));
    } while (!comes_true([&] { return (mine = recently_applied(is_mine)) != nullptr; }, std::min(kAgain, left())));
    return mine;
  }

  // What came while nobody measured is of the past. But what comes beside Deflection has a connection of its own: that
  // of a batch may come before it.
  void catch_up() {
    queue_.callAvailable();
    batches_.clear();
    while (impacts_.size() > kKeptBatches) impacts_.pop_front();
    while (frictions_.size() > kKeptBatches) frictions_.pop_front();
  }
  // What came beside its batches, but for the latest: a long period would fill the memory.
  template <class Message>
  static void drain(std::deque<Message>& beside, Measurement& measurement) {
    while (beside.size() > 1 && beside.front()->header.seq <= *measurement.last()) {
      measurement.add(*beside.front());
      beside.pop_front();
    }
  }
  template <class Message>
  void complete(const std::deque<Message>& beside, const std::string& topic, Measurement& measurement,
                std::uint32_t (Measurement::*lacking)() const) {
    const auto has_come = [&] { return !beside.empty() && beside.back()->header.seq >= *measurement.last(); };
    if (measurement.last()) wait_for(has_come, name_ + topic);
    for (const Message& batch : beside) measurement.add(*batch);
    const std::uint32_t lost = (measurement.*lacking)();
    if (lost == 0) return;
    throw EmulatorError(name_ + topic + ": " + std::to_string(lost) + " messages were lost while it was measured");
  }

  // As the emulator measures in lockstep, from the batches that it publishes.
  Control::Response measure(const Applied& since, double duration) {
    catch_up();
    // after a restart: of a new connection
    wait_for([&] { return !impacts_.empty(); }, name_ + "/impacts" + kPaused);
    wait_for([&] { return !frictions_.empty(); }, name_ + "/friction" + kPaused);
    Measurement measurement(since);
    std::uint64_t expected = 0;  // running index of the next sample; 0: not known
    while (measurement.seconds() < duration * (1.0 - kRounding)) {
      wait_for([this] { return !batches_.empty(); }, name_ + "/deflection" + kPaused,
               duration / configuration_->time_scale);
      const Deflection::ConstPtr batch = batches_.front();
      batches_.pop_front();
      check_restart();
      if (batch->epoch > since.epoch) throw EmulatorError(name_ + ": reset while it was measured");
      if (batch->epoch < since.epoch) continue;
      if (expected != 0 && batch->first_sample != expected) {
        throw EmulatorError(name_ + "/deflection: messages were lost while it was measured");
      }
      expected = batch->first_sample + batch->vertical.size();
      const bool is_whole = measurement.last() ||
                            batch->header.seq >= std::max(impacts_.front()->header.seq, frictions_.front()->header.seq);
      if (!is_whole || tau_between(since.time, batch->time) < 0.0) continue;
      measurement.add(*batch);
      drain(impacts_, measurement);
      drain(frictions_, measurement);
    }
    complete(impacts_, "/impacts", measurement, &Measurement::without_impacts);
    complete(frictions_, "/friction", measurement, &Measurement::without_friction);
    return measurement.answer(recently_applied_, {tau(), vertical_stiffness(), lateral_stiffness()});
  }

  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  const std::string name_;
  const double timeout_;
  ros::Publisher drag_publisher_, height_publisher_;
  std::vector<ros::Subscriber> subscribers_;
  struct Peer {
    boost::shared_ptr<ros::M_string> header;
    int count = 0;
  };
  std::map<std::string, Peer> peers_;  // by topic: the latest one, and how many there were
  int starts_ = 1, starts_told_ = 1;   // of the emulator, since this client was made; those that a call has told
  Connection<Control> control_;        // in lockstep
  Configuration::ConstPtr configuration_;
  Applied::ConstPtr applied_;
  std::deque<Applied::ConstPtr> recently_applied_;  // since the latest command
  std::deque<Deflection::ConstPtr> batches_;
  std::deque<ImpactArray::ConstPtr> impacts_;
  std::deque<Friction::ConstPtr> frictions_;
};

}  // namespace afm_emulator
