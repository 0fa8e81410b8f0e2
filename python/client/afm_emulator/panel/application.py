"""From the command line to the window and back."""
import sys

import rosgraph.names
import rospy
from PyQt5 import QtCore, QtWidgets

from .. import ending
from .link import Link
from .pictures import friction_curve
from .window import Window

WATCH_MS = 100  # for the end


def run():
    application = QtWidgets.QApplication(sys.argv)
    ending.init_node('panel', anonymous=True)
    emulator = str(rospy.get_param('~emulator', 'afm'))
    if not emulator or not rosgraph.names.is_legal_name(emulator):
        print('panel: emulator = "%s": is no name of a node' % emulator, file=sys.stderr)
        return 1
    name = rosgraph.names.ns_join('/', rospy.resolve_name(emulator))
    window = Window(Link(name), friction_curve(), rospy.get_param('~lever', ''))
    window.resize(window.size().boundedTo(application.primaryScreen().availableSize()))
    window.show()
    watch = QtCore.QTimer(interval=WATCH_MS, timeout=lambda: rospy.is_shutdown() and application.quit())
    watch.start()
    application.exec_()
    rospy.signal_shutdown('the window is closed')
    return 0
