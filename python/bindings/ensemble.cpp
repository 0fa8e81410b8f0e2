// Ensemble: many tips on threads.
#include "afm/ensemble.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include "convert.h"

namespace afm::python {
namespace {

using namespace py::literals;

class PyEnsemble {
 public:
  PyEnsemble(const std::vector<Tip>& tips, int threads)
      : threads_(threads),
        ensemble_(threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))) {
    require(threads >= 0 && threads <= 1024, "threads", threads, "must be within 0 and 1024");
    ensemble_.reserve(tips.size());
    for (const Tip& tip : tips) ensemble_.add(tip);
  }

  std::size_t size() const { return ensemble_.size(); }
  int threads() const { return threads_; }  // as given
  std::vector<Tip> tips() const {
    std::vector<Tip> copies;
    for (std::size_t i = 0; i < size(); ++i) copies.push_back(ensemble_.tip(i));
    return copies;
  }

  // In chunks of time and of events, so that signals are seen. No bit depends on them.
  py::array advance(const py::object& time) {
    constexpr double kAtATime = 1e4;  // tau of all tips together: about a second in contact
    const ModelTime end = to_time(time);
    ModelTime now = end;
    for (std::size_t i = 0; i < size(); ++i) {
      const ModelTime own = ensemble_.tip(i).now();
      require(own <= end, "time", end - ModelTime{}, "lies before the present of a tip");
      now = std::min(now, own);
    }
    std::vector<std::int64_t> events(size(), 0);
    const double chunk = kAtATime / static_cast<double>(std::max<std::size_t>(1, size()));
    do {  // also to the present, where an event may be due
      now = end - now > chunk ? now + chunk : end;
      advance_to(now, events);
    } while (now < end);
    return to_array(std::move(events), py::dtype::of<std::int64_t>());
  }

  void drag(double eta) {
    check_eta(eta);
    for (std::size_t i = 0; i < size(); ++i) {
      const auto warnings = find_warnings(ensemble_.tip(i).model(), ensemble_.tip(i).thermostat().bath(), eta);
      if (warnings.empty()) continue;
      warn(warnings);  // once for all
      break;
    }
    for (std::size_t i = 0; i < size(); ++i) ensemble_.drag(i, eta);
  }

  Tip tip(py::ssize_t i) const {
    const auto n = static_cast<py::ssize_t>(size());
    if (i < -n || i >= n) throw py::index_error("an ensemble of " + std::to_string(n) + " tips");
    return ensemble_.tip(static_cast<std::size_t>(i < 0 ? i + n : i));
  }

 private:
  void advance_to(const ModelTime& stop, std::vector<std::int64_t>& events) {
    constexpr std::uint32_t kAtATime = 10000;  // events of each tip
    for (bool more = true; more;) {
      {
        const py::gil_scoped_release released;
        ensemble_.advance(kAtATime, stop);
      }
      more = false;
      for (std::size_t i = 0; i < size(); ++i) {
        events[i] += ensemble_.events(i);
        const bool goes_on = ensemble_.events(i) == kAtATime;
        if (!goes_on && ensemble_.tip(i).now() < stop)
          throw std::runtime_error("the search of an impact of tip " + std::to_string(i) + " cannot go on");
        more = more || goes_on;
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

  const int threads_;
  Ensemble ensemble_;
};

}  // namespace

void add_ensemble(py::module& m) {
  py::class_<PyEnsemble>(m, "Ensemble",
                         R"(Many tips, each with its own model, drag velocity and start, advanced on threads.

tips: copies of these; threads: 0 is one for each processor. Each tip gives the same bits as alone. len() is their
number, ensemble[i] a copy of the i-th Tip as it is now.)")
      .def(py::init<const std::vector<Tip>&, int>(), "tips"_a, "threads"_a = 0)
      .def("advance", &PyEnsemble::advance, "time"_a,
           "All tips to a model time [tau] (a number, or a ModelTime). Returns the number of events of each, shape "
           "(n,).")
      .def("drag", &PyEnsemble::drag, "eta"_a, "A new drag velocity of all tips [a/tau] from now on.")
      .def("__len__", &PyEnsemble::size)
      .def("__getitem__", &PyEnsemble::tip, "i"_a)
      .def("__reduce__", [](const py::object& self) {  // to pickle it
        const auto& ensemble = self.cast<const PyEnsemble&>();
        return py::make_tuple(self.attr("__class__"), py::make_tuple(ensemble.tips(), ensemble.threads()));
      });
}

}  // namespace afm::python
