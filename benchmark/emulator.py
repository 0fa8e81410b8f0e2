"""A ROS master and an emulator of a measurement's own. A measurement prints its table; all else goes to stderr."""
import argparse
import contextlib
import signal
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'scripts'))
from own_master import PATIENCE_S, STDERR, own_master  # noqa: E402,F401  (for those who measure)


def option(description, name, default):
    """The number after --NAME, all that the command line of a measurement holds."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--' + name, type=type(default), default=default)
    return getattr(parser.parse_args(), name)


def binary(name):
    return subprocess.check_output(['catkin_find', '--first-only', '--libexec', 'afm_emulator', name],
                                   text=True).strip()


@contextlib.contextmanager
def emulator(server, parameters):
    """Its process, interrupted at the end."""
    server.setParam('benchmark', '/afm', parameters)
    process = subprocess.Popen([binary('emulator_node'), '__name:=afm'], stdout=STDERR)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()
