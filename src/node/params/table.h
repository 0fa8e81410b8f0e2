// Every parameter of the node, once: its name, which is the same on the parameter server and in messages, and where it
// is in Parameters.
#pragma once

// START: read at the start. RUN: a run depends on it, so it is in Configuration too. LIVE: it may change while the
// emulator runs, so it is in Configuration, Applied and Emulator.cfg.
#define AFM_PARAMETERS(START, RUN, LIVE)                                        \
  RUN(omega_v_rad_per_s, si.omega_v_rad_per_s)                                  \
  RUN(omega_h_rad_per_s, si.omega_h_rad_per_s)                                  \
  RUN(tip_mass_kg, si.tip_mass_kg)                                              \
  RUN(lattice_spacing_m, si.lattice_spacing_m)                                  \
  RUN(surface_amplitude_m, si.surface_amplitude_m)                              \
  START(spring_constant_n_per_m, lever.spring_constant_n_per_m)                 \
  START(resonance_hz, lever.resonance_hz)                                       \
  START(lateral_spring_constant_n_per_m, lever.lateral_spring_constant_n_per_m) \
  START(load_n, load_n)                                                         \
  START(lever_file, lever_file)                                                 \
  START(surface_file, surface_file)                                             \
  LIVE(restitution_gamma, si.restitution_gamma)                                 \
  LIVE(cutoff_speed, si.cutoff_speed)                                           \
  LIVE(rest_height_m, si.rest_height_m)                                         \
  LIVE(sample_rate_hz, sample_rate_hz)                                          \
  LIVE(friction_window_tau, friction_window_tau)                                \
  LIVE(temperature_k, bath.temperature_k)                                       \
  LIVE(quality_factor, bath.quality_factor)                                     \
  LIVE(lateral_quality_factor, bath.lateral_quality_factor)                     \
  LIVE(kicks_per_tau, bath.kicks_per_tau)                                       \
  RUN(seed, bath.seed)                                                          \
  RUN(model, model)                                                             \
  RUN(tolerance, tolerance)                                                     \
  RUN(tolerance_of, tolerance_of)                                               \
  START(level_table, level_table)                                               \
  RUN(drag_velocity, drag_velocity)                                             \
  RUN(max_drag_velocity, max_drag_velocity)                                     \
  RUN(initial_phase, initial.phase)                                             \
  RUN(initial_extension, initial.X)                                             \
  RUN(initial_height, initial.y)                                                \
  RUN(initial_u, initial.u)                                                     \
  RUN(initial_w, initial.w)                                                     \
  RUN(time_scale, time_scale)                                                   \
  RUN(pace, pace)                                                               \
  START(wait_for, wait_for)                                                     \
  START(command_wait_s, command_wait_s)                                         \
  START(publish_clock, publish_clock)                                           \
  RUN(batch_rate_hz, batch_rate_hz)                                             \
  START(commands_eta, commands_eta)                                             \
  START(commands_hold_s, commands_hold_s)                                       \
  START(command_timeout_s, command_timeout_s)                                   \
  RUN(impact_budget, impact_budget)                                             \
  RUN(contact_tolerance, contact_tolerance)                                     \
  START(paused, paused)                                                         \
  START(record, record)                                                         \
  START(bag_directory, bag_directory)                                           \
  START(disk_reserve_mb, disk_reserve_mb)                                       \
  START(compression, compression)                                               \
  START(split_size_mb, split_size_mb)                                           \
  START(split_duration_s, split_duration_s)

namespace afm::node {

#define AFM_NO(name, place)
#define AFM_NAME(name, place) #name,
#define AFM_VISIT(name, place) visit(#name, p.place);
#define AFM_COPY(name, place) copy(message.name, p.place);
#define AFM_MERGE(name, place) merge(from.place, to.place);

// But for the drag velocity, which has a topic of its own.
constexpr const char* kLiveNames[] = {AFM_PARAMETERS(AFM_NO, AFM_NO, AFM_NAME)};

// visit(name, value)
template <class P, class Visit>
void for_each_parameter(P& p, Visit visit) {
  AFM_PARAMETERS(AFM_VISIT, AFM_VISIT, AFM_VISIT)
}

// copy(field, value), either way, for what a run depends on.
template <class Message, class P, class Copy>
void for_each_of_run(Message& message, P& p, Copy copy) {
  AFM_PARAMETERS(AFM_NO, AFM_COPY, AFM_COPY)
}

// The same in the order of kLiveNames.
template <class Message, class P, class Copy>
void for_each_live(Message& message, P& p, Copy copy) {
  AFM_PARAMETERS(AFM_NO, AFM_NO, AFM_COPY)
}

// The same from one set of parameters to another: merge(value, value).
template <class P, class Merge>
void for_each_live_pair(const P& from, P& to, Merge merge) {
  AFM_PARAMETERS(AFM_NO, AFM_NO, AFM_MERGE)
}

#undef AFM_NO
#undef AFM_NAME
#undef AFM_VISIT
#undef AFM_COPY
#undef AFM_MERGE
#undef AFM_PARAMETERS

constexpr auto kToMessage = [](auto& field, const auto& value) { field = value; };
constexpr auto kFromMessage = [](const auto& field, auto& value) { value = field; };

}  // namespace afm::node
