"""The digests of a recording computed again from what a reader of bags gets: docs/recording.md in Python."""
import struct
from io import BytesIO

from std_msgs.msg import Header

MASK = (1 << 64) - 1
START = 0xcbf29ce484222325


def add(state, words):
    for word in words:
        state = ((state ^ word) * 0x9e3779b97f4a7c15) & MASK
        state ^= state >> 32
    return state


def bits(*numbers):
    return struct.unpack('<%dQ' % len(numbers), struct.pack('<%dd' % len(numbers), *numbers))


def time_words(time):
    return (time.tau & MASK,) + bits(time.phase)


def of_configuration(message):
    header, message.header = message.header, Header()
    buffer = BytesIO()
    message.serialize(buffer)
    message.header = header
    return add(START, buffer.getvalue())


def of_samples(messages, state=START):
    for message in messages:
        pairs = [value for pair in zip(message.vertical, message.lateral) for value in pair]
        state = add(state, bits(*pairs))
    return state


def of_impacts(messages, state=START):
    for message in messages:
        for i in message.impacts:
            state = add(state, time_words(i.time) + bits(i.surface_phase, i.normal_speed, i.tangential_velocity,
                                                         i.energy_loss) + (i.kind, i.count))
    return state


def in_order(drags, changes):
    """Of one epoch: drag velocities and changes of parameters as they took effect."""
    applied, rest = [], list(drags)
    for change in changes:
        while len(drags) - len(rest) < change.first_command:
            applied.append(rest.pop(0))
        applied.append(change)
    return applied + rest


def of_level(m):
    return (int(m.model == 'hammer'),) + bits(m.contact_tolerance, m.expected_error, m.energy_dropped)


def of_commands(messages, state=START):
    for m in messages:
        if hasattr(m, 'drag_velocity'):
            words = bits(m.drag_velocity) + (m.first_impact,) + of_level(m)
        else:
            words = ((m.first_impact, m.first_sample, m.first_command) +
                     bits(m.restitution_gamma, m.cutoff_speed, m.rest_height_m, m.sample_rate_hz, m.friction_window_tau) +
                     (m.samples_per_batch,) + bits(m.sample_period_tau) + of_level(m))
        state = add(state, time_words(m.time) + words)
    return state


def of_estimates(messages, state=START):
    for m in messages:
        figures = (m.drag_velocity, m.eta, m.force, m.force_std_error, m.k_f, m.k_f_std_error, m.k_f_tau_per_m,
                   m.energy_loss, m.window_force, m.window_k_f, m.window_k_f_std_error)
        state = add(state, time_words(m.time) + bits(*figures) + (m.impact_count,))
    return state


def of_checkpoint(m):
    d = m.digest
    figures = (m.drag_velocity, m.restitution_gamma, m.cutoff_speed, m.rest_height_m, m.sample_rate_hz, m.friction_window_tau)
    told = (d.epoch,) + time_words(d.time) + (d.samples, d.impacts, d.commands, d.estimates, d.configuration_digest,
                                              d.first_sample, d.samples_digest, d.impacts_digest, d.commands_digest,
                                              d.estimates_digest)
    return add(START, (m.epoch,) + time_words(m.time) + (m.impacts, m.samples, m.drags, m.next_drag, m.next_parameters) +
               bits(*figures) + told + (m.layout,) + tuple(m.state))
