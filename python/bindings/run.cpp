// Run: a run in batches, as the node runs it.
#include "afm/run.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "convert.h"
#include "long_call.h"

namespace afm::python {
namespace {

using namespace py::literals;

Run to_run(const Model& model, double eta, double phase, double extension, double y, const py::object& u, double w,
           double sample_period, std::uint64_t samples_per_batch, double friction_window, std::uint64_t impact_budget,
           double contact_tolerance, const Bath& bath) {
  RunSettings settings = to_settings(model, eta, phase, extension, y, u, w, contact_tolerance);
  settings.sample_period = sample_period;
  settings.samples_per_batch = samples_per_batch;
  settings.friction_window = friction_window;
  settings.impact_budget = impact_budget;
  settings.bath = bath;
  refuse(find_faults(settings));
  warn(find_warnings(model, bath, eta));
  return Run(settings);
}

double apply(Run& self, const py::kwargs& what) {
  RunSettings settings = self.settings();
  const std::map<std::string, double*> numbers{{"eta", &settings.eta},
                                               {"gamma", &settings.model.gamma},
                                               {"cutoff", &settings.model.v_c},
                                               {"rest_height", &settings.model.y0},
                                               {"sample_period", &settings.sample_period},
                                               {"friction_window", &settings.friction_window},
                                               {"contact_tolerance", &settings.contact_tolerance}};
  for (const auto& item : what) {
    const auto name = item.first.cast<std::string>();
    const auto number = numbers.find(name);
    if (number != numbers.end())
      *number->second = real(name.c_str(), item.second);
    else if (name == "samples_per_batch")
      settings.samples_per_batch = whole("samples_per_batch", item.second);
    else if (name == "bath" && py::isinstance<Bath>(item.second))
      settings.bath = item.second.cast<Bath>();
    else if (name == "bath")
      refuse_type("bath", item.second, "must be a Bath");
    else if (name == "kind" && py::isinstance<py::str>(item.second))
      settings.model.kind = kind_of(item.second.cast<std::string>());
    else if (name == "kind")
      refuse_type("kind", item.second, "must be a text");
    else
      throw py::type_error("apply() has no argument " + name);
  }
  refuse(find_faults(settings));
  if (what.contains("bath") || what.contains("eta") || what.contains("kind")) {
    warn(find_warnings(settings.model, settings.bath, settings.eta));
  }
  return self.apply(settings);
}

// Batches put together.
class Joined {
 public:
  void add(Batch& batch) {
    if (is_empty_) {
      all_ = std::move(batch);
      is_empty_ = false;
      return;
    }
    append(batch.vertical, all_.vertical);
    append(batch.lateral, all_.lateral);
    append(batch.impacts, all_.impacts);
    all_.end = batch.end;
    all_.friction = batch.friction;
  }

  py::object result(double sample_period) {
    return py::module::import("afm.values")
        .attr("Batch")(to_python(all_.begin), to_python(all_.end), all_.first_sample, to_python(all_.first_sample_time),
                       sample_period, to_array(std::move(all_.vertical)), to_array(std::move(all_.lateral)),
                       all_.first_impact, to_array(std::move(all_.impacts)), all_.eta, all_.holder,
                       to_python(all_.friction));
  }

 private:
  template <class T>
  static void append(const std::vector<T>& part, std::vector<T>& all) {
    all.insert(all.end(), part.begin(), part.end());
  }

  bool is_empty_ = true;
  Batch all_;
};

// Until the time is reached, or so many impacts.
void advance_to(Run& run, const ModelTime& time, std::uint64_t impacts, Joined& joined) {
  constexpr std::uint64_t kImpactsAtATime = 10000;
  repeat(1, [&] {
    Batch batch;
    const ModelTime before = run.now();
    const Outcome outcome = run.advance(next_stop(before, time),
                                        std::min({impacts, run.settings().impact_budget, kImpactsAtATime}), batch);
    const bool is_stuck = outcome == Outcome::budget_spent && batch.impacts.empty() && !(before < run.now());
    if (is_stuck && impacts > 0) throw_stuck(run.eta(), run.now());
    impacts -= std::min<std::uint64_t>(impacts, batch.impacts.size());
    joined.add(batch);
    return impacts == 0 || (outcome == Outcome::time_limit && !(run.now() < time));
  });
}

py::object advance(Run& self, const py::object& time, const py::object& impacts) {
  Joined joined;
  const std::uint64_t most = impacts.is_none() ? ~std::uint64_t{0} : whole("impacts", impacts);
  if (time.is_none()) {
    advance_to(self, self.next_boundary(), std::min(most, self.settings().impact_budget), joined);
  } else {
    const ModelTime end = to_time(time);
    require(self.now() <= end, "time", end - ModelTime{}, "lies before the run's present");
    advance_to(self, end, most, joined);
  }
  return joined.result(self.settings().sample_period);
}

py::dict snapshot(Run& self) {
  require_settled(self.can_split());
  return to_dict(self.split());
}

Run to_run_again(const py::dict& dict) { return Run(to_snapshot(dict)); }

}  // namespace

void add_run(py::module& m) {
  const RunSettings s;
  py::class_<Run>(m, "Run",
                  R"(A run as the node runs it: samples on a grid, impacts, friction, batch by batch.

What the node publishes of a run is a function of these arguments and the times of commands, to the last bit.
eta [a/tau]; start as of Tip; sample_period, friction_window [tau]; samples_per_batch; impact_budget: events of a
batch, after which it ends early; contact_tolerance as of Tip. Throws ParameterError.)")
      .def(py::init(&to_run), "model"_a = s.model, "eta"_a = s.eta, "phase"_a = s.initial.phase,
           "extension"_a = s.initial.X, "y"_a = s.initial.y, "u"_a = py::none(), "w"_a = s.initial.w,
           "sample_period"_a = s.sample_period, "samples_per_batch"_a = s.samples_per_batch,
           "friction_window"_a = s.friction_window, "impact_budget"_a = s.impact_budget,
           "contact_tolerance"_a = s.contact_tolerance, "bath"_a = s.bath)
      .def_static("from_snapshot", &to_run_again, "snapshot"_a,
                  "A run that goes on as the one whose snapshot() this is, with the same bits.")
      .def("advance", &advance, "time"_a = py::none(), "impacts"_a = py::none(),
           R"(To a model time [tau] (a number, or a ModelTime); None: to the end of the batch, or of its impact_budget.

With `impacts`, it ends earlier once so many impacts have happened; without a time the budget holds too. Returns a
Batch: begin, end, first_sample, first_sample_time, sample_period [tau], vertical and lateral [a], first_impact,
impacts (as Tip.advance), eta, holder, friction (a dict with the fields of the topic, in natural units).)")
      .def("apply", &apply,
           R"(Other settings from now on; those that are not named stay.

eta, gamma, cutoff, rest_height, sample_period, samples_per_batch, friction_window, bath, kind, contact_tolerance.
Returns the energy that a change to the hammer drops [m_tip a^2/tau^2].)")
      .def("snapshot", &snapshot,
           R"(The state of the run between two batches, as a dict of values and arrays in natural units.

Its names are those of the message Snapshot and of the arguments of Run; initial_*: the start.
It splits the motion under way: this run goes on with the bits of Run.from_snapshot() of it. Throws ValueError while an
event at the present is still to be reported; advance(now) reports it.)")
      .def(
          "copy", [](const Run& self) { return self; }, "Another run in the same state; copy.copy() does the same.")
      .def("__copy__", [](const Run& self) { return self; })
      .def("__deepcopy__", [](const Run& self, const py::object&) { return self; })
      .def(py::pickle([](Run self) { return snapshot(self); }, &to_run_again))
      .def_property_readonly(
          "now", [](const Run& self) { return to_python(self.now()); }, "ModelTime")
      .def_property_readonly("eta", &Run::eta, "drag velocity [a/tau]")
      .def_property_readonly(
          "state", [](const Run& self) { return to_python(self.state()); },
          "State(phase, extension, y, u, w) at now, in the lab [a, a/tau]")
      .def_property_readonly(
          "model", [](const Run& self) { return self.settings().model; }, "Model")
      .def_property_readonly("samples", &Run::samples, "due so far")
      .def_property_readonly("impacts", &Run::impacts, "so far");
}

}  // namespace afm::python
