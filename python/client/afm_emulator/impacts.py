"""The impacts of a batch, from the bytes of its message: a million of them take no longer as an array than a few
messages that are unpacked one field at a time."""
import struct

import numpy as np

IMPACT = np.dtype([('tau', '<i8'), ('phase', '<f8'), ('surface_phase', '<f8'), ('normal_speed', '<f8'),
                   ('tangential_velocity', '<f8'), ('energy_loss', '<f8'), ('kind', 'u1'), ('count', '<u4')])


def read_impacts(data):
    """(epoch, index of the first, table) of the bytes of an ImpactArray, in which the list of impacts is the last
    field."""
    at = 16 + int.from_bytes(data[12:16], 'little')  # the header ends in a text
    epoch, first, count = struct.unpack_from('<IQI', data, at)
    return epoch, first, np.frombuffer(data, IMPACT, count, at + struct.calcsize('<IQI'))
