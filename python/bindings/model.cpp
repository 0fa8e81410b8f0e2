// Model, Bath, Units.
#include "afm/bath.h"
#include "afm/units.h"
#include "convert.h"

namespace afm::python {
namespace {

using namespace py::literals;

Model to_model(double gamma, double cutoff, double rest_height, double amplitude, double frequency_ratio,
               const std::string& kind) {
  Model model;
  model.gamma = gamma;
  model.v_c = cutoff;
  model.y0 = rest_height;
  model.H = amplitude;
  model.frequency_ratio = frequency_ratio;
  model.kind = kind_of(kind);
  refuse(find_faults(model));
  return model;
}

void require_damping(const char* name, double temperature, const Bath& bath) {
  require(temperature == 0.0 || bath.is_on(), name, temperature,
          "needs a quality_factor above 0: without one no heat reaches the tip");
}

Bath to_bath(double temperature, double quality_factor, double lateral_quality_factor, double kicks_per_tau,
             std::uint64_t seed, std::uint64_t stream) {
  const Bath bath{temperature, quality_factor, lateral_quality_factor, kicks_per_tau, seed, stream};
  refuse(find_faults(bath));
  require_damping("temperature", temperature, bath);
  return bath;
}

struct SiUnits {
  SiModel si;
  Units units;
};

SiUnits to_units(double omega_v, double omega_h, double mass, double spacing, double amplitude, double rest_height,
                 double gamma, double cutoff, double spring_constant, double resonance, double lateral_spring_constant,
                 double load) {
  SiModel si{omega_v, omega_h, mass, spacing, amplitude, rest_height, gamma, cutoff};
  refuse(set_lever_and_load(Lever{spring_constant, resonance, lateral_spring_constant}, load, si));
  refuse(find_faults(si));
  return {si, Units(si)};
}

Bath bath_of(const SiUnits& u, double temperature_k, double quality_factor, double lateral_quality_factor,
             double kicks_per_tau, std::uint64_t seed) {
  const SiBath si{temperature_k, quality_factor, lateral_quality_factor, kicks_per_tau, seed};
  refuse(find_faults(si, u.units));
  const Bath bath = u.units.to_natural(si);
  if (temperature_k != 0.0 && !bath.is_on()) {  // the node takes it too, and so do its recordings
    warn({{"temperature_k", temperature_k, "has no effect: quality_factor is 0, so no heat reaches the tip"}});
  }
  return bath;
}

// The arguments that make each again, in their order.
py::dict arguments(const Model& m) {
  return py::dict("gamma"_a = m.gamma, "cutoff"_a = m.v_c, "rest_height"_a = m.y0, "amplitude"_a = m.H,
                  "frequency_ratio"_a = m.frequency_ratio, "kind"_a = name(m.kind));
}
py::dict arguments(const Bath& b) {
  return py::dict("temperature"_a = b.temperature, "quality_factor"_a = b.quality_factor,
                  "lateral_quality_factor"_a = b.lateral_quality_factor, "kicks_per_tau"_a = b.kicks_per_tau,
                  "seed"_a = b.seed, "stream"_a = b.stream);
}
py::dict arguments(const SiUnits& u) {
  return py::dict("omega_v_rad_per_s"_a = u.si.omega_v_rad_per_s, "omega_h_rad_per_s"_a = u.si.omega_h_rad_per_s,
                  "tip_mass_kg"_a = u.si.tip_mass_kg, "lattice_spacing_m"_a = u.si.lattice_spacing_m,
                  "surface_amplitude_m"_a = u.si.surface_amplitude_m, "rest_height_m"_a = u.si.rest_height_m,
                  "restitution_gamma"_a = u.si.restitution_gamma, "cutoff_speed"_a = u.si.cutoff_speed);
}

// Printed, pickled and compared by the call that makes it again.
template <class T>
void add_call(py::class_<T>& value) {
  value.def(
      "__eq__", [](const T& a, const T& b) { return arguments(a).equal(arguments(b)); }, py::is_operator());
  value.def("__repr__", [](const py::object& self) {
    py::list words;
    for (const auto& item : arguments(self.cast<const T&>()))
      words.append(py::str("{}={!r}").format(item.first, item.second));
    return py::str("{}({})").format(self.attr("__class__").attr("__name__"), py::str(", ").attr("join")(words));
  });
  value.def("__reduce__", [](const py::object& self) {
    return py::make_tuple(self.attr("__class__"), py::tuple(arguments(self.cast<const T&>()).attr("values")()));
  });
}

void add_bath(py::module& m) {
  const Bath none;
  py::class_<Bath> bath(m, "Bath", R"(A heat bath of the cantilever; temperature 0 is damping alone.

temperature: kT [m_tip a^2/tau^2]; quality_factor, lateral_quality_factor [-]; kicks_per_tau [1/tau];
seed, stream: of its random numbers; tips with different streams are independent.)");
  bath.def(py::init(&to_bath), "temperature"_a = 0.0, "quality_factor"_a = 0.0, "lateral_quality_factor"_a = 0.0,
           "kicks_per_tau"_a = none.kicks_per_tau, "seed"_a = none.seed, "stream"_a = none.stream)
      .def_readonly("temperature", &Bath::temperature, "kT [m_tip a^2/tau^2]; 0: damping alone")
      .def_readonly("quality_factor", &Bath::quality_factor, "of the vertical spring; 0: not damped, not heated")
      .def_readonly("lateral_quality_factor", &Bath::lateral_quality_factor,
                    "of the horizontal spring; 0: as the vertical one")
      .def_readonly("kicks_per_tau", &Bath::kicks_per_tau, "rate of the kicks [1/tau]: speed against accuracy")
      .def_readonly("seed", &Bath::seed, "of the random numbers")
      .def_readonly("stream", &Bath::stream, "which sequence of the seed; tips with different streams are independent");
  add_call(bath);
}

void add_units(py::module& m) {
  const SiModel mica;
  const Bath none;
  const auto unit = [](double (Units::*of)() const) { return [of](const SiUnits& u) { return (u.units.*of)(); }; };
  py::class_<SiUnits> units(m, "Units",
                            R"(A model in SI, and the factors from natural units to SI: value_si = value * factor.

The defaults are mica's. `model` is the same in natural units; `bath(temperature_k=, ...)` gives a heat bath.
A lever may be given as its owner knows it, in place of omega_v, omega_h and tip mass: spring_constant_n_per_m,
resonance_hz and lateral_spring_constant_n_per_m, all three; and load_n [N] in place of rest_height_m.)");
  units
      .def(py::init(&to_units), "omega_v_rad_per_s"_a = mica.omega_v_rad_per_s,
           "omega_h_rad_per_s"_a = mica.omega_h_rad_per_s, "tip_mass_kg"_a = mica.tip_mass_kg,
           "lattice_spacing_m"_a = mica.lattice_spacing_m, "surface_amplitude_m"_a = mica.surface_amplitude_m,
           "rest_height_m"_a = mica.rest_height_m, "restitution_gamma"_a = mica.restitution_gamma,
           "cutoff_speed"_a = mica.cutoff_speed, "spring_constant_n_per_m"_a = 0.0, "resonance_hz"_a = 0.0,
           "lateral_spring_constant_n_per_m"_a = 0.0, "load_n"_a = 0.0)
      .def_property_readonly(
          "model", [](const SiUnits& u) { return u.units.to_natural(u.si); }, "the Model in natural units")
      .def("bath", &bath_of, "temperature_k"_a = 0.0, "quality_factor"_a = 0.0, "lateral_quality_factor"_a = 0.0,
           "kicks_per_tau"_a = none.kicks_per_tau, "seed"_a = none.seed, "The bath in natural units; temperature in K.")
      .def_property_readonly("length", unit(&Units::length), "[m], of a")
      .def_property_readonly("time", unit(&Units::time), "[s], of tau")
      .def_property_readonly("velocity", unit(&Units::velocity), "[m/s], of a/tau")
      .def_property_readonly("energy", unit(&Units::energy), "[J]")
      .def_property_readonly("force", unit(&Units::force), "[N]")
      .def_property_readonly("friction", unit(&Units::friction), "[kg/s], of K_f in m_tip/tau")
      .def_property_readonly("temperature", unit(&Units::temperature), "[K], of kT");
  add_call(units);
}

}  // namespace

void add_model(py::module& m) {
  const Model mica;
  py::class_<Model> model(m, "Model",
                          R"(Tip, springs and surface, in natural units (a, tau, tip mass m). The defaults are mica's.

gamma: restitution at and above the cutoff [-]; cutoff: speed of the restitution law [a/tau];
rest_height: of the holder above mid-surface [a]; amplitude: of the surface [a];
frequency_ratio: omega_h / omega_v; kind: 'oscillator', or 'hammer' without the horizontal spring.
An object cannot be changed. Throws ParameterError.)");
  model
      .def(py::init(&to_model), "gamma"_a = mica.gamma, "cutoff"_a = mica.v_c, "rest_height"_a = mica.y0,
           "amplitude"_a = mica.H, "frequency_ratio"_a = mica.frequency_ratio, "kind"_a = "oscillator")
      .def_readonly("gamma", &Model::gamma, "restitution at and above the cutoff")
      .def_readonly("cutoff", &Model::v_c, "speed of the restitution law [a/tau]")
      .def_readonly("rest_height", &Model::y0, "of the holder above mid-surface [a]")
      .def_readonly("amplitude", &Model::H, "of the surface [a]")
      .def_readonly("frequency_ratio", &Model::frequency_ratio, "omega_h / omega_v")
      .def_property_readonly(
          "kind", [](const Model& self) { return name(self.kind); }, "'oscillator' or 'hammer'");
  add_call(model);
  add_bath(m);
  add_units(m);
  const auto of_eta = [](auto* function) {
    return [function](const Model& of, const Bath& bath, double eta) {
      check_eta(eta);
      return function(of, bath, eta);
    };
  };
  m.def(
      "kicks_lock", of_eta(&kicks_lock), "model"_a, "bath"_a, "eta"_a = 0.0,
      "Whether the kicks of the bath lock to the swing of the lateral spring: K_f may then be wrong by a fifth. Or to\n"
      "the drag at eta [a/tau]: K_f then depends on the start.");
  m.def("suitable_kicks", of_eta(&suitable_kicks), "model"_a, "bath"_a, "eta"_a = 0.0,
        "A rate of kicks [1/tau] that does not lock, for the model, the quality factors of the bath and eta [a/tau].");
}

}  // namespace afm::python
