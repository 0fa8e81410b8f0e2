"""A ROS master and an emulator of a measurement's own."""
import contextlib
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'scripts'))
from own_master import PATIENCE_S, own_master  # noqa: E402,F401  (for those who measure)

DATA = ROOT / 'docs/data'


def binary(name):
    return subprocess.check_output(['catkin_find', '--first-only', '--libexec', 'afm_emulator', name],
                                   text=True).strip()


@contextlib.contextmanager
def emulator(server, parameters):
    """Its process, interrupted at the end."""
    server.setParam('benchmark', '/afm', parameters)
    process = subprocess.Popen([binary('emulator_node'), '__name:=afm'])
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def write_table(path, lines):
    path.write_text('\n'.join(lines) + '\n')
    print('\n'.join(lines))
