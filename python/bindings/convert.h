// Between the library and Python: faults, model times, states, arrays that own what the library has made.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "afm/model.h"
#include "afm/run.h"
#include "afm/state.h"

namespace afm::python {

namespace py = pybind11;

// Every fault of a call; becomes afm.ParameterError.
struct Faults : std::exception {
  explicit Faults(std::vector<ParameterError> all_) : all(std::move(all_)) {}
  std::vector<ParameterError> all;
};

// Throws Faults unless there are none. The names become those of Python's arguments.
void refuse(const std::vector<ParameterError>& faults);
// The same as warnings (RuntimeWarning), at the line of the user: each function of ours is called by one in Python.
void warn(const std::string& text);
void warn(const std::vector<ParameterError>& warnings);
[[noreturn]] void throw_stuck(double eta, const ModelTime& now);  // a tip that is at Outcome::search_failed
void require(bool holds, const char* name, double value, const char* reason);
void check_eta(double eta);

// An argument that takes more than one type. Raises afm.ParameterError if it is something else.
[[noreturn]] void refuse_type(const char* name, const py::handle& value, const char* reason);  // of the wrong type
double real(const char* name, const py::handle& value);
std::uint64_t whole(const char* name, const py::handle& value);

// One of the words that an argument may be. Raises afm.ParameterError with the reason if it is none.
[[noreturn]] void refuse_word(const char* name, const std::string& word, const char* reason);
ModelKind kind_of(const std::string& name);

// A number of tau, or whole tau and a phase.
ModelTime to_time(const py::object& time, const char* name = "time");
py::object to_python(const ModelTime& time);   // afm.ModelTime
py::object to_python(const FreeState& state);  // afm.State
py::dict to_python(const FrictionEstimate& friction);

// The start of every run, unchecked; u None: the drag velocity.
RunSettings to_settings(const Model& model, double eta, double phase, double extension, double y, const py::object& u,
                        double w, double contact_tolerance);

// A snapshot as a dict of numbers and arrays in natural units: of a run, or of a tip alone.
py::dict to_dict(const Snapshot& snapshot);
Snapshot to_snapshot(const py::dict& dict);  // throws Faults
void require_settled(bool settled);

py::dtype impact_dtype();  // of the library's own records

// The array becomes the owner of the values: nothing is copied.
template <class T>
py::array to_array(std::vector<T> values, const py::dtype& dtype) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array(dtype, std::vector<py::ssize_t>{static_cast<py::ssize_t>(kept->size())},
                   std::vector<py::ssize_t>{static_cast<py::ssize_t>(sizeof(T))}, kept->data(), owner);
}
inline py::array to_array(std::vector<double> values) { return to_array(std::move(values), py::dtype::of<double>()); }
inline py::array to_array(std::vector<Impact> impacts) { return to_array(std::move(impacts), impact_dtype()); }

void add_errors();
void add_model(py::module& m);
void add_tip(py::module& m);
void add_ensemble(py::module& m);
void add_run(py::module& m);
void add_tables(py::module& m);
void add_studies(py::module& m);

}  // namespace afm::python
