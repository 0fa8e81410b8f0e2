"""The front panel on a display of its own: what is turned and pressed takes effect, what comes is drawn; it greys out
without an emulator, comes back with it, shows a recording, and ends when it is asked to. Pictures of it go to the
test's results."""
import os
import signal
import subprocess
import sys
import tempfile
import time

import rospy

from emulator_under_test import SPEED_UNIT, Emulator, EmulatorTest, NodeTest, Process, find
from topics import NAMESPACE, TOPICS, Topic, key, tau_between, wait_until


class Display:
    """An X server, on the first free number."""

    def __init__(self):
        readable, writable = os.pipe()
        self.child = subprocess.Popen(['Xvfb', '-displayfd', str(writable), '-screen', '0', '1000x700x24', '-nolisten',
                                       'tcp'],
                                      pass_fds=[writable], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writable)
        with os.fdopen(readable) as numbers:
            os.environ['DISPLAY'] = ':' + numbers.readline().strip()

    def close(self):
        self.child.terminate()
        self.child.wait()


DISPLAY = Display()
tearDownModule = DISPLAY.close
from PyQt5 import QtCore, QtGui, QtTest, QtWidgets  # noqa: E402
from afm_emulator.panel.link import Link  # noqa: E402
from afm_emulator.panel.pictures import BLUE, ORANGE, friction_curve  # noqa: E402
from afm_emulator.panel.window import NOT_YET, Window  # noqa: E402
from afm_emulator.expectations import results_path  # noqa: E402
from afm_emulator.srv import Step  # noqa: E402

APPLICATION = QtWidgets.QApplication(['panel'])


def until(condition, what):
    """While the window lives."""
    def and_alive():
        APPLICATION.processEvents()
        return condition()
    return wait_until(and_alive, what)


class Panel:
    def __init__(self):
        self.link = Link(NAMESPACE)
        self.window = Window(self.link, friction_curve())
        self.window.show()

    def close(self):
        self.window.close()
        self.window.deleteLater()
        self.link.close()

    def part(self, name):
        found = self.window.findChild(QtWidgets.QWidget, name)
        assert found is not None, 'no %s' % name
        return found

    def is_ready(self):
        return self.window.drag.isEnabled()

    def is_grey(self):
        return all(plot.backgroundBrush().color().name() != '#ffffff' for plot in self.window.plots)

    def press(self, name):
        until(self.part(name).isEnabled, name + ' can be pressed')
        QtTest.QTest.mouseClick(self.part(name), QtCore.Qt.LeftButton)

    def type_in(self, name, text):
        box = self.part(name)
        box.selectAll()
        QtTest.QTest.keyClicks(box, text)
        QtTest.QTest.keyClick(box, QtCore.Qt.Key_Return)

    def pixels(self, plot, colour):
        """How many of that colour a picture has."""
        image = plot.grab().toImage()
        wanted = int(colour[1:], 16)
        return sum(image.pixel(x, y) & 0xffffff == wanted for x in range(image.width()) for y in range(image.height()))

    def on_screen(self, plot):
        """The part of the screen that shows it: grab() paints anew, the screen keeps what nobody paints."""
        corner = plot.mapTo(self.window, QtCore.QPoint(0, 0))
        shown = APPLICATION.primaryScreen().grabWindow(self.window.winId(), corner.x(), corner.y(), plot.width(),
                                                       plot.height())
        return shown.toImage().convertToFormat(QtGui.QImage.Format_RGB32)

    def keep(self, name):
        path = results_path('panel_%s.png' % name)
        assert self.window.grab().save(path), path
        print('a picture of the panel: ' + path)


class Knobs(EmulatorTest):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.parameters = {'bag_directory': cls.directory.name}
        super().setUpClass()
        cls.panel = Panel()
        until(cls.panel.is_ready, 'the panel has found the emulator')

    @classmethod
    def tearDownClass(cls):
        cls.panel.close()
        super().tearDownClass()
        cls.directory.cleanup()

    def applied(self, condition, what):
        until(lambda: self.topics['applied'].messages and condition(self.topics['applied'].messages[-1])
              and condition(self.panel.link.latest('applied')), what)

    def paused_at(self):
        """The time at which it stands, when all of before has come."""
        self.status(lambda m: m.paused and key(m.time) == key(self.time()), 'it stands')
        return self.time()

    def status(self, condition, what):
        until(lambda: condition(self.topics['status'].messages[-1]), what)

    def time(self):
        return self.topics['friction'].messages[-1].time

    def test_the_drag_speed_is_turned(self):
        self.panel.type_in('eta', '2.0')
        self.applied(lambda m: abs(m.drag_velocity / SPEED_UNIT - 2.0) < 1e-9, 'eta = 2')
        until(lambda: abs(self.panel.part('drag_um_s').value() - 2e6 * SPEED_UNIT) < 1e-3, 'the other box follows')
        self.panel.type_in('drag_um_s', '5.5')
        self.applied(lambda m: abs(m.drag_velocity - 5.5e-6) < 1e-15, '5.5 um/s')
        self.panel.press('reverse')
        self.applied(lambda m: abs(m.drag_velocity + 5.5e-6) < 1e-15, '-5.5 um/s')
        slider = self.panel.part('eta_slider')
        before = self.topics['applied'].messages[-1].drag_velocity
        QtTest.QTest.keyClick(slider, QtCore.Qt.Key_Right)
        self.applied(lambda m: before < m.drag_velocity < before + 0.1 * SPEED_UNIT, 'a step of the slider')
        self.panel.press('stop')
        self.applied(lambda m: m.drag_velocity == 0.0, 'a standstill')

    def test_a_knob_follows_what_others_command(self):
        self.drag(-1.5)
        until(lambda: abs(self.panel.part('eta').value() + 1.5) < 1e-3, 'eta = -1.5 is shown')
        # and not commanded again
        self.assertEqual(self.topics['applied'].messages[-1].drag_velocity, -1.5 * SPEED_UNIT)

    def test_load_surface_and_bath(self):
        stiffness = 408e-12 * 40e3 ** 2
        self.panel.type_in('load_pn', '10')
        self.applied(lambda m: abs(m.rest_height_m * stiffness + 10e-12) < 1e-18, '10 pN')
        self.panel.type_in('load_pn', '1,5')  # once 15 pN
        self.panel.type_in('load_pn', '1.2e1')  # once 1.21 pN
        self.applied(lambda m: abs(m.rest_height_m * stiffness + 12e-12) < 1e-18, '12 pN')
        self.assertNotIn(-15e-12, [round(m.rest_height_m * stiffness, 15) for m in self.topics['applied'].messages])
        self.panel.type_in('height_pm', '-20')
        self.applied(lambda m: abs(m.rest_height_m + 20e-12) < 1e-18, '-20 pm')
        self.panel.type_in('gamma', '0.5')
        self.applied(lambda m: m.restitution_gamma == 0.5, 'gamma = 0.5')
        self.panel.type_in('quality', '100')
        self.panel.type_in('temperature', '300')
        self.applied(lambda m: (m.quality_factor, m.temperature_k) == (100.0, 300.0), 'a bath')
        self.emulator.set(quality_factor=2e4, temperature_k=1000.0)  # once shown as 1000 and 400 K
        until(lambda: [self.panel.part(name).value() for name in ('quality', 'temperature')] == [2e4, 1000.0],
              'the boxes show what holds')

    def test_what_is_refused_is_said(self):
        self.panel.type_in('height_pm', '70')  # above the crest: it would hover
        lamps = self.panel.window.lamps
        until(lambda: 'commands' in lamps and 'refused' in lamps['commands'].label.text(), 'a lamp')
        self.panel.window.resize(300, 300)  # smaller than it can be; the reason was cut off
        self.addCleanup(self.panel.window.resize, 1000, 700)
        label = lamps['commands'].label
        until(lambda: self.panel.window.height() < 700 and label.height() >= label.heightForWidth(label.width()),
              'all of it is seen in a small window')
        until(lambda: self.panel.part('height_pm').value() == 0.0, 'the box shows what holds')

    def test_pause_step_and_reset(self):
        self.panel.press('pause')
        begin = self.paused_at()
        self.panel.press('step_tau')
        until(lambda: key(self.time()) > key(begin), 'a step')
        end = self.paused_at()
        self.assertAlmostEqual(tau_between(begin, end), 1.0, delta=1e-12)
        impacts = sum(i.count for m in self.topics['impacts'].messages for i in m.impacts)
        self.panel.press('step_impact')
        until(lambda: sum(i.count for m in self.topics['impacts'].messages for i in m.impacts) > impacts,
              'an impact later')
        epoch = self.topics['status'].messages[-1].epoch
        self.panel.press('reset')
        self.status(lambda m: m.epoch == epoch + 1, 'a new epoch')
        window = self.panel.window
        until(lambda: NOT_YET in window.readouts['friction'].text() and window.trail.now is None
              and self.panel.pixels(window.scope.vertical, BLUE) == 0, 'nothing is shown of the epoch before')
        type(self).epoch = epoch + 1
        until(lambda: self.panel.part('pause').text() == 'Go on', 'the panel knows that it is paused')
        self.panel.press('pause')
        self.status(lambda m: not m.paused and m.time.tau > 10, 'it goes on')

    def test_a_change_of_load_leaves_the_picture_of_the_motion_before_it(self):
        """It was drawn as if the holder had always been where it is now."""
        self.panel.press('pause')
        self.addCleanup(self.panel.press, 'pause')
        self.paused_at()
        window = self.panel.window

        def shown():
            return [line.getData()[1].tolist() for line in (window.scope._Y, window.path._line)]
        end = time.monotonic() + 0.5
        until(lambda: time.monotonic() > end, 'the last batch is shown')
        before = shown()
        self.panel.type_in('height_pm', '-200')
        self.applied(lambda m: abs(m.rest_height_m + 200e-12) < 1e-18, '-200 pm')
        window.refresh()
        self.assertEqual(shown(), before)

    def test_a_run_is_recorded(self):
        self.panel.press('record')
        self.status(lambda m: m.recording, 'it is recorded')
        until(lambda: 'End' in self.panel.part('record').text(), 'the button says so')
        self.panel.press('record')
        self.status(lambda m: not m.recording, 'it is no longer recorded')
        self.assertEqual([name.rsplit('.', 1)[-1] for name in os.listdir(self.directory.name)], ['bag'])

    def test_pictures(self):
        self.panel.type_in('eta', '2.0')
        self.applied(lambda m: abs(m.drag_velocity / SPEED_UNIT - 2.0) < 1e-9, 'eta = 2')
        window = self.panel.window
        until(lambda: 'η = 2.000' in window.readouts['eta'].text() and {'pace', 'numerics'} <= set(window.lamps),
              'read-outs')
        until(lambda: window.trail.past.shape[1] > 0, 'a trail')
        for plot, colour, least in ((window.scope.vertical, BLUE, 300), (window.scope.lateral, ORANGE, 300),
                                    (window.path.plot, BLUE, 200), (window.loop_plot.plot, BLUE, 50),
                                    (window.curve.plot, ORANGE, 10)):
            until(lambda: self.panel.pixels(plot, colour) > least, 'it is drawn')
        self.panel.keep('eta_2')
        for _ in range(5):
            before = window.link.latest('applied').drag_velocity  # what the panel knows, which others may know sooner
            self.panel.press('reverse')
            until(lambda: window.link.latest('applied').drag_velocity == -before, 'reversed')
        until(lambda: self.panel.pixels(window.loop_plot.plot, ORANGE) > 50, 'a retrace')
        self.panel.keep('loop')

    def test_held_pictures_stand_still(self):
        self.panel.press('hold')
        end = time.monotonic() + 0.2
        until(lambda: time.monotonic() > end, '')
        still = self.panel.window.scope.vertical.grab().toImage()
        self.panel.window.refresh()
        self.assertEqual(self.panel.window.scope.vertical.grab().toImage(), still)
        self.panel.press('hold')
        until(lambda: self.panel.window.scope.vertical.grab().toImage() != still, 'it goes on')

    def test_the_screen_shows_the_newest_pictures(self):
        self.panel.type_in('eta', '3.4')
        self.applied(lambda m: abs(m.drag_velocity / SPEED_UNIT - 3.4) < 1e-9, 'a motion that never repeats')
        window = self.panel.window
        plots = window.scope.vertical, window.scope.lateral, window.path.plot, window.loop_plot.plot
        end = time.monotonic() + 1.0
        until(lambda: time.monotonic() > end, 'motions on the screen, one after another')
        self.panel.press('hold')
        self.addCleanup(self.panel.press, 'hold')
        for plot in plots:
            newest = plot.grab().toImage().convertToFormat(QtGui.QImage.Format_RGB32)
            until(lambda: self.panel.on_screen(plot) == newest, 'the newest picture is on the screen')


class Coming(NodeTest):
    def test_greys_out_and_comes_back(self):
        panel = Panel()
        self.addCleanup(panel.close)
        APPLICATION.processEvents()
        self.assertFalse(panel.is_ready())
        for _ in range(2):
            master, uri = rospy.get_master(), rospy.get_node_uri()  # it forgets the panel, as a new one would
            for topic in ('drag_velocity', 'rest_height'):
                master.unregisterPublisher('/afm/' + topic, uri)
            for topic in TOPICS:
                master.unregisterSubscriber('/afm/' + topic, uri)
            emulator = self.start(Emulator())
            until(panel.is_ready, 'it has found the emulator')
            until(lambda: not panel.part('banner').isVisible(), 'it says nothing any more')
            self.assertFalse(panel.is_grey())
            os.kill(emulator.child.pid, signal.SIGKILL)
            emulator.wait()
            until(panel.is_grey, 'it greys out')
            self.assertFalse(panel.is_ready())
            until(lambda: 'no emulator' in panel.part('banner').text(), 'it says why')
        panel.keep('without_emulator')

    def test_shows_nothing_of_the_emulator_before(self):
        """On a model clock the configurations of two are equal to the byte."""
        panel = Panel()
        self.addCleanup(panel.close)
        friction, scope = panel.window.readouts['friction'], panel.window.scope.vertical
        for _ in range(2):
            emulator = self.start(Emulator({'pace': 'lockstep', 'publish_clock': True}))
            until(panel.is_ready, 'it has found the emulator')
            until(lambda: NOT_YET in friction.text() and panel.pixels(scope, BLUE) == 0, 'nothing has run')
            emulator.call('step', Step, tau=200.0)
            until(lambda: '±' in friction.text() and panel.pixels(scope, BLUE) > 300, 'a motion and its friction')
            emulator.assert_alive()
            self.assertEqual(emulator.stop(), 0)

    def test_shows_a_recording(self):
        emulator = self.record(record=True)
        status = Topic('status')
        status.wait_for(lambda m: m.time.tau > 7000, 'a second of the run')
        bag, = self.end(emulator)
        panel = Panel()
        self.addCleanup(panel.close)
        self.start(Process([find('play', 'rosbag'), '--quiet', '--loop', bag]))
        banner = panel.part('banner')
        until(lambda: banner.isVisible() and 'recording' in banner.text(), 'it knows a recording')
        until(lambda: 'η = 3.400' in panel.window.readouts['eta'].text(), 'its drag speed')
        until(lambda: panel.pixels(panel.window.scope.vertical, BLUE) > 300, 'its signals')
        self.assertFalse(panel.is_ready() or panel.is_grey())
        self.assertTrue(panel.part('hold').isEnabled())
        panel.keep('recording')


class Ending(NodeTest):
    def test_without_a_display(self):
        for display, why in ((None, 'DISPLAY is not set'), (':987', ':987 cannot be opened')):
            environment = {name: value for name, value in os.environ.items()
                           if name not in ('DISPLAY', 'WAYLAND_DISPLAY')}
            if display:
                environment['DISPLAY'] = display
            panel = self.start(Process([find('panel')], environment))
            self.assertEqual(panel.wait(), 1)
            self.assertEqual(panel.output().count('\n'), 1, panel.output())
            self.assertIn(why, panel.output())

    def test_of_an_emulator_that_cannot_be(self):
        for name in ('/bad name', '5'):
            panel = self.start(Process([find('panel'), '_emulator:=' + name]))
            self.assertEqual(panel.wait(), 1, panel.output())
            self.assertIn('emulator = "%s": is no name of a node' % name, panel.output())

    def test_when_its_window_is_closed(self):
        close_it = '''
import os, sys
from afm_emulator import ending
from afm_emulator.panel import application
class Closed(application.Window):
    def showEvent(self, event):
        super().showEvent(event)
        os.write(1, b'closing')
        application.QtCore.QTimer.singleShot(300, self.close)
application.Window = Closed
sys.exit(application.run())
'''
        panel = self.start(Process([sys.executable, '-c', close_it]))
        wait_until(lambda: 'closing' in panel.output(), 'it is closed')
        self.assertIn(panel.wait(), (0, -signal.SIGALRM), panel.output())  # else the kernel ends it, after a second
