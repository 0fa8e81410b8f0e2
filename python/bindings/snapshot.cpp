// A snapshot as a dict.
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <type_traits>

#include "convert.h"

namespace afm::python {
namespace {

[[noreturn]] void refuse_entry(const char* name, const py::handle& value) {
  throw py::type_error(std::string(name) + " = " + std::string(py::repr(value)) + ": has the wrong type");
}

template <class T>
void read(const char* name, const py::handle& value, T& out) {
  if (value.is_none()) refuse_entry(name, value);  // pybind11 would look for another constructor
  try {
    out = value.cast<T>();
  } catch (const py::cast_error&) {
    refuse_entry(name, value);
  } catch (const py::error_already_set&) {  // NumPy's, of an array
    refuse_entry(name, value);
  }
}
void read(const char* name, const py::handle& value, double& out) { out = real(name, value); }
void read(const char* name, const py::handle& value, std::uint64_t& out) { out = whole(name, value); }

// An archive takes an entry of the dict and a member of the snapshot, one way or the other.
class ToDict {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    dict[name] = value;
  }
  void operator()(const char* name, const ModelTime& time) { dict[name] = to_python(time); }
  template <std::size_t n>
  void operator()(const char* name, const std::array<double, n>& numbers) {
    dict[name] = py::array_t<double>(static_cast<py::ssize_t>(n), numbers.data());
  }

  py::dict dict;
};

class FromDict {
 public:
  explicit FromDict(const py::dict& dict) : dict_(dict) {
    for (const auto& item : dict) unread_.insert(py::str(item.first));
  }
  template <class T>
  void operator()(const char* name, T& value) {
    read(name, take(name), value);
  }
  void operator()(const char* name, ModelTime& time) { time = to_time(take(name), name); }
  template <std::size_t n>
  void operator()(const char* name, std::array<double, n>& numbers) {
    py::array_t<double, py::array::c_style | py::array::forcecast> array;
    read(name, take(name), array);
    if (array.size() != n) throw py::value_error(name + (": must hold " + std::to_string(n)) + " numbers");
    std::copy(array.data(), array.data() + n, numbers.begin());
  }
  void end() const {
    if (!unread_.empty()) throw py::type_error("a snapshot has no " + *unread_.begin());
  }

 private:
  py::object take(const char* name) {
    if (unread_.erase(name) == 0) throw py::value_error(std::string("the snapshot lacks ") + name);
    return dict_[name];
  }

  py::dict dict_;
  std::set<std::string> unread_;
};

template <class Archive, class Sum>
void visit_sum(Archive& archive, const char* name, Sum& sum) {
  std::array<double, 2> both{sum.value, sum.rest};
  archive(name, both);
  if constexpr (!std::is_const_v<Sum>) sum = {both[0], both[1]};
}

template <class Archive, class Settings>
void visit_settings(Archive& archive, Settings& s) {
  archive("model", s.model);
  archive("eta", s.eta);
  archive("initial_phase", s.initial.phase);
  archive("initial_extension", s.initial.X);
  archive("initial_y", s.initial.y);
  archive("initial_u", s.initial.u);
  archive("initial_w", s.initial.w);
  archive("sample_period", s.sample_period);
  archive("samples_per_batch", s.samples_per_batch);
  archive("friction_window", s.friction_window);
  archive("impact_budget", s.impact_budget);
  archive("contact_tolerance", s.contact_tolerance);
  archive("bath", s.bath);
}

template <class Archive, class State>
void visit_motion(Archive& archive, State& s) {
  archive("time", s.tip.time);
  archive("next_sample", s.next_sample);
  archive("next_impact", s.next_impact);
  archive("sample_origin", s.samples.origin);
  archive("sample_first", s.samples.first);
  archive("kicks", s.kick_count);
  archive("kick_origin", s.kicks.origin);
  archive("kick_first", s.kicks.first);
  archive("holder_since", s.holder.since);
  archive("holder_from", s.holder.from);
  archive("surface_phase", s.tip.state.phase);
  archive("extension", s.tip.state.X);
  archive("u", s.tip.state.u);
  archive("gap", s.tip.state.g);
  archive("gap_rate", s.tip.state.g1);
  archive("sequence_normal_speed", s.tip.sequence_normal_speed);
  archive("sequence_gain", s.tip.sequence_gain);
  archive("chatter_speed", s.tip.chatter_speed);
  archive("chatter_count", s.tip.chatter_count);
}

template <class Archive, class Sums>
void visit_sums(Archive& archive, Sums& f) {
  archive("estimate_start", f.start);
  archive("estimate_impacts", f.impact_count);
  visit_sum(archive, "estimate_energy", f.energy);
  visit_sum(archive, "estimate_impulse", f.impulse);
  visit_sum(archive, "estimate_heat", f.heat);
  visit_sum(archive, "estimate_vertical", f.vertical);
  archive("estimate_samples", f.samples);
  archive("energy_bin_width", f.energy_bins.width);
  archive("energy_bins", f.energy_bins.amount);
  archive("impulse_bin_width", f.impulse_bins.width);
  archive("impulse_bins", f.impulse_bins.amount);
  archive("window_start", f.window_start);
  archive("window_bin", f.window.current);
  archive("window_bins", f.window.energy);
}

}  // namespace

py::dict to_dict(const Snapshot& s) {
  ToDict archive;
  visit_settings(archive, s.settings);
  visit_motion(archive, s);
  archive("phase", static_cast<std::uint64_t>(s.tip.phase));
  visit_sums(archive, s.friction.sums());
  return archive.dict;
}

Snapshot to_snapshot(const py::dict& dict) {
  FromDict archive(dict);
  Snapshot s;
  visit_settings(archive, s.settings);
  visit_motion(archive, s);
  std::uint64_t phase = 0;
  archive("phase", phase);
  s.tip.phase = static_cast<TipSnapshot::Phase>(std::min<std::uint64_t>(phase, 255));
  s.samples.period = s.settings.sample_period;
  s.kicks.period = 1.0 / s.settings.bath.kicks_per_tau;
  FrictionSums sums(s.settings.friction_window);
  sums.eta = s.settings.eta;
  visit_sums(archive, sums);
  archive.end();
  s.friction = Friction(sums);
  refuse(find_faults(s));
  return s;
}

void require_settled(bool settled) {
  if (!settled) throw py::value_error("an event at the present is still to be reported: advance to the present first");
}

}  // namespace afm::python
