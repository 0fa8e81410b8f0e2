"""The figures of a control period in real time: those of the service ~control, from the batches that are published."""
import math

from afm_emulator.impacts import read_impacts
from afm_emulator.msg import Friction
from afm_emulator.srv import ControlResponse


def tau_between(begin, end):
    """Model time from one ModelTime message to another [tau]."""
    return (end.tau - begin.tau) + (end.phase - begin.phase)


class Measurement:
    """Sums over the batches of a period, which come in order and without a gap.

    applied: the Applied message that is in force at its begin
    lever: has tau_s [s], stiffness and lateral_stiffness [N/m], as a Client has
    """

    def __init__(self, applied, lever):
        self.seconds = 0.0  # of model time, by the samples: batches may begin and end between them
        self.first = self.last = None  # header.seq of the batches; None: there is none yet
        self._since, self._lever = applied, lever
        self._begin = self._end = self._last_begin = applied.time
        self._samples, self._impulse = 0, 0.0
        self._vertical = self._vertical_squares = self._lateral_squares = 0.0
        self._impact_count, self._losses = 0, []  # J of a batch each
        self._with_impacts = self._with_friction = 0  # batches
        self._same_speed = True

    def add(self, batch):
        """A Deflection message."""
        if self.first is None:
            self.first = batch.header.seq
        self.last, self._last_begin = batch.header.seq, batch.time
        self._same_speed = self._same_speed and batch.drag_velocity == self._since.drag_velocity
        self._samples += len(batch.vertical)
        self._vertical += sum(batch.vertical)
        self._vertical_squares += sum(y * y for y in batch.vertical)
        self._lateral_squares += sum(x * x for x in batch.lateral)
        self._impulse += batch.lateral_impulse
        self.seconds += len(batch.vertical) * batch.sample_period

    def adders(self):
        """What takes the messages of the topics beside that of the batches."""
        return (('impacts', self.add_impacts), ('friction', self.add_friction))

    def add_impacts(self, messages):
        """(sequence number, bytes) of ImpactArray messages, after those added before: those of its batches count.
        Returns how many of these lack."""
        for data in self._of_period(messages):
            epoch, _, impacts = read_impacts(data)
            if epoch == self._since.epoch:
                self._with_impacts += 1
                self._impact_count += int(impacts['count'].sum(dtype='u8'))
                self._losses.append(math.fsum(impacts['energy_loss'].tolist()))
        return self._batches - self._with_impacts

    def add_friction(self, messages):
        """The same of Friction messages, which have the exact begin and end of each batch."""
        of_period = self._of_period(messages)
        if of_period:
            if self._with_friction == 0:
                self._begin = Friction().deserialize(of_period[0]).begin
            self._end = Friction().deserialize(of_period[-1]).time
            self._with_friction += len(of_period)
        elif self.first is None and messages:  # a period of no length: now
            latest = Friction().deserialize(messages[-1][1])
            if latest.epoch == self._since.epoch and tau_between(self._begin, latest.time) > 0.0:
                self._begin = self._end = latest.time
        return self._batches - self._with_friction

    @property
    def _batches(self):
        return 0 if self.first is None else self.last - self.first + 1

    def _of_period(self, messages):
        return [data for seq, data in messages if self._batches and self.first <= seq <= self.last]

    def answer(self, applied):
        """A ControlResponse, as the emulator gives it in lockstep. applied: the Applied messages since its begin."""
        r = ControlResponse(success=True, epoch=self._since.epoch)
        r.begin, r.end, r.samples = self._begin, self._end, self._samples
        samples, seconds = self._samples or math.nan, tau_between(r.begin, r.end) * self._lever.tau_s or math.nan
        # they act where a batch begins
        r.applied = max([self._since.number] + [m.number for m in applied if m.epoch == self._since.epoch and
                                                tau_between(m.time, self._last_begin) >= 0.0])
        r.mean_vertical = self._vertical / samples
        r.rms_vertical = math.sqrt(self._vertical_squares / samples)
        r.mean_lateral_force = self._impulse / seconds
        r.rms_lateral_force = self._lever.lateral_stiffness * math.sqrt(self._lateral_squares / samples)
        r.mean_normal_force = self._lever.stiffness * r.mean_vertical
        r.impact_count = self._impact_count
        r.energy_loss = math.fsum(self._losses)
        v0 = (self._since.drag_velocity if self._same_speed else 0.0) or math.nan
        r.k_f = r.energy_loss / (v0 * v0 * seconds)
        r.k_f_work = r.mean_lateral_force / v0
        return r
