// Emulator: a run in batches, as the node runs it.
#include "afm/emulator.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "afm/level.h"
#include "convert.h"

namespace afm::python {
namespace {

using namespace py::literals;

struct PyEmulator {
  Emulator emulator;
  FrictionEstimate friction;
};

PyEmulator to_emulator(const Model& model, double eta, double phase, double extension, double y, const py::object& u,
                       double w, double sample_period, std::uint64_t samples_per_batch, double friction_window,
                       std::uint64_t impact_budget, double contact_tolerance, const Bath& bath) {
  EmulatorSettings settings = to_settings(model, eta, phase, extension, y, u, w, contact_tolerance);
  settings.sample_period = sample_period;
  settings.samples_per_batch = samples_per_batch;
  settings.friction_window = friction_window;
  settings.impact_budget = impact_budget;
  settings.bath = bath;
  refuse(find_faults(settings));
  return {Emulator(settings), {}};
}

PyEmulator restored(const py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast>& words) {
  SavedState state;
  const auto size = static_cast<std::size_t>(words.size());
  std::optional<Emulator> emulator;
  if (size <= state.words.size()) {
    std::copy(words.data(), words.data() + size, state.words.begin());
    state.size = size;
    emulator = Emulator::restored(state);
  }
  if (!emulator) throw py::value_error("no emulator can be in this state");
  return {*emulator, {}};
}

void change(PyEmulator& self, const py::kwargs& what) {
  LiveSettings live = live_settings(self.emulator.settings());
  EmulatorSettings settings = self.emulator.settings();
  const std::map<std::string, std::pair<double*, double*>> numbers{
      {"gamma", {&settings.model.gamma, &live.gamma}},
      {"cutoff", {&settings.model.v_c, &live.v_c}},
      {"rest_height", {&settings.model.y0, &live.y0}},
      {"sample_period", {&settings.sample_period, &live.sample_period}},
      {"friction_window", {&settings.friction_window, &live.friction_window}}};
  for (const auto& item : what) {
    const auto name = item.first.cast<std::string>();
    const auto number = numbers.find(name);
    if (number != numbers.end())
      *number->second.first = *number->second.second = real(name.c_str(), item.second);
    else if (name == "samples_per_batch")
      settings.samples_per_batch = live.samples_per_batch = whole("samples_per_batch", item.second);
    else if (name == "bath" && py::isinstance<Bath>(item.second))
      settings.bath = live.bath = item.second.cast<Bath>();
    else if (name == "bath")
      throw py::type_error("bath = " + std::string(py::repr(item.second)) + ": must be a Bath");
    else
      throw py::type_error("change() has no argument " + name);
  }
  refuse(find_faults(settings));
  self.emulator.change(live);
}

py::tuple pickled(const PyEmulator& self) {
  static_assert(std::is_trivially_copyable_v<FrictionEstimate>);
  SavedState state;
  self.emulator.save(state);
  const py::bytes friction(reinterpret_cast<const char*>(&self.friction), sizeof self.friction);
  return to_pickle(state) + py::make_tuple(friction);
}

PyEmulator unpickled(const py::tuple& t) {
  const std::optional<Emulator> emulator = Emulator::restored(from_pickle(t));
  const auto friction = t[2].cast<std::string>();
  if (!emulator || friction.size() != sizeof(FrictionEstimate)) {
    throw py::value_error("no emulator can be in this state");
  }
  PyEmulator result{*emulator, {}};
  std::memcpy(&result.friction, friction.data(), friction.size());
  return result;
}

double set_level(PyEmulator& self, const std::string& kind, double contact_tolerance) {
  const Level level{kind_of(kind), contact_tolerance};
  require(has_valid_tolerance(level), "contact_tolerance", contact_tolerance, "must be 0, or between 1e-9 and 0.01");
  return self.emulator.set_level(level);
}

void drag(PyEmulator& self, double eta) {
  require(std::abs(eta) <= kMaxEta, "eta", eta, "must be finite and at most 1000 lattice spacings per tau");
  self.emulator.drag(eta);
}

// Batches put together.
class Stretch {
 public:
  explicit Stretch(PyEmulator& self)
      : self_(self),
        begin_(self.emulator.now()),
        first_sample_(self.emulator.samples()),
        first_sample_time_(self.emulator.grid().time(first_sample_)),
        first_impact_(self.emulator.impacts()) {}

  void add(Batch& batch) {
    self_.friction = batch.friction;
    add(std::move(batch.vertical), vertical_);
    add(std::move(batch.lateral), lateral_);
    add(std::move(batch.impacts), impacts_);
  }

  py::object result() {
    const Emulator& e = self_.emulator;
    return py::module::import("afm.values")
        .attr("Batch")(to_python(begin_), to_python(e.now()), first_sample_, to_python(first_sample_time_),
                       e.settings().sample_period, to_array(std::move(vertical_)), to_array(std::move(lateral_)),
                       first_impact_, to_array(std::move(impacts_)), e.eta(), to_python(self_.friction));
  }

 private:
  template <class T>
  static void add(std::vector<T>&& part, std::vector<T>& all) {
    if (all.empty()) {
      all = std::move(part);
    } else {
      all.insert(all.end(), part.begin(), part.end());
    }
  }

  PyEmulator& self_;
  ModelTime begin_;
  std::uint64_t first_sample_;
  ModelTime first_sample_time_;
  std::uint64_t first_impact_;
  std::vector<double> vertical_, lateral_;
  std::vector<Impact> impacts_;
};

// One batch at most. An impact and the end of a batch may have the same time; then the number tells which is first.
void run_batch_towards(Emulator& emulator, const ModelTime& time, std::uint64_t impacts, Batch& batch) {
  const EmulatorSettings& s = emulator.settings();
  if (emulator.impacts() < impacts) {
    emulator.run_impacts(impacts - emulator.impacts(), batch);
  } else if (time - emulator.now() > static_cast<double>(s.samples_per_batch) * s.sample_period) {
    emulator.run_batch(batch);
  } else {
    emulator.run_until(time, batch);
  }
}

void run_to(PyEmulator& self, const ModelTime& time, std::uint64_t impacts, Stretch& stretch) {
  constexpr std::chrono::milliseconds kBetweenLooks(100);
  Emulator& e = self.emulator;
  const auto is_left = [&] { return e.now() < time || (e.now() == time && e.impacts() < impacts); };
  while (is_left()) {
    {
      const py::gil_scoped_release released;
      const auto end = std::chrono::steady_clock::now() + kBetweenLooks;
      while (is_left() && std::chrono::steady_clock::now() < end) {
        Batch batch;
        run_batch_towards(e, time, impacts, batch);
        stretch.add(batch);
      }
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

py::object run(PyEmulator& self, const py::object& time, const py::object& impacts) {
  Stretch stretch(self);
  if (time.is_none()) {
    Batch batch;
    {
      const py::gil_scoped_release released;
      self.emulator.run_batch(batch);
    }
    stretch.add(batch);
  } else {
    const ModelTime end = to_time(time);
    require(self.emulator.now() <= end, "time", end - ModelTime{}, "lies before the emulator's present");
    run_to(self, end, impacts.is_none() ? 0 : whole("impacts", impacts), stretch);
  }
  return stretch.result();
}

}  // namespace

void add_emulator(py::module& m) {
  const EmulatorSettings s;
  m.def("state_layout", &state_layout, "Of the words that Emulator.restored() reads.");
  py::class_<PyEmulator>(m, "Emulator",
                         R"(A run as the node runs it: samples on a grid, impacts, friction, batch by batch.

What the node publishes of a run is a function of these arguments and the times of commands, to the last bit.
eta [a/tau]; start as of Tip; sample_period, friction_window [tau]. Throws ParameterError.)")
      .def(py::init(&to_emulator), "model"_a = s.model, "eta"_a = s.eta, "phase"_a = s.initial.phase,
           "extension"_a = s.initial.X, "y"_a = s.initial.y, "u"_a = py::none(), "w"_a = s.initial.w,
           "sample_period"_a = s.sample_period, "samples_per_batch"_a = s.samples_per_batch,
           "friction_window"_a = s.friction_window, "impact_budget"_a = s.impact_budget,
           "contact_tolerance"_a = s.contact_tolerance, "bath"_a = s.bath)
      .def_static("restored", &restored, "words"_a, "From the state in a checkpoint: an array of whole numbers.")
      .def("run", &run, "time"_a = py::none(), "impacts"_a = py::none(),
           R"(To a model time [tau] (a number, or a ModelTime); None: to the end of the batch.

With `impacts`, of the impacts at that very time only so many as make this number in all. Returns a Batch: begin, end,
first_sample, first_sample_time, sample_period [tau], vertical and lateral [a], first_impact, impacts (as Tip.advance),
eta, friction (a dict with the fields of the topic, in natural units).)")
      .def(py::pickle(&pickled, &unpickled))
      .def("drag", &drag, "eta"_a, "A new drag velocity [a/tau] from now on.")
      .def("change", &change,
           "Other gamma, cutoff, rest_height, sample_period, samples_per_batch, friction_window, bath from now on.")
      .def("set_level", &set_level, "kind"_a, "contact_tolerance"_a,
           "Another level of the model from now on. Returns the energy dropped [m a^2/tau^2].")
      .def_property_readonly(
          "now", [](const PyEmulator& self) { return to_python(self.emulator.now()); }, "ModelTime")
      .def_property_readonly(
          "eta", [](const PyEmulator& self) { return self.emulator.eta(); }, "drag velocity [a/tau]")
      .def_property_readonly(
          "state", [](const PyEmulator& self) { return to_python(self.emulator.state()); },
          "State(phase, extension, y, u, w) at now, in the lab [a, a/tau]")
      .def_property_readonly(
          "model", [](const PyEmulator& self) { return self.emulator.settings().model; }, "Model")
      .def_property_readonly(
          "samples", [](const PyEmulator& self) { return self.emulator.samples(); }, "due so far")
      .def_property_readonly(
          "impacts", [](const PyEmulator& self) { return self.emulator.impacts(); }, "so far");
}

}  // namespace afm::python
