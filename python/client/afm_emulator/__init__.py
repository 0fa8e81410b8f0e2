"""The client library of the emulator: from afm_emulator import Client.

It is imported when it is first used, since the messages live in this package too and need no rospy.
"""
import threading

# rospy of Debian 11 calls it by a name that Python has dropped
if not hasattr(threading.Thread, 'isAlive'):
    threading.Thread.isAlive = threading.Thread.is_alive


def __getattr__(name):
    if name in ('Client', 'EmulatorError', 'number_parameter'):
        from afm_emulator import client
        return getattr(client, name)
    raise AttributeError('afm_emulator has no %s' % name)
