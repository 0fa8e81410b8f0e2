// Tip: one tip in Python's hands.
#include "afm/tip.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "convert.h"
#include "long_call.h"

namespace afm::python {
namespace {

using namespace py::literals;

Tip to_tip(const Model& model, double eta, double phase, double extension, double y, const py::object& u, double w,
           double contact_tolerance, const Bath& bath) {
  const RunSettings settings = to_settings(model, eta, phase, extension, y, u, w, contact_tolerance);
  refuse(find_faults(settings));
  Tip tip(model, eta, settings.initial, contact_tolerance);
  warn(find_warnings(model, bath, eta));
  tip.set_bath(bath);
  return tip;
}

ModelTime later(const Tip& self, const py::object& time) {
  const ModelTime end = to_time(time);
  require(self.now() <= end, "time", end - ModelTime{}, "lies before the tip's present");
  return end;
}

constexpr int kStepsAtATime = 64;  // of a tip, between two looks at the clock

py::array advance_tip(Tip& self, const py::object& time, const py::object& most_events) {
  const ModelTime end = later(self, time);
  const std::uint64_t most =
      most_events.is_none() ? std::numeric_limits<std::uint64_t>::max() : whole("most_events", most_events);
  std::vector<Impact> events;
  if (most > 0) {
    repeat(kStepsAtATime, [&] {
      const ModelTime stop = next_stop(self.now(), end);
      const Outcome outcome = self.advance(stop);
      if (outcome == Outcome::time_limit) return stop == end;
      if (outcome == Outcome::search_failed) throw_stuck(self.eta(), self.now());
      events.push_back(self.last_impact());
      return events.size() == most;
    });
  }
  return to_array(std::move(events));
}

// Samples from now on, evenly, taken segment by segment, before the next replaces it.
class Sampler {
 public:
  Sampler(Tip& tip, double period, std::size_t count)
      : tip_(tip), grid_{period, 0, tip.now()}, end_(grid_.time(count)), vertical_(count), lateral_(count) {}

  bool step() {
    const ModelTime few = grid_.time(std::min(vertical_.size(), taken_ + kSamplesAtATime));
    const ModelTime stop = next_stop(tip_.now(), few), segment_end = tip_.segment_end();
    take(segment_end < stop ? segment_end : stop);
    const ModelTime before = tip_.now();
    const Outcome outcome = tip_.advance_segment(stop);
    if (outcome == Outcome::search_failed && !(before < tip_.now())) throw_stuck(tip_.eta(), tip_.now());
    if (outcome == Outcome::time_limit) return stop == end_;
    if (outcome == Outcome::impact || outcome == Outcome::contact || outcome == Outcome::released) {
      events_.push_back(tip_.last_impact());
    }
    return false;
  }

  py::object result() {
    return py::module::import("afm.values")
        .attr("Samples")(to_python(grid_.origin), grid_.period, to_array(std::move(vertical_)),
                         to_array(std::move(lateral_)), to_array(std::move(events_)));
  }

 private:
  static constexpr std::size_t kSamplesAtATime = 1000000;

  void take(const ModelTime& until) {
    std::size_t to = taken_;
    while (to < vertical_.size() && grid_.time(to) < until) ++to;
    if (to == taken_) return;
    tip_.deflections(grid_, taken_, to - taken_, &vertical_[taken_], &lateral_[taken_]);
    taken_ = to;
  }

  Tip& tip_;
  SampleGrid grid_;
  ModelTime end_;
  std::size_t taken_ = 0;
  std::vector<double> vertical_, lateral_;
  std::vector<Impact> events_;
};

py::object samples(Tip& self, double period, std::size_t count) {
  constexpr std::size_t kMost = 100000000;  // a choice: 1.6 GB, which are there within a second
  require(period >= 1e-9 && period <= 1e6, "period", period, "must be between 1e-9 and 1e6 tau");
  require(count <= kMost, "count", static_cast<double>(count),
          "must be at most 100 million: ask for the rest after it");
  Sampler sampler(self, period, count);
  repeat(1, [&] { return sampler.step(); });  // a step may have a million samples
  return sampler.result();
}

void change(Tip& self, const py::object& gamma, const py::object& cutoff, const py::object& rest_height) {
  Model model = self.model();
  if (!gamma.is_none()) model.gamma = real("gamma", gamma);
  if (!cutoff.is_none()) model.v_c = real("cutoff", cutoff);
  if (!rest_height.is_none()) model.y0 = real("rest_height", rest_height);
  refuse(find_faults(model));
  self.set_parameters(model);
}

// As a snapshot of a run that begins here.
py::dict pickled_tip(const Tip& tip) {
  require_settled(tip.is_settled());
  Snapshot s;
  s.settings.model = tip.model();
  s.settings.eta = tip.eta();
  s.settings.contact_tolerance = tip.contact_tolerance();
  s.settings.bath = tip.thermostat().bath();
  s.tip = tip.snapshot();
  s.samples.origin = s.tip.time;
  s.kicks = tip.thermostat().grid();
  s.kick_count = tip.thermostat().count();
  return to_dict(s);
}

Tip unpickled_tip(const py::dict& dict) {
  const Snapshot s = to_snapshot(dict);
  const RunSettings& settings = s.settings;
  const Thermostat kicks(settings.bath, settings.model.frequency_ratio, s.kicks, s.kick_count);
  return Tip(settings.model, settings.eta, s.tip, settings.contact_tolerance, kicks);
}

}  // namespace

void add_tip(py::module& m) {
  const FreeState start = RunSettings{}.initial;
  py::class_<Tip>(m, "Tip",
                  R"(One tip: where it is, what has happened to it, what happens next. Exact, impact by impact.

eta: drag velocity [a/tau]. The start: phase, extension and y [a], u and w [a/tau], in the lab; u None: eta.
contact_tolerance: error allowed where chatter becomes one event [a, a/tau]; 0: every bounce by itself.
An object serves one thread at a time. Throws ParameterError.)")
      .def(py::init(&to_tip), "model"_a = Model{}, "eta"_a = 3.4, "phase"_a = start.phase, "extension"_a = start.X,
           "y"_a = start.y, "u"_a = py::none(), "w"_a = start.w, "contact_tolerance"_a = kDefaultContactTolerance,
           "bath"_a = Bath{})
      .def("advance", &advance_tip, "time"_a, "most_events"_a = py::none(),
           R"(To a model time [tau] (a number, or a ModelTime), or until so many events have happened.

Returns the events on the way, shape (n,), with the fields tau and phase (their sum is the model time [tau]),
surface_phase [a], normal_speed and tangential_velocity before the impact [a/tau], energy_loss [m_tip a^2/tau^2],
kind (afm.Kind), and count, the bounces it stands for. No time is split: any sequence of calls gives the same bits.
After Ctrl-C the tip stands where it had come to.)")
      .def("samples", &samples, "period"_a, "count"_a,
           R"(Samples of the deflection from now on, `period` tau apart; the tip is left at the time of the next one.

Returns Samples: time of the first, period, vertical and lateral of shape (count,) [a], events as advance() does.)")
      .def(
          "drag",
          [](Tip& self, double eta) {
            check_eta(eta);
            warn(find_warnings(self.model(), self.thermostat().bath(), eta));
            self.drag(eta);
          },
          "eta"_a, "A new drag velocity [a/tau] from now on.")
      .def("change", &change, "gamma"_a = py::none(), "cutoff"_a = py::none(), "rest_height"_a = py::none(),
           "Another restitution, cutoff [a/tau] or height of the holder [a] from now on; None: as it is.")
      .def(
          "set_bath",
          [](Tip& self, const Bath& bath) {
            warn(find_warnings(self.model(), bath, self.eta()));
            self.set_bath(bath);
          },
          "bath"_a, "Another heat bath from now on.")
      .def(
          "copy", [](const Tip& self) { return self; }, "Another tip in the same state; copy.copy() does the same.")
      .def("__copy__", [](const Tip& self) { return self; })
      .def("__deepcopy__", [](const Tip& self, const py::object&) { return self; })
      .def(py::pickle(&pickled_tip, &unpickled_tip))
      .def_property_readonly(
          "now", [](const Tip& self) { return to_python(self.now()); }, "ModelTime")
      .def_property_readonly(
          "state", [](const Tip& self) { return to_python(self.state()); },
          "State(phase, extension, y, u, w) at now, in the lab [a, a/tau]; in a chatter sequence without its bounces")
      .def_property_readonly("eta", &Tip::eta, "drag velocity [a/tau]")
      .def_property_readonly("model", &Tip::model, py::return_value_policy::copy, "Model")
      .def_property_readonly(
          "in_contact", &Tip::in_contact,
          "true while the surface presses on the tip: it slides without bouncing, after CONTACT_BEGUN")
      .def_property_readonly("stored_energy", &Tip::stored_energy,
                             "in springs and motion, in the lab [m_tip a^2/tau^2]")
      .def_property_readonly(
          "search_failures", &Tip::search_failures,
          "must stay 0: searches that failed, since the start or unpickling; the motion goes on from a safe point");
}

}  // namespace afm::python
