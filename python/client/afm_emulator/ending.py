"""Import this early: from here on the node ends at SIGINT, SIGTERM and SIGHUP, whenever they come.

rospy's own handler runs in the middle of what the main thread does, an import or a lock that it waits for, and the node
may hang. Here a thread of its own waits for the signal. It asks rospy to shut down, and a second later the kernel ends
the process. The signal may also come to a thread that was started before, as numpy starts some, or be ignored, as by a
script's `&`. So Python writes it to a pipe, whichever thread gets it, and another thread reads it there.
"""
import os
import signal
import sys
import threading

# the last where the terminal is closed, unless nohup keeps it off
SIGNALS = (signal.SIGINT, signal.SIGTERM) + (signal.SIGHUP,) * (signal.getsignal(signal.SIGHUP) != signal.SIG_IGN)
LEAVE_S = 1  # to take leave of the master
asked = threading.Event()  # by a signal, not by the master


def _wait():
    signal.sigwait(SIGNALS)
    _end()


def _read(pipe):
    while os.read(pipe, 1)[0] not in SIGNALS:  # others with a handler in Python are written too
        pass
    _end()


def _end():
    asked.set()
    signal.alarm(LEAVE_S)  # no lock holds it up
    rospy = sys.modules.get('rospy')
    if rospy is None or not hasattr(rospy, 'core') or not rospy.core.is_initialized():
        os._exit(0)  # nobody knows this node yet
    rospy.signal_shutdown('signal')


def unblock():
    """For a child, which would inherit that signals are blocked: subprocess.Popen(..., preexec_fn=ending.unblock)."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


def init_node(name, **options):
    """rospy.init_node() without rospy's handlers."""
    import rospy
    rospy.init_node(name, disable_signals=True, **options)


def _leave():
    """A child of multiprocessing has the pipe too: its signals would end this node."""
    signal.set_wakeup_fd(-1)
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)
    unblock()


def _begin():
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    for number in SIGNALS:
        # for a library that takes the place of the pipe for a time, as matplotlib does while it shows a window
        signal.signal(number, lambda number, _: os.write(writing, bytes([number])))
    os.register_at_fork(after_in_child=_leave)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)  # for every thread that is started from here on
    threading.Thread(target=_wait, daemon=True).start()
    threading.Thread(target=_read, args=(reading,), daemon=True).start()


_begin()
