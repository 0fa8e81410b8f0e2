"""The digests of a recording computed again from what a reader of bags gets: docs/recording.md in Python."""
import copy
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


def words_of(buffer):
    """Bytes eight at a time, the first of them the lowest; the last word is filled up with zeros."""
    padded = buffer + bytes(-len(buffer) % 8)
    return struct.unpack('<%dQ' % (len(padded) // 8), padded)


def bytes_of(message):
    """On the wire, with an empty header."""
    message = copy.deepcopy(message)
    if hasattr(message, 'header'):
        message.header = Header()
    buffer = BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def of_configuration(message):
    return add(START, words_of(bytes_of(message)))


def of_samples(messages, state=START):
    for message in messages:
        pairs = [value for pair in zip(message.vertical, message.lateral) for value in pair]
        state = add(state, struct.unpack('<%dQ' % len(pairs), struct.pack('<%dd' % len(pairs), *pairs)))
    return state


def of_messages(messages, state=START):
    for message in messages:
        state = add(state, words_of(bytes_of(message)))
    return state


def of_impacts(messages, state=START):
    return of_messages([impact for message in messages for impact in message.impacts], state)


def in_order(drags, changes):
    """Of one epoch: drag velocities and changes of parameters as they took effect."""
    applied, rest = [], list(drags)
    for change in changes:
        while len(drags) - len(rest) < change.first_command:
            applied.append(rest.pop(0))
        applied.append(change)
    return applied + rest


def of_checkpoint(message):
    message = copy.deepcopy(message)
    message.digest.header = Header()
    message.state_digest = 0
    return add(START, words_of(bytes_of(message)))
