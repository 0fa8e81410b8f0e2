"""Shared by the tests of the view: its pictures, and what they must show, computed anew from what the emulator
reported."""
import math
import subprocess

from visualization_msgs.msg import Marker, MarkerArray

from emulator_under_test import SPEED_UNIT, TAU_S, Process, find
from topics import Topic, key, tau_between

CELLS, AHEAD = 6, 1     # seen across a picture, and from its middle to the holder
SCALE = 7.0 / CELLS     # units of the picture per cell
LATTICE = 0.52e-9       # m
AMPLITUDE = 0.05 / 0.52  # of the surface [a]
CONTACT_RED = 230 / 255


class View(Process):
    def __init__(self):
        super().__init__([find('view_node'), '__name:=afm_view', '_emulator:=/afm'])
        self.markers = Topic('/afm_view/markers', MarkerArray)


def open_rviz(**environment):
    return subprocess.run([find('open_rviz')], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True, timeout=30)


def surface(x):
    return AMPLITUDE * math.cos(2 * math.pi * x)


def luminance(colour):
    return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b


class Picture:
    """One MarkerArray, by name; places in cells from its middle."""

    def __init__(self, message):
        self.markers = {m.ns: m for m in message.markers if m.action == Marker.ADD}
        self.stamp = message.markers[0].header.stamp.to_sec()

    def has(self, name):
        return name in self.markers

    def text(self, name):
        return self.markers[name].text

    def places(self, name):
        return [(p.x / SCALE, p.z / SCALE) for p in self.markers[name].points] if self.has(name) else []

    def tip(self):
        return self.places('tip')[-1]

    def spots(self):
        return len(self.places('impacts')) + len(self.places('contacts'))


class Reported:
    """What the emulator has reported so far, of its present epoch, and what follows from it."""

    def __init__(self, topics):
        self.epoch = topics['configuration'].messages[-1].epoch
        self.configuration = topics['configuration'].messages[-1]
        self.commands = self.of_epoch(topics['applied'])
        self.batches = [m for m in self.of_epoch(topics['deflection']) if m.vertical]
        self.events = [i for m in self.of_epoch(topics['impacts']) for i in m.impacts]

    def of_epoch(self, topic):
        return [m for m in topic.messages if m.epoch == self.epoch]

    def last_sample(self):
        """Its time, and the tip's place from the holder [a]."""
        batch = self.batches[-1]
        time = type(batch.time)(batch.time.tau, batch.time.phase)
        time.phase += (len(batch.vertical) - 1) * self.configuration.sample_period_tau
        return time, batch.lateral[-1] / LATTICE, batch.vertical[-1] / LATTICE

    def height(self, time):
        """Of the holder [a]."""
        return [m.rest_height_m for m in self.commands if key(m.time) <= key(time)][-1] / LATTICE

    def centre(self, time):
        """Where it is over the surface [a]."""
        batch = [m for m in self.batches if key(m.time) <= key(time)][-1]
        return (batch.holder_position + batch.drag_velocity * TAU_S * tau_between(batch.time, time)) / LATTICE

    def middle(self, time):
        eta = self.commands[-1].drag_velocity / SPEED_UNIT
        return self.centre(time) - math.copysign(AHEAD, eta)

    def events_seen(self, time):
        """Of the last 8 tau and in the picture, as (place in it, event)."""
        middle, seen = self.middle(time), []
        for event in self.events:
            if not 0 <= tau_between(event.time, time) <= 8:
                continue
            cells = round(self.centre(event.time) - event.surface_phase)  # the extension is far below half a cell
            x = cells + event.surface_phase - middle
            if abs(x) <= CELLS / 2:
                seen.append((x, event))
        return seen
