#include "convert.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/fault_list.h"

namespace afm::python {
namespace {

std::string argument_name(const std::string& member) {
  std::string name = detail::word_for(member);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

py::object values() { return py::module::import("afm.values"); }

// Raises the first, with all of them in it.
void raise(const std::vector<ParameterError>& faults) {
  const py::object type = py::module::import("afm.errors").attr("ParameterError");
  py::list all;
  for (const ParameterError& fault : faults) all.append(type(fault.name, fault.value, fault.reason));
  const py::object first = all[0];
  first.attr("faults") = py::tuple(all);
  PyErr_SetObject(type.ptr(), first.ptr());
}

[[noreturn]] void raise(const char* type, const char* name, const py::handle& value, const char* reason) {
  const py::object error = py::module::import("afm.errors").attr(type);
  PyErr_SetObject(error.ptr(), error(name, value, reason).ptr());
  throw py::error_already_set();
}

}  // namespace

void refuse_type(const char* name, const py::handle& value, const char* reason) {
  raise("ArgumentTypeError", name, value, reason);
}

void refuse_word(const char* name, const std::string& word, const char* reason) {
  raise("ParameterError", name, py::str(word), reason);
}

void refuse(const std::vector<ParameterError>& faults) {
  if (faults.empty()) return;
  std::vector<ParameterError> renamed;
  for (const ParameterError& fault : faults) renamed.emplace_back(argument_name(fault.name), fault.value, fault.reason);
  throw Faults(renamed);
}

void warn(const std::string& text) {
  constexpr int kCallOfOurs = 2;  // the level of the line that calls a function in Python
  if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), kCallOfOurs) != 0) throw py::error_already_set();
}

void warn(const std::vector<ParameterError>& warnings) {
  for (const ParameterError& warning : warnings) {
    warn(ParameterError(argument_name(warning.name), warning.value, warning.reason).what());
  }
}

void throw_stuck(double eta, const ModelTime& now) {
  throw std::runtime_error("the search of an impact cannot go on at eta = " + number_text(eta) + ", model time " +
                           number_text(static_cast<double>(now.tau) + now.phase) + " tau");
}

void require(bool holds, const char* name, double value, const char* reason) {
  if (!holds) refuse({ParameterError(name, value, reason)});
}

void check_eta(double eta) {
  require(std::abs(eta) <= kMaxEta, "eta", eta, "must be finite and at most 1000 lattice spacings per tau");
}

double real(const char* name, const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() == nullptr) return number;
  const bool overflows = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
  PyErr_Clear();
  if (overflows) return std::numeric_limits<double>::infinity();
  refuse_type(name, value, "must be a number");
}

std::uint64_t whole(const char* name, const py::handle& value) {
  constexpr double kMostWhole = 9007199254740992.0;  // up to there every whole number is a double
  if (PyIndex_Check(value.ptr()) != 0) {
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    const std::uint64_t number = index ? PyLong_AsUnsignedLongLong(index.ptr()) : 0;
    if (PyErr_Occurred() == nullptr) return number;
  } else {
    const double number = PyFloat_AsDouble(value.ptr());  // NumPy's too
    if (number >= 0.0 && number <= kMostWhole && number == std::floor(number)) {
      return static_cast<std::uint64_t>(number);
    }
  }
  PyErr_Clear();
  refuse_type(name, value, "must be a whole number from 0 to 18446744073709551615");
}

ModelKind kind_of(const std::string& name) {
  ModelKind kind = ModelKind::oscillator;
  if (!parse(name, kind)) refuse_word("kind", name, "must be oscillator or hammer");
  return kind;
}

ModelTime to_time(const py::object& time, const char* name) {
  constexpr double kLongest = 1e15;  // [tau]
  ModelTime result;
  if (py::isinstance<py::tuple>(time)) {
    const auto parts = py::reinterpret_borrow<py::tuple>(time);
    if (parts.size() != 2 || PyIndex_Check(parts[0].ptr()) == 0) {  // NumPy's whole numbers too, as of an event
      refuse_type(name, time, "must be a number of tau, or whole tau and a phase");
    }
    const double tau = real(name, parts[0]);
    require(std::abs(tau) <= kLongest, name, tau, "must be at most 1e15 tau");
    result = {py::int_(parts[0]).cast<std::int64_t>(), real(name, parts[1])};
    require(result.phase >= 0.0 && result.phase < 1.0, name, result.phase, "the phase must be in [0, 1)");
  } else {
    const double tau = real(name, time);
    require(std::abs(tau) <= kLongest, name, tau, "must be finite and at most 1e15 tau");
    result = ModelTime{} + tau;
  }
  return result;
}

py::object to_python(const ModelTime& time) { return values().attr("ModelTime")(time.tau, time.phase); }

py::object to_python(const FreeState& s) { return values().attr("State")(s.phase, s.X, s.y, s.u, s.w); }

py::dict to_python(const FrictionEstimate& f) {
  using namespace py::literals;
  return py::dict("force"_a = f.force, "force_std_error"_a = f.force_std_error, "k_f"_a = f.K_f,
                  "k_f_std_error"_a = f.K_f_std_error, "energy_loss"_a = f.energy_loss,
                  "impact_count"_a = f.impact_count, "window_force"_a = f.window_force, "window_k_f"_a = f.window_K_f,
                  "window_k_f_std_error"_a = f.window_K_f_std_error, "mean_lateral_force"_a = f.mean_lateral_force,
                  "mean_lateral_force_std_error"_a = f.mean_lateral_force_std_error, "k_f_work"_a = f.K_f_work,
                  "k_f_work_std_error"_a = f.K_f_work_std_error, "mean_normal_force"_a = f.mean_normal_force,
                  "heat_to_bath"_a = f.heat_to_bath);
}

RunSettings to_settings(const Model& model, double eta, double phase, double extension, double y, const py::object& u,
                        double w, double contact_tolerance) {
  RunSettings settings;
  settings.model = model;
  settings.eta = eta;
  settings.initial = {phase, extension, y, u.is_none() ? eta : real("u", u), w};
  settings.contact_tolerance = contact_tolerance;
  return settings;
}

py::dtype impact_dtype() {
  struct Field {
    const char* name;
    const char* format;
    std::size_t offset;
  };
  constexpr std::size_t kTime = offsetof(Impact, time);
  const Field fields[] = {{"tau", "<i8", kTime + offsetof(ModelTime, tau)},
                          {"phase", "<f8", kTime + offsetof(ModelTime, phase)},
                          {"surface_phase", "<f8", offsetof(Impact, surface_phase)},
                          {"normal_speed", "<f8", offsetof(Impact, normal_speed)},
                          {"tangential_velocity", "<f8", offsetof(Impact, tangential_velocity)},
                          {"energy_loss", "<f8", offsetof(Impact, energy_loss)},
                          {"kind", "u1", offsetof(Impact, kind)},
                          {"count", "<u4", offsetof(Impact, count)}};
  py::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(py::dtype(field.format));
    offsets.append(field.offset);
  }
  return py::dtype(names, formats, offsets, sizeof(Impact));
}

void add_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Faults& faults) {
      raise(faults.all);
    } catch (const ParameterError& fault) {
      raise({ParameterError(argument_name(fault.name), fault.value, fault.reason)});
    }
  });
}

}  // namespace afm::python
