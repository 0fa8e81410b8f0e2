#!/usr/bin/python3
"""What the front panel takes of a core, and how often it draws: starts an X server, a master and an emulator of its
own, at the default sample rate and at the greatest. Prints the table of docs/interface.md.

usage: panel_load.py [--seconds S]     (default: 20)"""
import os
import subprocess
import time

from emulator import emulator, option, own_master

RATES = (200e3, 1e6)  # the default, and the greatest
ETA_3_4 = 1.1255437575458838e-05  # m/s on mica: the chaotic motion of the paper
WARM_UP_S = 5.0


def watch(seconds):
    """(frames a second of the slowest picture, share of a core of the whole process)."""
    import rospy
    from PyQt5 import QtCore, QtWidgets
    from afm_emulator.panel.link import Link
    from afm_emulator.panel.pictures import friction_curve
    from afm_emulator.panel.window import Window

    class Paints(QtCore.QObject):
        count = 0

        def eventFilter(self, _, event):
            self.count += event.type() == QtCore.QEvent.Paint
            return False

    application = QtWidgets.QApplication.instance() or QtWidgets.QApplication(['panel_load'])
    if not rospy.core.is_initialized():
        rospy.init_node('panel_load', anonymous=True, disable_rostime=True)
    window = Window(Link('/afm'), friction_curve())
    window.show()
    paints = []
    for picture in (window.scope.vertical, window.scope.lateral, window.path.plot):  # drawn at every frame
        paints.append(Paints())
        picture.viewport().installEventFilter(paints[-1])

    def pass_time(duration):
        QtCore.QTimer.singleShot(round(1e3 * duration), application.quit)
        application.exec_()

    pass_time(WARM_UP_S)
    before, cpu, begin = [paint.count for paint in paints], time.process_time(), time.monotonic()
    pass_time(seconds)
    cpu, elapsed = time.process_time() - cpu, time.monotonic() - begin
    window.close()
    window.link.close()
    return min(paint.count - count for paint, count in zip(paints, before)) / elapsed, cpu / elapsed


def main():
    seconds = option(__doc__, 'seconds', 20.0)
    display = subprocess.Popen(['Xvfb', '-displayfd', '1', '-screen', '0', '1000x700x24', '-nolisten', 'tcp'],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    os.environ['DISPLAY'] = ':' + display.stdout.readline().strip()
    print('sample rate / Hz,frames a second,CPU seconds per second')
    try:
        with own_master() as server:
            for rate in RATES:
                with emulator(server, {'sample_rate_hz': rate, 'drag_velocity': ETA_3_4}):
                    print('%g,%.1f,%.3f' % ((rate,) + watch(seconds)), flush=True)
    finally:
        display.kill()


if __name__ == '__main__':
    main()
